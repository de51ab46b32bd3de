#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Pose of a body in plan view.
struct PlanarPose {
  double x = 0.0;  ///< position of the origin of the body, world, m
  double y = 0.0;
  double cosine = 1.0;  ///< of the heading, like `sine`
  double sine = 0.0;
};

PlanarPose planar_pose(const Pose& pose) noexcept;

/// Nearest chains of two outlines in the last search. The next search for the same bodies, moved a
/// little, starts from them.
struct NearestChains {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  bool known = false;
};

/// Outlines of a body prepared for distance queries: line segments that approximate them to 2 mm,
/// in short chains with bounding circles.
class BodyOutline {
public:
  BodyOutline() = default;
  /// Uses the outlines of the profile or, if a mesh is given, its convex hull in each height band.
  /// The hull contains mirrors, handlebars and arms, and suits bodies without deep concavities.
  explicit BodyOutline(const Profile& profile, const TriangleMesh* convex_mesh = nullptr);

  /// Centre of the bounding rectangle of all outlines, body coordinates, m.
  double middle_x() const noexcept { return middle_x_; }
  double middle_y() const noexcept { return middle_y_; }
  /// Half the sides of that rectangle, m.
  double half_x() const noexcept { return half_x_; }
  double half_y() const noexcept { return half_y_; }
  /// Upper bound on the distance of an outline point from the origin of the body, m.
  double radius_m() const noexcept { return radius_m_; }

private:
  friend double outline_distance_m(const BodyOutline&, const PlanarPose&, const BodyOutline&,
                                   const PlanarPose&, double, NearestChains&);
  struct Piece {
    double x = 0.0;  ///< begin
    double y = 0.0;
    double along_x = 0.0;  ///< vector from begin to end
    double along_y = 0.0;
    double length_m = 0.0;
    double per_length2 = 0.0;  ///< 1 / length²
  };
  struct Chain {
    double x = 0.0;  ///< centre of its bounding circle
    double y = 0.0;
    double radius = 0.0;
    std::uint32_t first = 0;  ///< index of the first piece
    std::uint32_t end = 0;
  };

  void add_chain(std::uint32_t first, std::uint32_t end);

  std::vector<Piece> pieces_;
  std::vector<Chain> chains_;
  std::array<std::uint32_t, profile_bands + 1> first_chain_{};  ///< by band, plus the end
  double middle_x_ = 0.0;
  double middle_y_ = 0.0;
  double half_x_ = 0.0;
  double half_y_ = 0.0;
  double radius_m_ = 0.0;
};

/// Distance between the outlines of two bodies on the same ground in plan view, m: the smallest
/// over the height bands that both have. Returns a value of at least `cutoff_m` if they are no
/// nearer than that, and infinity without a common band. For a body inside another it is the
/// distance between their outlines. Accuracy 4 mm. Does not allocate. O(chains²) for each band,
/// plus the segments of the nearest chains. `nearest` belongs to the same two bodies; it changes
/// only the time that the search takes, and is updated.
double outline_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                          const PlanarPose& pose_b, double cutoff_m, NearestChains& nearest);

/// Distance between the bounding rectangles in plan view, m: a lower bound on the outline distance;
/// 0 if they overlap. Constant time.
double rectangle_distance_m(const BodyOutline& a, const PlanarPose& pose_a, const BodyOutline& b,
                            const PlanarPose& pose_b) noexcept;

}  // namespace crashrank::detail
