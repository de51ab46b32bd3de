#include "session.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace crashrank::python {
namespace {

/// Below this a call is not worth a thread of its own that Ctrl-C could end.
constexpr double short_deadline_s = 0.1;

using Doubles = nb::ndarray<nb::numpy, double, nb::shape<-1>>;
using Flags = nb::ndarray<nb::numpy, bool, nb::shape<-1>>;
using Indices = nb::ndarray<nb::numpy, std::int64_t, nb::shape<-1>>;

std::shared_ptr<Answered> rank_session(const std::shared_ptr<Session>& session,
                                       const std::optional<GivenPaths>& paths,
                                       const std::optional<GivenTimes>& times,
                                       const std::vector<std::string>& names,
                                       const RankBudget& budget, const nb::object& report) {
  std::optional<PosedCandidates> posed;
  if (paths) posed = PosedCandidates::copy(*paths, *times, names);
  Progress progress;
  if (budget.deadline_s <= short_deadline_s && report.is_none()) {
    const nb::gil_scoped_release unlocked;
    return session->rank(posed, budget, progress);
  }
  std::shared_ptr<Answered> answered;
  progress.on_cancel = [&session] { session->cancel(); };
  const bool interrupted =
      run_waiting(progress, report, [&] { answered = session->rank(posed, budget, progress); });
  answered->interrupted = interrupted;
  return answered;
}

std::shared_ptr<Ranked> explain_session(const std::shared_ptr<Session>& session,
                                        const Answered& answered) {
  Progress progress;
  progress.on_cancel = [&session] { session->cancel(); };
  std::shared_ptr<Ranked> ranked;
  const bool interrupted =
      run_waiting(progress, nb::none(), [&] { ranked = session->explain(answered, progress); });
  ranked->interrupted = interrupted;
  return ranked;
}

template <class Member> Doubles doubles_of(const Answered& answered, const Member& member) {
  std::vector<double> values;
  for (const RankedCandidate& each : answered.ranking) values.push_back(member(each));
  const std::size_t count = values.size();
  return make_array<double, nb::shape<-1>>(std::move(values), {count});
}

template <class Member> Indices indices_of(const Answered& answered, const Member& member) {
  std::vector<std::int64_t> values;
  for (const RankedCandidate& each : answered.ranking) values.push_back(member(each));
  const std::size_t count = values.size();
  return make_array<std::int64_t, nb::shape<-1>>(std::move(values), {count});
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void bind_answers(nb::module_& module) {
  using One = RankedCandidate;
  nb::class_<Answered>(module, "Answered", "An answer of a Ranker, most promising first.")
      .def("__len__", [](const Answered& self) { return self.ranking.size(); })
      .def(
          "name",
          [](const Answered& self, std::size_t place) {
            return self.candidates[self.ranking.at(place).candidate].name;
          },
          nb::arg("place"), "Of the candidate at that place.")
      .def(
          "score",
          [](const Answered& self) {
            return doubles_of(self, [](const One& c) { return c.known ? c.score : unknown; });
          },
          "NaN where it is not known.")
      .def(
          "lowest",
          [](const Answered& self) {
            return doubles_of(self, [](const One& c) { return c.interval.lowest; });
          },
          "The score is not below.")
      .def(
          "highest",
          [](const Answered& self) {
            return doubles_of(self, [](const One& c) { return c.interval.highest; });
          },
          "The score is not above.")
      .def(
          "time_of_impact_s",
          [](const Answered& self) {
            return doubles_of(
                self, [](const One& c) { return c.collides ? c.time_of_impact_s : unknown; });
          },
          "NaN without a contact.")
      .def(
          "closing_speed_mps",
          [](const Answered& self) {
            return doubles_of(
                self, [](const One& c) { return c.collides ? c.closing_speed_mps : unknown; });
          },
          "NaN without a contact.")
      .def(
          "collision_probability",
          [](const Answered& self) {
            return doubles_of(self, [](const One& c) {
              return c.stage < RankStage::searched && !c.known ? unknown : c.collision_probability;
            });
          },
          "NaN where it is not known.")
      .def(
          "candidate",
          [](const Answered& self) {
            return indices_of(self,
                              [](const One& c) { return static_cast<std::int64_t>(c.candidate); });
          },
          "Index into the candidates asked about.")
      .def(
          "other",
          [](const Answered& self) {
            return indices_of(self, [](const One& c) {
              return c.collides ? static_cast<std::int64_t>(c.actor) : std::int64_t{-1};
            });
          },
          "Index of the actor that is hit first, -1 without a contact.")
      .def(
          "flags",
          [](const Answered& self) {
            return indices_of(self, [](const One& c) {
              return std::int64_t{c.known ? 1 : 0} | (c.in_race ? 2 : 0) | (c.collides ? 4 : 0) |
                     (c.feasible ? 8 : 0) | (c.leaves_road ? 16 : 0) |
                     (c.contact_without_force ? 32 : 0);
            });
          },
          "Bits: known, in race, collides, feasible, leaves road, contact without force.")
      .def_prop_ro("complete", [](const Answered& self) { return self.answer.complete; })
      .def_prop_ro("proved", [](const Answered& self) { return self.answer.proved; })
      .def_prop_ro("basis", [](const Answered& self) { return basis_name(self.answer.basis); })
      .def_prop_ro("in_race", [](const Answered& self) { return self.answer.in_race; })
      .def_prop_ro("elapsed_s", [](const Answered& self) { return self.answer.elapsed_s; })
      .def_prop_ro("hash", [](const Answered& self) { return self.answer.hash; })
      .def_ro("interrupted", &Answered::interrupted);
}

/// Poses of an actor over time, at a height.
std::vector<TimedPose> timed_poses(const Given<double, nb::shape<-1, 3>>& path,
                                   const GivenTimes& times, double z_m) {
  std::vector<TimedPose> poses;
  for (std::size_t k = 0; k < path.shape(0); ++k) {
    const double* const at = path.data() + 3 * k;
    poses.push_back({times.data()[k], planar_pose(at[0], at[1], z_m, at[2])});
  }
  return poses;
}

}  // namespace

void bind_rankers(nb::module_& module) {
  bind_answers(module);
  nb::class_<Session::EgoState>(module, "EgoState", "What an update changes of the ego.")
      .def(nb::init<>())
      .def(
          "set_pose",
          [](Session::EgoState& self, double x_m, double y_m, double z_m, double yaw_rad,
             double pitch_rad, double roll_rad) {
            self.pose = pose_from_angles({x_m, y_m, z_m}, yaw_rad, pitch_rad, roll_rad);
          },
          nb::arg("x_m"), nb::arg("y_m"), nb::arg("z_m"), nb::arg("yaw_rad"), nb::arg("pitch_rad"),
          nb::arg("roll_rad"))
      .def_rw("speed_mps", &Session::EgoState::speed_mps, nb::arg().none())
      .def_rw("yaw_rate_radps", &Session::EgoState::yaw_rate_radps, nb::arg().none());
  nb::class_<Session::ActorState>(module, "ActorState", "What an update changes of an actor.")
      .def(
          "__init__",
          [](Session::ActorState* self, std::size_t actor, std::size_t prediction) {
            new (self) Session::ActorState{actor, prediction, {}};
          },
          nb::arg("actor"), nb::arg("prediction"))
      .def(
          "set_motion",
          [](Session::ActorState& self, double x_m, double y_m, double z_m, double yaw_rad,
             double pitch_rad, double roll_rad, double speed_mps, double acceleration_mps2,
             double yaw_rate_radps) {
            self.motion = {pose_from_angles({x_m, y_m, z_m}, yaw_rad, pitch_rad, roll_rad),
                           speed_mps,
                           acceleration_mps2,
                           yaw_rate_radps,
                           {}};
          },
          nb::arg("x_m"), nb::arg("y_m"), nb::arg("z_m"), nb::arg("yaw_rad"), nb::arg("pitch_rad"),
          nb::arg("roll_rad"), nb::arg("speed_mps"), nb::arg("acceleration_mps2"),
          nb::arg("yaw_rate_radps"))
      .def(
          "set_poses",
          [](Session::ActorState& self, const Given<double, nb::shape<-1, 3>>& path,
             const GivenTimes& times,
             double z_m) { self.motion.poses = timed_poses(path, times, z_m); },
          nb::arg("path").noconvert(), nb::arg("times_s").noconvert(), nb::arg("z_m"));
  nb::class_<Session>(module, "Session", "A Ranker with its scenario.")
      .def(
          "plans",
          [](Session& self) {
            return self.read([](const Scenario& scenario) {
              std::vector<std::pair<std::string, std::size_t>> plans;
              for (const ScenarioActor& actor : scenario.actors) {
                plans.emplace_back(actor.name, std::max<std::size_t>(1, actor.predictions.size()));
              }
              return plans;
            });
          },
          "Name and number of motions of each actor.")
      .def("is_joint",
           [](Session& self) {
             return self.read([](const Scenario& scenario) { return !scenario.futures.empty(); });
           })
      .def(
          "actor_height",
          [](Session& self, std::size_t actor) {
            return self.read([actor](const Scenario& scenario) {
              return scenario.actors.at(actor).pose.translation.z();
            });
          },
          nb::arg("actor"), "Of its origin, m.")
      .def(
          "ego_pose",
          [](Session& self) {
            return self.read([](const Scenario& scenario) {
              const Pose& pose = scenario.ego.pose;
              return std::vector<double>{pose.translation.x(), pose.translation.y(),
                                         pose.translation.z(),
                                         std::atan2(pose.rotation(1, 0), pose.rotation(0, 0))};
            });
          },
          "x, y, z in m, heading in rad.")
      .def("candidate_names", &Session::candidate_names)
      .def("update", &Session::update, nb::arg("ego"), nb::arg("actors"), nb::arg("probabilities"),
           nb::call_guard<nb::gil_scoped_release>())
      .def("enter", &Session::enter, nb::arg("actor"), nb::arg("model"), nb::arg("state"),
           nb::arg("occupants").none(), nb::call_guard<nb::gil_scoped_release>())
      .def("leave", &Session::leave, nb::arg("actor"), nb::call_guard<nb::gil_scoped_release>())
      .def("close", &Session::close, nb::call_guard<nb::gil_scoped_release>());
  module.def(
      "make_session",
      [](SharedSituation situation, const RankRequest& request, std::size_t most_candidates) {
        const nb::gil_scoped_release unlocked;
        return std::make_shared<Session>(std::move(situation), request, most_candidates);
      },
      nb::arg("situation"), nb::arg("request"), nb::arg("most_candidates"), "Prepares a Ranker.");
  module.def("rank_session", &rank_session, nb::arg("session"), nb::arg("paths").noconvert().none(),
             nb::arg("times_s").noconvert().none(), nb::arg("names"), nb::arg("budget"),
             nb::arg("progress").none(), "Ranks within a budget.");
  module.def("explain_session", &explain_session, nb::arg("session"), nb::arg("answered"),
             "The ranking in full, off the clock.");
}

}  // namespace crashrank::python
