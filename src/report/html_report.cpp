#include "crashrank/report/ranking.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "report/base64.hpp"
#include "report/contact_table.hpp"
#include "report/crash_summary.hpp"
#include "report/damage_summary.hpp"
#include "report/future_words.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/page/embedded.hpp"
#include "report/parts_table.hpp"
#include "report/plan_view.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"
#include "report/still_picture.hpp"
#include "report/view_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace crashrank {
namespace {

using detail::DamageSummary;

class Page {
public:
  Page(const Scenario& scenario, View<const Model> models, const RankResult& result,
       const HtmlReportOptions& options)
      : scenario_(scenario), models_(models), result_(result), plan_(scenario, models, result) {
    const std::size_t all = result.ranking.size();
    const std::size_t drawn = options.drawn == 0 ? all : std::min(options.drawn, all);
    for (std::size_t place = 0; place < drawn; ++place) places_.push_back(place);
    if (drawn < all) places_.push_back(all - 1);
    scores_ = detail::score_texts(result);
    data_ = detail::view_data(scenario, models, result, places_, options.model_triangles);
  }

  std::string html() {
    head();
    verdict();
    if (has_view()) {
      view();
    } else if (detail::embedded_three().empty()) {
      out_ +=
          "<p class='note'>The 3-D view is missing: this crashrank was built without "
          "three.js.</p>\n";
    }
    table();
    for (const std::size_t place : places_) candidate(place);
    foot();
    return std::move(out_);
  }

private:
  bool has_view() const { return !detail::embedded_three().empty() && !places_.empty(); }

  bool has_futures() const { return result_.futures.method != FutureMethod::certain; }

  bool is_drawn(std::size_t place) const {
    return std::binary_search(places_.begin(), places_.end(), place);
  }

  const std::string& name_of(std::size_t place) const {
    return result_.candidates[result_.ranking[place].candidate].name;
  }

  void head() {
    out_ +=
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
        "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
        "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<title>";
    out_ += escape_xml(scenario_.name) + " - crashrank</title>\n<style>";
    out_ += detail::embedded_style();
    out_ += "</style></head><body>\n<header><h1>" + escape_xml(scenario_.name) + "</h1>\n";
    if (!scenario_.description.empty()) {
      out_ += "<p>" + escape_xml(scenario_.description) + "</p>\n";
    }
    const auto free =
        std::count_if(result_.ranking.begin(), result_.ranking.end(), [](const CandidateResult& r) {
          return r.score && !r.collides && !(r.collision_probability > 0.0);
        });
    out_ += fmt::format(
        "<p class='facts'>{} candidates, {} other{} on the road, {} {}touch nothing. Ranked by {} "
        "[{}], lower is better, in {:.1f} ms{}.</p></header>\n",
        result_.ranking.size(), scenario_.actors.size(), scenario_.actors.size() == 1 ? "" : "s",
        free, result_.complete ? "" : "are known to ", measure_name(result_.measure),
        escape_xml(measure_unit(result_.measure)), result_.elapsed_s * 1e3,
        result_.complete ? "" : "; the answer is partial");
    for (const std::string& doubt : ranking_doubts(scenario_, models_, result_)) {
      out_ += "<p class='note'>Doubtful: " + escape_xml(doubt) + ".</p>\n";
    }
  }

  void verdict() {
    if (result_.ranking.empty()) return;
    out_ += fmt::format("<section class='verdict {}'><h2>", how_bad());
    out_ += !result_.proved                    ? "Best guess so far: "
            : result_.measure == Measure::harm ? "Least harmful: "
                                               : "Least destructive: ";
    out_ += escape_xml(name_of(0));
    if (result_.ranking[0].sharing > 1) {
      out_ += fmt::format(", tied with {} more", result_.ranking[0].sharing - 1);
    }
    out_ += "</h2>\n";
    out_ += result_.ranking.size() > 1
                ? "<p>" +
                      escape_xml(detail::reason_words(scenario_, models_, result_, scores_, 0)) +
                      "</p>\n"
                : "<p>It is the only candidate.</p>\n";
    if (!result_.proved) {
      out_ += "<p class='note'>The first place is not proved; still in the race: ";
      for (std::size_t i = 0; i < result_.in_race.size(); ++i) {
        if (i > 0) out_ += ", ";
        out_ += escape_xml(result_.candidates[result_.in_race[i]].name);
      }
      out_ += "</p>\n";
    }
    const std::vector<std::string> futures = detail::future_words(scenario_, result_);
    if (!futures.empty()) {
      out_ += "<p class='note' id='futures'>";
      for (std::size_t i = 0; i < futures.size(); ++i) {
        out_ += (i > 0 ? "<br>" : "") + escape_xml(futures[i]);
      }
      out_ += "</p>\n";
    }
    const std::vector<std::string> pushed =
        detail::pushed_words(scenario_, result_, result_.ranking.size());
    if (!pushed.empty()) {
      out_ += "<p class='note'>Hurt by a contact between others:";
      for (const std::string& words : pushed) out_ += "<br>" + escape_xml(words);
      out_ += "</p>\n";
    }
    const std::vector<std::string> open =
        detail::not_separable_words(result_, result_.ranking.size());
    if (!open.empty()) {
      constexpr std::size_t shown = 12;
      out_ += "<p class='note' id='separability'>";
      for (std::size_t i = 0; i < std::min(shown, open.size()); ++i) {
        out_ += (i > 0 ? "; " : "") + escape_xml(open[i]);
      }
      if (open.size() > shown) out_ += fmt::format("; and {} more pairs", open.size() - shown);
      out_ += ".</p>\n";
    } else if (!result_.samples.empty() && result_.ranking.size() > 1) {
      out_ += fmt::format(
          "<p class='note' id='separability'>Every place is separable from the next: no order "
          "reverses "
          "in more than {:.0f} % of {} samples of what is not known, nor with longer steps "
          "or 1 mm aside{}.</p>\n",
          100.0 * separable_share, range_sample_count(result_),
          result_.futures.method == FutureMethod::sampled
              ? ", and every difference exceeds two standard errors of the sample of futures"
              : "");
    }
    out_ += "</section>\n";
  }

  /// Colour of the verdict: how much harm even the best choice does.
  const char* how_bad() const {
    const CandidateResult& best = result_.ranking.front();
    if (result_.measure != Measure::harm || !best.score) return "unweighted";
    constexpr double few = 0.02;
    constexpr double many = 0.2;
    return *best.score < few ? "slight" : *best.score < many ? "grave" : "severe";
  }

  bool simulated() const { return needs_crash(result_.measure); }

  /// The winner's scene as a picture, for print and for browsers without WebGL.
  void still() {
    const Result<std::string> drawn = detail::still_picture(scenario_, models_, result_, 0);
    if (!drawn) return;
    out_ += "<figure class='still'><img alt='' src='data:image/png;base64,";
    out_ += detail::base64(drawn->data(), drawn->size());
    out_ += "'><figcaption>" + escape_xml(name_of(0)) +
            (result_.ranking.front().contacts.empty() ? ", at the end of the plan"
                                                      : ", at first contact; damage is red") +
            "</figcaption></figure>\n";
  }

  void view() {
    out_ += "<section class='stage'>\n";
    still();
    out_ +=
        "<div id='view'><p id='view-note'>The 3-D view needs a browser "
        "with JavaScript and WebGL.</p></div>\n"
        "<noscript><style>#view { height: auto; }</style></noscript>\n"
        "<div class='controls'><b id='view-title'></b> <label>pull apart <input id='apart' "
        "type='range' min='0' max='3' step='0.05' value='0'></label> "
        "<span>drag to turn, wheel to come nearer; damage is red</span></div>\n";
    if (data_.left_out) {
      out_ += "<p class='note'>Models of very many triangles are left out of the 3-D view.</p>\n";
    }
    out_ += "</section>\n";
  }

  void table() {
    double top = 0.0;
    for (const CandidateResult& ranked : result_.ranking) {
      top = std::max(top, ranked.score.value_or(ranked.score_interval.highest));
    }
    out_ +=
        "<section class='wide'><h2>Ranking</h2>\n<table class='ranking'><thead><tr><th>rank</th>"
        "<th>candidate</th><th>";
    out_ += std::string(measure_name(result_.measure)) + " [" +
            escape_xml(measure_unit(result_.measure)) + "]</th>";
    if (simulated()) out_ += "<th>interval</th><th class='roomy'>may rank</th>";
    if (has_futures()) out_ += "<th>collides</th>";
    out_ += has_futures() ? "<th>likeliest hits</th>" : "<th>hits</th>";
    out_ +=
        "<th class='roomy'>after s</th><th class='roomy'>closing m/s</th></tr></thead>"
        "<tbody>\n";
    for (std::size_t place = 0; place < result_.ranking.size(); ++place) row(place, top);
    out_ += "</tbody></table></section>\n";
  }

  void row(std::size_t place, double top) {
    const CandidateResult& ranked = result_.ranking[place];
    const double score = ranked.score.value_or(ranked.score_interval.highest);
    const double width = top > 0.0 && std::isfinite(score) ? 110.0 * score / top : 0.0;
    out_ += fmt::format("<tr data-place='{}'><td class='n'>{}</td>", place + 1,
                        detail::place_text(ranked));
    out_ += is_drawn(place) ? fmt::format("<td><a href='#c{}'>", place + 1) : std::string("<td>");
    out_ += escape_xml(name_of(place)) + (is_drawn(place) ? "</a>" : "");
    const std::string mark = detail::manoeuvre_mark(ranked);
    out_ += (mark.empty() ? "" : " <em>" + mark + "</em>") + "</td>";
    out_ += fmt::format("<td class='score'><span class='bar' style='width:{:.1f}px'></span>{}</td>",
                        width, scores_[place]);
    if (simulated()) {
      out_ += "<td class='n'>" + detail::interval_text(ranked) + "</td><td class='n roomy'>" +
              detail::places_text(ranked) + "</td>";
    }
    if (has_futures()) {
      out_ += "<td class='n'>" +
              (ranked.score || ranked.searched ? detail::percent_text(ranked.collision_probability)
                                               : std::string()) +
              "</td>";
    }
    if (ranked.first_touch) {
      const FirstTouch& touch = *ranked.first_touch;
      out_ += fmt::format(
          "<td>{}</td><td class='n roomy'>{:.3f}</td><td class='n roomy'>{}</td></tr>\n",
          escape_xml(scenario_.actors[touch.actor].name), touch.time_of_impact_s,
          detail::fixed_text(touch.closing_speed_mps, 1));
      return;
    }
    if (ranked.contacts.empty()) {
      out_ += "<td colspan='3' class='free'>";
      out_ += escape_xml(detail::passing_words(scenario_, ranked));
      out_ += "</td></tr>\n";
      return;
    }
    const Contact& first = ranked.contacts.front();
    std::string hit;
    for (const std::size_t actor : detail::hit_actors(ranked)) {
      hit += hit.empty() ? detail::contact_name(scenario_, first)
                         : ", " + scenario_.actors[actor].name;
    }
    for (const detail::FurtherPair& pair : detail::further_pairs(ranked)) {
      hit += ", " + detail::pair_name(scenario_, *pair.first);
    }
    out_ += fmt::format(
        "<td><details><summary>{}</summary>{}</details></td><td class='n roomy'>{:.3f}</td>"
        "<td class='n roomy'>{}</td></tr>\n",
        escape_xml(hit), outcome_lines(ranked), first.time_of_impact_s,
        detail::fixed_text(first.closing_speed_mps, 1));
  }

  std::string outcome_lines(const CandidateResult& ranked) const {
    const Contact& first = ranked.contacts.front();
    const DamageSummary ego = detail::summary_of(ranked.ego, models_[scenario_.ego.model].mesh);
    const DamageSummary other = detail::summary_of_others(scenario_, models_, ranked);
    std::string parts;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, ego.parts.size()); ++i) {
      if (i > 0) parts += ", ";
      parts += ego.parts[i];
    }
    if (ego.parts.size() > 4) parts += fmt::format(" and {} more", ego.parts.size() - 4);
    std::string lines =
        fmt::format("after {:.3f} s, closing with {} m/s, {} along the normal",
                    first.time_of_impact_s, detail::fixed_text(first.closing_speed_mps, 1),
                    detail::fixed_text(first.normal_speed_mps, 1));
    if (simulated()) lines += severity_lines(ranked);
    lines += fmt::format("<br>damaged m²: ego {}, others {}", detail::fixed_text(ego.area_m2, 2),
                         detail::fixed_text(other.area_m2, 2));
    if (!parts.empty()) lines += "<br>ego's parts: " + escape_xml(parts);
    return lines;
  }

  /// As many digits as the ranges leave of anything.
  static std::string severity_lines(const CandidateResult& ranked) {
    const detail::CrashSummary ego = detail::crash_of_ego(ranked);
    const detail::CrashSummary others = detail::crash_of_others(ranked);
    return fmt::format(
        "<br>exposure m/s: ego {}, others up to {}<br>crush m: ego {}, others up to {}"
        "<br>harm: ego {}, others {}",
        detail::fixed_text(ego.exposure_mps, 1), detail::fixed_text(others.exposure_mps, 1),
        detail::fixed_text(ego.crush_m, 2), detail::fixed_text(others.crush_m, 2),
        detail::harm_text(ego.harm), detail::harm_text(others.harm));
  }

  void candidate(std::size_t place) {
    const CandidateResult& ranked = result_.ranking[place];
    out_ +=
        fmt::format("<section class='candidate' id='c{}'><h2>{}. {}{}</h2>\n", place + 1,
                    ranked.place, escape_xml(name_of(place)), ranked.sharing > 1 ? " (tied)" : "");
    out_ += "<p>It " + escape_xml(detail::outcome_words(scenario_, ranked)) + ": " +
            escape_xml(detail::score_words(ranked, scores_[place], result_.measure)) + ". " +
            escape_xml(detail::manoeuvre_words(scenario_, ranked));
    if (place > 0 && place + 1 < result_.ranking.size() && is_drawn(place + 1)) {
      out_ += std::string(ranked.place == result_.ranking[place + 1].place
                              ? " Tied with the next: "
                              : " Why it stands before the next: ") +
              escape_xml(detail::reason_words(scenario_, models_, result_, scores_, place));
    }
    out_ += "</p>\n<div class='columns'>\n" + plan_.draw(place);
    out_ += "<div>\n";
    if (!ranked.contacts.empty()) {
      if (has_view()) {
        out_ += fmt::format("<button data-place='{}'>show in 3-D</button>\n", place + 1);
      }
      out_ += detail::contact_table(scenario_, result_.measure, ranked);
      out_ += detail::parts_table("ego", models_[scenario_.ego.model].mesh, ranked.ego);
      for (const detail::DamagedBody& body : detail::damaged_others(scenario_, models_, ranked)) {
        out_ +=
            detail::parts_table(scenario_.actors[body.actor].name,
                                detail::mesh_of_actor(scenario_, models_, body.actor), body.damage);
      }
    }
    out_ += "</div></div></section>\n";
  }

  void foot() {
    if (places_.size() < result_.ranking.size()) {
      out_ += fmt::format("<p class='more'>{} candidates are drawn: the best and the worst.</p>\n",
                          places_.size());
    }
    out_ +=
        "<footer>Made by crashrank. Plans: the ego blue, what it hits sand, the shaded outline "
        "its start, the arrow the closing velocity, damage red, a ring where two others collide. "
        "Damage is what the "
        "bodies pass through of each other, as rigid ones, in the simulated contact, not a "
        "deformation.";
    if (result_.measure != Measure::harm) {
      out_ += " The measure is one of the crash, not of harm to people.";
    } else {
      for (const std::string& line : detail::harm_words(result_.harm)) {
        out_ += "<br>" + escape_xml(line);
      }
    }
    out_ += "</footer>\n";
    if (has_view()) {
      out_ += "<script>";
      add_script(detail::embedded_three());
      out_ += "</script>\n<script type='application/json' id='view-data'>";
      out_ += data_.json;
      out_ += "</script>\n<script>";
      out_ += detail::embedded_view();
      out_ += "</script>\n";
    }
    out_ += "</body></html>\n";
  }

  // A script's own strings might hold what ends its element.
  void add_script(std::string_view text) {
    constexpr std::string_view end = "</script";
    for (std::size_t at = text.find(end); at != std::string_view::npos; at = text.find(end)) {
      out_ += text.substr(0, at);
      out_ += "<\\/script";
      text.remove_prefix(at + end.size());
    }
    out_ += text;
  }

  const Scenario& scenario_;
  View<const Model> models_;
  const RankResult& result_;
  detail::PlanView plan_;
  std::vector<std::size_t> places_;  // drawn, rising
  std::vector<std::string> scores_;  // by row
  detail::ViewData data_;
  std::string out_;
};

}  // namespace

std::string html_report(const Scenario& scenario, View<const Model> models,
                        const RankResult& result, const HtmlReportOptions& options) {
  if (!is_uncertain(scenario)) return Page(scenario, models, result, options).html();
  const Scenario shown = likeliest_future(scenario);
  return Page(shown, models, result, options).html();
}

}  // namespace crashrank
