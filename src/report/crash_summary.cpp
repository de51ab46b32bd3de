#include "report/crash_summary.hpp"

#include <algorithm>

namespace crashrank::detail {
namespace {

void add(CrashSummary& sum, const BodyOutcome& outcome) {
  sum.exposure_mps = std::max(sum.exposure_mps, outcome.exposure_mps);
  sum.crush_m = std::max(sum.crush_m, outcome.crush_m);
  sum.harm += outcome.harm;
}

}  // namespace

CrashSummary crash_of_ego(const CandidateResult& ranked) {
  CrashSummary sum;
  for (const Contact& contact : ranked.contacts) add(sum, contact.severity.ego);
  return sum;
}

CrashSummary crash_of_others(const CandidateResult& ranked) {
  CrashSummary sum;
  for (const Contact& contact : ranked.contacts) add(sum, contact.severity.other);
  for (const FurtherContact& further : ranked.further) {
    add(sum, further.outcome_a);
    add(sum, further.outcome_b);
  }
  return sum;
}

}  // namespace crashrank::detail
