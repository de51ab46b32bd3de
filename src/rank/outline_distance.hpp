#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Where a body is seen from above.
struct PlanarPose {
  double x = 0.0;  ///< of the body's origin, world, m
  double y = 0.0;
  double cosine = 1.0;  ///< of the heading
  double sine = 0.0;
};

PlanarPose planar_pose(const Pose& pose) noexcept;

/// Chains of two outlines that were nearest to each other: where the next search for the distance
/// of the same two bodies, moved a little, begins.
struct NearestChains {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  bool known = false;
};

/// A body's outlines prepared for distances: segments that follow them to 2 mm, in short chains
/// with circles around them.
class BodyOutline {
public:
  BodyOutline() = default;
  /// As the profile cuts it. With a mesh: its convex hull in each height band, which leaves out no
  /// mirror, handlebar or arm; of a body without deep bays.
  explicit BodyOutline(const Profile& profile, const TriangleMesh* convex_mesh = nullptr);

  /// Middle of the rectangle around all outlines, body coordinates, m.
  double middle_x() const noexcept { return middle_x_; }
  double middle_y() const noexcept { return middle_y_; }
  /// Half its sides, m.
  double half_x() const noexcept { return half_x_; }
  double half_y() const noexcept { return half_y_; }
  /// No point of an outline is further from the body's origin, m.
  double radius_m() const noexcept { return radius_m_; }

private:
  friend double outline_distance_m(const BodyOutline&, const PlanarPose&, const BodyOutline&,
                                   const PlanarPose&, double, NearestChains&);
  struct Piece {
    double x = 0.0;  ///< from
    double y = 0.0;
    double along_x = 0.0;  ///< to its end
    double along_y = 0.0;
    double length_m = 0.0;
    double per_length2 = 0.0;  ///< 1 / length²
  };
  struct Chain {
    double x = 0.0;  ///< middle of its circle
    double y = 0.0;
    double radius = 0.0;
    std::uint32_t first = 0;  ///< piece
    std::uint32_t end = 0;
  };

  void add_chain(std::uint32_t first, std::uint32_t end);

  std::vector<Piece> pieces_;
  std::vector<Chain> chains_;
  std::array<std::uint32_t, profile_bands + 1> first_chain_{};  ///< of each band, then their number
  double middle_x_ = 0.0;
  double middle_y_ = 0.0;
  double half_x_ = 0.0;
  double half_y_ = 0.0;
  double radius_m_ = 0.0;
};

/// Distance of the outlines of two bodies that stand on the same ground, seen from above: the least
/// over the height bands that both have, m. A number of at least `cutoff_m` where they are no
/// nearer than it, infinity without a common band. Bodies in each other are as far apart as their
/// outlines are. Exact to 4 mm. Allocates nothing. O(chains²) a band and the segments of the
/// nearest; `nearest`, of the same two bodies, changes what that takes and is changed.
double outline_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                          const PlanarPose& pose_b, double cutoff_m, NearestChains& nearest);

/// Distance of the rectangles around the outlines, seen from above: no outline distance is less.
/// 0 where they overlap. Constant time.
double rectangle_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                            const PlanarPose& pose_b) noexcept;

}  // namespace crashrank::detail
