#include "ranking.hpp"

#include "arrays.hpp"
#include "error.hpp"
#include "waiting.hpp"

#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace crashrank::python {

RankOptions options_of(const RankRequest& request, const Scenario& scenario) {
  RankOptions options;
  options.workers = request.workers;
  options.sampled_futures = request.sampled_futures;
  options.records_motion = request.motion;
  options.smooth = request.smooth;
  if (!request.measure.empty()) options.measure = value_of(measure_from_name(request.measure));
  if (!request.risk.empty()) options.risk = value_of(risk_from_name(request.risk));
  options.order = value_of(order_from_name(request.order));
  options.infeasible = value_of(infeasible_from_name(request.infeasible));
  options.harm = scenario.harm;
  if (!request.profile_file.empty()) {
    options.harm = value_of(load_profile_file(request.profile_file, scenario.harm));
  }
  return options;
}

namespace {

using PathArray = nb::ndarray<nb::numpy, double, nb::shape<-1, -1, 3>>;

bool bounded(const RankBudget& budget) {
  return std::isfinite(budget.deadline_s) || budget.first_place_only ||
         budget.work != std::numeric_limits<std::uint64_t>::max();
}

/// The result, or a Failure that names the scenario's file.
RankResult ranked_value(Result<RankResult> result, const Situation& situation) {
  if (!result && result.error().file.empty()) result.error().file = situation.file();
  return value_of(std::move(result));
}

/// Ranks; the interpreter's lock is not held. Throws Failure.
RankResult rank_now(const Situation& situation, RankOptions& how, const RankBudget& within,
                    Progress& progress) {
  if (bounded(within)) {
    RankBudget budget = within;
    budget.cancel = &progress.cancel;
    budget.known = &progress.done;
    const Box bounds = situation.models()[situation.scenario().ego.model].mesh.bounds();
    progress.all =
        value_of(make_candidates(situation.scenario(), static_cast<double>(bounds.extent().x())))
            .size();
    return ranked_value(rank_within(situation.scenario(), situation.models(), how, budget),
                        situation);
  }
  how.on_progress = [&progress](std::size_t evaluated, std::size_t candidates) {
    progress.done = evaluated;
    progress.all = candidates;
    return !progress.cancel;
  };
  return ranked_value(rank(situation.scenario(), situation.models(), how), situation);
}

std::shared_ptr<Ranked> rank_situation(const SharedSituation& situation, const RankRequest& request,
                                       const RankBudget& within, const nb::object& report) {
  auto ranked = std::make_shared<Ranked>();
  ranked->situation = situation;
  Progress progress;
  ranked->interrupted = run_waiting(progress, report, [&] {
    situation->load();
    ranked->scenario = situation->scenario();
    RankOptions how = options_of(request, ranked->scenario);
    ranked->warnings = situation->warnings();
    if (progress.cancel) return;
    ranked->result = rank_now(*situation, how, within, progress);
    if (bounded(within) || how.records_motion || !ranked->result.complete ||
        ranked->result.candidates.size() > most_played_candidates) {
      return;
    }
    how.records_motion = true;
    how.on_progress = nullptr;
    ranked->replay = how;
  });
  if (ranked->result.ranking.empty() && ranked->interrupted) {
    // Nothing is known yet: there is no partial answer.
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw nb::python_error();
  }
  if (ranked->interrupted || (progress.cancel && !ranked->result.complete)) {
    ranked->warnings.push_back(ranking_progress(ranked->result));
  } else if (!ranked->result.complete && !(within.first_place_only && ranked->result.proved)) {
    ranked->warnings.push_back(why_partial(ranked->result, bounded(within)));
  }
  return ranked;
}

std::string json_of(const Ranked& ranked) {
  const nb::gil_scoped_release unlocked;
  return ranking_json(ranked.scenario, ranked.situation->models(), ranked.result, ranked.warnings);
}

std::string html_of(const Ranked& ranked, std::size_t drawn, bool is_small) {
  const nb::gil_scoped_release unlocked;
  HtmlReportOptions options;
  options.drawn = drawn;
  if (is_small) {
    options.model_triangles = 500;
    options.still = false;
  }
  if (ranked.replay) {
    Result<RankResult> played = rank(ranked.scenario, ranked.situation->models(), *ranked.replay);
    if (played) {
      played->elapsed_s = ranked.result.elapsed_s;
      return html_report(ranked.scenario, ranked.situation->models(), *played, options);
    }
  }
  return html_report(ranked.scenario, ranked.situation->models(), ranked.result, options);
}

std::string text_of(const Ranked& ranked) {
  const nb::gil_scoped_release unlocked;
  RankingTextOptions options;
  options.top = 20;
  options.width = 100;
  return ranking_text(ranked.scenario, ranked.situation->models(), ranked.result, options);
}

/// x, y (m) and heading (rad) in the world, by motion and time.
PathArray sample_motions(const std::vector<Motion>& motions, const GivenTimes& times) {
  std::vector<double> values;
  values.reserve(3 * motions.size() * times.shape(0));
  for (const Motion& motion : motions) {
    for (std::size_t i = 0; i < times.shape(0); ++i) {
      const Pose pose = motion.pose_at(times.data()[i]);
      values.push_back(pose.translation.x());
      values.push_back(pose.translation.y());
      values.push_back(std::atan2(pose.rotation(1, 0), pose.rotation(0, 0)));
    }
  }
  return make_array<double, nb::shape<-1, -1, 3>>(std::move(values),
                                                  {motions.size(), times.shape(0), 3});
}

PathArray candidate_paths(const Ranked& ranked, const GivenTimes& times) {
  std::vector<Motion> motions;
  for (const CandidateResult& each : ranked.result.ranking) {
    motions.push_back(ranked.result.candidates[each.candidate].motion);
  }
  return sample_motions(motions, times);
}

PathArray actor_paths(const Ranked& ranked, const GivenTimes& times) {
  const Scenario likeliest = likeliest_future(ranked.scenario);
  std::vector<Motion> motions;
  for (const ScenarioActor& actor : likeliest.actors) {
    motions.push_back(value_of(make_motion(actor)));
  }
  return sample_motions(motions, times);
}

/// Of the model of an actor, or of the ego for -1: what is seen from above.
nb::ndarray<nb::numpy, double, nb::shape<-1, 2>> outline_of(const Ranked& ranked, long actor) {
  const Scenario& scenario = ranked.scenario;
  const std::size_t model =
      actor < 0 ? scenario.ego.model : scenario.actors.at(static_cast<std::size_t>(actor)).model;
  std::vector<double> corners = outline_corners(ranked.situation->models()[model].mesh);
  const std::size_t count = corners.size() / 2;
  return make_array<double, nb::shape<-1, 2>>(std::move(corners), {count, 2});
}

}  // namespace

void bind_rankings(nb::module_& module) {
  nb::class_<Ranked>(module, "Ranked", "A ranking with its scenario and models.")
      .def("json", &json_of, "The document that `crashrank rank --json` prints.")
      .def("text", &text_of, "The table that `crashrank rank` prints.")
      .def("html", &html_of, nb::arg("drawn"), nb::arg("is_small") = false,
           "The report, one page; a small one has coarse meshes and no still picture.")
      .def("candidate_paths", &candidate_paths, nb::arg("times_s").noconvert(),
           "x, y, heading by rank and time; m, rad, world.")
      .def("actor_paths", &actor_paths, nb::arg("times_s").noconvert(),
           "The same by actor, in the likeliest future.")
      .def("outline", &outline_of, nb::arg("actor"), "Seen from above, body coordinates, m.")
      .def_prop_ro(
          "horizon_s", [](const Ranked& self) { return self.scenario.horizon_s; },
          "How far contacts were searched for, s.")
      .def_ro("interrupted", &Ranked::interrupted, "Whether Ctrl-C ended it.");
  nb::class_<RankRequest>(module, "RankRequest", "What is asked of every ranking.")
      .def(nb::init<std::string, std::string, std::string, std::string, std::string, unsigned,
                    std::size_t, bool, bool>(),
           nb::arg("measure"), nb::arg("risk"), nb::arg("infeasible"), nb::arg("order"),
           nb::arg("profile"), nb::arg("workers"), nb::arg("futures"), nb::arg("motion") = false,
           nb::arg("smooth") = false);
  nb::class_<RankBudget>(module, "RankBudget", "Where one ranking ends early.")
      .def(
          "__init__",
          [](RankBudget* self, double deadline_s, std::uint64_t work, bool first_place_only) {
            new (self) RankBudget{deadline_s, work, first_place_only};
          },
          nb::arg("deadline_s"), nb::arg("work_budget"), nb::arg("first_place_only"));
  module.def("rank", &rank_situation, nb::arg("situation"), nb::arg("request"), nb::arg("budget"),
             nb::arg("progress").none(), "Ranks the candidates of a scenario.");
  module.attr("max_sampled_futures") = max_sampled_futures;
}

}  // namespace crashrank::python
