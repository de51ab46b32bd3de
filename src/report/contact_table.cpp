#include "report/contact_table.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "report/contact_order.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

namespace crashrank::detail {
namespace {

std::string row_of(const std::string& names, double time_s, double closing_mps,
                   const BodyOutcome& a, const BodyOutcome& b) {
  return fmt::format(
      "<tr><td>{}</td><td class='n'>{:.3f}</td><td class='n'>{}</td><td class='n'>{}</td>"
      "<td class='n'>{}</td>",
      escape_xml(names), time_s, fixed_text(closing_mps, 1), fixed_text(a.exposure_mps, 1),
      fixed_text(b.exposure_mps, 1));
}

}  // namespace

std::string contact_table(const Scenario& scenario, Measure measure,
                          const CandidateResult& ranked) {
  const bool has_harm = measure == Measure::harm;
  std::string html =
      "<table class='parts contacts'><caption>contacts</caption><thead><tr><th>bodies</th>"
      "<th>after s</th><th>closing m/s</th><th>exposure m/s, first</th><th>second</th>";
  if (has_harm) html += "<th>harm</th>";
  html += "</tr></thead><tbody>\n";
  for (const AnyContact& contact : contacts_in_order(ranked)) {
    double harm = 0.0;
    if (contact.own != nullptr) {
      const Contact& own = *contact.own;
      html += row_of("ego / " + contact_name(scenario, own), own.time_of_impact_s,
                     own.closing_speed_mps, own.severity.ego, own.severity.other);
      harm = own.severity.harm;
    } else {
      const FurtherContact& further = *contact.further;
      html += row_of(pair_name(scenario, further), further.time_s, further.closing_speed_mps,
                     further.outcome_a, further.outcome_b);
      harm = further.harm;
    }
    if (has_harm) html += "<td class='n'>" + harm_text(harm) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

}  // namespace crashrank::detail
