#include "crashrank/crash/contact.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using Segment = ContactWorkspace::Segment;

Vector3d normal_of(const TriangleD& t) {
  return (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
}

/// Offers the points in which edges of `s` pass through `t`. A crossing on the rim of two triangles
/// has to be seen by one of them at least, so the rim is a little wider than it is.
template <class Offer> void pierce(const TriangleD& s, const TriangleD& t, Offer&& offer) {
  const Vector3d u = t.corner[1] - t.corner[0];
  const Vector3d v = t.corner[2] - t.corner[0];
  const Vector3d n = u.cross(v);
  const double nn = n.squaredNorm();
  if (!(nn > 0.0)) return;
  constexpr double rim = 1e-9;
  std::array<double, 3> height{};
  for (std::size_t i = 0; i < 3; ++i) height[i] = n.dot(s.corner[i] - t.corner[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!((height[i] < 0.0) != (height[j] < 0.0))) continue;
    const Vector3d x =
        s.corner[i] + (height[i] / (height[i] - height[j])) * (s.corner[j] - s.corner[i]);
    const Vector3d w = x - t.corner[0];
    const double beta = w.cross(v).dot(n) / nn;
    const double gamma = u.cross(w).dot(n) / nn;
    if (beta >= -rim && gamma >= -rim && beta + gamma <= 1.0 + rim) offer(x);
  }
}

/// Length, middle and second moments of a curve, and the area vector it encloses.
struct Curve {
  double length = 0.0;
  Vector3d middle = Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Vector3d area = Vector3d::Zero();
};

Curve measure(const std::vector<Segment>& segments) {
  Curve curve;
  for (const Segment& s : segments) {
    const double length = (s.to - s.from).norm();
    curve.length += length;
    curve.middle += 0.5 * length * (s.from + s.to);
  }
  if (!(curve.length > 0.0)) return curve;
  curve.middle /= curve.length;
  for (const Segment& s : segments) {
    const Vector3d p = s.from - curve.middle;
    const Vector3d q = s.to - curve.middle;
    const Vector3d d = q - p;
    const Vector3d m = 0.5 * (p + q);
    curve.spread += d.norm() * (m * m.transpose() + d * d.transpose() / 12.0);
    curve.area += 0.5 * p.cross(q);
  }
  return curve;
}

struct Normal {
  Vector3d direction = Vector3d::Zero();
  NormalSource source = NormalSource::motion;
};

/// Outward faces give the curve one sense, in which its area vector points from A to B; faces that
/// look both ways leave little of it, or turn it against the closing velocity.
Normal normal_from(const Curve& curve, const Vector3d& witness, const Vector3d& closing) {
  constexpr double least_area = 0.005;  // of the length squared; a circle has 0.08
  constexpr double flat = 0.1;          // of the middle moment
  const auto towards = [&](const Vector3d& n) -> Vector3d {
    return n.dot(closing) < 0.0 ? Vector3d(-n) : n;
  };
  if (curve.length > 0.0) {
    if (curve.area.norm() > least_area * curve.length * curve.length &&
        curve.area.dot(closing) >= 0.0) {
      return {curve.area.normalized(), NormalSource::region};
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(curve.spread);
    if (axes.eigenvalues()[0] < flat * axes.eigenvalues()[1]) {
      return {towards(axes.eigenvectors().col(0)), NormalSource::plane};
    }
  }
  if (witness.norm() > 0.5) return {witness, NormalSource::witness};
  if (closing.norm() > 0.0) return {closing.normalized(), NormalSource::motion};
  return {Vector3d::UnitX(), NormalSource::motion};
}

/// The bodies at one time.
struct Moment {
  Pose a;
  Pose b;
  Velocity velocity_a;
  Velocity velocity_b;

  Vector3d relative_velocity(const Vector3d& point) const {
    return velocity_of_point(velocity_a, a.translation, point) -
           velocity_of_point(velocity_b, b.translation, point);
  }
};

Moment moment_at(const Motion& motion_a, const Motion& motion_b, double t) {
  Moment m;
  motion_a.state_at(t, m.a, m.velocity_a);
  motion_b.state_at(t, m.b, m.velocity_b);
  return m;
}

Vector3d middle_of(const AabbTree& tree, const Pose& pose) {
  Vector3d center = tree.nodes[0].box.center().cast<double>();
  if (!tree.axes_are_world) center = detail::rotate(tree.axes, center);
  return detail::rotate(pose.rotation, center) + pose.translation;
}

/// Collects the curve in which the surfaces cut each other, in A's body coordinates.
void find_curve(const Model& a, const Model& b, const Pose& b_in_a, ContactWorkspace& workspace) {
  collide(a.tree, b.tree, b_in_a, workspace.pairs, workspace.collide);
  // The collider's order is the tree's; sums have to be the same for every tree.
  std::sort(workspace.pairs.begin(), workspace.pairs.end());
  workspace.curve.clear();
  for (const Pair& pair : workspace.pairs) {
    const TriangleD ta = to_double(a.mesh.triangle(static_cast<std::size_t>(pair.a)));
    const TriangleD tb = carry(b_in_a, b.mesh.triangle(static_cast<std::size_t>(pair.b)));
    std::array<Vector3d, 2> ends;
    if (!cut_of(ta, tb, ends)) continue;
    const bool along = (ends[1] - ends[0]).dot(normal_of(ta).cross(normal_of(tb))) >= 0.0;
    workspace.curve.push_back({ends[along ? 0 : 1], ends[along ? 1 : 0]});
  }
}

void fill_region(const Moment& now, ContactWorkspace& workspace, ContactFacts& facts) {
  const Pose to_b = inverse(relative(now.a, now.b));
  Vector3d across = Vector3d::UnitZ().cross(facts.normal);
  if (across.norm() < 1e-3) across = Vector3d::UnitY();
  across.normalize();
  const Vector3d up = facts.normal.cross(across);
  const double endless = std::numeric_limits<double>::infinity();
  Vector3d low = Vector3d::Constant(endless);
  Vector3d high = -low;
  for (const Segment& s : workspace.curve) {
    for (const Vector3d& in_a : {s.from, s.to}) {
      const Vector3d p = detail::rotate(now.a.rotation, in_a) + now.a.translation;
      const Vector3d seen(across.dot(p), up.dot(p), p.z());
      low = low.cwiseMin(seen);
      high = high.cwiseMax(seen);
      facts.region_a.grow(Eigen::Vector3f(in_a.cast<float>()));
      facts.region_b.grow(
          Eigen::Vector3f((detail::rotate(to_b.rotation, in_a) + to_b.translation).cast<float>()));
    }
  }
  facts.overlap_width_m = high.x() - low.x();
  facts.overlap_height_m = high.y() - low.y();
  facts.lowest_m = low.z();
  facts.highest_m = high.z();
}

}  // namespace

bool cut_of(const TriangleD& a, const TriangleD& b, std::array<Vector3d, 2>& ends) {
  int count = 0;
  double longest = 0.0;
  Vector3d first = Vector3d::Zero();
  const auto offer = [&](const Vector3d& x) {
    if (count++ == 0) {
      first = x;
    } else if ((x - first).norm() > longest) {
      longest = (x - first).norm();
      ends = {first, x};
    }
  };
  pierce(a, b, offer);
  pierce(b, a, offer);
  return longest > 0.0;
}

ContactFacts contact_facts(const Model& a, const Motion& motion_a, const Model& b,
                           const Motion& motion_b, const Impact& impact,
                           ContactWorkspace& workspace, const ContactOptions& options) {
  constexpr int most_tries = 4;
  ContactFacts facts;
  Moment now = moment_at(motion_a, motion_b, impact.time_s);
  const bool witnessed = impact.triangle_a >= 0 && impact.triangle_b >= 0;
  if (witnessed) {
    facts.point_m = 0.5 * (impact.point_a_m + impact.point_b_m);
  } else {
    const bool a_inside = half_area(a.tree.nodes[0].box) < half_area(b.tree.nodes[0].box);
    facts.point_m = a_inside ? middle_of(a.tree, now.a) : middle_of(b.tree, now.b);
  }
  const Vector3d closing = now.relative_velocity(facts.point_m);

  facts.time_s = impact.time_s;
  workspace.curve.clear();
  workspace.pairs.clear();
  if (impact.state == ImpactState::overlapping) {
    find_curve(a, b, relative(now.a, now.b), workspace);
  } else if (impact.state == ImpactState::contact && closing.norm() > 0.0) {
    double wait = options.depth_m / closing.norm();
    for (int i = 0; i < most_tries && workspace.curve.empty(); ++i) {
      facts.time_s = impact.time_s + std::min(wait, options.longest_s);
      now = moment_at(motion_a, motion_b, facts.time_s);
      find_curve(a, b, relative(now.a, now.b), workspace);
      if (wait >= options.longest_s) break;
      wait *= 2.0;
    }
    if (workspace.curve.empty()) {
      facts.time_s = impact.time_s;
      now = moment_at(motion_a, motion_b, facts.time_s);
    }
  }
  facts.pairs = workspace.pairs.size();

  Curve curve = measure(workspace.curve);
  if (curve.length > 0.0) {
    curve.area = detail::rotate(now.a.rotation, curve.area);
    curve.middle = detail::rotate(now.a.rotation, curve.middle) + now.a.translation;
    curve.spread = now.a.rotation * curve.spread * now.a.rotation.transpose();
    facts.point_m = curve.middle;
  }
  // The velocity that brought the bodies together tells front from back: at depth a turning body
  // may already be on its way out.
  const Normal normal = normal_from(curve, impact.normal, closing);
  facts.normal = normal.direction;
  facts.normal_source = normal.source;
  facts.relative_velocity_mps = now.relative_velocity(facts.point_m);
  facts.relative_speed_mps = facts.relative_velocity_mps.norm();
  facts.normal_speed_mps = facts.relative_velocity_mps.dot(facts.normal);
  if (curve.length > 0.0) {
    fill_region(now, workspace, facts);
    if (facts.normal_source == NormalSource::region) facts.overlap_area_m2 = curve.area.norm();
  }
  return facts;
}

}  // namespace crashrank
