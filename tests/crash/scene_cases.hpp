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

/// Owns the vehicles, plans and footings of a scene.
struct SceneSetup {
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
  /// Returns the bodies of the scene, with or without road forces.
  View<const detail::SceneBody> make_bodies(bool road, double brake = 0.7) {
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

/// Returns a test body by name.
inline const Vehicle& named(const char* name) {
  for (std::size_t i = 0; i < test_bodies().size(); ++i) {
    if (test_bodies().any(i).name == name) return test_bodies().any(i).vehicle;
  }
  throw std::runtime_error(name);
}

/// Bodies that drive towards a common centre from all directions; the first two are movable.
inline SceneSetup random_pile_up(Random& random, std::size_t count, bool with_fixed) {
  SceneSetup setup;
  const auto movable = static_cast<std::uint32_t>(test_bodies().movable.size());
  const auto all = static_cast<std::uint32_t>(test_bodies().size());
  for (std::size_t i = 0; i < count; ++i) {
    const double round = 2.0 * detail::pi * static_cast<double>(i) / static_cast<double>(count);
    const double away = random.uniform(9, 14);
    const Pose pose = flat_pose(away * std::cos(round), away * std::sin(round),
                                round + detail::pi + random.uniform(-0.25, 0.25));
    const std::size_t what = i > 1 && with_fixed ? random.below(all) : random.below(movable);
    const bool moves = what < movable;
    setup.add(test_bodies().any(what).vehicle, pose, moves ? random.uniform(3, 30) : 0.0);
  }
  return setup;
}

/// A fast body behind a row of others, which it pushes into each other. The last one may be fixed.
inline SceneSetup random_queue(Random& random, std::size_t count) {
  SceneSetup setup;
  const auto movable = static_cast<std::uint32_t>(test_bodies().movable.size());
  const auto all = static_cast<std::uint32_t>(test_bodies().size());
  double x = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    // The first body is a car or a lorry.
    const std::size_t what = i == 0           ? random.below(3)
                             : i + 1 == count ? random.below(all)
                                              : random.below(movable);
    const Vehicle& v = test_bodies().any(what).vehicle;
    const double yaw = random.uniform(-0.3, 0.3);
    const double rear = static_cast<double>(v.silhouettes.min_x);
    const double front = static_cast<double>(v.silhouettes.max_x);
    const double slack = 0.3 * static_cast<double>(v.silhouettes.width_m());
    x -= rear - slack;
    const double y = i == 0 ? 0.0 : random.uniform(-0.8, 0.8);
    const double fast = i == 0 ? random.uniform(8, 35) : random.uniform(0, 5);
    setup.add(v, flat_pose(x, y, yaw), v.movable() ? fast : 0.0);
    x += front + slack + random.uniform(0.5, 4.0);
  }
  return setup;
}

/// Options with the default step sizes times a factor.
inline detail::SceneOptions options_with_steps(double factor) {
  detail::SceneOptions options;
  options.contact.travel_m *= factor;
  options.contact.shortest_s *= factor;
  options.contact.longest_s *= factor;
  options.contact.speed_change *= factor;
  options.rolling_step_s *= factor;
  return options;
}

}  // namespace crashrank::test
