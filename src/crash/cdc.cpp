#include "crashrank/crash/contact_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace crashrank {
namespace {

using Eigen::Vector3d;

/// Returns which thirds of [low, high] the range [from, to] covers by at least a third of their
/// length.
std::array<bool, 3> thirds(double from, double to, double low, double high) {
  const double part = (high - low) / 3.0;
  std::array<bool, 3> covered{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double start = low + static_cast<double>(i) * part;
    covered[i] = std::min(to, start + part) - std::max(from, start) > part / 3.0;
  }
  if (!covered[0] && !covered[1] && !covered[2]) {
    const double at = (0.5 * (from + to) - low) / part;
    covered[static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, 2.0))] = true;
  }
  return covered;
}

char place_of(const std::array<bool, 3>& covered, const char* names) {
  const auto& [low, middle, high] = covered;
  if (low && high) return 'D';
  if (low && middle) return 'Y';
  if (middle && high) return 'Z';
  if (low) return names[0];
  return middle ? names[1] : names[2];
}

char height_of(double from, double to, double low, double high) {
  const double belt = low + 0.62 * (high - low);
  const double frame = low + 0.35 * (high - low);
  const bool over = to > belt;
  const bool under = from < frame;
  if (over) return under ? 'A' : (from >= belt ? 'G' : 'H');
  if (under) return to > frame ? 'E' : 'L';
  return 'M';
}

/// A face of a body, and the depth of the damage from it.
struct DamagedFace {
  char area = 'F';
  double depth_m = 0.0;
};

/// The face from which the damage is least deep, relative to the body's size in that direction.
DamagedFace face_of(const Box& region, const Box& body) {
  const Vector3d from = region.min.cast<double>();
  const Vector3d to = region.max.cast<double>();
  const Vector3d low = body.min.cast<double>();
  const Vector3d high = body.max.cast<double>();
  const Vector3d size = (high - low).cwiseMax(1e-9);
  struct Reach {
    double share;
    DamagedFace face;
  };
  const std::array<Reach, 5> reach{{
      {(high.x() - from.x()) / size.x(), {'F', high.x() - from.x()}},
      {(to.x() - low.x()) / size.x(), {'B', to.x() - low.x()}},
      {(high.y() - from.y()) / size.y(), {'L', high.y() - from.y()}},
      {(to.y() - low.y()) / size.y(), {'R', to.y() - low.y()}},
      {(high.z() - from.z()) / size.z(), {'T', high.z() - from.z()}},
  }};
  return std::min_element(reach.begin(), reach.end(),
                          [](const Reach& p, const Reach& q) { return p.share < q.share; })
      ->face;
}

}  // namespace

double damage_depth_m(const Box& region, const Box& body) {
  if (region.empty() || body.empty()) return 0.0;
  return std::max(0.0, face_of(region, body).depth_m);
}

std::string cdc_code(const Deformation& d) {
  if (d.region.empty() || d.body.empty()) return {};
  const Vector3d from = d.region.min.cast<double>();
  const Vector3d to = d.region.max.cast<double>();
  const Vector3d low = d.body.min.cast<double>();
  const Vector3d high = d.body.max.cast<double>();
  const Vector3d size = (high - low).cwiseMax(1e-9);
  const char area = face_of(d.region, d.body).area;
  const bool end = area == 'F' || area == 'B' || area == 'T';
  // Lateral positions count from right to left, longitudinal ones from rear to front.
  const char place = end ? place_of(thirds(from.y(), to.y(), low.y(), high.y()), "RCL")
                         : place_of(thirds(from.x(), to.x(), low.x(), high.x()), "BPF");
  // In J224 Y is left with centre, or front with passenger compartment.
  const char union_place = place == 'Y' ? 'Z' : (place == 'Z' ? 'Y' : place);
  constexpr double narrow_m = 0.41;
  const double width = end ? to.y() - from.y() : to.x() - from.x();
  const char kind = d.sideswipe ? 'S' : (width < narrow_m ? 'N' : 'W');
  const double zone_m = (area == 'T' ? size.z() : (end ? 0.5 * size.x() : size.y())) / 9.0;
  const int zone = static_cast<int>(std::clamp(std::ceil(d.depth_m / zone_m), 1.0, 9.0));
  const int clock = clock_of(d.pdof_deg);
  std::string code = clock < 10 ? "0" : "";
  code += std::to_string(clock);
  code += area;
  code += union_place;
  code += height_of(from.z(), to.z(), low.z(), high.z());
  code += kind;
  code += std::to_string(zone);
  return code;
}

}  // namespace crashrank
