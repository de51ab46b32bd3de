#include "crash/struck_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crashrank::detail {
namespace {

/// The plane with an axis along a velocity and one to its left.
struct Heading {
  double x = 1.0;
  double y = 0.0;

  /// Coordinates of a place of a body, along and across.
  Eigen::Vector2d place(const PressedBody& body, double x_m, double y_m) const {
    const PlanarBody& at = body.motion;
    const double from_x = x_m - body.vehicle->center_m.x();
    const double from_y = y_m - body.vehicle->center_m.y();
    const double world_x = at.x + at.cosine * from_x - at.sine * from_y;
    const double world_y = at.y + at.sine * from_x + at.cosine * from_y;
    return {x * world_x + y * world_y, x * world_y - y * world_x};
  }
};

/// What strikers pass over: all that is ahead of their rear between two lines along the velocity.
struct Path {
  double rear = 1e9;
  double right = 1e9;
  double left = -1e9;
};

/// Calls back with both ends of every outline piece of a body in a band.
template <class Visit>
void visit_pieces(const PressedBody& body, std::size_t band, const Heading& along, Visit&& visit) {
  const Profile& profile = *body.vehicle->profile;
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& p = profile.pieces[i];
    const auto half_x = static_cast<double>(-0.5F * p.length_m * p.normal_y);
    const auto half_y = static_cast<double>(0.5F * p.length_m * p.normal_x);
    const auto x = static_cast<double>(p.x);
    const auto y = static_cast<double>(p.y);
    visit(along.place(body, x - half_x, y - half_y), along.place(body, x + half_x, y + half_y));
  }
}

/// Area of a band of a body within a path, and in all, m².
Eigen::Vector2d areas(const PressedBody& body, std::size_t band, const Heading& along,
                      const Path& path) {
  double within = 0.0;
  double all = 0.0;
  visit_pieces(body, band, along, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double width = to.y() - from.y();
    all += 0.5 * (from.x() + to.x()) * width;
    const double first = std::clamp(from.y(), path.right, path.left);
    const double last = std::clamp(to.y(), path.right, path.left);
    if (first == last) return;
    const double share = (0.5 * (first + last) - from.y()) / width;
    within += std::max(path.rear, from.x() + share * (to.x() - from.x())) * (last - first);
  });
  return {std::abs(within), std::abs(all)};
}

}  // namespace

double struck_part_mps(const PressedBody& person, View<const PressedBody* const> strikers) {
  const PlanarBody& p = person.motion;
  const PlanarBody& q = strikers[0]->motion;
  const double vx = q.vx - q.spin * (p.y - q.y) - p.vx;
  const double vy = q.vy + q.spin * (p.x - q.x) - p.vy;
  const double speed_mps = plane_length(vx, vy);
  if (!(speed_mps > 0.0)) return 0.0;
  const Heading along{vx / speed_mps, vy / speed_mps};
  std::array<Path, profile_bands> paths;
  for (const PressedBody* const striker : strikers) {
    const auto target = target_bands(rise_of(*striker, person));
    for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
      if (target[band] == no_band) continue;
      Path& path = paths[target[band]];
      visit_pieces(*striker, band, along, [&](const Eigen::Vector2d& at, const Eigen::Vector2d&) {
        path.rear = std::min(path.rear, at.x());
        path.right = std::min(path.right, at.y());
        path.left = std::max(path.left, at.y());
      });
    }
  }
  double struck_m3 = 0.0;
  double body_m3 = 0.0;
  for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
    if (!(paths[band].right < paths[band].left)) continue;
    const Eigen::Vector2d area_m2 = areas(person, band, along, paths[band]);
    struck_m3 += band_height_m(band) * area_m2.x();
    body_m3 += band_height_m(band) * area_m2.y();
  }
  if (!(body_m3 > 0.0)) return 0.0;
  const double share = std::min(1.0, struck_m3 / body_m3);
  return speed_mps * std::sqrt(share) / (1.0 + share * q.inverse_mass / p.inverse_mass);
}

}  // namespace crashrank::detail
