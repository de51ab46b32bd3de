#pragma once

#include "crashrank/crash/contact_law.hpp"

#include <tuple>

namespace crashrank::detail {

/// Returns true if `p` comes second in the fixed order in which every computation treats two
/// bodies; exchanging the arguments of a computation then changes no bit of its result. The order
/// compares the vehicles, then poses and velocities; bodies that are equal in all of these
/// coincide.
inline bool goes_second(const ContactBody& p, const ContactBody& q) {
  const auto key = [](const ContactBody& body) {
    const Vehicle& v = *body.vehicle;
    const Silhouettes& s = v.silhouettes;
    const Pose& pose = body.pose;
    const Velocity& velocity = body.velocity;
    return std::make_tuple(
        v.strength.rigid, v.stands(), v.mass_kg, v.yaw_inertia_kgm2, v.profile->pieces.size(),
        s.min_x, s.max_x, s.min_y, s.max_y, v.center_m.x(), v.center_m.y(), pose.translation.x(),
        pose.translation.y(), pose.rotation(0, 0), pose.rotation(1, 0), velocity.linear_mps.x(),
        velocity.linear_mps.y(), velocity.angular_radps.z());
  };
  return key(q) < key(p);
}

}  // namespace crashrank::detail
