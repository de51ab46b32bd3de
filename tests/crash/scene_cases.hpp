#pragma once

#include "crash/scene_run.hpp"

#include "crash/contact_cases.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace crashrank::test {

/// Bodies of a scene with what they refer to.
struct Stage {
  std::vector<Motion> plans;
  std::vector<detail::Footing> footings;
  std::vector<const Vehicle*> vehicles;
  std::vector<detail::SceneBody> bodies;

  void add(const Vehicle& vehicle, const Motion& plan) {
    vehicles.push_back(&vehicle);
    plans.push_back(plan);
  }
  void add(const Vehicle& vehicle, const Pose& pose, double speed_mps) {
    const Eigen::Vector3d velocity = speed_mps * pose.rotation.col(0);
    add(vehicle, Motion(FreeMotion{pose, {velocity, Eigen::Vector3d::Zero()}}));
  }
  void add(const ContactBody& body) {
    add(*body.vehicle, Motion(FreeMotion{body.pose, body.velocity}));
  }
  /// On a road, or on ice without any.
  View<const detail::SceneBody> ready(bool road, double brake = 0.7) {
    bodies.clear();
    footings.clear();
    for (const Vehicle* v : vehicles) footings.push_back(detail::footing_of(*v));
    for (std::size_t i = 0; i < plans.size(); ++i) {
      detail::SceneBody body;
      body.vehicle = vehicles[i];
      body.plan = &plans[i];
      body.footing = road ? &footings[i] : nullptr;
      body.brake = brake;
      bodies.push_back(body);
    }
    return {bodies.data(), bodies.size()};
  }
};

inline void run_to_end(detail::SceneRun& run) {
  while (run.advance(1000)) {
  }
}

/// A body of the company by its name.
inline const Vehicle& named(const char* name) {
  for (std::size_t i = 0; i < company().size(); ++i) {
    if (company().any(i).name == name) return company().any(i).vehicle;
  }
  throw std::runtime_error(name);
}

/// Bodies thrown at each other from all around, at least two of them movable.
inline Stage pile(Random& random, std::size_t count, bool fixed_too) {
  Stage stage;
  const auto movable = static_cast<std::uint32_t>(company().movable.size());
  const auto all = static_cast<std::uint32_t>(company().size());
  for (std::size_t i = 0; i < count; ++i) {
    const double round = 2.0 * detail::pi * static_cast<double>(i) / static_cast<double>(count);
    const double away = random.uniform(9, 14);
    const Pose pose = flat_pose(away * std::cos(round), away * std::sin(round),
                                round + detail::pi + random.uniform(-0.25, 0.25));
    const std::size_t what = i > 1 && fixed_too ? random.below(all) : random.below(movable);
    const bool moves = what < movable;
    stage.add(company().any(what).vehicle, pose, moves ? random.uniform(3, 30) : 0.0);
  }
  return stage;
}

/// A fast body behind a row of others, which are pushed into each other. The last may be fixed.
inline Stage row(Random& random, std::size_t count) {
  Stage stage;
  const auto movable = static_cast<std::uint32_t>(company().movable.size());
  const auto all = static_cast<std::uint32_t>(company().size());
  double x = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    // The first is a car or a lorry.
    const std::size_t what = i == 0           ? random.below(3)
                             : i + 1 == count ? random.below(all)
                                              : random.below(movable);
    const Vehicle& v = company().any(what).vehicle;
    const double yaw = random.uniform(-0.3, 0.3);
    const double rear = static_cast<double>(v.silhouettes.min_x);
    const double front = static_cast<double>(v.silhouettes.max_x);
    const double slack = 0.3 * static_cast<double>(v.silhouettes.width_m());
    x -= rear - slack;
    const double y = i == 0 ? 0.0 : random.uniform(-0.8, 0.8);
    const double fast = i == 0 ? random.uniform(8, 35) : random.uniform(0, 5);
    stage.add(v, flat_pose(x, y, yaw), v.movable() ? fast : 0.0);
    x += front + slack + random.uniform(0.5, 4.0);
  }
  return stage;
}

/// Options with the steps that the scene takes by itself, times a factor.
inline detail::SceneOptions with_steps(double factor) {
  detail::SceneOptions options;
  options.contact.travel_m *= factor;
  options.contact.shortest_s *= factor;
  options.contact.longest_s *= factor;
  options.contact.speed_change *= factor;
  options.rolling_step_s *= factor;
  return options;
}

}  // namespace crashrank::test
