// Forces of the outline pieces of one body on another, eight pieces at a time. Included once per
// vector target. Products and sums are rounded separately and summed in eight lanes on every
// target, so that all vector units give the same bits.
#if defined(CRASHRANK_SURFACE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_SURFACE_KERNEL_INL
#undef CRASHRANK_SURFACE_KERNEL_INL
#else
#define CRASHRANK_SURFACE_KERNEL_INL
#endif

#include "collide/lanes-inl.hpp"
#include "crash/crush_curves-inl.hpp"
#include "crash/piece_lists-inl.hpp"
#include "crash/silhouette_depths-inl.hpp"
#include "crash/surface_kernel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// Eight pieces in the pressed body's axes; `advance` is their speed along their normals, m/s.
struct TransformedPieces {
  F8 x, y, normal_x, normal_y, advance;
};

HWY_INLINE TransformedPieces transform_pieces(const RelativeMotion& to, F8 x, F8 y, F8 normal_x,
                                              F8 normal_y) {
  const F8 c = all(to.c);
  const F8 s = all(to.s);
  const F8 spin = all(to.spin);
  TransformedPieces at;
  at.x = c * x - s * y + all(to.x);
  at.y = s * x + c * y + all(to.y);
  at.normal_x = c * normal_x - s * normal_y;
  at.normal_y = s * normal_x + c * normal_y;
  at.advance = (all(to.vx) - spin * at.y) * at.normal_x + (all(to.vy) + spin * at.x) * at.normal_y;
  return at;
}

/// Sums by lane; see `PassSums` for the members.
struct LaneSums {
  F8 force_x = all(0.0F);
  F8 force_y = all(0.0F);
  F8 moment = all(0.0F);
  F8 point_x = all(0.0F);
  F8 point_y = all(0.0F);
  F8 weight = all(0.0F);
  F8 pressing = all(0.0F);
  F8 closing = all(0.0F);
  F8 speed = all(0.0F);
  F8 unused_crush = all(0.0F);
  F8 power_own = all(0.0F);
  F8 power_other = all(0.0F);
  F8 power_friction = all(0.0F);
  F8 depth_own = all(0.0F);
  F8 depth_other = all(0.0F);
  F8 intrusion_own = all(0.0F);
  F8 intrusion_other = all(0.0F);
  F8 intruding_own = all(0.0F);
  F8 intruding_other = all(0.0F);

  // Explicit: a generated constructor would not be compiled for the vector target.
  HWY_INLINE LaneSums() {}
};

/// Bounds of the pieces that press, seen from above, by lane.
struct LaneBounds {
  F8 min_x = all(1e9F);
  F8 min_y = all(1e9F);
  F8 max_x = all(-1e9F);
  F8 max_y = all(-1e9F);

  HWY_INLINE LaneBounds() {}
  HWY_INLINE void grow(M8 where, F8 x, F8 y) {
    min_x = minimum(min_x, select(where, x, min_x));
    min_y = minimum(min_y, select(where, y, min_y));
    max_x = maximum(max_x, select(where, x, max_x));
    max_y = maximum(max_y, select(where, y, max_y));
  }
};

HWY_INLINE double sum_lanes(F8 a) {
  alignas(32) float lane[8];
  store(a, lane);
  double sum = 0.0;
  for (const float value : lane) sum += static_cast<double>(value);
  return sum;
}
HWY_INLINE float greatest_lane(F8 a) {
  alignas(32) float lane[8];
  store(a, lane);
  return *std::max_element(lane, lane + 8);
}

/// Eight pieces of one height band that advance beyond the depth they have crushed.
struct PressingPieces {
  TransformedPieces at;  ///< in the pressed body's axes
  M8 where;              ///< lanes with a piece that may press
  const PieceRows* rows = nullptr;
  const PieceCurves* curves = nullptr;
  float* path = nullptr;    ///< see PieceStates
  float* path_x = nullptr;  ///< see PieceStates
  std::size_t band = 0;     ///< of the pieces
  std::size_t target = 0;   ///< of the pressed body at the same height
  std::size_t first = 0;    ///< first of the eight pieces within the block, 0 or 8
};

class ForceAccumulator {
public:
  HWY_INLINE explicit ForceAccumulator(const PressQuery& query)
      : q_(query),
        own_(query.pressed->response),
        other_(query.pusher->response),
        target_(query.pressed->vehicle->silhouettes) {}

  /// Adds the forces of the pieces that lie inside the pressed body.
  template <bool both_yield> HWY_INLINE void add_forces(const PressingPieces& p);
  void store_sums(PressTotals& totals, PassSums& sums, PassRecord& record) const;

private:
  const PressQuery& q_;
  const CrushResponse& own_;
  const CrushResponse& other_;
  const Silhouettes& target_;
  LaneSums sums_;
  LaneBounds own_bounds_;
  LaneBounds other_bounds_;
  /// Lowest and highest band that presses: of the pressed body and of the pusher.
  std::array<std::size_t, 2> lowest_band_{profile_bands, profile_bands};
  std::array<std::size_t, 2> highest_band_{0, 0};
};

template <bool both_yield> HWY_INLINE void ForceAccumulator::add_forces(const PressingPieces& p) {
  // Depth over which the pressure rises to the yield pressure, m: paint, cladding and gaps.
  constexpr float soft_m = 0.012F;
  // Normal force and friction rise linearly up to these shares of the relative speed (or up to
  // `least_ramp_mps`), so that both are continuous where closing or sliding begins.
  constexpr float closing_share = 0.1F;
  constexpr float sliding_share = 0.3F;
  constexpr float least_ramp_mps = 0.2F;
  // A narrow body engages material beside it: additional width per metre of depth, on each side.
  constexpr float spread = 0.35F;
  // Crush depth of both bodies from which their folds interlock completely, m: the size of a rail.
  constexpr float interlock_m = 0.15F;
  // Upper bound of 1/sine of the angle between the path of a piece and the surface, in the first
  // step inside.
  constexpr float max_inverse_sine = 10.0F;
  const F8 zero = all(0.0F);
  const F8 one = all(1.0F);
  const F8 flank = all(flank_share);
  const F8 x = p.at.x;
  const F8 y = p.at.y;
  Depths d = depths_at(target_, p.target, x, y);
  F8 least = d.least();
  M8 where = both(p.where, less(zero, least));
  if (bits(where) == 0) return;
  const F8 common = common_height(q_, *p.rows, p.first, p.target, d);
  where = both(where, less(zero, common));
  if (bits(where) == 0) return;
  lowest_band_ = {std::min(lowest_band_[0], p.target), std::min(lowest_band_[1], p.band)};
  highest_band_ = {std::max(highest_band_[0], p.target), std::max(highest_band_[1], p.band)};
  // Fill the lanes outside `where` with a number that keeps all results finite.
  const auto or_filler = [&](F8 a) { return select(where, a, all(0.01F)); };
  least = or_filler(least);
  d = {or_filler(d.front), or_filler(d.rear), or_filler(d.left), or_filler(d.right), d.known, d.row,
       d.row_share,        d.column,          d.column_share};
  const F8 advance = or_filler(p.at.advance);

  const F8 nx = p.at.normal_x;
  const F8 ny = p.at.normal_y;
  const F8 vx = all(q_.to.vx) - all(q_.to.spin) * y;
  const F8 vy = all(q_.to.vy) + all(q_.to.spin) * x;
  const F8 speed = square_root(vx * vx + vy * vy);
  // Limit the depth to the path inside the body: a piece that enters through a flank is not deep
  // below the front. In its first step a piece starts at the surface.
  const F8 travel = speed * all(static_cast<float>(q_.settings->pass_interval_s));
  const F8 path_before = load(p.path);
  const F8 path = select(less(zero, path_before), path_before + travel,
                         minimum(travel, least * minimum(all(max_inverse_sine), speed / advance)));
  store(select(where, path, path_before), p.path);
  // The sideways part of the path does not count as depth below the front or rear.
  const F8 path_x_before = load(p.path_x);
  const F8 path_x =
      select(less(zero, path_before),
             path_x_before + vx * all(static_cast<float>(q_.settings->pass_interval_s)),
             path * vx / speed);
  store(select(where, path_x, path_x_before), p.path_x);
  const M8 rearwards = less(nx, zero);
  const F8 below = positive(select(rearwards, -path_x, path_x));
  const F8 end_depth_limit = minimum(select(rearwards, d.front, d.rear), path);
  const F8 end = minimum(end_depth_limit, below);
  const F8 side = select(less(ny, zero), d.left, d.right);
  const F8 end_weight = nx * nx;
  const F8 side_weight = flank * ny * ny;
  const F8 depth = end_weight * end + side_weight * minimum(side, end_depth_limit);
  CrushCurves own = crush_curves(own_, p.target, x, y, nx, ny);
  own.shorten(end_weight * (d.front + d.rear) + side_weight * (d.left + d.right));
  F8 force;
  F8 own_depth = depth;
  F8 friction = all(q_.settings->friction);
  F8 unused_crush;
  const F8 own_x = load(p.rows->x.data() + p.first);
  const F8 own_y = load(p.rows->y.data() + p.first);
  const F8 own_nx = load(p.rows->normal_x.data() + p.first);
  const F8 own_ny = load(p.rows->normal_y.data() + p.first);
  if constexpr (both_yield) {
    const CrushCurves others = load_curves(*p.curves, p.first);
    const SharedCrush shared = share_crush(own, others, depth, where);
    force = shared.force;
    own_depth = shared.depth_a;
    const F8 other_part = depth - own_depth;
    const F8 interlocked_share =
        minimum(one, minimum(own_depth, other_part) * all(1.0F / interlock_m));
    friction = friction + positive(all(q_.settings->interlocked) - friction) * interlocked_share;
    // Mean of the unused shares of both crush lengths, weighted with the crush depths.
    const F8 unused = own_depth * positive(one - own_depth / own.length) +
                      other_part * positive(one - other_part / others.length);
    unused_crush = select(less(zero, depth), unused / depth, one);
  } else {
    force = own.force_at(depth);
    unused_crush = positive(one - depth / own.length);
  }
  const F8 other_depth = depth - own_depth;
  const F8 own_share =
      both_yield ? select(less(all(1e-6F), depth), own_depth / depth, all(0.5F)) : one;
  // Limit the additional width by the material ahead of the piece: a post behind a strip of sheet
  // metal tears through it and does not drag the whole corner along.
  const F8 depth_ahead = end_weight * select(rearwards, d.rear, d.front) +
                         ny * ny * select(less(ny, zero), d.right, d.left);
  const F8 extra_width =
      minimum(all(2.0F * spread) * minimum(depth, depth_ahead), all(q_.excess_width_m));
  force = force * (one + extra_width * all(1.0F / q_.narrower_width_m));
  const auto height = static_cast<float>(band_height_m(p.target));
  // The lowest band drags along what is below it, too.
  const auto dragged_m = static_cast<float>(p.target == lowest_pressing_band
                                                ? profile_edges_m[lowest_pressing_band + 1]
                                                : band_height_m(p.target));
  const F8 length = load(p.rows->length_m.data() + p.first);
  const F8 pressed = (force + all(q_.dragged_density_kgm3 * dragged_m) * advance * advance) *
                     minimum(one, least * all(1.0F / soft_m)) * own_share *
                     (length * (common * all(1.0F / height)));
  const F8 whole = select(where, pressed, zero);
  const F8 least_ramp = all(least_ramp_mps);
  const F8 closing = minimum(one, advance / maximum(least_ramp, all(closing_share) * speed));
  const F8 normal = whole * closing;
  const F8 slip = vy * nx - vx * ny;
  const F8 slip_ratio = slip / maximum(least_ramp, all(sliding_share) * speed);
  const F8 friction_force = friction * normal * minimum(maximum(slip_ratio, -one), one);
  const F8 fx = normal * nx - friction_force * ny;
  const F8 fy = normal * ny + friction_force * nx;
  // Move the point of contact back by the pusher's own crush, but not beyond the surface of the
  // pressed body.
  constexpr float least_normal = 1e-3F;
  const F8 out_x = select(rearwards, d.front, d.rear) / maximum(absolute(nx), all(least_normal));
  const F8 out_y = side / maximum(absolute(ny), all(least_normal));
  const F8 pusher_shift = minimum(other_depth, minimum(out_x, out_y));
  const F8 px = x - pusher_shift * nx;
  const F8 py = y - pusher_shift * ny;
  const F8 power = normal * advance;
  LaneSums& s = sums_;
  s.force_x = s.force_x + fx;
  s.force_y = s.force_y + fy;
  s.moment = s.moment + (px * fy - py * fx);
  s.weight = s.weight + normal;
  s.point_x = s.point_x + normal * px;
  s.point_y = s.point_y + normal * py;
  s.pressing = s.pressing + whole;
  s.closing = s.closing + whole * advance;
  s.speed = s.speed + whole * speed;
  s.unused_crush = s.unused_crush + whole * unused_crush;
  s.power_own = s.power_own + power * own_share;
  s.power_friction = s.power_friction + friction_force * slip;
  // Flank depths were weighted with `flank_share`; restore the geometric crush depth. Intrusion is
  // at most the crush depth, and reduced at low closing speed, so that sliding contact does not
  // intrude.
  const F8 own_crush = own_depth / (end_weight + side_weight);
  const auto intrusion = [&](F8 inside, F8 crush) {
    return select(where, closing * minimum(inside, crush), zero);
  };
  // Volume per time that a piece sweeps with its share of the advance, where it is inside.
  const F8 swept = closing * advance * length * common;
  const auto intruding = [&](F8 depth_inside, F8 share) {
    return select(less(zero, depth_inside), swept * share, zero);
  };
  s.depth_own = maximum(s.depth_own, select(where, own_crush, zero));
  own_bounds_.grow(where, px, py);
  if (p.target >= own_.cabin_band) {
    const F8 inside = inside_compartment(own_, px, py, nx);
    const F8 depth_inside = intrusion(inside, own_crush);
    s.intrusion_own = maximum(s.intrusion_own, depth_inside);
    s.intruding_own = s.intruding_own + intruding(depth_inside, own_share);
  }
  if constexpr (both_yield) {
    const F8 other_crush = other_depth / (own_nx * own_nx + flank * own_ny * own_ny);
    s.power_other = s.power_other + power * (one - own_share);
    s.depth_other = maximum(s.depth_other, select(where, other_crush, zero));
    other_bounds_.grow(where, own_x, own_y);
    if (p.band >= other_.cabin_band) {
      const F8 inside = inside_compartment(other_, own_x - pusher_shift * own_nx,
                                           own_y - pusher_shift * own_ny, -own_nx);
      const F8 depth_inside = intrusion(inside, other_crush);
      s.intrusion_other = maximum(s.intrusion_other, depth_inside);
      s.intruding_other = s.intruding_other + intruding(depth_inside, one - own_share);
    }
  }
}

/// Below this force intrusion is reduced in proportion: a door has to resist a mean force of 10 kN
/// over its first 0.15 m (FMVSS 214), so a scratch on its skin does not intrude.
inline constexpr double least_intruding_n = 10e3;

inline void ForceAccumulator::store_sums(PressTotals& totals, PassSums& sums,
                                         PassRecord& record) const {
  if (lowest_band_[0] == profile_bands) return;
  const LaneSums& s = sums_;
  totals.force_x = sum_lanes(s.force_x);
  totals.force_y = sum_lanes(s.force_y);
  totals.moment = sum_lanes(s.moment);
  totals.point_x = sum_lanes(s.point_x);
  totals.point_y = sum_lanes(s.point_y);
  sums.weight = sum_lanes(s.weight);
  sums.pressing = sum_lanes(s.pressing);
  sums.closing = sum_lanes(s.closing);
  sums.speed = sum_lanes(s.speed);
  sums.unused_crush = sum_lanes(s.unused_crush);
  sums.power_own = sum_lanes(s.power_own);
  sums.power_other = sum_lanes(s.power_other);
  sums.power_friction = sum_lanes(s.power_friction);
  sums.depth_own = greatest_lane(s.depth_own);
  sums.depth_other = greatest_lane(s.depth_other);
  const auto counted = static_cast<float>(std::min(1.0, sums.weight / least_intruding_n));
  record.intrusion_own = std::max(record.intrusion_own, counted * greatest_lane(s.intrusion_own));
  sums.intruding_own_m3ps = static_cast<double>(counted) * sum_lanes(s.intruding_own);
  const auto grow = [&](const LaneBounds& lanes, std::size_t body, Box& box) {
    const auto low = static_cast<float>(profile_edges_m[lowest_band_[body]]);
    const auto high = static_cast<float>(profile_edges_m[highest_band_[body] + 1]);
    box.grow(Eigen::Vector3f(-greatest_lane(-lanes.min_x), -greatest_lane(-lanes.min_y), low));
    box.grow(Eigen::Vector3f(greatest_lane(lanes.max_x), greatest_lane(lanes.max_y), high));
  };
  grow(own_bounds_, 0, record.own);
  if (other_.rigid) return;
  record.intrusion_other =
      std::max(record.intrusion_other, counted * greatest_lane(s.intrusion_other));
  sums.intruding_other_m3ps = static_cast<double>(counted) * sum_lanes(s.intruding_other);
  grow(other_bounds_, 1, record.other);
}

/// Advances the pieces of a block by a step and adds the forces of those that go beyond the depth
/// they have crushed.
template <bool both_yield>
HWY_INLINE void advance_block(const PressQuery& q, std::size_t block, NearPieces& near,
                              ForceAccumulator& accumulator, PressTotals& totals) {
  constexpr float rounding_m = 1e-4F;
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  const F8 step = all(static_cast<float>(q.settings->step_s));
  const std::uint8_t target_band = q.target_band[own.blocks[block].band];
  const BandBounds& target = q.pressed->vehicle->silhouettes.bands[target_band];
  const PieceRows& rows = own.rows[block];
  PieceStates& states = near.pool->states[near.slot[block]];
  for (std::size_t h = 0; h < own.blocks[block].count; h += 8) {
    PressingPieces p;
    p.at = transform_pieces(q.to, load(rows.x.data() + h), load(rows.y.data() + h),
                            load(rows.normal_x.data() + h), load(rows.normal_y.data() + h));
    const F8 before = load(states.s.data() + h);
    const F8 furthest = load(states.furthest.data() + h);
    const M8 in_box = both(both(less(all(target.min_x), p.at.x), less(p.at.x, all(target.max_x))),
                           both(less(all(target.min_y), p.at.y), less(p.at.y, all(target.max_y))));
    // Advance counts only inside the bounds of the other body, or once the piece has been inside
    // it.
    const M8 counts = either(in_box, less(all(0.0F), load(states.path.data() + h)));
    const F8 after = before + select(counts, p.at.advance * step, all(0.0F));
    store(after, states.s.data() + h);
    store(maximum(after, furthest), states.furthest.data() + h);
    // Positive where the piece advances and is at its greatest advance so far.
    const F8 unused_crush = minimum(p.at.advance, before - furthest + all(rounding_m));
    p.where = both(less(all(0.0F), unused_crush), in_box);
    if (bits(p.where) == 0) continue;
    totals.approaching = true;
    near.entered[block] = 1;
    p.rows = &rows;
    p.curves = &near.pool->curves[near.slot[block]];
    p.path = states.path.data() + h;
    p.path_x = states.path_x.data() + h;
    p.band = own.blocks[block].band;
    p.target = target_band;
    p.first = h;
    accumulator.add_forces<both_yield>(p);
  }
}

template <bool both_yield>
inline void advance_listed_blocks(const PressQuery& q, NearPieces& near, PressTotals& totals,
                                  PassSums& sums, PassRecord& record) {
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  constexpr float rounding_m = 0.01F;
  ForceAccumulator accumulator(q);
  near.pieces = 0;
  for (std::size_t i = 0; i < near.count; ++i) {
    const NearGroup& entry = near.groups[i];
    const BlockGroup& group = own.groups[entry.group];
    const std::uint32_t first_block = group.first;
    // Blocks outside the bounds of the other body stay as they are until a piece was inside it.
    const std::uint32_t inside = near_blocks(q, group, rounding_m);
    // Pieces beside the other body are advanced as well: if the body later moves sideways over
    // them, they press no deeper than their neighbours.
    for (std::uint32_t left = entry.listed; left != 0; left &= left - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t block = first_block + lane;
      near.pieces += own.blocks[block].count;
      if ((inside >> lane & 1U) == 0 && near.entered[block] == 0) continue;
      advance_block<both_yield>(q, block, near, accumulator, totals);
    }
  }
  accumulator.store_sums(totals, sums, record);
}

inline void accumulate_forces(const PressQuery& q, NearPieces& near, PressTotals& totals,
                              PassSums& sums, PassRecord& record) {
  if (q.pusher->response.rigid) {
    advance_listed_blocks<false>(q, near, totals, sums, record);
  } else {
    advance_listed_blocks<true>(q, near, totals, sums, record);
  }
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
