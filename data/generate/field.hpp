#pragma once

#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace generate {

/// A solid as a function of place: negative inside, zero on its surface, about the distance in
/// metres near it (its slope must stay between 0.5 and 1.7 for the surface to be found).
using Field = std::function<double(const Vec3&)>;

/// The smaller of two, blended over a band of width `k`: joins two solids with a fillet.
inline double smooth_min(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k * 0.25;
}

/// The larger of two, blended: intersects two solids with a rounded edge.
inline double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

/// Distance to a cone with round ends: a limb from `a` (radius ra) to `b` (radius rb).
inline double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb) {
  const Vec3 along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm() - (ra + t * (rb - ra));
}

/// About the distance to an ellipsoid with half axes `r` (exact on the surface).
inline double ellipsoid(const Vec3& p, const Vec3& center, const Vec3& r) {
  const Vec3 q = p - center;
  const double k0 = q.cwiseQuotient(r).norm();
  const double k1 = q.cwiseQuotient(r.cwiseProduct(r)).norm();
  return k1 < 1e-9 ? -r.minCoeff() : k0 * (k0 - 1.0) / k1;
}

/// Distance to a box of half sizes `half` whose edges are rounded by `radius`.
inline double round_box(const Vec3& p, const Vec3& center, const Vec3& half, double radius) {
  const Vec3 q = (p - center).cwiseAbs() - half + Vec3::Constant(radius);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
}

}  // namespace generate
