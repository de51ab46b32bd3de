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

/// A body with the geometry and the properties that the search for contacts and the crash model
/// need.
struct Body {
  const Model* model = nullptr;
  double mass_kg = 0.0;
  Pose fixed_pose;  ///< pose of a fixed body
  /// centre of the root box, body coordinates
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  /// half extents of the root box along its axes
  Eigen::Matrix3d half_axes_m = Eigen::Matrix3d::Zero();
  double radius_m = 0.0;  ///< upper bound on the distance of a point of the body from its origin
  Footing footing;        ///< contact patches on the road; movable bodies only
  /// Mechanical properties for the crash model, which the bodies of a model share; never null.
  std::shared_ptr<const Vehicle> vehicle;
  std::shared_ptr<const BodyOutline> outline;  ///< for distance queries, shared likewise
  std::optional<double> occupants;             ///< persons; absent: the default of its kind
};

/// Bounding box in world coordinates of all points of the body during [from, until], widened by the
/// contact tolerance and by more than all rounding errors.
Box swept_box(const Body& body, const Motion& motion, double from_s, double until_s,
              double tolerance_m);

/// A body of a model of the scenario, ready to enter the scene.
struct EnteringBody {
  Body body;
  RankedBody ranked;
};

/// Fixed bodies that adjoin each other and act as one body in a contact.
struct JoinedBodies {
  /// indices of actors, ascending; the pose of the first is that of all
  std::vector<std::size_t> members;
  Vehicle vehicle;  ///< their common outline, in the body coordinates of the first member
};

/// Everything that the candidates of a scenario share, prepared once and then read only.
struct Scene {
  Body ego;
  Pose ego_start;
  std::vector<Body> actors;
  /// By model of the scenario: nothing where it is fixed or at fault; empty where no actor that
  /// exists in no future keeps a place.
  std::vector<std::optional<EnteringBody>> entering;
  std::vector<JoinedBodies> joined;
  std::vector<std::size_t> joined_of;  ///< by actor: index into `joined`, or `not_joined`
  static constexpr std::size_t not_joined = static_cast<std::size_t>(-1);
  /// By actor: fixed bodies that adjoin it but are not joined with it, because one of the two may
  /// be absent. Joined bodies are represented by their first member.
  std::vector<std::vector<std::uint32_t>> adjoining;
  /// Time is divided into slices, each with a broad phase over the swept boxes of all plans.
  std::vector<double> slice_s;  ///< limits of the slices, from 0 to the horizon
  Futures futures;
  /// upper bound on the speed of any point of an actor on its plan
  double fastest_plan_mps = 0.0;
  std::vector<BroadPhase> slices;  ///< broad phase over the plans, by slice
  std::vector<Box> boxes;          ///< swept boxes of the plans in one slice, while it is built
  /// By plan: the ego at its start is known to be clear of the actor on that plan.
  std::vector<char> apart_at_start;
  Measure measure = Measure::polygons;
  HarmOptions harm;
  HarmSample nominal;               ///< the sample with all parameters at their nominal values
  std::vector<HarmSample> samples;  ///< further samples of the unknown parameters; may be empty
  EgoLimits limits;
  Infeasible infeasible = Infeasible::demote;
  bool records_motion = false;
  bool finds_damage = true;  ///< of every contact of the likeliest future
  Road road;
  double grip = 0.8;  ///< friction of the tyres on the road
  PlanTrajectories trajectories;
  ImpactOptions impact;
  RankWork work;  ///< work of the preparation
};

/// The body of an index: an actor, or the ego for `ego_body`.
inline const Body& body_of(const Scene& scene, std::size_t index) {
  return index == ego_body ? scene.ego : scene.actors[index];
}

Result<Scene> make_scene(const Scenario& scenario, View<const Model> models,
                         const RankOptions& options, RankResult& result);

/// Updates everything that depends on the motions of the plans: swept boxes, trajectories, and
/// which plans the ego at its start is clear of. Allocates only when memory has to grow.
void update_plans(Scene& scene, ImpactWorkspace& workspace);

}  // namespace crashrank::detail
