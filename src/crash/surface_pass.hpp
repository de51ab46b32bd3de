#pragma once

#include "crash/crush_response.hpp"
#include "crash/planar_body.hpp"

#include "crashrank/base/box.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A body of a contact: what it is, how it resists, where it is now.
struct PressedBody {
  const Vehicle* vehicle = nullptr;
  CrushResponse response;
  PlanarBody motion;
};

/// Pieces of one body's outline that may press into another, by field. `s` is how far a piece has
/// advanced along its normal through the other body, `furthest` the greatest of that.
struct NearPieces {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> normal_x;
  std::vector<float> normal_y;
  std::vector<float> length;
  std::vector<std::uint32_t> piece;
  std::vector<std::uint8_t> band;
  // In the axes of the other body, at the instant looked at.
  std::vector<float> at_x;
  std::vector<float> at_y;
  std::vector<float> at_normal_x;
  std::vector<float> at_normal_y;
  std::vector<float> advance;       ///< velocity against the other body's material along the normal
  std::vector<float> s_now;         ///< s of the piece
  std::vector<float> furthest_now;  ///< furthest of the piece
  std::vector<float> fresh;         ///< > 0: it advances into what it has not been in
  std::vector<std::uint32_t> pressing;  ///< places of those that may press
  std::size_t count = 0;
  // By piece of the profile.
  std::vector<float> s;               ///< of pieces that are not listed
  std::vector<float> furthest;        ///< of pieces that are not listed
  std::vector<float> way;             ///< how far it has travelled inside the other body, m
  std::vector<std::uint32_t> listed;  ///< number of the last list that the piece was in
  std::uint32_t list = 0;             ///< number of the present list
  double valid_for_m = -1e9;          ///< relative travel until the list has to be made anew

  void resize(std::size_t pieces);
  /// Forgets everything. O(1).
  void begin();
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
  View<const PressedBody> neighbours;
  std::size_t self = 0;  ///< the pressing body's place among them
};

/// Forces of the pieces of `pusher` on the material of `pressed`, which yields. `moved_m` is how
/// far points of the two have moved against each other since the last pass.
void press_pieces(const PressedBody& pusher, const PressedBody& pressed,
                  const PassSettings& settings, double moved_m, NearPieces& near, PassSums& sums,
                  PassRecord& record);

}  // namespace crashrank::detail
