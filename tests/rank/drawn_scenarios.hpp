#pragma once

// The drawn futures of a scenario with errors of states, each as a scenario without uncertainty.

#include "rank/future_sample.hpp"
#include "rank/futures_cases.hpp"
#include "rank/strata.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::futures {

inline std::vector<StateError> drawn(std::uint64_t seed, const StateUncertainty& uncertainty,
                                     std::size_t count) {
  detail::Strata strata;
  strata.prepare(count);
  std::vector<StateError> errors(count);
  strata.draw(seed, uncertainty, errors.data());
  return errors;
}

inline std::vector<StateError> drawn_of_ego(const Scenario& scenario, std::size_t count) {
  return drawn(detail::reserved_seed("ego"), scenario.ego.uncertainty, count);
}

inline Pose displaced(const Pose& pose, const StateError& error) {
  Pose moved = pose;
  const Eigen::AngleAxisd turn(error.heading_rad, Eigen::Vector3d::UnitZ());
  moved.rotation = turn.toRotationMatrix() * pose.rotation;
  moved.translation += Eigen::Vector3d(error.x_m, error.y_m, 0.0);
  return moved;
}

inline double changed(double speed, double error) {
  return speed == 0.0 ? 0.0 : std::max(speed + error, 0.0);
}

inline void displace(ActorMotion& motion, const StateError& error) {
  motion.pose = displaced(motion.pose, error);
  const double speed = changed(motion.speed_mps, error.speed_mps);
  if (speed == 0.0 && motion.acceleration_mps2 <= 0.0) motion.yaw_rate_radps = 0.0;
  motion.speed_mps = speed;
}

/// The scenario with its alternatives in the order in which they are drawn: the faster one first,
/// then the one that turns further to the left.
inline Scenario sorted(Scenario scenario) {
  const auto precedes = [](const ActorMotion& p, const ActorMotion& q) {
    return p.speed_mps != q.speed_mps ? p.speed_mps > q.speed_mps
                                      : p.yaw_rate_radps > q.yaw_rate_radps;
  };
  for (ScenarioActor& actor : scenario.actors) {
    std::sort(actor.predictions.begin(), actor.predictions.end(), precedes);
  }
  std::sort(scenario.futures.begin(), scenario.futures.end(),
            [&](const JointFuture& p, const JointFuture& q) {
              return precedes(p.motions.front().motion, q.motions.front().motion);
            });
  return scenario;
}

/// Each of the drawn futures without uncertainty, and its probability.
inline std::vector<SingleFuture> single_scenarios(const Scenario& written, std::size_t sampled) {
  const Scenario scenario = sorted(written);
  std::vector<SingleFuture> singles(sampled);
  const std::vector<StateError> ego = drawn_of_ego(scenario, sampled);
  detail::Strata strata;
  strata.prepare(sampled);
  // What every actor does: tests of FutureSample hold it against the stated probabilities.
  detail::FutureSample sample;
  sample.prepare(sampled, scenario.actors.size() + 1, 100);
  std::vector<std::size_t> uncertain;
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    if (actor.predictions.size() > 1 || actor.existence_probability < 1.0) uncertain.push_back(i);
  }
  std::sort(uncertain.begin(), uncertain.end(), [&](std::size_t p, std::size_t q) {
    return detail::seed_of(scenario.actors[p].name) < detail::seed_of(scenario.actors[q].name);
  });
  if (scenario.futures.empty()) {
    for (const std::size_t i : uncertain) {
      const ScenarioActor& actor = scenario.actors[i];
      const double exists = actor.existence_probability;
      sample.add_variable(detail::seed_of(actor.name));
      if (actor.predictions.empty()) sample.add_choice(exists);
      for (const Prediction& each : actor.predictions) sample.add_choice(exists * each.probability);
      if (exists < 1.0) sample.add_choice(1.0 - exists);
    }
  } else {
    sample.add_variable(detail::reserved_seed("futures"));
    for (const JointFuture& future : scenario.futures) sample.add_choice(future.probability);
  }
  sample.draw(strata);
  for (std::size_t f = 0; f < sampled; ++f) {
    singles[f].probability = sample.drawn()[f].probability;
    Scenario& single = singles[f].scenario;
    single = likeliest_future(scenario);
    ScenarioEgo& own = single.ego;
    own.pose = displaced(own.pose, ego[f]);
    own.speed_mps = changed(own.speed_mps, ego[f].speed_mps);
    for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
      single.actors[i].existence_probability = 1.0;
      if (!scenario.futures.empty()) {
        static_cast<ActorMotion&>(single.actors[i]) = scenario.actors[i];
      }
    }
    if (!scenario.futures.empty()) {
      for (const FutureMotion& moved : scenario.futures[sample.choice(f, 0)].motions) {
        static_cast<ActorMotion&>(single.actors[moved.actor]) = moved.motion;
      }
      continue;
    }
    for (std::size_t v = 0; v < uncertain.size(); ++v) {
      const ScenarioActor& actor = scenario.actors[uncertain[v]];
      const std::size_t choice = sample.choice(f, v);
      const std::size_t motions = std::max<std::size_t>(actor.predictions.size(), 1);
      if (choice >= motions) {
        single.actors[uncertain[v]].existence_probability = 0.0;
      } else if (!actor.predictions.empty()) {
        static_cast<ActorMotion&>(single.actors[uncertain[v]]) = actor.predictions[choice];
      }
    }
  }
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const std::vector<StateError> errors =
        drawn(detail::seed_of(actor.name), actor.perception, sampled);
    for (std::size_t f = 0; f < sampled; ++f) displace(singles[f].scenario.actors[i], errors[f]);
  }
  return singles;
}

}  // namespace crashrank::futures
