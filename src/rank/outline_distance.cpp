#include "rank/outline_distance.hpp"

#include "base/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

/// Number of segments in a chain.
constexpr std::uint32_t chain_segments = 4;

/// Pieces are merged into one segment if they deviate from it by at most this, m. Faces of vehicles
/// have hundreds of pieces but few corners, so distances are computed several times faster.
constexpr double straight_m = 0.002;

constexpr double infinity_m = std::numeric_limits<double>::infinity();

/// Squared distance from a point to a piece, both relative to the begin of the piece.
double distance2(double x, double y, double along_x, double along_y, double per_length2) {
  const double share = std::clamp((x * along_x + y * along_y) * per_length2, 0.0, 1.0);
  const double dx = x - share * along_x;
  const double dy = y - share * along_y;
  return dx * dx + dy * dy;
}

/// Smallest squared distance of the corners of a rectangle to another rectangle. The first is given
/// relative to the centre of the other, in its axes.
double corners_distance2(double x, double y, double cosine, double sine, double half_x,
                         double half_y, double other_half_x, double other_half_y) {
  double least = infinity_m;
  for (const double side_x : {-1.0, 1.0}) {
    for (const double side_y : {-1.0, 1.0}) {
      const double corner_x = x + side_x * half_x * cosine - side_y * half_y * sine;
      const double corner_y = y + side_x * half_x * sine + side_y * half_y * cosine;
      const double dx = std::max(std::abs(corner_x) - other_half_x, 0.0);
      const double dy = std::max(std::abs(corner_y) - other_half_y, 0.0);
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return least;
}

}  // namespace

PlanarPose planar_pose(const Pose& pose) noexcept {
  PlanarPose planar;
  planar.x = pose.translation.x();
  planar.y = pose.translation.y();
  const double length = std::hypot(pose.rotation(0, 0), pose.rotation(1, 0));
  if (length > 0.0) {
    planar.cosine = pose.rotation(0, 0) / length;
    planar.sine = pose.rotation(1, 0) / length;
  }
  return planar;
}

namespace {

struct OutlineSegment {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

OutlineSegment segment_of(const OutlinePiece& piece) {
  const Eigen::Vector2d middle(static_cast<double>(piece.x), static_cast<double>(piece.y));
  const Eigen::Vector2d half =
      0.5 * static_cast<double>(piece.length_m) *
      Eigen::Vector2d(-static_cast<double>(piece.normal_y), static_cast<double>(piece.normal_x));
  return {middle - half, middle + half};
}

/// Returns true if the ends of all pieces but the last are within `straight_m` of the line from the
/// begin of the first to the end of the last.
bool is_straight(const std::vector<OutlineSegment>& pieces, std::size_t first, std::size_t last) {
  const Eigen::Vector2d along = (pieces[last].to - pieces[first].from).normalized();
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d out = pieces[i].to - pieces[first].from;
    const double ahead = out.dot(along);
    if ((out - ahead * along).norm() > straight_m || ahead < 0.0) return false;
  }
  return true;
}

/// Merges the pieces of a band into as few segments as the tolerance allows.
std::vector<OutlineSegment> merge_straight_pieces(const std::vector<OutlineSegment>& pieces) {
  // of a segment; the cost of checking grows with its square
  constexpr std::size_t most_pieces = 512;
  std::vector<OutlineSegment> segments;
  for (std::size_t first = 0, last = 0; first < pieces.size(); first = last + 1) {
    last = first;
    while (last + 1 < pieces.size() && last + 1 < first + most_pieces &&
           (pieces[last + 1].from - pieces[last].to).norm() <= straight_m &&
           is_straight(pieces, first, last + 1)) {
      ++last;
    }
    segments.push_back({pieces[first].from, pieces[last].to});
  }
  return segments;
}

std::vector<OutlineSegment> profile_segments(const Profile& profile, std::size_t band) {
  std::vector<OutlineSegment> segments;
  for (std::size_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    segments.push_back(segment_of(profile.pieces[i]));
  }
  return segments;
}

using Ring = std::vector<Eigen::Vector2d>;

/// Points of a mesh by height band, including the intersections of edges with the limits of the
/// bands.
std::array<Ring, profile_bands> points_by_band(const TriangleMesh& mesh, double ground_m) {
  std::array<Ring, profile_bands> points;
  const auto height = [ground_m](const Eigen::Vector3f& vertex) {
    return static_cast<double>(vertex.z()) - ground_m;
  };
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    for (std::size_t band = 0; band < profile_bands; ++band) {
      const double z = height(vertex);
      if (z < profile_edges_m[band] || z > profile_edges_m[band + 1]) continue;
      points[band].emplace_back(vertex.head<2>().cast<double>());
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& a = mesh.vertices[triangle[k]];
      const Eigen::Vector3f& b = mesh.vertices[triangle[(k + 1) % 3]];
      for (std::size_t edge = 0; edge < profile_edges_m.size(); ++edge) {
        const double from = height(a) - profile_edges_m[edge];
        const double to = height(b) - profile_edges_m[edge];
        if (!(from * to < 0.0)) continue;
        const Eigen::Vector3d at = a.cast<double>() + from / (from - to) * (b - a).cast<double>();
        if (edge > 0) points[edge - 1].emplace_back(at.head<2>());
        if (edge < profile_bands) points[edge].emplace_back(at.head<2>());
      }
    }
  }
  return points;
}

/// Convex hull of a band as segments.
std::vector<OutlineSegment> hull_of(Ring points) {
  std::vector<OutlineSegment> segments;
  const Ring hull = convex_hull(std::move(points));
  for (std::size_t i = 0; i < hull.size(); ++i) {
    segments.push_back({hull[i], hull[(i + 1) % hull.size()]});
  }
  return segments;
}

}  // namespace

BodyOutline::BodyOutline(const Profile& profile, const TriangleMesh* convex_mesh) {
  double low_x = infinity_m;
  double low_y = infinity_m;
  double high_x = -infinity_m;
  double high_y = -infinity_m;
  const auto grow_bounds = [&](double x, double y) {
    low_x = std::min(low_x, x);
    low_y = std::min(low_y, y);
    high_x = std::max(high_x, x);
    high_y = std::max(high_y, y);
    radius_m_ = std::max(radius_m_, std::hypot(x, y));
  };
  std::array<Ring, profile_bands> points;
  if (convex_mesh != nullptr) points = points_by_band(*convex_mesh, profile.ground_m);
  for (std::size_t band = 0; band < profile_bands; ++band) {
    first_chain_[band] = static_cast<std::uint32_t>(chains_.size());
    const auto first_of_band = static_cast<std::uint32_t>(pieces_.size());
    for (const OutlineSegment& segment :
         merge_straight_pieces(convex_mesh != nullptr ? hull_of(std::move(points[band]))
                                                      : profile_segments(profile, band))) {
      const Eigen::Vector2d along = segment.to - segment.from;
      const double length2 = along.squaredNorm();
      if (!(length2 > 0.0)) continue;
      pieces_.push_back({segment.from.x(), segment.from.y(), along.x(), along.y(),
                         std::sqrt(length2), 1.0 / length2});
      grow_bounds(segment.from.x(), segment.from.y());
      grow_bounds(segment.to.x(), segment.to.y());
    }
    const auto end_of_band = static_cast<std::uint32_t>(pieces_.size());
    for (std::uint32_t first = first_of_band; first < end_of_band; first += chain_segments) {
      add_chain(first, std::min(first + chain_segments, end_of_band));
    }
  }
  first_chain_[profile_bands] = static_cast<std::uint32_t>(chains_.size());
  middle_x_ = 0.5 * (low_x + high_x);
  middle_y_ = 0.5 * (low_y + high_y);
  // The merged outlines can be inside the exact ones by the tolerance.
  half_x_ = 0.5 * (high_x - low_x) + straight_m;
  half_y_ = 0.5 * (high_y - low_y) + straight_m;
  radius_m_ += straight_m;
}

void BodyOutline::add_chain(std::uint32_t first, std::uint32_t end) {
  Chain chain;
  chain.first = first;
  chain.end = end;
  const Piece& begin = pieces_[first];
  const Piece& last = pieces_[end - 1];
  chain.x = 0.5 * (begin.x + last.x + last.along_x);
  chain.y = 0.5 * (begin.y + last.y + last.along_y);
  for (std::uint32_t i = first; i < end; ++i) {
    const Piece& p = pieces_[i];
    chain.radius = std::max({chain.radius, std::hypot(p.x - chain.x, p.y - chain.y),
                             std::hypot(p.x + p.along_x - chain.x, p.y + p.along_y - chain.y)});
  }
  chains_.push_back(chain);
}

double outline_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                          const PlanarPose& pose_b, double cutoff_m, NearestChains& nearest) {
  // Pose of b in the frame of a.
  const double cosine = pose_a.cosine * pose_b.cosine + pose_a.sine * pose_b.sine;
  const double sine = pose_a.cosine * pose_b.sine - pose_a.sine * pose_b.cosine;
  const double dx = pose_b.x - pose_a.x;
  const double dy = pose_b.y - pose_a.y;
  const double x = pose_a.cosine * dx + pose_a.sine * dy;
  const double y = pose_a.cosine * dy - pose_a.sine * dx;
  double least = cutoff_m;
  const auto near_pieces = [&](std::uint32_t chain_a, std::uint32_t chain_b) {
    const BodyOutline::Chain& p = a.chains_[chain_a];
    const BodyOutline::Chain& q = b.chains_[chain_b];
    const double before = least;
    double least2 = before * before;
    for (std::uint32_t k = q.first; k < q.end; ++k) {
      const BodyOutline::Piece& of_b = b.pieces_[k];
      const double bx = x + cosine * of_b.x - sine * of_b.y;
      const double by = y + sine * of_b.x + cosine * of_b.y;
      const double along_x = cosine * of_b.along_x - sine * of_b.along_y;
      const double along_y = sine * of_b.along_x + cosine * of_b.along_y;
      for (std::uint32_t i = p.first; i < p.end; ++i) {
        const BodyOutline::Piece& of_a = a.pieces_[i];
        const double apart_x = bx - of_a.x;
        const double apart_y = by - of_a.y;
        // A piece extends from its begin by at most its length.
        const double reach = before + of_a.length_m + of_b.length_m;
        if (apart_x * apart_x + apart_y * apart_y >= reach * reach) continue;
        const double per_a2 = of_a.per_length2;
        const double per_b2 = of_b.per_length2;
        least2 = std::min(
            {least2, distance2(apart_x, apart_y, of_a.along_x, of_a.along_y, per_a2),
             distance2(-apart_x, -apart_y, along_x, along_y, per_b2),
             distance2(apart_x + along_x, apart_y + along_y, of_a.along_x, of_a.along_y, per_a2),
             distance2(of_a.along_x - apart_x, of_a.along_y - apart_y, along_x, along_y, per_b2)});
      }
    }
    if (!(least2 < before * before)) return;
    least = std::sqrt(least2);
    nearest = {chain_a, chain_b, true};
  };
  if (nearest.known) near_pieces(nearest.a, nearest.b);
  bool common = false;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    const std::uint32_t end_a = a.first_chain_[band + 1];
    const std::uint32_t end_b = b.first_chain_[band + 1];
    common = common || (a.first_chain_[band] < end_a && b.first_chain_[band] < end_b);
    for (std::uint32_t k = b.first_chain_[band]; k < end_b; ++k) {
      const BodyOutline::Chain& q = b.chains_[k];
      const double qx = x + cosine * q.x - sine * q.y;
      const double qy = y + sine * q.x + cosine * q.y;
      // Skip chains that are farther from the bounding rectangle of a than the best distance.
      const double out_x = std::abs(qx - a.middle_x_) - a.half_x_ - q.radius;
      const double out_y = std::abs(qy - a.middle_y_) - a.half_y_ - q.radius;
      if (std::max(out_x, out_y) >= least) continue;
      for (std::uint32_t i = a.first_chain_[band]; i < end_a; ++i) {
        const BodyOutline::Chain& p = a.chains_[i];
        const double reach = least + p.radius + q.radius;
        const double apart_x = qx - p.x;
        const double apart_y = qy - p.y;
        if (apart_x * apart_x + apart_y * apart_y < reach * reach) near_pieces(i, k);
      }
    }
  }
  if (!common) return infinity_m;
  return least;
}

double rectangle_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                            const PlanarPose& pose_b) noexcept {
  const double cosine = pose_a.cosine * pose_b.cosine + pose_a.sine * pose_b.sine;
  const double sine = pose_a.cosine * pose_b.sine - pose_a.sine * pose_b.cosine;
  // Vector between the centres of the rectangles, world.
  const double dx = pose_b.x + pose_b.cosine * b.middle_x() - pose_b.sine * b.middle_y() -
                    (pose_a.x + pose_a.cosine * a.middle_x() - pose_a.sine * a.middle_y());
  const double dy = pose_b.y + pose_b.sine * b.middle_x() + pose_b.cosine * b.middle_y() -
                    (pose_a.y + pose_a.sine * a.middle_x() + pose_a.cosine * a.middle_y());
  const double in_a_x = pose_a.cosine * dx + pose_a.sine * dy;
  const double in_a_y = pose_a.cosine * dy - pose_a.sine * dx;
  const double in_b_x = -(pose_b.cosine * dx + pose_b.sine * dy);
  const double in_b_y = -(pose_b.cosine * dy - pose_b.sine * dx);
  // Separating-axis test on the sides of both rectangles.
  const double c = std::abs(cosine);
  const double s = std::abs(sine);
  const bool apart = std::abs(in_a_x) > a.half_x() + c * b.half_x() + s * b.half_y() ||
                     std::abs(in_a_y) > a.half_y() + s * b.half_x() + c * b.half_y() ||
                     std::abs(in_b_x) > b.half_x() + c * a.half_x() + s * a.half_y() ||
                     std::abs(in_b_y) > b.half_y() + s * a.half_x() + c * a.half_y();
  if (!apart) return 0.0;
  return std::sqrt(std::min(corners_distance2(in_a_x, in_a_y, cosine, sine, b.half_x(), b.half_y(),
                                              a.half_x(), a.half_y()),
                            corners_distance2(in_b_x, in_b_y, cosine, -sine, a.half_x(), a.half_y(),
                                              b.half_x(), b.half_y())));
}

}  // namespace crashrank::detail
