#include "crashrank/report/ranking.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "report/base64.hpp"
#include "report/contact_table.hpp"
#include "report/damage_summary.hpp"
#include "report/decision.hpp"
#include "report/future_words.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/page/embedded.hpp"
#include "report/page_data.hpp"
#include "report/page_mesh.hpp"
#include "report/page_rows.hpp"
#include "report/parts_table.hpp"
#include "report/plan_view.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"
#include "report/still_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace crashrank {
namespace {

class Page {
public:
  /// `scenario` is the likeliest future of `asked`.
  Page(const Scenario& asked, const Scenario& scenario, View<const Model> models,
       const RankResult& result, const HtmlReportOptions& options)
      : scenario_(scenario),
        models_(models),
        result_(result),
        plan_(scenario, models, result),
        options_(options) {
    const std::size_t all = result.ranking.size();
    const std::size_t drawn = options.drawn == 0 ? all : std::min(options.drawn, all);
    for (std::size_t place = 0; place < drawn; ++place) places_.push_back(place);
    if (drawn < all) places_.push_back(all - 1);
    scores_ = detail::score_texts(result);
    full_bar_ = detail::full_bar(result);
    data_ = detail::page_data(asked, scenario, models, result, scores_, places_,
                              options.model_triangles);
  }

  std::string html() {
    head();
    if (!result_.ranking.empty()) {
      decision();
      stage();
      table();
      uncertainty();
      const std::size_t on_paper = described_on_paper();
      out_ += fmt::format("<div id='candidates' class='{}'>\n", on_paper < few ? "many" : "");
      for (const std::size_t place : places_) candidate(place);
      out_ += "</div>\n";
      if (places_.size() > on_paper) {
        out_ += fmt::format("<p class='paper-only'>{} more are described on the screen.</p>\n",
                            places_.size() - on_paper);
      }
    }
    foot();
    return std::move(out_);
  }

private:
  // As page/style.css has them.
  static constexpr std::size_t few = 5;
  std::size_t described_on_paper() const { return result_.ranking.size() > 2 * few ? 3 : few; }

  const std::string& name_of(std::size_t place) const {
    return result_.candidates[result_.ranking[place].candidate].name;
  }

  void paragraph(const std::string& text) { out_ += "<p>" + escape_xml(text) + "</p>\n"; }

  void list(const std::string& title, const std::vector<std::string>& items) {
    out_ += "<div><h3>" + title + "</h3>\n<ul>";
    for (const std::string& item : items) out_ += "<li>" + escape_xml(item) + "</li>\n";
    out_ += "</ul></div>\n";
  }

  void head() {
    out_ +=
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
        "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
        "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";
    if (options_.served_version > 0) out_ += "; connect-src 'self'";
    out_ +=
        "\">\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        "<meta name='color-scheme' content='light dark'>\n<title>";
    out_ += escape_xml(scenario_.name) + " - crashrank</title>\n<style>";
    out_ += detail::embedded_style();
    out_ += "</style></head><body";
    if (options_.served_version > 0) {
      out_ += fmt::format(" data-version='{}'", options_.served_version);
    }
    out_ += ">\n<header><h1>" + escape_xml(scenario_.name) + "</h1>\n";
    if (!options_.notice.empty()) {
      out_ += "<p class='note' role='alert'>" + escape_xml(options_.notice) + "</p>\n";
    }
    if (options_.served_version > 0 && !result_.complete) {
      out_ +=
          "<p class='note' role='status'>A first answer. The whole ranking is under way; this page "
          "shows it as soon as it is there.</p>\n";
    }
    if (!scenario_.description.empty()) paragraph(scenario_.description);
    out_ += "</header>\n<main>\n";
    if (result_.ranking.empty()) out_ += "<p class='note'>There is no candidate to rank.</p>\n";
  }

  /// How full the bar of a score is, 0 to 100 %, as a style.
  std::string share_style(double value) const {
    const double share = full_bar_ > 0.0 && std::isfinite(value) ? value / full_bar_ : 0.0;
    return fmt::format("style='--share:{:.1f}%'", 100.0 * std::clamp(share, 0.0, 1.0));
  }

  void decision() {
    const detail::Decision decision = detail::decision_of(scenario_, result_, scores_);
    const CandidateResult& best = result_.ranking.front();
    out_ += fmt::format("<section class='decision {}' {} aria-label='Decision'>\n<h2>{}</h2>\n",
                        decision.is_clear ? "clear" : "crash",
                        share_style(best.score.value_or(0.0)), escape_xml(decision.sentence));
    choices(decision.choices);
    out_ += "<div class='why'>\n";
    list("How sure", decision.sure);
    std::vector<std::string> against = decision.against;
    for (const std::string& doubt : ranking_doubts(scenario_, models_, result_)) {
      (is_of_later(doubt) ? later_doubts_ : against)
          .push_back("Doubtful: " + detail::in_kmh(doubt) + ".");
    }
    if (against.empty()) against.emplace_back("Nothing that is known.");
    list("What speaks against it", against);
    out_ += "</div>\n";
    if (result_.ranking.size() > 1) {
      out_ += "<details><summary>Why it stands before the next, in numbers</summary>\n";
      paragraph(detail::reason_words(scenario_, models_, result_, scores_, 0));
      out_ += "</details>\n";
    }
    out_ += "</section>\n";
  }

  /// The first row beside others: what each hits, and whom it hurts.
  void choices(const std::vector<detail::Choice>& choices) {
    const bool is_harm = result_.measure == Measure::harm;
    const std::string outcome =
        is_harm ? fmt::format("somebody is {}", detail::outcome_participle(result_.harm.model))
                : std::string(measure_meaning(result_.measure));
    out_ += "<table class='choices'><thead><tr><th>manoeuvre</th><th>hits</th><th>" +
            escape_xml(outcome) + "</th>";
    if (is_harm) out_ += "<th>who</th>";
    out_ += "</tr></thead><tbody>\n";
    for (const detail::Choice& choice : choices) {
      const CandidateResult& ranked = result_.ranking[choice.row];
      out_ += "<tr><th scope='row'><span class='words'>" + choice.role + "</span>" +
              escape_xml(choice.manoeuvre) + "</th><td data-title='" +
              (detail::is_brush(ranked) ? "" : "hits ") + "'>" +
              escape_xml(detail::contact_words(scenario_, ranked, true)) + "</td><td>" +
              chance_bar(ranked) + "<span data-title='" + escape_xml(outcome) + ": '>" +
              escape_xml(choice.outcome) + "</span></td>";
      if (is_harm) out_ += "<td data-title='who: '>" + escape_xml(hurt(ranked)) + "</td>";
      out_ += "</tr>\n";
    }
    out_ += "</tbody></table>\n";
    if (!is_harm) paragraph("The measure is one of the crash, not of harm to people.");
  }

  /// As long as the chance, of a hundred on every page, or as the share of the worst score; none
  /// where there is nothing to show.
  std::string chance_bar(const CandidateResult& ranked) const {
    const double score = ranked.score.value_or(ranked.score_interval.highest);
    const bool is_harm = result_.measure == Measure::harm && !ranked.people.empty();
    const double length = is_harm           ? detail::chance_of_any(ranked)
                          : full_bar_ > 0.0 ? std::clamp(score / full_bar_, 0.0, 1.0)
                                            : 0.0;
    if (!(length > 0.0)) return {};
    return fmt::format("<span class='bar whole' {}><span style='width:{:.1f}%'></span></span>",
                       share_style(score), 100.0 * length);
  }

  /// "our car 2 in 100, saloon (2 people) 1 in 100 each"; those in most danger first.
  std::string hurt(const CandidateResult& ranked) const {
    constexpr std::size_t most = 3;
    std::vector<PersonRisk> people = ranked.people;
    const auto is_safe = [](const PersonRisk& risk) {
      return !(risk.persons > 0.0 && risk.probability > 0.0);
    };
    people.erase(std::remove_if(people.begin(), people.end(), is_safe), people.end());
    std::stable_sort(people.begin(), people.end(), [](const PersonRisk& p, const PersonRisk& q) {
      return p.persons * p.probability > q.persons * q.probability;
    });
    if (people.empty()) return ranked.score ? "nobody" : "not known";
    std::string words;
    for (std::size_t i = 0; i < std::min(most, people.size()); ++i) {
      const PersonRisk& risk = people[i];
      const bool is_one = risk.persons == 1.0;
      words += fmt::format("{}{}{} {}{}", i > 0 ? "; " : "", name_of_body(risk.body),
                           is_one ? "" : fmt::format(" ({:g} people)", risk.persons),
                           detail::chance_words(risk.probability), is_one ? "" : " each");
    }
    if (people.size() > most) words += fmt::format("; {} more", people.size() - most);
    return words;
  }

  std::string name_of_body(std::size_t body) const {
    return body == ego_body ? "our car" : scenario_.actors[body].name;
  }

  /// Whether a doubt names candidates, but not the first.
  static bool is_of_later(const std::string& doubt) {
    const std::string_view place = "in place ";
    bool names = false;
    for (std::size_t at = doubt.find(place); at != std::string::npos; at = doubt.find(place, at)) {
      at += place.size();
      if (std::strtol(doubt.c_str() + at, nullptr, 10) == 1) return false;
      names = true;
    }
    return names && doubt.find("the first place") == std::string::npos;
  }

  /// The winner's scene as a picture, for print and for browsers without WebGL.
  void still() {
    if (!options_.still) return;
    const Result<std::string> drawn = detail::still_picture(scenario_, models_, result_, 0);
    if (!drawn) return;
    const std::string caption =
        escape_xml(name_of(0)) + (result_.ranking.front().contacts.empty()
                                      ? ", at the end of the plan"
                                      : ", at first contact; damage is red");
    out_ += "<figure class='still'><img src='data:image/png;base64,";
    out_ += detail::base64(drawn->data(), drawn->size());
    out_ += "' alt='" + caption + "'><figcaption>" + caption + "</figcaption></figure>\n";
  }

  void stage() {
    if (places_.empty()) return;
    out_ +=
        "<section class='stage' id='stage' aria-label='The scene, moving'>\n"
        "<div class='choose'><label>Show <select id='shown'></select></label>\n"
        "<label>beside <select id='beside'><option value=''>nothing</option></select></label>\n"
        "<span id='told' role='status'></span></div>\n<div id='views'></div>\n"
        "<div class='clock'><button type='button' id='play'>Play</button>\n"
        "<input id='time' type='range' min='0' step='0.01' value='0' aria-label='Time'>\n"
        "<output id='now' for='time'></output>\n"
        "<label><input id='slow' type='checkbox' checked> slow at contacts</label>\n"
        "<canvas id='trace' role='img' aria-label='Change of each body&apos;s "
        "velocity within 0.3 s, over time'></canvas></div>\n"
        "<p class='hint'>Space plays, arrows step, N and P go from contact to contact. Orange "
        "marks: until then another manoeuvre can still be chosen. In a picture that has focus: "
        "drag to move or turn, wheel or pinch to come nearer, 0 for all.</p>\n";
    still();
    const bool is_played = std::any_of(places_.begin(), places_.end(), [this](std::size_t place) {
      const CandidateResult& ranked = result_.ranking[place];
      return !ranked.contacts.empty() && ranked.motion.empty();
    });
    if (is_played) {
      out_ +=
          "<p class='note'>The motion after first contacts was not recorded: the pictures end "
          "there.</p>\n";
    }
    if (data_.is_coarser) {
      out_ += fmt::format(
          "<p class='hint'>Meshes of more than {} triangles are drawn with fewer.</p>\n",
          detail::most_page_triangles);
    }
    out_ +=
        "<noscript><p class='note'>The moving scene needs JavaScript.</p></noscript>\n"
        "</section>\n";
  }

  void table() {
    const auto free =
        std::count_if(result_.ranking.begin(), result_.ranking.end(), [](const CandidateResult& r) {
          return r.score && !r.collides && !(r.collision_probability > 0.0);
        });
    out_ += "<section class='table' aria-label='Ranking'><h2>All candidates</h2>\n";
    out_ += fmt::format(
        "<p class='facts'>{} candidates, {} other{} on the road, {} {}touch nothing. Ranked by {} "
        "[{}], lower is better, in {}{}.</p>\n",
        result_.ranking.size(), scenario_.actors.size(), scenario_.actors.size() == 1 ? "" : "s",
        free, result_.complete ? "" : "are known to ", measure_name(result_.measure),
        escape_xml(measure_unit(result_.measure)),
        result_.elapsed_s < 1.0 ? fmt::format("{:.1f} ms", result_.elapsed_s * 1e3)
                                : fmt::format("{:.1f} s", result_.elapsed_s),
        result_.complete ? "" : "; the answer is partial");
    out_ += fmt::format(
        "<div class='tools'><label>Filter <input id='filter' type='search'></label>\n"
        "<span id='listed' role='status'></span>\n"
        "<span class='legend'>0 <span class='scale'></span> {:.3g} {}</span></div>\n",
        full_bar_, escape_xml(measure_unit(result_.measure)));
    out_ +=
        "<div id='rows' tabindex='0' role='region' aria-label='Candidates, scrollable'>"
        "<table class='ranking'><thead><tr>";
    const std::string score_title = std::string(measure_name(result_.measure)) + " [" +
                                    escape_xml(measure_unit(result_.measure)) + "]";
    for (const std::string& title : {std::string("place"), std::string("manoeuvre"), score_title,
                                     std::string("first contact"), std::string("warnings")}) {
      out_ += "<th scope='col'>" + title + "</th>";
    }
    out_ += "</tr></thead><tbody>\n";
    for (const std::size_t place : places_) row(place);
    out_ += "</tbody></table></div>\n";
    if (places_.size() < result_.ranking.size()) {
      out_ += fmt::format(
          "<p class='hint'>The best {} and the worst are drawn and described; {} of {} are "
          "left out.</p>\n",
          places_.size() - 1, result_.ranking.size() - places_.size(), result_.ranking.size());
    }
    out_ += "</section>\n";
  }

  /// What the page shows without its script; page/table.js builds the same.
  void row(std::size_t place) {
    const detail::PageRow row = detail::page_row(scenario_, result_, scores_, place);
    out_ += fmt::format("<tr data-row='{}' class='{}'><td class='place'>{}{}</td><td>{}", place,
                        row.bracket, row.place, row.bracket == "tied" ? " tied" : "",
                        escape_xml(row.name));
    if (row.manoeuvre != row.name) {
      out_ += "<span class='words'>" + escape_xml(row.manoeuvre) + "</span>";
    }
    out_ += fmt::format("</td><td class='score' {}><span class='bar'></span>{}",
                        share_style(row.value), row.score);
    if (!row.interval.empty()) out_ += "<span class='interval'>" + row.interval + "</span>";
    out_ += "</td><td>" + escape_xml(row.contact) + "</td><td>";
    if (!row.warnings.empty()) out_ += "<em>" + escape_xml(row.warnings) + "</em>";
    out_ += "</td></tr>\n";
  }

  void uncertainty() {
    std::vector<std::string> lines = detail::future_words(scenario_, result_);
    constexpr std::size_t pushing = 3;
    const std::vector<std::string> pushed = detail::pushed_words(scenario_, result_, pushing);
    std::vector<std::string> open = detail::not_separable_words(result_, result_.ranking.size());
    out_ +=
        "<section class='uncertainty' aria-label='Uncertainty'><h2>What is not known</h2>\n"
        "<div id='futures'></div>\n";
    for (std::string& line : lines) {
      if (result_.measure != Measure::delta_v) line = detail::in_kmh(line);
    }
    if (!lines.empty()) list("Futures", lines);
    out_ += "<div id='stability'></div>\n";
    constexpr std::size_t shown = 12;
    if (open.size() > shown) {
      const std::string more = fmt::format("and {} more pairs", open.size() - shown);
      open.resize(shown);
      open.push_back(more);
    }
    if (open.empty() && !result_.samples.empty() && result_.ranking.size() > 1) {
      open.push_back(fmt::format(
          "Every place is separable from the next: no order reverses in more than {:.0f} % of {} "
          "samples of what is not known, nor with longer steps or 1 mm aside{}.",
          100.0 * separable_share, range_sample_count(result_),
          result_.futures.method == FutureMethod::sampled
              ? ", and every difference exceeds two standard errors of the sample of futures"
              : ""));
    }
    if (!open.empty()) list("Places", open);
    if (!pushed.empty()) list("Hurt by a contact between others", pushed);
    if (!later_doubts_.empty()) list("Doubts about other candidates", later_doubts_);
    out_ += "</section>\n";
  }

  void candidate(std::size_t place) {
    const CandidateResult& ranked = result_.ranking[place];
    out_ +=
        fmt::format("<section class='candidate' id='c{}'><h3>{}. {}{}</h3>\n", place + 1,
                    ranked.place, escape_xml(name_of(place)), ranked.sharing > 1 ? " (tied)" : "");
    paragraph("It " + detail::outcome_words(scenario_, ranked) + ": " +
              detail::score_words(ranked, scores_[place], result_.measure) + ". " +
              detail::manoeuvre_words(scenario_, ranked));
    if (place > 0 && place + 1 < places_.size()) {
      paragraph((ranked.place == result_.ranking[place + 1].place ? "Tied with the next: "
                                                                  : "Why before the next: ") +
                detail::reason_words(scenario_, models_, result_, scores_, place));
    }
    out_ += "<div class='columns'>\n" + plan_.draw(place) + "<div>\n";
    if (!ranked.people.empty()) candidate_people(ranked);
    if (!ranked.contacts.empty()) {
      out_ += detail::contact_table(scenario_, result_.measure, ranked);
    }
    out_ += "</div></div>\n";
    if (!ranked.contacts.empty()) damage(ranked);
    out_ += "</section>\n";
  }

  void damage(const CandidateResult& ranked) {
    out_ += "<div class='damage'><div>";
    out_ +=
        detail::parts_table(name_of_body(ego_body), models_[scenario_.ego.model].mesh, ranked.ego);
    for (const detail::DamagedBody& body : detail::damaged_others(scenario_, models_, ranked)) {
      out_ +=
          "</div>\n<div>" +
          detail::parts_table(scenario_.actors[body.actor].name,
                              detail::mesh_of_actor(scenario_, models_, body.actor), body.damage);
    }
    out_ += "</div></div>\n";
  }

  void candidate_people(const CandidateResult& ranked) {
    out_ += fmt::format(
        "<table class='parts'><caption>people</caption><thead><tr><th>who</th>"
        "<th>persons</th><th>{}</th><th>exposure km/h</th></tr></thead><tbody>\n",
        detail::outcome_participle(result_.harm.model));
    for (const PersonRisk& risk : ranked.people) {
      out_ += fmt::format(
          "<tr><td>{}</td><td class='n'>{:g}</td><td class='n'>{}</td><td class='n'>{:.0f}</td>"
          "</tr>\n",
          escape_xml(name_of_body(risk.body)), risk.persons, detail::chance_words(risk.probability),
          3.6 * risk.exposure_mps);
    }
    out_ += "</tbody></table>\n";
  }

  void foot() {
    out_ +=
        "</main>\n<footer>Made by crashrank. Our car, the ego, is blue, others are sand, damage is "
        "red; a ring is where two others collide. Damage is what the bodies pass through of each "
        "other, as rigid ones, in the simulated contact; dents are drawn to the simulated crush.";
    if (result_.measure != Measure::harm) {
      out_ += " The measure is one of the crash, not of harm to people.";
    } else {
      for (const std::string& line : detail::harm_words(result_.harm)) {
        out_ += "<br>" + escape_xml(line);
      }
    }
    out_ += "</footer>\n";
    if (!places_.empty()) {
      out_ += "<script type='application/json' id='page-data'>" + data_.json + "</script>\n";
      out_ += "<script>\n\"use strict\";\n";
      for (const std::string_view part : detail::embedded_scripts()) out_ += part;
      out_ += "</script>\n";
    }
    if (options_.served_version > 0) {
      out_ += "<script>\n\"use strict\";\n";
      out_ += detail::embedded_reload();
      out_ += "</script>\n";
    }
    out_ += "</body></html>\n";
  }

  const Scenario& scenario_;
  View<const Model> models_;
  const RankResult& result_;
  detail::PlanView plan_;
  std::vector<std::size_t> places_;  // drawn, rising
  std::vector<std::string> scores_;  // by row
  std::vector<std::string> later_doubts_;
  double full_bar_ = 0.0;
  const HtmlReportOptions& options_;
  detail::PageData data_;
  std::string out_;
};

}  // namespace

std::string html_report(const Scenario& scenario, View<const Model> models,
                        const RankResult& result, const HtmlReportOptions& options) {
  if (!is_uncertain(scenario)) return Page(scenario, scenario, models, result, options).html();
  const Scenario shown = likeliest_future(scenario);
  return Page(scenario, shown, models, result, options).html();
}

}  // namespace crashrank
