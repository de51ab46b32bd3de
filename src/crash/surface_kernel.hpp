#pragma once

#include "crash/crush_response.hpp"
#include "crash/near_pieces.hpp"
#include "crash/surface_pass.hpp"

#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <array>

namespace crashrank::detail {

/// Rigid transformation from one body's axes to another's, and the velocity of the first one's
/// material against the second one's, in the second one's axes.
struct Carrier {
  float c = 1.0F;
  float s = 0.0F;
  float x = 0.0F;
  float y = 0.0F;
  float vx = 0.0F;  ///< at the origin of the axes
  float vy = 0.0F;
  float spin = 0.0F;
};

/// A pass for the vector units.
struct PressQuery {
  Carrier to;  ///< from the pusher to the pressed body
  const PressedBody* pusher = nullptr;
  const PressedBody* pressed = nullptr;
  const PassSettings* settings = nullptr;
  float narrow_m = 1.0F;  ///< width of the narrower body
  float wider_m = 0.0F;   ///< width of the pressed body beside the pusher, >= 0
  float dragged_kgm3 = 0.0F;
};

/// Sums of a pass in the pressed body's axes.
struct PressTotals {
  bool approaching = false;
  double force_x = 0.0;
  double force_y = 0.0;
  double moment = 0.0;
  double point_x = 0.0;  ///< force times its place
  double point_y = 0.0;
};

/// Makes the list anew: blocks with pieces that may press within the next `near_m` of travel.
void list_blocks(const PressQuery& query, float near_m, NearPieces& near);

/// Moves the pieces of the listed blocks by a step and adds up the forces of those that press; of
/// `sums` all but what is in world axes. The same bits on every vector unit.
void press_blocks(const PressQuery& query, NearPieces& near, PressTotals& totals, PassSums& sums,
                  PassRecord& record);

/// Whether a piece of one fixed body is covered by another.
bool is_hidden(const PressedBody& owner, const OutlinePiece& piece, std::size_t band,
               const PassSettings& settings);

}  // namespace crashrank::detail
