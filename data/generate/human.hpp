#pragma once

#include "mesh.hpp"

#include <array>

namespace generate {

/// Where a person's joints are, m; index 0 is the left one, 1 the right one.
struct Posture {
  Vec3 pelvis;
  Vec3 neck;  ///< foot of the neck
  Vec3 head;  ///< middle of the head
  std::array<Vec3, 2> shoulder, elbow, wrist, fingers, hip, knee, ankle, toe;
  bool helmet = false;
};

/// Places of the left and the right joint, from that of the left one.
inline std::array<Vec3, 2> both_sides(const Vec3& left) {
  return {left, Vec3(left.x(), -left.y(), left.z())};
}

/// An adult in that posture, about `edge` m a triangle side: head or helmet, neck, torso, pelvis
/// and limbs as parts, each name with `prefix` before it.
Model build_person(const Posture& posture, const std::string& prefix, double edge);

/// Somebody of 1.75 m walking along +x, the ground under the pelvis as origin.
Model build_pedestrian(double edge);

/// A child of 1.14 m walking along +x: the adult, smaller.
Model build_child(double edge);

}  // namespace generate
