#include "report/contact_order.hpp"

#include <algorithm>

namespace crashrank::detail {

std::vector<AnyContact> contacts_in_order(const CandidateResult& ranked) {
  std::vector<AnyContact> all;
  all.reserve(ranked.contacts.size() + ranked.further.size());
  for (const Contact& contact : ranked.contacts) all.push_back({&contact, nullptr});
  for (const FurtherContact& contact : ranked.further) all.push_back({nullptr, &contact});
  std::stable_sort(all.begin(), all.end(), [](const AnyContact& p, const AnyContact& q) {
    return p.time_s() < q.time_s();
  });
  return all;
}

}  // namespace crashrank::detail
