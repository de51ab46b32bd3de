#pragma once

#include "arrays.hpp"
#include "error.hpp"
#include "ranking.hpp"
#include "waiting.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/report/ranking.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::python {

/// At that height, turned by the heading alone.
inline Pose planar_pose(double x_m, double y_m, double z_m, double yaw_rad) {
  return pose_from_angles({x_m, y_m, z_m}, yaw_rad, 0.0, 0.0);
}

/// Candidates that follow poses, copied from arrays: x, y, heading by candidate and time.
struct PosedCandidates {
  std::vector<double> values;
  std::vector<double> times_s;
  std::vector<std::string> names;

  static PosedCandidates copy(const GivenPaths& paths, const GivenTimes& times,
                              const std::vector<std::string>& names) {
    return {{paths.data(), paths.data() + paths.size()},
            {times.data(), times.data() + times.size()},
            names};
  }

  /// At that height. Throws Failure naming the candidate.
  std::vector<Candidate> make(double z_m) const {
    std::vector<Candidate> candidates(names.size());
    std::vector<TimedPose> poses(times_s.size());
    const double* at = values.data();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      for (std::size_t k = 0; k < poses.size(); ++k, at += 3) {
        poses[k] = {times_s[k], planar_pose(at[0], at[1], z_m, at[2])};
      }
      Result<Motion> motion = Motion::timed(poses);
      if (!motion) {
        motion.error().place = "candidates[" + std::to_string(i) + "]: " + motion.error().place;
        throw Failure(motion.error());
      }
      candidates[i].name = names[i];
      candidates[i].motion = std::move(*motion);
    }
    return candidates;
  }
};

/// An answer that stands for itself: by place, the most promising first.
struct Answered {
  std::vector<RankedCandidate> ranking;
  std::vector<Candidate> candidates;
  RankerAnswer answer;  ///< its ranking looks into the one above
  std::uint64_t situation = 0;
  bool interrupted = false;
};

/// A Ranker, what it ranks, and the lock that one thread at a time holds.
class Session {
public:
  Session(SharedSituation situation, const RankRequest& request, std::size_t most_candidates)
      : situation_(std::move(situation)) {
    situation_->load();
    current_ = situation_->scenario();
    RankerOptions options;
    options.rank = options_of(request, current_);
    options.limits.candidates = most_candidates;
    options.limits.actors = std::max<std::size_t>(1, current_.actors.size());
    options.limits.triangles = std::numeric_limits<std::size_t>::max();
    ranker_.emplace(value_of(Ranker::prepare(current_, situation_->models(), options)));
  }

  /// The state of the ego at time 0.
  struct EgoState {
    std::optional<Pose> pose;
    std::optional<double> speed_mps;
    std::optional<double> yaw_rate_radps;
  };

  /// The motion of one of an actor's predictions, or its only one.
  struct ActorState {
    std::size_t actor = 0;
    std::size_t prediction = 0;
    ActorMotion motion;
  };

  /// Changes ego, motions and probabilities; all or, after an error, nothing.
  void update(const EgoState& ego, std::vector<ActorState> actors,
              const std::vector<double>& probabilities) {
    const std::unique_lock<std::mutex> lock = hold();
    Scenario next = current_;
    if (ego.pose) next.ego.pose = *ego.pose;
    if (ego.speed_mps) next.ego.speed_mps = *ego.speed_mps;
    if (ego.yaw_rate_radps) next.ego.yaw_rate_radps = *ego.yaw_rate_radps;
    for (ActorState& state : actors) {
      ScenarioActor& actor = next.actors.at(state.actor);
      ActorMotion& motion = actor.predictions.empty() ? static_cast<ActorMotion&>(actor)
                                                      : actor.predictions.at(state.prediction);
      motion = std::move(state.motion);
    }
    if (!probabilities.empty()) set_probabilities(next, probabilities);
    check(detail::check_scenario(next));
    const std::vector<Motion> motions = value_of(plan_motions(next));
    const EgoMotion moves{next.ego.speed_mps, next.ego.yaw_rate_radps};
    if (!probabilities.empty()) check(ranker_->weigh_plans(probabilities));
    check(ranker_->move_actors(next.ego.pose, motions, moves));
    current_ = std::move(next);
    ++situations_;
  }

  /// Lets a body of a model, by its name, enter in place of an actor that keeps a place.
  void enter(std::size_t actor, const std::string& model, ActorState state,
             std::optional<double> occupants) {
    const std::unique_lock<std::mutex> lock = hold();
    Scenario next = current_;
    const auto named = [&](const ScenarioModel& each) { return each.name == model; };
    const auto found = std::find_if(next.models.begin(), next.models.end(), named);
    ScenarioActor& entering = next.actors.at(actor);
    entering.model = static_cast<std::size_t>(found - next.models.begin());
    entering.existence_probability = 1.0;
    entering.occupants = occupants;
    static_cast<ActorMotion&>(entering) = std::move(state.motion);
    if (found != next.models.end()) check(detail::check_scenario(next));
    const Motion motion = value_of(make_motion(entering));
    check(ranker_->enter(actor, entering.model, motion, occupants));
    current_ = std::move(next);
    ++situations_;
  }

  /// Takes it out again.
  void leave(std::size_t actor) {
    const std::unique_lock<std::mutex> lock = hold();
    check(ranker_->leave(actor));
    current_.actors.at(actor).existence_probability = 0.0;
    ++situations_;
  }

  /// Calls `read(scenario)` while no other thread changes it.
  template <class Read> auto read(const Read& read) {
    const std::unique_lock<std::mutex> lock = hold();
    return read(current_);
  }

  std::vector<std::string> candidate_names() {
    const std::unique_lock<std::mutex> lock = hold();
    std::vector<std::string> names;
    for (const Candidate& each : own_candidates()) names.push_back(each.name);
    return names;
  }

  std::shared_ptr<Answered> rank(const std::optional<PosedCandidates>& posed, RankBudget budget,
                                 Progress& progress) {
    const std::unique_lock<std::mutex> lock = hold();
    auto answered = std::make_shared<Answered>();
    answered->candidates =
        posed ? posed->make(current_.ego.pose.translation.z()) : own_candidates();
    progress.all = answered->candidates.size();
    cancel_ = progress.cancel.load();
    budget.cancel = &cancel_;
    budget.known = &progress.done;
    answered->answer = ranker_->rank(answered->candidates, budget);
    check(answered->answer.status);
    const View<const RankedCandidate> told = answered->answer.ranking;
    answered->ranking.assign(told.begin(), told.end());
    answered->answer.ranking = answered->ranking;
    answered->situation = situations_;
    return answered;
  }

  /// Ends the call of `rank` or `explain` that is under way soon.
  void cancel() noexcept { cancel_ = true; }

  std::shared_ptr<Ranked> explain(const Answered& answered, const Progress& progress) {
    const std::unique_lock<std::mutex> lock = hold();
    if (answered.situation != situations_) {
      throw Failure(make_error(ErrorCode::usage, "the Ranker was updated after this answer",
                               "explain an answer before the next update"));
    }
    cancel_ = progress.cancel.load();
    auto ranked = std::make_shared<Ranked>();
    ranked->situation = situation_;
    ranked->scenario = current_;
    ranked->warnings = situation_->warnings();
    ranked->result = value_of(ranker_->explain(answered.candidates, answered.answer, &cancel_));
    if (!ranked->result.complete) {
      ranked->warnings.push_back(cancel_ ? ranking_progress(ranked->result)
                                         : why_partial(ranked->result, true));
    }
    return ranked;
  }

  void close() {
    const std::unique_lock<std::mutex> lock = hold();
    ranker_.reset();
  }

private:
  /// The lock, at once: a call that waits for another's deadline would miss its own.
  std::unique_lock<std::mutex> hold() {
    std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) {
      throw Failure(make_error(ErrorCode::usage, "another thread uses this Ranker",
                               "give each thread a Ranker of its own"));
    }
    if (!ranker_) {
      throw Failure(make_error(ErrorCode::usage, "the Ranker is closed", "make a new one"));
    }
    return lock;
  }

  static void set_probabilities(Scenario& scenario, const std::vector<double>& probabilities) {
    std::size_t next = 0;
    for (ScenarioActor& actor : scenario.actors) {
      if (actor.predictions.empty()) ++next;
      for (Prediction& prediction : actor.predictions) {
        if (next < probabilities.size()) prediction.probability = probabilities[next];
        ++next;
      }
    }
    if (next != probabilities.size()) {
      throw Failure(make_error(ErrorCode::usage, "there is not one probability for each plan",
                               "give them in the order of plans"));
    }
  }

  /// The scenario's candidates, made from where the ego is now.
  std::vector<Candidate> own_candidates() const {
    const Box bounds = situation_->models()[current_.ego.model].mesh.bounds();
    return value_of(make_candidates(current_, static_cast<double>(bounds.extent().x())));
  }

  SharedSituation situation_;
  Scenario current_;
  std::atomic<bool> cancel_{false};  ///< workers may read it until the Ranker's end
  std::optional<Ranker> ranker_;
  std::mutex mutex_;
  std::uint64_t situations_ = 0;
};

}  // namespace crashrank::python
