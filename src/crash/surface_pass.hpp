#pragma once

#include "crash/crush_response.hpp"
#include "crash/near_pieces.hpp"
#include "crash/planar_body.hpp"

#include "crashrank/base/box.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <cstddef>

namespace crashrank::detail {

/// A body of a contact: what it is, how it resists, where it is now.
struct PressedBody {
  const Vehicle* vehicle = nullptr;
  CrushResponse response;
  PlanarBody motion;
};

/// Sums of one pass.
struct PassSums {
  bool approaching = false;  ///< pieces within the other's bounds advance, pressing or not yet
  PlanarForce on_pressed;    ///< on the body whose material is pressed in
  double pressing = 0.0;     ///< N, without the gate of the advance
  double closing = 0.0;      ///< N·m/s: pressing times advance
  double passing = 0.0;      ///< N·m/s: pressing times relative speed
  double fresh = 0.0;        ///< N: pressing times the share of its free crush length that is left
  double weight = 0.0;       ///< N: pressing forces
  double point_x = 0.0;      ///< N·m: force times its place, world axes from first contact
  double point_y = 0.0;      ///< N·m
  double power_own = 0.0;    ///< W: crushing the body whose material is pressed in
  double power_other = 0.0;  ///< W: crushing the body whose pieces press
  double power_friction = 0.0;  ///< W
  float depth_own = 0.0F;       ///< greatest crush depth, m
  float depth_other = 0.0F;     ///< m
};

/// What a pass records of both bodies over a whole contact.
struct PassRecord {
  Box own;                       ///< where pieces pressed, axes of the pressed body
  Box other;                     ///< the pieces that pressed, axes of their body
  float intrusion_own = 0.0F;    ///< greatest reach into the compartment, m
  float intrusion_other = 0.0F;  ///< m
};

/// What does not change within a contact.
struct PassSettings {
  float friction = 0.3F;
  float interlocked = 1.0F;  ///< friction where both bodies are crushed
  double step_s = 0.001;
  double since_s = 0.001;  ///< from the last pass until this one
  /// Other bodies that nothing moves: pieces inside one of them do not press.
  View<const PressedBody* const> neighbours;
  std::size_t self = 0;  ///< the pressing body's place among them
};

/// Whether a point (body axes, m) lies inside an outline of the band: O(pieces of the band).
bool inside_outline(const Vehicle& vehicle, std::size_t band, float x, float y);

/// Forces of the pieces of `pusher` on the material of `pressed`, which yields. `moved_m` is how
/// far points of the two have moved against each other since the last pass.
void press_pieces(const PressedBody& pusher, const PressedBody& pressed,
                  const PassSettings& settings, double moved_m, NearPieces& near, PassSums& sums,
                  PassRecord& record);

}  // namespace crashrank::detail
