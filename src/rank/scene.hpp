#pragma once

#include "crash/tyres.hpp"
#include "crashrank/base/box.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/broad_phase.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "rank/clearance.hpp"
#include "rank/futures.hpp"
#include "rank/outline_distance.hpp"
#include "scenario/demand.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// A body with what the search for contacts needs to know of its size.
struct Body {
  const Model* model = nullptr;
  double mass_kg = 0.0;
  Pose fixed_pose;                                        ///< of what nothing moves
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();     ///< of the root box, body coordinates
  Eigen::Matrix3d half_axes_m = Eigen::Matrix3d::Zero();  ///< its half extents along its axes
  double radius_m = 0.0;                       ///< no point of the body is further from its origin
  Vehicle vehicle;                             ///< what it is in a crash
  Footing footing;                             ///< of what moves
  std::shared_ptr<const BodyOutline> outline;  ///< for distances, never null
  std::optional<double> occupants;             ///< persons; absent: the kind's
};

/// A box in world coordinates that holds every point of the body at every time of [from, until],
/// with a margin that covers contact at the tolerance and rounding.
Box swept_box(const Body& body, const Motion& motion, double from_s, double until_s,
              double tolerance_m);

/// Bodies that nothing moves and that adjoin each other: one body in a contact.
struct JoinedBodies {
  std::vector<std::size_t> members;  ///< actors, rising; the first one's pose is that of all
  Vehicle vehicle;                   ///< their common outline, in its body coordinates
};

/// What all candidates of a scenario share, prepared once and then only read.
struct Scene {
  Body ego;
  Pose ego_start;
  std::vector<Body> actors;
  std::vector<JoinedBodies> joined;
  std::vector<std::size_t> joined_of;  ///< by actor: its place in `joined`, or `alone`
  static constexpr std::size_t not_joined = static_cast<std::size_t>(-1);
  /// By actor: fixed bodies that it adjoins but is not joined with, since one of the two may not
  /// exist. The first member of joined bodies stands for all of them.
  std::vector<std::vector<std::uint32_t>> adjoining;
  /// Time is cut into slices; in each the swept boxes of the actors' plans are ready to be asked.
  std::vector<double> slice_s;  ///< ends of the slices, from 0 to the horizon
  Futures futures;
  double fastest_plan_mps = 0.0;   ///< no point of an actor that follows a plan is faster
  std::vector<BroadPhase> slices;  ///< of the plans
  std::vector<Box> boxes;          ///< of the plans, while slices are built
  /// Whether the ego at its start is known to be clear of an actor on a plan, by plan.
  std::vector<char> apart_at_start;
  Measure measure = Measure::polygons;
  HarmOptions harm;
  HarmSample nominal;               ///< in which nothing varies
  std::vector<HarmSample> samples;  ///< in which the score is evaluated, too; may be empty
  EgoLimits limits;
  Infeasible infeasible = Infeasible::demote;
  Road road;
  double grip = 0.8;  ///< of tyres on the road
  PlanTrajectories trajectories;
  ImpactOptions impact;
  RankWork work;  ///< spent on preparing
};

/// The body that an index stands for: an actor, or the ego.
inline const Body& body_of(const Scene& scene, std::size_t index) {
  return index == ego_body ? scene.ego : scene.actors[index];
}

Result<Scene> make_scene(const Scenario& scenario, View<const Model> models,
                         const RankOptions& options, RankResult& result);

/// Reads the plans: sweeps their boxes, and finds which the ego at its start is clear of. Allocates
/// only to grow beyond what was held before.
void update_plans(Scene& scene, ImpactWorkspace& workspace);

}  // namespace crashrank::detail
