#include "rank/meet.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

double closing_energy_j(double ego_kg, double other_kg, double speed_mps) {
  const double reduced = std::isinf(other_kg) ? ego_kg : ego_kg * other_kg / (ego_kg + other_kg);
  return 0.5 * reduced * speed_mps * speed_mps;
}

Contact make_contact(const Scene& scene, const EgoAtContact& ego, std::size_t actor,
                     const Impact& impact) {
  const Body& other = scene.actors[actor];
  Contact contact;
  contact.actor = actor;
  contact.state = impact.state;
  contact.time_of_impact_s = impact.time_s;
  contact.gap_m = impact.gap_m;
  contact.normal = impact.normal;
  Pose other_pose;
  Velocity other_velocity;
  other.motion.state_at(impact.time_s, other_pose, other_velocity);
  if (impact.triangle_a >= 0 && impact.triangle_b >= 0) {
    contact.point_m = 0.5 * (impact.point_a_m + impact.point_b_m);
  } else {
    // One lies inside the other: the middle of the smaller one stands for the place, of equal ones
    // the middle between theirs.
    const Eigen::Vector3d own = ego.pose.rotation * scene.ego.center_m + ego.pose.translation;
    const Eigen::Vector3d theirs = other_pose.rotation * other.center_m + other_pose.translation;
    contact.point_m = scene.ego.radius_m < other.radius_m   ? own
                      : other.radius_m < scene.ego.radius_m ? theirs
                                                            : Eigen::Vector3d(0.5 * (own + theirs));
  }
  const Eigen::Vector3d closing =
      velocity_of_point(ego.met, ego.pose.translation, contact.point_m) -
      velocity_of_point(other_velocity, other_pose.translation, contact.point_m);
  contact.closing = closing;
  contact.closing_speed_mps = closing.norm();
  contact.normal_speed_mps = std::max(0.0, closing.dot(contact.normal));
  contact.closing_energy_j =
      closing_energy_j(scene.ego.mass_kg, other.mass_kg, contact.closing_speed_mps);
  return contact;
}

}  // namespace crashrank::detail
