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
      escape_xml(names), time_s, fixed_text(3.6 * closing_mps, 0),
      fixed_text(3.6 * a.exposure_mps, 0), fixed_text(3.6 * b.exposure_mps, 0));
}

/// What the contact does to both bodies, after SAE J224; fixed ones have no code.
std::string codes(const BodyOutcome& a, const BodyOutcome& b) {
  return a.cdc + (a.cdc.empty() || b.cdc.empty() ? "" : " / ") + b.cdc;
}

}  // namespace

std::string contact_table(const Scenario& scenario, Measure measure,
                          const CandidateResult& ranked) {
  const bool has_harm = measure == Measure::harm;
  std::string html =
      "<table class='parts contacts'><caption>contacts <span class='words'>exposure: the "
      "body's greatest change of velocity by contacts alone within 0.3 s</span></caption><thead>"
      "<tr><th>bodies</th><th>after s</th><th>closing km/h</th><th>exposure of first km/h</th>"
      "<th>of second km/h</th>";
  if (has_harm) html += "<th>harm</th>";
  html += "<th>energy kJ</th><th>CDC</th>";
  html += "</tr></thead><tbody>\n";
  for (const AnyContact& contact : contacts_in_order(ranked)) {
    double harm = 0.0;
    double dissipated_j = 0.0;
    std::string cdc;
    if (contact.own != nullptr) {
      const Contact& own = *contact.own;
      html += row_of("our car / " + contact_name(scenario, own), own.time_of_impact_s,
                     own.closing_speed_mps, own.severity.ego, own.severity.other);
      harm = own.severity.harm;
      dissipated_j = own.severity.dissipated_j;
      cdc = codes(own.severity.ego, own.severity.other);
    } else {
      const FurtherContact& further = *contact.further;
      html += row_of(pair_name(scenario, further), further.time_s, further.closing_speed_mps,
                     further.outcome_a, further.outcome_b);
      harm = further.harm;
      dissipated_j = further.dissipated_j;
      cdc = codes(further.outcome_a, further.outcome_b);
    }
    if (has_harm) html += "<td class='n'>" + harm_text(harm) + "</td>";
    html += fmt::format("<td class='n'>{:.0f}</td><td>{}</td></tr>\n", 1e-3 * dissipated_j,
                        escape_xml(cdc));
  }
  return html + "</tbody></table>\n";
}

}  // namespace crashrank::detail
