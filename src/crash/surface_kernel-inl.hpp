// Pieces of one body that press into another, eight at a time. Included once per target. Products
// and sums are rounded one by one and sums are kept in eight lanes on every target, so that all
// vector units have the same bits.
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
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// Eight pieces in the pressed body's axes.
struct CarriedPieces {
  F8 x, y, normal_x, normal_y, advance;
};

HWY_INLINE CarriedPieces carry_pieces(const Carrier& to, F8 x, F8 y, F8 normal_x, F8 normal_y) {
  const F8 c = all(to.c);
  const F8 s = all(to.s);
  const F8 spin = all(to.spin);
  CarriedPieces at;
  at.x = c * x - s * y + all(to.x);
  at.y = s * x + c * y + all(to.y);
  at.normal_x = c * normal_x - s * normal_y;
  at.normal_y = s * normal_x + c * normal_y;
  at.advance = (all(to.vx) - spin * at.y) * at.normal_x + (all(to.vy) + spin * at.x) * at.normal_y;
  return at;
}

/// Sums of eight lanes.
struct LaneSums {
  F8 force_x = all(0.0F);
  F8 force_y = all(0.0F);
  F8 moment = all(0.0F);
  F8 point_x = all(0.0F);
  F8 point_y = all(0.0F);
  F8 weight = all(0.0F);
  F8 pressing = all(0.0F);
  F8 closing = all(0.0F);
  F8 passing = all(0.0F);
  F8 fresh = all(0.0F);
  F8 power_own = all(0.0F);
  F8 power_other = all(0.0F);
  F8 power_friction = all(0.0F);
  F8 depth_own = all(0.0F);
  F8 depth_other = all(0.0F);
  F8 intrusion_own = all(0.0F);
  F8 intrusion_other = all(0.0F);

  // Written out, because what compilers add themselves is not for the target.
  HWY_INLINE LaneSums() {}
};

/// Where pieces pressed, seen from above, by lane.
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

/// Eight pieces of one band that advance into what they have not been in.
struct PressingPieces {
  CarriedPieces at;  ///< in the pressed body's axes
  M8 where;          ///< lanes that count
  const PieceRows* rows = nullptr;
  const PieceCurves* curves = nullptr;
  float* way = nullptr;    ///< see PieceStates
  float* ahead = nullptr;  ///< see PieceStates
  std::size_t band = 0;
  std::size_t first = 0;  ///< lane of the block, 0 or 8
};

class Presser {
public:
  HWY_INLINE explicit Presser(const PressQuery& query)
      : q_(query),
        own_(query.pressed->response),
        other_(query.pusher->response),
        target_(query.pressed->vehicle->silhouettes) {}

  /// Adds the forces of those of the pieces that lie inside the pressed body.
  template <bool both_yield> HWY_INLINE void press(const PressingPieces& p);
  void store_sums(PressTotals& totals, PassSums& sums, PassRecord& record) const;

private:
  const PressQuery& q_;
  const CrushResponse& own_;
  const CrushResponse& other_;
  const Silhouettes& target_;
  LaneSums sums_;
  LaneBounds own_bounds_;
  LaneBounds other_bounds_;
  std::size_t lowest_band_ = profile_bands;
  std::size_t highest_band_ = 0;
};

template <bool both_yield> HWY_INLINE void Presser::press(const PressingPieces& p) {
  // A step inwards from the surface over which the pressure rises to the yield pressure, m: paint,
  // cladding, gaps.
  constexpr float soft_m = 0.012F;
  // Pressing and friction rise evenly up to these shares of the relative speed: material that is
  // only just closing, or only just sliding, bears part of the force.
  constexpr float closing_share = 0.1F;
  constexpr float sliding_share = 0.3F;
  constexpr float least_even_mps = 0.2F;
  // Narrow bodies engage material beside them: width per metre of depth, on each side.
  constexpr float spread = 0.35F;
  // Folds of two crushed vehicles hook into each other over the size of a rail.
  constexpr float interlock_m = 0.15F;
  // Least slant of a piece's way to the surface that its first depth reckons with, as 1/sine.
  constexpr float most_slanted = 10.0F;
  const F8 zero = all(0.0F);
  const F8 one = all(1.0F);
  const F8 flank = all(flank_share);
  const F8 x = p.at.x;
  const F8 y = p.at.y;
  Depths d = depths_at(target_, p.band, x, y);
  F8 least = d.least();
  const M8 where = both(p.where, less(zero, least));
  if (bits(where) == 0) return;
  lowest_band_ = std::min(lowest_band_, p.band);
  highest_band_ = std::max(highest_band_, p.band);
  // Lanes that do not count are given numbers that keep everything finite.
  const auto where_it_counts = [&](F8 a) { return select(where, a, all(0.01F)); };
  least = where_it_counts(least);
  d = {where_it_counts(d.front), where_it_counts(d.rear), where_it_counts(d.left),
       where_it_counts(d.right), d.known};
  const F8 advance = where_it_counts(p.at.advance);

  const F8 nx = p.at.normal_x;
  const F8 ny = p.at.normal_y;
  const F8 vx = all(q_.to.vx) - all(q_.to.spin) * y;
  const F8 vy = all(q_.to.vy) + all(q_.to.spin) * x;
  const F8 speed = square_root(vx * vx + vy * vy);
  // No depth counts that the piece has not travelled: what enters through a flank is not deep below
  // the front. The first step of a piece inside begins at the surface.
  const F8 travel = speed * all(static_cast<float>(q_.settings->since_s));
  const F8 way_before = load(p.way);
  const F8 way = select(less(zero, way_before), way_before + travel,
                        minimum(travel, least * minimum(all(most_slanted), speed / advance)));
  store(select(where, way, way_before), p.way);
  // What was travelled sideways does not count below front or rear.
  const F8 ahead_before = load(p.ahead);
  const F8 along =
      select(less(zero, way_before),
             ahead_before + vx * all(static_cast<float>(q_.settings->since_s)), way * vx / speed);
  store(select(where, along, ahead_before), p.ahead);
  const M8 rearwards = less(nx, zero);
  const F8 below = positive(select(rearwards, -along, along));
  const F8 whole_end = minimum(select(rearwards, d.front, d.rear), way);
  const F8 end = minimum(whole_end, below);
  const F8 side = select(less(ny, zero), d.left, d.right);
  const F8 ahead = nx * nx;
  const F8 across = flank * ny * ny;
  const F8 depth = ahead * end + across * minimum(side, whole_end);
  CrushCurves own = crush_curves(own_, p.band, x, y, nx, ny);
  own.shorten(ahead * (d.front + d.rear) + across * (d.left + d.right));
  F8 force;
  F8 own_depth = depth;
  F8 friction = all(q_.settings->friction);
  F8 fresh;
  const F8 own_x = load(p.rows->x.data() + p.first);
  const F8 own_y = load(p.rows->y.data() + p.first);
  const F8 own_nx = load(p.rows->normal_x.data() + p.first);
  const F8 own_ny = load(p.rows->normal_y.data() + p.first);
  if constexpr (both_yield) {
    const CrushCurves others = load_curves(*p.curves, p.first);
    const SharedCrush shared = share_crush(own, others, depth, where);
    force = shared.force;
    own_depth = shared.depth_a;
    const F8 rest = depth - own_depth;
    const F8 hooked = minimum(one, minimum(own_depth, rest) * all(1.0F / interlock_m));
    friction = friction + positive(all(q_.settings->interlocked) - friction) * hooked;
    // By the shares in which the two are crushed.
    const F8 left = own_depth * positive(one - own_depth / own.length) +
                    rest * positive(one - rest / others.length);
    fresh = select(less(zero, depth), left / depth, one);
  } else {
    force = own.force_at(depth);
    fresh = positive(one - depth / own.length);
  }
  const F8 other_depth = depth - own_depth;
  const F8 own_share =
      both_yield ? select(less(all(1e-6F), depth), own_depth / depth, all(0.5F)) : one;
  // Along no longer way than there is material ahead: a post behind a strip of sheet metal tears
  // out, it does not drag a whole corner along.
  const F8 remains = ahead * select(rearwards, d.rear, d.front) +
                     ny * ny * select(less(ny, zero), d.right, d.left);
  const F8 beside = minimum(all(2.0F * spread) * minimum(depth, remains), all(q_.wider_m));
  force = force * (one + beside * all(1.0F / q_.narrow_m));
  const auto height = static_cast<float>(profile_edges_m[p.band + 1] - profile_edges_m[p.band]);
  const F8 length = load(p.rows->length_m.data() + p.first);
  const F8 pressed = (force + all(q_.dragged_kgm3 * height) * advance * advance) *
                     minimum(one, least * all(1.0F / soft_m)) * own_share * length;
  const F8 whole = select(where, pressed, zero);
  const F8 least_even = all(least_even_mps);
  const F8 closing = minimum(one, advance / maximum(least_even, all(closing_share) * speed));
  const F8 normal = whole * closing;
  const F8 slip = vy * nx - vx * ny;
  const F8 slides = slip / maximum(least_even, all(sliding_share) * speed);
  const F8 rubbing = friction * normal * minimum(maximum(slides, -one), one);
  const F8 fx = normal * nx - rubbing * ny;
  const F8 fy = normal * ny + rubbing * nx;
  // The surfaces meet where the pusher's own crush has moved them back to, and no further than to
  // the flank of what it ploughs along.
  constexpr float least_normal = 1e-3F;
  const F8 out_x = select(rearwards, d.front, d.rear) / maximum(absolute(nx), all(least_normal));
  const F8 out_y = side / maximum(absolute(ny), all(least_normal));
  const F8 moved_back = minimum(other_depth, minimum(out_x, out_y));
  const F8 px = x - moved_back * nx;
  const F8 py = y - moved_back * ny;
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
  s.passing = s.passing + whole * speed;
  s.fresh = s.fresh + whole * fresh;
  s.power_own = s.power_own + power * own_share;
  s.power_friction = s.power_friction + rubbing * slip;
  // Along flanks less depth counts than there is. No reach counts that is not crush, and none of
  // what only slides past.
  const F8 own_crush = own_depth / (ahead + across);
  const auto intrusion = [&](F8 inside, F8 crush) {
    return select(where, closing * minimum(inside, crush), zero);
  };
  s.depth_own = maximum(s.depth_own, select(where, own_crush, zero));
  own_bounds_.grow(where, px, py);
  if (p.band >= own_.cabin_band) {
    const F8 inside = inside_compartment(own_, px, py, nx);
    s.intrusion_own = maximum(s.intrusion_own, intrusion(inside, own_crush));
  }
  if constexpr (both_yield) {
    const F8 other_crush = other_depth / (own_nx * own_nx + flank * own_ny * own_ny);
    s.power_other = s.power_other + power * (one - own_share);
    s.depth_other = maximum(s.depth_other, select(where, other_crush, zero));
    other_bounds_.grow(where, own_x, own_y);
    if (p.band >= other_.cabin_band) {
      const F8 inside = inside_compartment(other_, own_x - moved_back * own_nx,
                                           own_y - moved_back * own_ny, -own_nx);
      s.intrusion_other = maximum(s.intrusion_other, intrusion(inside, other_crush));
    }
  }
}

/// Under this force reach counts in proportion: a door has to bear 10 kN in the mean of its first
/// 0.15 m (FMVSS 214), so what scratches its skin intrudes nowhere.
inline constexpr double least_intruding_n = 10e3;

inline void Presser::store_sums(PressTotals& totals, PassSums& sums, PassRecord& record) const {
  if (lowest_band_ == profile_bands) return;
  const LaneSums& s = sums_;
  totals.force_x = sum_lanes(s.force_x);
  totals.force_y = sum_lanes(s.force_y);
  totals.moment = sum_lanes(s.moment);
  totals.point_x = sum_lanes(s.point_x);
  totals.point_y = sum_lanes(s.point_y);
  sums.weight = sum_lanes(s.weight);
  sums.pressing = sum_lanes(s.pressing);
  sums.closing = sum_lanes(s.closing);
  sums.passing = sum_lanes(s.passing);
  sums.fresh = sum_lanes(s.fresh);
  sums.power_own = sum_lanes(s.power_own);
  sums.power_other = sum_lanes(s.power_other);
  sums.power_friction = sum_lanes(s.power_friction);
  sums.depth_own = greatest_lane(s.depth_own);
  sums.depth_other = greatest_lane(s.depth_other);
  const auto counted = static_cast<float>(std::min(1.0, sums.weight / least_intruding_n));
  record.intrusion_own = std::max(record.intrusion_own, counted * greatest_lane(s.intrusion_own));
  const auto low = static_cast<float>(profile_edges_m[lowest_band_]);
  const auto high = static_cast<float>(profile_edges_m[highest_band_ + 1]);
  const auto grow = [&](const LaneBounds& lanes, Box& box) {
    box.grow(Eigen::Vector3f(-greatest_lane(-lanes.min_x), -greatest_lane(-lanes.min_y), low));
    box.grow(Eigen::Vector3f(greatest_lane(lanes.max_x), greatest_lane(lanes.max_y), high));
  };
  grow(own_bounds_, record.own);
  if (other_.rigid) return;
  record.intrusion_other =
      std::max(record.intrusion_other, counted * greatest_lane(s.intrusion_other));
  grow(other_bounds_, record.other);
}

/// Moves the pieces of a block, and presses those that advance into what they have not been in.
template <bool both_yield>
HWY_INLINE void press_block(const PressQuery& q, std::size_t block, NearPieces& near,
                            Presser& presser, PressTotals& totals) {
  constexpr float rounding_m = 1e-4F;
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  const F8 step = all(static_cast<float>(q.settings->step_s));
  const BandBounds& target = q.pressed->vehicle->silhouettes.bands[own.blocks[block].band];
  const PieceRows& rows = own.rows[block];
  PieceStates& states = near.states[block];
  near.pieces += own.blocks[block].count;
  for (std::size_t h = 0; h < own.blocks[block].count; h += 8) {
    PressingPieces p;
    p.at = carry_pieces(q.to, load(rows.x.data() + h), load(rows.y.data() + h),
                        load(rows.normal_x.data() + h), load(rows.normal_y.data() + h));
    const F8 before = load(states.s.data() + h);
    const F8 furthest = load(states.furthest.data() + h);
    const M8 in_box = both(both(less(all(target.min_x), p.at.x), less(p.at.x, all(target.max_x))),
                           both(less(all(target.min_y), p.at.y), less(p.at.y, all(target.max_y))));
    // Ways beside the other body, before the piece has been in it, count neither forth nor back.
    const M8 counts = either(in_box, less(all(0.0F), load(states.way.data() + h)));
    const F8 after = before + select(counts, p.at.advance * step, all(0.0F));
    store(after, states.s.data() + h);
    store(maximum(after, furthest), states.furthest.data() + h);
    // Positive where the piece advances and has not gone back.
    const F8 fresh = minimum(p.at.advance, before - furthest + all(rounding_m));
    p.where = both(less(all(0.0F), fresh), in_box);
    if (bits(p.where) == 0) continue;
    totals.approaching = true;
    p.rows = &rows;
    p.curves = &near.curves[block];
    p.way = states.way.data() + h;
    p.ahead = states.ahead.data() + h;
    p.band = own.blocks[block].band;
    p.first = h;
    presser.press<both_yield>(p);
  }
}

template <bool both_yield>
inline void press_all(const PressQuery& q, NearPieces& near, PressTotals& totals, PassSums& sums,
                      PassRecord& record) {
  const Silhouettes& own = q.pusher->vehicle->silhouettes;
  Presser presser(q);
  near.pieces = 0;
  for (std::size_t i = 0; i < near.count; ++i) {
    const NearGroup& entry = near.groups[i];
    const std::uint32_t first_block = own.groups[entry.group].first;
    // Those beside the other body, too: where they press once it has moved sideways, they press no
    // deeper than their neighbours have been.
    for (std::uint32_t left = entry.listed; left != 0; left &= left - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      press_block<both_yield>(q, first_block + lane, near, presser, totals);
    }
  }
  presser.store_sums(totals, sums, record);
}

inline void press_blocks(const PressQuery& q, NearPieces& near, PressTotals& totals, PassSums& sums,
                         PassRecord& record) {
  if (q.pusher->response.rigid) {
    press_all<false>(q, near, totals, sums, record);
  } else {
    press_all<true>(q, near, totals, sums, record);
  }
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
