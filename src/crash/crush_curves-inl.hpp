// Force-deflection curves at eight places of a body. Included once per vector target. Products and
// sums are rounded separately, so that every vector unit gives the same bits.
#if defined(CRASHRANK_CRUSH_CURVES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_CRUSH_CURVES_INL
#undef CRASHRANK_CRUSH_CURVES_INL
#else
#define CRASHRANK_CRUSH_CURVES_INL
#endif

#include "collide/lanes-inl.hpp"
#include "crash/crush_response.hpp"

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

HWY_INLINE F8 positive(F8 a) { return maximum(a, all(0.0F)); }

/// Force-deflection curve at a place of a body, per metre of outline in one height band: yield +
/// slope·c, steeper by `hardening` from depth `length` on and by `rigid` from `hardening_length`
/// further on. Strictly increasing.
struct CrushCurves {
  F8 yield;             ///< N/m
  F8 slope;             ///< N/m², > 0
  F8 length;            ///< m
  F8 hardening;         ///< N/m²
  F8 hardening_length;  ///< m
  F8 rigid;             ///< N/m²

  /// Limits the curve to the material present: once the crush length of a thin part is used up, the
  /// part is rigid, so that nothing passes through the body. `thickness`: chord through the body,
  /// weighted as depths are.
  HWY_INLINE void shorten(F8 thickness) {
    constexpr float crush_share = 0.35F;
    constexpr float hardens = 0.2F;
    length = minimum(length, all(crush_share) * thickness);
    hardening_length = minimum(hardening_length, all(hardens) * thickness);
  }
  HWY_INLINE void scale(F8 factor) {
    yield = yield * factor;
    slope = slope * factor;
    hardening = hardening * factor;
    rigid = rigid * factor;
  }
  HWY_INLINE F8 force_at(F8 depth) const {
    return yield + slope * depth + hardening * positive(depth - length) +
           rigid * positive(depth - length - hardening_length);
  }
};

/// Inverse of the curves: force and depth at the corners, and the compliance from each corner to
/// the next.
struct CrushCorners {
  F8 force[3];       ///< N/m
  F8 depth[3];       ///< m
  F8 compliance[3];  ///< m²/N

  HWY_INLINE explicit CrushCorners(const CrushCurves& c) {
    const F8 one = all(1.0F);
    const F8 hardened = c.slope + c.hardening;
    compliance[0] = one / c.slope;
    compliance[1] = one / hardened;
    compliance[2] = one / (hardened + c.rigid);
    depth[0] = all(0.0F);
    depth[1] = c.length;
    depth[2] = c.length + c.hardening_length;
    force[0] = c.yield;
    force[1] = c.yield + c.slope * c.length;
    force[2] = force[1] + hardened * c.hardening_length;
  }
  HWY_INLINE F8 depth_at(F8 at) const {
    return minimum(positive(at - force[0]), force[1] - force[0]) * compliance[0] +
           minimum(positive(at - force[1]), force[2] - force[1]) * compliance[1] +
           positive(at - force[2]) * compliance[2];
  }
};

/// Division of a total depth between two bodies pressed together.
struct SharedCrush {
  F8 force;    ///< N/m, equal on both
  F8 depth_a;  ///< depth of A, m
};

/// Divides a depth between two curves at equal force, for any shape of the curves. The sum of both
/// depths is piecewise linear and non-decreasing in the force, with six corners. Find the corner
/// with the greatest force whose depth sum is below the given depth; from there the relation is
/// linear.
HWY_INLINE SharedCrush share_hardened(const CrushCurves& curve_a, const CrushCurves& curve_b,
                                      F8 depth) {
  const CrushCorners a(curve_a);
  const CrushCorners b(curve_b);
  const F8 zero = all(0.0F);
  F8 force = zero;
  F8 depth_a = zero;
  F8 sum = zero;
  F8 compliance_a = zero;
  F8 compliance_b = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const F8 in_b = b.depth_at(a.force[k]);
    const F8 both_at_a = a.depth[k] + in_b;
    const M8 below_a = less(both_at_a, depth);
    const F8 in_a = a.depth_at(b.force[k]);
    const F8 both_at_b = in_a + b.depth[k];
    const M8 below_b = less(both_at_b, depth);
    force = maximum(force,
                    maximum(select(below_a, a.force[k], zero), select(below_b, b.force[k], zero)));
    sum = maximum(sum, maximum(select(below_a, both_at_a, zero), select(below_b, both_at_b, zero)));
    depth_a =
        maximum(depth_a, maximum(select(below_a, a.depth[k], zero), select(below_b, in_a, zero)));
    compliance_a = select(below_a, a.compliance[k], compliance_a);
    compliance_b = select(below_b, b.compliance[k], compliance_b);
  }
  const F8 compliance = compliance_a + compliance_b;
  const F8 rise = select(less(zero, compliance), (depth - sum) / compliance, zero);
  return {force + rise, minimum(depth_a + rise * compliance_a, depth)};
}

/// Divides a depth between two curves at equal force; results are valid in the lanes `where`.
HWY_INLINE SharedCrush share_crush(const CrushCurves& a, const CrushCurves& b, F8 depth, M8 where) {
  // Where neither curve hardens yet: yield_a + slope_a·a = yield_b + slope_b·(depth - a). A body
  // below its yield force leaves the whole depth to the other.
  const F8 even = (b.slope * depth + (b.yield - a.yield)) / (a.slope + b.slope);
  const F8 in_a = minimum(positive(even), depth);
  const M8 hardens = either(less(a.length, in_a), less(b.length, depth - in_a));
  if (bits(both(where, hardens)) != 0) return share_hardened(a, b, depth);
  return {select(less(all(0.0F), even), a.yield + a.slope * in_a, b.yield + b.slope * depth), in_a};
}

/// Rises from 0 to 1 over the width of a rail, 1/2 at 0: the force stays continuous where a body
/// slides across the edge of the core.
HWY_INLINE F8 core_ramp(F8 inward_m) {
  constexpr float per_ramp = 1.0F / 0.1F;
  return minimum(positive(inward_m * all(per_ramp) + all(0.5F)), all(1.0F));
}

/// Force-deflection curves for a force along the unit vector (nx, ny), body axes, at (x, y). The
/// laws of front or rear and of the flank are blended with the squares of the components.
HWY_INLINE CrushCurves crush_curves(const CrushResponse& body, std::size_t band, F8 x, F8 y, F8 nx,
                                    F8 ny) {
  // Degree to which a place is in the core: 1 inside, 0 outside.
  const F8 lateral = absolute(y);
  const F8 in_rails = core_ramp(all(body.rails) - lateral);
  const F8 in_cage = maximum(core_ramp(all(body.cage) - lateral), in_rails);
  const F8 along_cage =
      minimum(core_ramp(all(body.cage_front) - x), core_ramp(x - all(body.cage_rear)));
  const F8 in_core = in_rails + (in_cage - in_rails) * along_cage;
  const F8 band_share = all(body.share[band]);
  const F8 of_mean = all(body.outside) + all(body.inside - body.outside) * in_core;
  const F8 share = band_share * of_mean;
  // Doors have half of the mean strength from the skin on. A car of 1.7 t then resists a cylinder
  // of 0.3 m with the mean force of 10 kN over the first 0.15 m that FMVSS 214 requires.
  constexpr float door = 0.5F;
  const F8 side_share = band_share * maximum(of_mean, all(door) * along_cage);
  const F8 end_weight = nx * nx;
  const F8 side_weight = ny * ny;
  const M8 from_front = less(nx, all(0.0F));
  const auto end = [&](float front, float rear) {
    return end_weight * select(from_front, all(front), all(rear));
  };
  CrushCurves curve;
  curve.yield = share * end(body.front.yield, body.rear.yield) +
                side_share * side_weight * all(body.flank.yield);
  curve.slope = share * end(body.front.slope, body.rear.slope) +
                side_share * side_weight * all(body.flank.slope);
  const F8 engine = select(from_front, all(body.engine) * in_rails, all(0.0F));
  curve.length =
      end_weight * (select(from_front, all(body.front.length), all(body.rear.length)) - engine) +
      side_weight * all(body.flank.length);
  curve.hardening = band_share * in_core * all(body.hardening);
  curve.hardening_length = all(body.hardening_length);
  curve.rigid = band_share * in_core * all(body.rigid_slope);
  return curve;
}

/// Depth inside the passenger compartment, m, of places pressed along nx (body axes); 0 or less
/// outside it and for bodies without one. In the front the engine reaches the compartment before
/// the surface does.
HWY_INLINE F8 inside_compartment(const CrushResponse& body, F8 x, F8 y, F8 nx) {
  const F8 lateral = absolute(y);
  const M8 by_engine = both(less(nx, all(0.0F)), less(lateral, all(body.rails)));
  const F8 engine = select(by_engine, nx * nx * all(body.engine), all(0.0F));
  return minimum(minimum(all(body.cage_front) + engine - x, x - all(body.cage_rear)),
                 all(body.cage) - lateral);
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
