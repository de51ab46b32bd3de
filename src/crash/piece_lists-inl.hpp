// Lists of the outline pieces of one body that may press into another. Included once per vector
// target.
#if defined(CRASHRANK_PIECE_LISTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_PIECE_LISTS_INL
#undef CRASHRANK_PIECE_LISTS_INL
#else
#define CRASHRANK_PIECE_LISTS_INL
#endif

#include "collide/lanes-inl.hpp"
#include "crash/crush_curves-inl.hpp"
#include "crash/silhouette_depths-inl.hpp"
#include "crash/surface_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// Advance of a piece that never presses: so low that no step changes it.
inline constexpr float never_presses = -1e9F;

/// How far back along its normal a piece that only touches now was outside the other body or passed
/// over it, m: a piece of an outline and two cells, by which heights may count too early, and 0.05.
inline constexpr float back_m = 0.15F;

/// Lengths along the other body's x and y axes, as lengths along the normals of pieces that face
/// its ends or its flanks.
HWY_INLINE F8 along_normal(F8 along_x, F8 along_y, F8 nx, F8 ny) {
  const F8 x_share = absolute(nx);
  const F8 y_share = absolute(ny);
  return select(less(x_share, y_share), y_share * along_y, x_share * along_x);
}

/// Depth of pieces, along their normals, below the side of the other body that they face; negative
/// outside it. Beside its silhouettes the bounds of the band count.
HWY_INLINE F8 faced_depth(const Depths& d, const BandBounds& bounds, F8 x, F8 y, F8 nx, F8 ny) {
  const auto known_or = [&](F8 depth, F8 to_bounds) {
    constexpr float no_interval = -1e6F;
    return select(less(all(no_interval), depth), depth, to_bounds);
  };
  const F8 end = select(less(nx, all(0.0F)), known_or(d.front, all(bounds.max_x) - x),
                        known_or(d.rear, x - all(bounds.min_x)));
  const F8 side = select(less(ny, all(0.0F)), known_or(d.left, all(bounds.max_y) - y),
                         known_or(d.right, y - all(bounds.min_y)));
  return along_normal(end, side, nx, ny);
}

/// Height that eight pieces and the pressed body have in common, m; 0 or less where they pass over
/// each other. The heights of a piece are those at the surface and, the deeper it is, behind it.
HWY_INLINE F8 common_height(const PressQuery& q, const PieceRows& rows, std::size_t first,
                            std::size_t band, const Depths& d) {
  const Edges there = heights_at(q.pressed->vehicle->silhouettes, band, d);
  const F8 behind =
      minimum(all(1.0F), positive(d.least()) * all(static_cast<float>(1.0 / profile_depth_m)));
  const auto height_of = [&](const std::array<float, block_pieces>& at_edge,
                             const std::array<float, block_pieces>& at_depth) {
    const F8 edge = load(at_edge.data() + first);
    return edge + behind * (load(at_depth.data() + first) - edge) + all(q.rise_m);
  };
  return minimum(height_of(rows.edge_high_m, rows.behind_high_m), there.greatest) -
         maximum(height_of(rows.edge_low_m, rows.behind_low_m), there.least);
}

/// Starts to track pieces of a block, a bit for each in `which`. Pieces that lie too deep inside
/// the other body never press, unless a little earlier they were outside or passed over it. After
/// an earlier contact of the two bodies, pieces press only beyond the depth that they have crushed:
/// their path inside, along the normal.
inline void start_tracking(const PressQuery& q, const PieceBlock& block, const PieceRows& rows,
                           float allowed_m, std::uint32_t which, PieceStates& states) {
  const Silhouettes& target = q.pressed->vehicle->silhouettes;
  const std::size_t band = q.target_band[block.band];
  PieceStates begun;
  for (std::size_t h = 0; h < block_pieces; h += 8) {
    const auto turn_x = [&](F8 x, F8 y) { return all(q.to.c) * x - all(q.to.s) * y; };
    const auto turn_y = [&](F8 x, F8 y) { return all(q.to.s) * x + all(q.to.c) * y; };
    const F8 x = load(rows.x.data() + h);
    const F8 y = load(rows.y.data() + h);
    const F8 normal_x = load(rows.normal_x.data() + h);
    const F8 normal_y = load(rows.normal_y.data() + h);
    const F8 at_x = turn_x(x, y) + all(q.to.x);
    const F8 at_y = turn_y(x, y) + all(q.to.y);
    const Depths depths = depths_at(target, band, at_x, at_y);
    const F8 nx = turn_x(normal_x, normal_y);
    const F8 ny = turn_y(normal_x, normal_y);
    const F8 path = load(states.path.data() + h);
    const F8 path_x = absolute(load(states.path_x.data() + h));
    const F8 path_y = square_root(positive(path * path - path_x * path_x));
    const F8 crushed = along_normal(path_x, path_y, nx, ny);
    // Bodies stand in the middle of a step, and the advance counts from its begin.
    const F8 advance =
        (all(q.to.vx) - all(q.to.spin) * at_y) * nx + (all(q.to.vy) + all(q.to.spin) * at_x) * ny;
    const F8 depth = faced_depth(depths, target.bands[band], at_x, at_y, nx, ny) -
                     all(static_cast<float>(0.5 * q.settings->step_s)) * advance;
    store(crushed, begun.furthest.data() + h);
    const Depths before = depths_at(target, band, at_x - all(back_m) * nx, at_y - all(back_m) * ny);
    const M8 was_inside = both(less(all(0.0F), before.least()),
                               less(all(0.0F), common_height(q, rows, h, band, before)));
    const M8 stays_inside = q.settings->overlapping
                                ? either(at_most(before.least(), all(0.0F)), was_inside)
                                : was_inside;
    const M8 too_deep = both(less(all(allowed_m), depths.least()), stays_inside);
    const F8 fresh = select(too_deep, all(never_presses), all(0.0F));
    store(select(less(all(0.0F), path), minimum(depth, crushed), fresh), begun.s.data() + h);
  }
  const std::vector<std::uint8_t>& in_joint = q.pusher->vehicle->in_joint;
  for (std::size_t k = 0; k < block.count; ++k) {
    if ((which >> k & 1U) == 0) continue;
    states.s[k] = begun.s[k];
    states.furthest[k] = begun.furthest[k];
    if (!in_joint.empty() && in_joint[block.first + k] != 0) states.s[k] = never_presses;
    if (q.settings->neighbours.size() < 2) continue;
    const OutlinePiece& piece = q.pusher->vehicle->profile->pieces[block.first + k];
    if (is_hidden(*q.pusher, piece, block.band, *q.settings)) states.s[k] = never_presses;
  }
}

/// Computes the force-deflection curves of the block's pieces for their own body's material.
inline void compute_block_curves(const PressQuery& q, const PieceBlock& block,
                                 const PieceRows& rows, PieceCurves& curves) {
  // The force of both bodies counts for the height of the pressed body's band.
  const float scale =
      static_cast<float>(band_height_m(q.target_band[block.band]) / band_height_m(block.band));
  for (std::size_t h = 0; h < block_pieces; h += 8) {
    CrushCurves c = crush_curves(q.pusher->response, block.band, load(rows.x.data() + h),
                                 load(rows.y.data() + h), -load(rows.normal_x.data() + h),
                                 -load(rows.normal_y.data() + h));
    c.shorten(load(rows.thickness_m.data() + h));
    c.scale(all(scale));
    store(c.yield, curves.yield.data() + h);
    store(c.slope, curves.slope.data() + h);
    store(c.length, curves.length.data() + h);
    store(c.hardening, curves.hardening.data() + h);
    store(c.hardening_length, curves.hardening_length.data() + h);
    store(c.rigid, curves.rigid.data() + h);
  }
}

HWY_INLINE CrushCurves load_curves(const PieceCurves& curves, std::size_t first) {
  return {load(curves.yield.data() + first),
          load(curves.slope.data() + first),
          load(curves.length.data() + first),
          load(curves.hardening.data() + first),
          load(curves.hardening_length.data() + first),
          load(curves.rigid.data() + first)};
}

/// Centres and half extents of eight boxes in the axes of the other body, m.
struct TransformedBoxes {
  F8 x, y, reach_x, reach_y;
};

HWY_INLINE TransformedBoxes transform_boxes(const RelativeMotion& to, const BlockGroup& group) {
  const F8 own_x = load(group.x.data());
  const F8 own_y = load(group.y.data());
  const F8 half_x = load(group.half_x.data());
  const F8 half_y = load(group.half_y.data());
  const F8 c = all(std::abs(to.c));
  const F8 s = all(std::abs(to.s));
  TransformedBoxes at;
  at.x = all(to.c) * own_x - all(to.s) * own_y + all(to.x);
  at.y = all(to.s) * own_x + all(to.c) * own_y + all(to.y);
  at.reach_x = c * half_x + s * half_y;
  at.reach_y = s * half_x + c * half_y;
  return at;
}

/// Returns which boxes come nearer than `near_m` to the bounds of a height band.
HWY_INLINE M8 are_near(const TransformedBoxes& at, const BandBounds& bounds, float near_m) {
  const F8 reach_x = at.reach_x + all(near_m);
  const F8 reach_y = at.reach_y + all(near_m);
  return both(
      both(less(all(bounds.min_x), at.x + reach_x), less(at.x - reach_x, all(bounds.max_x))),
      both(less(all(bounds.min_y), at.y + reach_y), less(at.y - reach_y, all(bounds.max_y))));
}

/// Returns the blocks of a group with pieces within `near_m` of the bounds of a height band, a bit
/// for each.
HWY_INLINE std::uint32_t near_blocks(const PressQuery& q, const BlockGroup& group, float near_m) {
  const std::uint8_t band = q.target_band[group.band];
  if (band == no_band) return 0;
  const BandBounds& bounds = q.pressed->vehicle->silhouettes.bands[band];
  return bits(are_near(transform_boxes(q.to, group), bounds, near_m));
}

/// Returns the pieces of a block within `near_m` of the bounds of the height band, a bit for each.
/// Each piece is decided by itself, whatever its direction: its tracking does not depend on the
/// other pieces of its block, and no piece that turns later is first found inside the body.
HWY_INLINE std::uint32_t near_pieces(const PressQuery& q, const PieceBlock& block,
                                     const PieceRows& rows, float near_m) {
  const BandBounds& bounds = q.pressed->vehicle->silhouettes.bands[q.target_band[block.band]];
  std::uint32_t which = 0;
  for (std::size_t h = 0; h < block.count; h += 8) {
    const F8 x = load(rows.x.data() + h);
    const F8 y = load(rows.y.data() + h);
    const TransformedBoxes at{all(q.to.c) * x - all(q.to.s) * y + all(q.to.x),
                              all(q.to.s) * x + all(q.to.c) * y + all(q.to.y), all(0.0F),
                              all(0.0F)};
    which |= bits(are_near(at, bounds, near_m)) << h;
  }
  return which & block.presses;
}

inline void list_block(const PressQuery& q, std::size_t i, float near_m, float allowed_m,
                       NearPieces& near) {
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  const PieceBlock& block = own.blocks[i];
  // The block was not in the previous list: the path of its pieces is not known.
  const std::uint32_t before = near.listed[i] + 1 == near.list ? near.tracked[i] : 0U;
  if (near.listed[i] <= near.first_list) {
    near.tracked[i] = 0;
    near.entered[i] = 0;
    near.slot[i] = near.pool->take();
    if (near.slot[i] == PiecePool::none) return;
    near.pool->states[near.slot[i]] = {};
  }
  PieceStates& states = near.pool->states[near.slot[i]];
  if (before == 0 && !q.pusher->response.rigid) {
    compute_block_curves(q, block, own.rows[i], near.pool->curves[near.slot[i]]);
  }
  const std::uint32_t now = near_pieces(q, block, own.rows[i], near_m);
  for (std::size_t k = 0; k < block_pieces; ++k) {
    if ((now >> k & 1U) == 0) states.s[k] = never_presses;
  }
  if ((now & ~before) != 0) {
    start_tracking(q, block, own.rows[i], allowed_m, now & ~before, states);
  }
  near.listed[i] = near.list;
  near.tracked[i] = static_cast<std::uint16_t>(now);
}

inline void list_blocks(const PressQuery& q, float near_m, NearPieces& near) {
  // A piece that lies deeper than this inside the other body at the start never presses; nor does a
  // piece that is found inside later without having been tracked on its way in.
  constexpr float inside_m = 0.05F;
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  // On a slope outlines lie as far apart as seen from above, and overlap by the slope's share of
  // the length of the bodies when they meet.
  constexpr float length_m = 10.0F;
  const auto steepness2 = [](const PlanarBody& body) {
    return static_cast<float>(body.rise_x * body.rise_x + body.rise_y * body.rise_y);
  };
  const float overlap_m =
      0.5F * length_m * std::max(steepness2(q.pusher->motion), steepness2(q.pressed->motion));
  const float allowed_m = near.is_new() ? inside_m + overlap_m : 0.0F;
  near.count = 0;
  ++near.list;
  for (std::size_t g = 0; g < own.groups.size(); ++g) {
    const BlockGroup& group = own.groups[g];
    std::uint32_t listed = 0;
    for (std::uint32_t left = near_blocks(q, group, near_m); left != 0; left &= left - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      list_block(q, group.first + lane, near_m, allowed_m, near);
      if (near.tracked[group.first + lane] != 0) listed |= 1U << lane;
    }
    if (listed == 0) continue;
    near.groups[near.count++] = {static_cast<std::uint32_t>(g), static_cast<std::uint8_t>(listed)};
  }
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
