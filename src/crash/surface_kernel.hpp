#pragma once

#include "crash/crush_response.hpp"
#include "crash/near_pieces.hpp"
#include "crash/surface_pass.hpp"

#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <array>
#include <cstdint>

namespace crashrank::detail {

/// Rigid transformation from the axes of one body to those of another, and the velocity of the
/// first body relative to the second, in the second body's axes.
struct RelativeMotion {
  float c = 1.0F;
  float s = 0.0F;
  float x = 0.0F;
  float y = 0.0F;
  float vx = 0.0F;  ///< velocity at the origin of the axes
  float vy = 0.0F;
  float spin = 0.0F;
};

/// Arguments of a pass: one evaluation of the forces of one outline on another body.
struct PressQuery {
  RelativeMotion to;  ///< from the axes of `pusher` to those of `pressed`
  const PressedBody* pusher = nullptr;
  const PressedBody* pressed = nullptr;
  const PassSettings* settings = nullptr;
  float narrower_width_m = 1.0F;  ///< width of the narrower body
  float excess_width_m = 0.0F;  ///< width of the pressed body in excess of that of the pusher, >= 0
  float dragged_density_kgm3 = 0.0F;
  float rise_m = 0.0F;  ///< height of the ground of the pusher over that of the pressed body
  /// By band of the pusher: the band of the pressed body at the same height, or `no_band`.
  std::array<std::uint8_t, profile_bands> target_band{};
};

/// Sums of a pass, in the pressed body's axes.
struct PressTotals {
  bool approaching = false;
  double force_x = 0.0;
  double force_y = 0.0;
  double moment = 0.0;
  double point_x = 0.0;  ///< force times position
  double point_y = 0.0;
};

/// Makes a new list of the blocks with pieces that may press within the next `near_m` of relative
/// travel.
void list_blocks(const PressQuery& query, float near_m, NearPieces& near);

/// Advances the pieces of the listed blocks by a step and sums the forces of those that press.
/// Fills all of `sums` except the members in world axes. Every vector unit gives the same bits.
void accumulate_forces(const PressQuery& query, NearPieces& near, PressTotals& totals,
                       PassSums& sums, PassRecord& record);

/// Returns true if a piece of one fixed body is covered by another fixed body.
bool is_hidden(const PressedBody& owner, const OutlinePiece& piece, std::size_t band,
               const PassSettings& settings);

}  // namespace crashrank::detail
