#include "crash/surface_pass.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// A step inwards from the surface over which the pressure rises to the yield pressure, m: paint,
/// cladding, gaps.
constexpr float soft_m = 0.012F;
/// Pressing and friction rise evenly up to these shares of the relative speed: material that is
/// only just closing, or only just sliding, bears part of the force.
constexpr float closing_share = 0.1F;
constexpr float sliding_share = 0.15F;
constexpr float least_even_mps = 0.2F;
/// Narrow bodies engage material beside them: width per metre of depth, on each side.
constexpr float spread = 0.35F;
/// Mass that is pushed aside, times the mean density: a vehicle's mass lies in the lower half of
/// its volume, and what is pushed drags about as much beside it along.
constexpr float dragged = 4.0F;
/// Folds of two crushed vehicles hook into each other over the size of a rail.
constexpr float interlock_m = 0.15F;
/// List of pieces: those within this distance of the other body, m.
constexpr double near_m = 0.15;
/// A piece that lies this deep inside the other body at the start never presses, nor does one that
/// is found inside later without having been followed there.
constexpr float inside_m = 0.05F;
constexpr float never = -1e9F;
/// Least slant of a piece's way to the surface that its first depth reckons with, as 1/sine.
constexpr float most_slanted = 10.0F;

/// Rigid transformation from one body's axes to another's, and the velocity of the first one's
/// material against the second one's, in the second one's axes.
struct Carrier {
  float c = 1.0F;
  float s = 0.0F;
  float x = 0.0F;
  float y = 0.0F;
  float vx = 0.0F;  ///< at the origin of the axes
  float vy = 0.0F;
  float spin = 0.0F;
};

Carrier carrier(const PressedBody& from, const PressedBody& to) {
  const PlanarBody& p = from.motion;
  const PlanarBody& q = to.motion;
  const double pcx = from.vehicle->center_m.x();
  const double pcy = from.vehicle->center_m.y();
  const double qcx = to.vehicle->center_m.x();
  const double qcy = to.vehicle->center_m.y();
  const double c = q.cosine * p.cosine + q.sine * p.sine;
  const double s = q.cosine * p.sine - q.sine * p.cosine;
  // The first body's centre of mass in the second one's axes.
  const double mx = qcx + q.cosine * (p.x - q.x) + q.sine * (p.y - q.y);
  const double my = qcy - q.sine * (p.x - q.x) + q.cosine * (p.y - q.y);
  const double ux = q.cosine * (p.vx - q.vx) + q.sine * (p.vy - q.vy);
  const double uy = -q.sine * (p.vx - q.vx) + q.cosine * (p.vy - q.vy);
  Carrier carrier;
  carrier.c = static_cast<float>(c);
  carrier.s = static_cast<float>(s);
  carrier.x = static_cast<float>(mx - (c * pcx - s * pcy));
  carrier.y = static_cast<float>(my - (s * pcx + c * pcy));
  carrier.vx = static_cast<float>(ux + p.spin * my - q.spin * qcy);
  carrier.vy = static_cast<float>(uy - p.spin * mx + q.spin * qcx);
  carrier.spin = static_cast<float>(p.spin - q.spin);
  return carrier;
}

/// How deep a place lies below the four sides of a band's silhouettes.
struct Depths {
  float front = -1.0F;
  float rear = -1.0F;
  float left = -1.0F;
  float right = -1.0F;

  float least() const { return std::min(std::min(front, rear), std::min(left, right)); }
};

Depths depths_at(const Silhouettes& s, std::size_t band, float x, float y) {
  const Silhouette& over_y = s.along_x[band];
  const Silhouette& over_x = s.along_y[band];
  const float row = (y - over_y.low_m) * over_y.nodes_per_m;
  const float column = (x - over_x.low_m) * over_x.nodes_per_m;
  if (!(row >= 0.0F && column >= 0.0F)) return {};
  const auto i = static_cast<std::uint32_t>(row);
  const auto j = static_cast<std::uint32_t>(column);
  if (i + 1 >= over_y.count || j + 1 >= over_x.count) return {};
  const SilhouetteNode* const a = s.nodes.data() + over_y.first + i;
  const SilhouetteNode* const b = s.nodes.data() + over_x.first + j;
  const float t = row - static_cast<float>(i);
  const float u = column - static_cast<float>(j);
  return {a[0].greatest_m + t * (a[1].greatest_m - a[0].greatest_m) - x,
          x - (a[0].least_m + t * (a[1].least_m - a[0].least_m)),
          b[0].greatest_m + u * (b[1].greatest_m - b[0].greatest_m) - y,
          y - (b[0].least_m + u * (b[1].least_m - b[0].least_m))};
}

/// Whether a point (body axes) lies inside an outline of the band: crossings of a ray along x.
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

/// Whether a piece of one fixed body is covered by another.
bool hidden(const PressedBody& owner, const OutlinePiece& piece, std::size_t band,
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
    const PressedBody& other = settings.neighbours[k];
    const PlanarBody& q = other.motion;
    const double at_x = other.vehicle->center_m.x() + q.cosine * (x - q.x) + q.sine * (y - q.y);
    const double at_y = other.vehicle->center_m.y() - q.sine * (x - q.x) + q.cosine * (y - q.y);
    if (inside_outline(*other.vehicle, band, static_cast<float>(at_x), static_cast<float>(at_y))) {
      return true;
    }
  }
  return false;
}

/// Lists the pieces that may press within the next `near_m` of relative travel.
void list_near(const PressedBody& pusher, const PressedBody& pressed, const Carrier& to,
               const PassSettings& settings, NearPieces& near) {
  constexpr float turns = 0.25F;  // sine of how far a normal may turn until the next list
  const Silhouettes& own = pusher.vehicle->silhouettes;
  const Silhouettes& target = pressed.vehicle->silhouettes;
  const Profile& profile = *pusher.vehicle->profile;
  const float allowed_m = near.valid_for_m < -1e6 ? inside_m : 0.0F;
  for (std::size_t k = 0; k < near.count; ++k) {
    near.s[near.piece[k]] = near.s_now[k];
    near.furthest[near.piece[k]] = near.furthest_now[k];
  }
  near.count = 0;
  ++near.list;
  near.valid_for_m = near_m;
  const auto margin = static_cast<float>(near_m);
  for (const PieceBlock& block : own.blocks) {
    if (target.along_x[block.band].count == 0) continue;
    const float x = to.c * block.x - to.s * block.y + to.x;
    const float y = to.s * block.x + to.c * block.y + to.y;
    const float reach = block.radius_m + margin;
    if (x < target.min_x - reach || x > target.max_x + reach || y < target.min_y - reach ||
        y > target.max_y + reach) {
      continue;
    }
    // Pieces that face away from where they go do not press: the cosine between velocity and any
    // normal of the block's cone is at most that to the mean normal plus the cone's sine.
    const float nx = to.c * block.normal_x - to.s * block.normal_y;
    const float ny = to.s * block.normal_x + to.c * block.normal_y;
    const float vx = to.vx - to.spin * y;
    const float vy = to.vy + to.spin * x;
    const float speed = std::sqrt(vx * vx + vy * vy) + std::abs(to.spin) * block.radius_m;
    if (block.cosine > 0.0F) {
      const float sine = std::sqrt(std::max(0.0F, 1.0F - block.cosine * block.cosine));
      if (vx * nx + vy * ny < -(sine + turns) * speed) continue;
    }
    for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
      const OutlinePiece& piece = profile.pieces[i];
      // Not in the list before this one: nothing is known of the way it came.
      if (near.listed[i] + 1 != near.list) {
        near.furthest[i] = 0.0F;
        near.s[i] = 0.0F;
        near.way[i] = 0.0F;
        const float at_x = to.c * piece.x - to.s * piece.y + to.x;
        const float at_y = to.s * piece.x + to.c * piece.y + to.y;
        if (depths_at(target, block.band, at_x, at_y).least() > allowed_m ||
            (settings.neighbours.size() > 1 && hidden(pusher, piece, block.band, settings))) {
          near.s[i] = never;
        }
      }
      near.listed[i] = near.list;
      if (near.s[i] == never) continue;
      const std::size_t k = near.count++;
      near.x[k] = piece.x;
      near.y[k] = piece.y;
      near.normal_x[k] = piece.normal_x;
      near.normal_y[k] = piece.normal_y;
      near.length[k] = piece.length_m;
      near.piece[k] = i;
      near.band[k] = static_cast<std::uint8_t>(block.band);
      near.s_now[k] = near.s[i];
      near.furthest_now[k] = near.furthest[i];
    }
  }
}

/// Places, normals, velocities and advances of the listed pieces in the pressed body's axes; fresh
/// ones are marked. Plain arrays without branches, so that compilers do several at once: the same
/// operations for each, so the same bits.
void carry_pieces(const Carrier& to, float step, NearPieces& near) {
  constexpr float rounding_m = 1e-4F;
  const Carrier k = to;
  const float* __restrict const x = near.x.data();
  const float* __restrict const y = near.y.data();
  const float* __restrict const nx = near.normal_x.data();
  const float* __restrict const ny = near.normal_y.data();
  float* __restrict const at_x = near.at_x.data();
  float* __restrict const at_y = near.at_y.data();
  float* __restrict const out_nx = near.at_normal_x.data();
  float* __restrict const out_ny = near.at_normal_y.data();
  float* __restrict const advance = near.advance.data();
  float* __restrict const s = near.s_now.data();
  float* __restrict const furthest = near.furthest_now.data();
  float* __restrict const fresh = near.fresh.data();
  const std::size_t count = near.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float px = k.c * x[i] - k.s * y[i] + k.x;
    const float py = k.s * x[i] + k.c * y[i] + k.y;
    const float mx = k.c * nx[i] - k.s * ny[i];
    const float my = k.s * nx[i] + k.c * ny[i];
    const float rate = (k.vx - k.spin * py) * mx + (k.vy + k.spin * px) * my;
    const float before = s[i];
    const float after = before + rate * step;
    const float top = furthest[i];
    // Positive where the piece advances and has not gone back.
    const float further = before - top + rounding_m;
    fresh[i] = rate < further ? rate : further;
    s[i] = after;
    furthest[i] = after > top ? after : top;
    at_x[i] = px;
    at_y[i] = py;
    out_nx[i] = mx;
    out_ny[i] = my;
    advance[i] = rate;
  }
}

}  // namespace

void NearPieces::resize(std::size_t pieces) {
  if (listed.size() >= pieces) return;
  for (std::vector<float>* field :
       {&x, &y, &normal_x, &normal_y, &length, &at_x, &at_y, &at_normal_x, &at_normal_y, &advance,
        &s_now, &furthest_now, &fresh, &s, &furthest, &way}) {
    field->resize(pieces);
  }
  piece.resize(pieces);
  band.resize(pieces);
  pressing.resize(pieces + 1);
  listed.resize(pieces, 0);
}

void NearPieces::begin() {
  // One number is left out, so that the first list continues none. Numbers that come round would
  // take pieces for listed that were not.
  constexpr std::uint32_t nearly_round = 0xf0000000U;
  if (list > nearly_round) {
    std::fill(listed.begin(), listed.end(), 0U);
    list = 0;
  }
  list += 2;
  count = 0;
  valid_for_m = -1e9;
}

void press_pieces(const PressedBody& pusher, const PressedBody& pressed,
                  const PassSettings& settings, double moved_m, NearPieces& near, PassSums& sums,
                  PassRecord& record) {
  const Carrier to = carrier(pusher, pressed);
  near.valid_for_m -= moved_m;
  if (!(near.valid_for_m > 0.0)) list_near(pusher, pressed, to, settings, near);
  carry_pieces(to, static_cast<float>(settings.step_s), near);

  const Silhouettes& target = pressed.vehicle->silhouettes;
  std::size_t pressing = 0;
  for (std::size_t i = 0; i < near.count; ++i) {
    const bool presses = near.fresh[i] > 0.0F && near.at_x[i] > target.min_x &&
                         near.at_x[i] < target.max_x && near.at_y[i] > target.min_y &&
                         near.at_y[i] < target.max_y;
    near.pressing[pressing] = static_cast<std::uint32_t>(i);
    pressing += presses ? 1 : 0;
  }
  sums.approaching = pressing > 0;

  const bool both_yield = !pusher.response.rigid();
  // A wall is as wide as it is long, a vehicle as it is across.
  const Silhouettes& shape = pusher.vehicle->silhouettes;
  const auto pusher_width = pusher.vehicle->movable()
                                ? static_cast<float>(shape.width_m())
                                : std::max(shape.max_x - shape.min_x, shape.max_y - shape.min_y);
  const auto own_width = static_cast<float>(target.width_m());
  const float narrow = std::max(std::min(pusher_width, own_width), 1e-3F);
  const float wider = std::max(0.0F, own_width - pusher_width);
  const auto density = static_cast<float>(pressed.vehicle->density_kgm3);
  float force_x = 0.0F;
  float force_y = 0.0F;
  float moment = 0.0F;
  float point_x = 0.0F;
  float point_y = 0.0F;
  float weight = 0.0F;
  for (std::size_t k = 0; k < pressing; ++k) {
    const std::size_t i = near.pressing[k];
    const std::size_t band = near.band[i];
    const float x = near.at_x[i];
    const float y = near.at_y[i];
    const Depths d = depths_at(target, band, x, y);
    const float least = d.least();
    if (!(least > 0.0F)) continue;
    const float nx = near.at_normal_x[i];
    const float ny = near.at_normal_y[i];
    const float advance = near.advance[i];
    const float vx = to.vx - to.spin * y;
    const float vy = to.vy + to.spin * x;
    const float speed = std::sqrt(vx * vx + vy * vy);
    // No depth counts that the piece has not travelled: what enters through a flank is not deep
    // below the front. The first step of a piece inside begins at the surface.
    const float travel = speed * static_cast<float>(settings.since_s);
    float& way = near.way[near.piece[i]];
    way = way > 0.0F ? way + travel
                     : std::min(travel, least * std::min(most_slanted, speed / advance));
    const float end = std::min(nx < 0.0F ? d.front : d.rear, way);
    const float flank = ny < 0.0F ? d.left : d.right;
    const float depth = nx * nx * end + flank_share * ny * ny * std::min(flank, end);
    CrushCurve own = pressed.response.at(band, x, y, nx, ny);
    own.shorten(nx * nx * (d.front + d.rear) + flank_share * ny * ny * (d.left + d.right));
    float force = 0.0F;
    float own_depth = depth;
    float friction = settings.friction;
    float fresh = 0.0F;
    if (both_yield) {
      CrushCurve others =
          pusher.response.at(band, near.x[i], near.y[i], -near.normal_x[i], -near.normal_y[i]);
      others.shorten(shape.thickness_m[near.piece[i]]);
      const SharedCrush shared = share_crush(own, others, depth);
      force = shared.force;
      own_depth = shared.depth_a;
      const float hooked = std::min(1.0F, std::min(own_depth, depth - own_depth) / interlock_m);
      friction += std::max(0.0F, settings.interlocked - friction) * hooked;
      // By the shares in which the two are crushed.
      const float left =
          own_depth * std::max(0.0F, 1.0F - own_depth / own.length) +
          (depth - own_depth) * std::max(0.0F, 1.0F - (depth - own_depth) / others.length);
      fresh = depth > 0.0F ? left / depth : 1.0F;
    } else {
      force = own.force_at(depth);
      fresh = std::max(0.0F, 1.0F - depth / own.length);
    }
    const float other_depth = depth - own_depth;
    const float own_share = !both_yield ? 1.0F : depth > 1e-6F ? own_depth / depth : 0.5F;
    force *= 1.0F + std::min(2.0F * spread * depth, wider) / narrow;
    const auto height = static_cast<float>(profile_edges_m[band + 1] - profile_edges_m[band]);
    const float whole = (force + dragged * density * advance * advance * height) *
                        std::min(1.0F, least / soft_m) * own_share * near.length[i];
    const float normal =
        whole * std::min(1.0F, advance / std::max(least_even_mps, closing_share * speed));
    const float slip = vy * nx - vx * ny;
    const float sliding =
        std::clamp(slip / std::max(least_even_mps, sliding_share * speed), -1.0F, 1.0F);
    const float rubbing = friction * normal * sliding;
    const float fx = normal * nx - rubbing * ny;
    const float fy = normal * ny + rubbing * nx;
    // The surfaces meet where the pusher's own crush has moved them back to.
    const float px = x - other_depth * nx;
    const float py = y - other_depth * ny;
    force_x += fx;
    force_y += fy;
    moment += px * fy - py * fx;
    weight += normal;
    point_x += normal * px;
    point_y += normal * py;
    sums.pressing += static_cast<double>(whole);
    sums.closing += static_cast<double>(whole * advance);
    sums.passing += static_cast<double>(whole * speed);
    sums.fresh += static_cast<double>(whole * fresh);
    sums.power_own += static_cast<double>(normal * advance * own_share);
    sums.power_other += static_cast<double>(normal * advance * (1.0F - own_share));
    sums.power_friction += static_cast<double>(rubbing * slip);
    sums.depth_own = std::max(sums.depth_own, own_depth);
    sums.depth_other = std::max(sums.depth_other, other_depth);
    const auto low = static_cast<float>(profile_edges_m[band]);
    record.own.grow(Eigen::Vector3f(px, py, low));
    record.own.grow(Eigen::Vector3f(px, py, low + height));
    record.intrusion_own =
        std::max(record.intrusion_own, pressed.response.inside_compartment(px, py, nx));
    if (both_yield) {
      const float back_x = near.x[i] - other_depth * near.normal_x[i];
      const float back_y = near.y[i] - other_depth * near.normal_y[i];
      record.other.grow(Eigen::Vector3f(near.x[i], near.y[i], low));
      record.other.grow(Eigen::Vector3f(near.x[i], near.y[i], low + height));
      record.intrusion_other =
          std::max(record.intrusion_other,
                   pusher.response.inside_compartment(back_x, back_y, -near.normal_x[i]));
    }
  }

  // From the pressed body's axes to the world's.
  const PlanarBody& q = pressed.motion;
  const double cx = pressed.vehicle->center_m.x();
  const double cy = pressed.vehicle->center_m.y();
  const double origin_x = q.x - (q.cosine * cx - q.sine * cy);
  const double origin_y = q.y - (q.sine * cx + q.cosine * cy);
  const auto turn_x = [&](double x, double y) { return q.cosine * x - q.sine * y; };
  const auto turn_y = [&](double x, double y) { return q.sine * x + q.cosine * y; };
  const double wx = turn_x(static_cast<double>(force_x), static_cast<double>(force_y));
  const double wy = turn_y(static_cast<double>(force_x), static_cast<double>(force_y));
  sums.on_pressed.x += wx;
  sums.on_pressed.y += wy;
  sums.on_pressed.moment += static_cast<double>(moment) + origin_x * wy - origin_y * wx;
  const auto w = static_cast<double>(weight);
  sums.weight += w;
  sums.point_x += w * origin_x + turn_x(static_cast<double>(point_x), static_cast<double>(point_y));
  sums.point_y += w * origin_y + turn_y(static_cast<double>(point_x), static_cast<double>(point_y));
}

}  // namespace crashrank::detail
