#pragma once

#include "crash/crush_response.hpp"
#include "crash/near_pieces.hpp"
#include "crash/planar_body.hpp"

#include "crashrank/base/box.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// A body of a contact: its vehicle, its strength and its present motion.
struct PressedBody {
  const Vehicle* vehicle = nullptr;
  CrushResponse response;
  PlanarBody motion;
  double foot_load = 0.0;  ///< of a post, over what its foot bears; above 1 it broke away
};

/// Sums of one pass. "Own" is the body whose material is pressed in, "other" the body whose outline
/// pieces press.
struct PassSums {
  bool approaching = false;   ///< pieces inside the other body's bounds advance
  PlanarForce on_pressed;     ///< force on the pressed body
  double pressing = 0.0;      ///< N: normal forces before the reduction at low closing speed
  double closing = 0.0;       ///< N·m/s: pressing times closing speed along the normal
  double speed = 0.0;         ///< N·m/s: pressing times relative speed
  double unused_crush = 0.0;  ///< N: pressing times the unused share of the crush length
  double weight = 0.0;        ///< N: normal forces
  double point_x = 0.0;       ///< N·m: normal force times position, world axes from first contact
  double point_y = 0.0;       ///< N·m
  double power_own = 0.0;     ///< W: crush power of the pressed body
  double power_other = 0.0;   ///< W: crush power of the pushing body
  double power_friction = 0.0;  ///< W
  /// Volume of the compartment that the force crushes, m³/s, of the pressed and the pushing body.
  double intruding_own_m3ps = 0.0;
  double intruding_other_m3ps = 0.0;
  float depth_own = 0.0F;    ///< greatest crush depth, m
  float depth_other = 0.0F;  ///< m

  /// Reduces all forces to a share.
  void scale(double share) {
    for (double* const sum :
         {&on_pressed.x, &on_pressed.y, &on_pressed.moment, &pressing, &closing, &speed,
          &unused_crush, &weight, &point_x, &point_y, &power_own, &power_other, &power_friction}) {
      *sum *= share;
    }
  }
};

/// Damage of both bodies that the passes of a contact record.
struct PassRecord {
  Box own;                       ///< region where pieces pressed, axes of the pressed body
  Box other;                     ///< pieces that pressed, axes of their own body
  float intrusion_own = 0.0F;    ///< greatest intrusion, m
  float intrusion_other = 0.0F;  ///< m
};

/// Parameters of a pass.
struct PassSettings {
  float friction = 0.3F;
  float interlocked = 1.0F;  ///< friction coefficient where both bodies are crushed
  double step_s = 0.001;
  double pass_interval_s = 0.001;  ///< time from the last pass to this one
  bool overlapping = false;        ///< see ContactOptions
  /// All fixed bodies of the contact: pieces inside another of them do not press.
  View<const PressedBody* const> neighbours;
  std::size_t self = 0;  ///< index of the pressing body in `neighbours`
};

/// Height of the ground of the pusher over that of the pressed body, m: near the smaller of both.
double rise_of(const PressedBody& pusher, const PressedBody& pressed);

/// By band of the pusher the band of the pressed body that shares most height with it, or
/// `no_band`.
std::array<std::uint8_t, profile_bands> target_bands(double rise_m);

/// Returns true if a point (body axes, m) lies inside an outline of the height band. O(pieces of
/// the band).
bool inside_outline(const Vehicle& vehicle, std::size_t band, float x, float y);

/// Computes the forces of the outline pieces of `pusher` on the deformable body `pressed`.
/// `moved_m`: upper bound of the relative travel of points of the two bodies since the last pass.
void compute_piece_forces(const PressedBody& pusher, const PressedBody& pressed,
                          const PassSettings& settings, double moved_m, NearPieces& near,
                          PassSums& sums, PassRecord& record);

}  // namespace crashrank::detail
