#pragma once

#include "crashrank/crash/contact_law.hpp"

#include <tuple>

namespace crashrank::detail {

/// Whether `p` is the second of the two bodies in the one order that every computation on a pair
/// uses, so that exchanging the bodies changes no bit of it. Decided by what the bodies are, then
/// by where they are and how they move; bodies that are equal in all of it coincide.
inline bool goes_second(const ContactBody& p, const ContactBody& q) {
  const auto key = [](const ContactBody& body) {
    const Vehicle& v = *body.vehicle;
    const Silhouettes& s = v.silhouettes;
    const Pose& pose = body.pose;
    const Velocity& velocity = body.velocity;
    return std::make_tuple(
        v.strength.rigid, !v.movable(), v.mass_kg, v.yaw_inertia_kgm2, v.profile->pieces.size(),
        s.min_x, s.max_x, s.min_y, s.max_y, v.center_m.x(), v.center_m.y(), pose.translation.x(),
        pose.translation.y(), pose.rotation(0, 0), pose.rotation(1, 0), velocity.linear_mps.x(),
        velocity.linear_mps.y(), velocity.angular_radps.z());
  };
  return key(q) < key(p);
}

}  // namespace crashrank::detail
