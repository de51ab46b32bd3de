#include "crash/surface_pass.hpp"

#include "crash/surface_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// Ratio of the density of the material pushed aside to the mean density of the body. The mass of a
/// vehicle lies in the lower half of its volume, and displaced material drags about the same mass
/// along beside it.
constexpr float dragged_mass_factor = 4.0F;
/// Relative travel for which a list of pieces is valid, m.
constexpr double list_travel_m = 0.15;
/// Upper bound of the relative travel of a step, m: a new list is made in the first step beyond
/// `list_travel_m`.
constexpr double step_travel_m = 0.1;

RelativeMotion relative_motion(const PressedBody& from, const PressedBody& to) {
  const PlanarBody& p = from.motion;
  const PlanarBody& q = to.motion;
  const double pcx = from.vehicle->center_m.x();
  const double pcy = from.vehicle->center_m.y();
  const double qcx = to.vehicle->center_m.x();
  const double qcy = to.vehicle->center_m.y();
  const double c = q.cosine * p.cosine + q.sine * p.sine;
  const double s = q.cosine * p.sine - q.sine * p.cosine;
  // Centre of mass of the first body in the second body's axes.
  const double mx = qcx + q.cosine * (p.x - q.x) + q.sine * (p.y - q.y);
  const double my = qcy - q.sine * (p.x - q.x) + q.cosine * (p.y - q.y);
  const double ux = q.cosine * (p.vx - q.vx) + q.sine * (p.vy - q.vy);
  const double uy = -q.sine * (p.vx - q.vx) + q.cosine * (p.vy - q.vy);
  RelativeMotion relative_motion;
  relative_motion.c = static_cast<float>(c);
  relative_motion.s = static_cast<float>(s);
  relative_motion.x = static_cast<float>(mx - (c * pcx - s * pcy));
  relative_motion.y = static_cast<float>(my - (s * pcx + c * pcy));
  relative_motion.vx = static_cast<float>(ux + p.spin * my - q.spin * qcy);
  relative_motion.vy = static_cast<float>(uy - p.spin * mx + q.spin * qcx);
  relative_motion.spin = static_cast<float>(p.spin - q.spin);
  return relative_motion;
}

}  // namespace

double rise_of(const PressedBody& pusher, const PressedBody& pressed) {
  const PlanarBody& p = pusher.motion;
  const PlanarBody& q = pressed.motion;
  const double of_p = pusher.vehicle->silhouettes.longest_m();
  const double of_q = pressed.vehicle->silhouettes.longest_m();
  const double share = of_p / (of_p + of_q);
  const double x = p.x + share * (q.x - p.x);
  const double y = p.y + share * (q.y - p.y);
  return p.ground_at(x, y) - q.ground_at(x, y);
}

std::array<std::uint8_t, profile_bands> target_bands(double rise_m) {
  constexpr double level_m = 1e-3;
  std::array<std::uint8_t, profile_bands> target{};
  for (std::size_t band = 0; band < profile_bands; ++band) {
    target[band] = std::abs(rise_m) < level_m ? static_cast<std::uint8_t>(band) : no_band;
    if (target[band] != no_band) continue;
    double most_m = 0.0;
    for (std::size_t other = lowest_pressing_band; other < profile_bands; ++other) {
      const double common_m =
          std::min(profile_edges_m[band + 1] + rise_m, profile_edges_m[other + 1]) -
          std::max(profile_edges_m[band] + rise_m, profile_edges_m[other]);
      if (common_m <= most_m) continue;
      most_m = common_m;
      target[band] = static_cast<std::uint8_t>(other);
    }
  }
  return target;
}

bool inside_outline(const Vehicle& vehicle, std::size_t band, float x, float y) {
  const Silhouettes& s = vehicle.silhouettes;
  if (x < s.min_x || x > s.max_x || y < s.min_y || y > s.max_y) return false;
  const Profile& profile = *vehicle.profile;
  bool inside = false;
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    const float half = 0.5F * piece.length_m;
    const float from = piece.y - half * piece.normal_x;
    const float to = piece.y + half * piece.normal_x;
    if ((from <= y) == (to <= y)) continue;
    const float share = (y - from) / (to - from);
    if (piece.x + half * piece.normal_y - share * 2.0F * half * piece.normal_y > x) {
      inside = !inside;
    }
  }
  return inside;
}

bool is_hidden(const PressedBody& owner, const OutlinePiece& piece, std::size_t band,
               const PassSettings& settings) {
  constexpr float beside_m = 0.02F;
  const PlanarBody& p = owner.motion;
  const double local_x =
      static_cast<double>(piece.x + beside_m * piece.normal_x) - owner.vehicle->center_m.x();
  const double local_y =
      static_cast<double>(piece.y + beside_m * piece.normal_y) - owner.vehicle->center_m.y();
  const double x = p.x + p.cosine * local_x - p.sine * local_y;
  const double y = p.y + p.sine * local_x + p.cosine * local_y;
  for (std::size_t k = 0; k < settings.neighbours.size(); ++k) {
    if (k == settings.self) continue;
    const PressedBody& other = *settings.neighbours[k];
    const PlanarBody& q = other.motion;
    const double at_x = other.vehicle->center_m.x() + q.cosine * (x - q.x) + q.sine * (y - q.y);
    const double at_y = other.vehicle->center_m.y() - q.sine * (x - q.x) + q.cosine * (y - q.y);
    if (inside_outline(*other.vehicle, band, static_cast<float>(at_x), static_cast<float>(at_y))) {
      return true;
    }
  }
  return false;
}

void compute_piece_forces(const PressedBody& pusher, const PressedBody& pressed,
                          const PassSettings& settings, double moved_m, NearPieces& near,
                          PassSums& sums, PassRecord& record) {
  const Silhouettes& shape = pusher.vehicle->silhouettes;
  const Silhouettes& target = pressed.vehicle->silhouettes;
  // A fixed body counts with its larger dimension, a vehicle with its width.
  const auto pusher_width = pusher.vehicle->stands()
                                ? std::max(shape.max_x - shape.min_x, shape.max_y - shape.min_y)
                                : static_cast<float>(shape.width_m());
  const auto own_width = static_cast<float>(target.width_m());
  PressQuery query;
  query.to = relative_motion(pusher, pressed);
  query.pusher = &pusher;
  query.pressed = &pressed;
  query.settings = &settings;
  query.narrower_width_m = std::max(std::min(pusher_width, own_width), 1e-3F);
  query.excess_width_m = std::max(0.0F, own_width - pusher_width);
  query.dragged_density_kgm3 =
      dragged_mass_factor * static_cast<float>(pressed.vehicle->density_kgm3);
  const double rise_m = rise_of(pusher, pressed);
  query.rise_m = static_cast<float>(rise_m);
  near.valid_for_m -= moved_m;
  const bool is_due = !(near.valid_for_m > 0.0);
  if (is_due) near.target_band = target_bands(rise_m);
  query.target_band = near.target_band;
  if (is_due) {
    list_blocks(query, static_cast<float>(list_travel_m + step_travel_m), near);
    near.valid_for_m = list_travel_m;
  }
  PressTotals totals;
  accumulate_forces(query, near, totals, sums, record);
  sums.approaching = totals.approaching;

  // Transform from the pressed body's axes to world axes.
  const PlanarBody& q = pressed.motion;
  const double cx = pressed.vehicle->center_m.x();
  const double cy = pressed.vehicle->center_m.y();
  const double origin_x = q.x - (q.cosine * cx - q.sine * cy);
  const double origin_y = q.y - (q.sine * cx + q.cosine * cy);
  const auto turn_x = [&](double x, double y) { return q.cosine * x - q.sine * y; };
  const auto turn_y = [&](double x, double y) { return q.sine * x + q.cosine * y; };
  const double wx = turn_x(totals.force_x, totals.force_y);
  const double wy = turn_y(totals.force_x, totals.force_y);
  sums.on_pressed.x = wx;
  sums.on_pressed.y = wy;
  sums.on_pressed.moment = totals.moment + origin_x * wy - origin_y * wx;
  sums.point_x = sums.weight * origin_x + turn_x(totals.point_x, totals.point_y);
  sums.point_y = sums.weight * origin_y + turn_y(totals.point_x, totals.point_y);
}

}  // namespace crashrank::detail
