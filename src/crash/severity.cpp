#include "crashrank/crash/severity.hpp"

#include "crash/severity_of.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace crashrank {
namespace {

using Eigen::Vector3d;

/// Bounds of the moved triangles.
Box region_of(const TriangleMesh& mesh, const BodyCrush& crush) {
  Box box;
  for (const std::uint32_t triangle : crush.triangles) {
    for (const std::uint32_t vertex : mesh.triangles[triangle]) box.grow(mesh.vertices[vertex]);
  }
  return box;
}

/// Which of three even parts of [low, high] a stretch covers by a third of a part at least.
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

BodySeverity describe(const PulseBody& body, const BodyImpulse& impulse, const BodyCrush& crush,
                      double intrusion_m, bool slides) {
  BodySeverity told;
  told.delta_v_mps = body.pose.rotation.transpose() * impulse.delta_v_mps;
  told.delta_v_total_mps = impulse.delta_v_mps.norm();
  told.yaw_rate_change_radps = impulse.delta_omega_radps.z();
  told.pdof_deg =
      body.rigid.movable() ? impulse.pdof_deg : pdof_deg(impulse.impulse_ns, body.rigid.forward);
  told.clock = clock_of(told.pdof_deg);
  told.crush_energy_j = crush.energy_j;
  told.ees_mps = crush.ees_mps;
  told.crush_m = crush.deepest_m;
  told.intrusion_m = intrusion_m;
  told.cdc = cdc_code(
      {told.pdof_deg, region_of(*body.mesh, crush), body.mesh->bounds(), crush.deepest_m, slides});
  return told;
}

}  // namespace

double cage_intrusion_m(const PulseBody& body, const CrushResult& crush, bool body_is_a) {
  const BodyCrush& own = body_is_a ? crush.a : crush.b;
  const CrushCore& core = body.strength.core;
  if (!std::isfinite(core.cage_half_width_m)) return 0.0;
  // The crush front of each cell, as deep as it lies behind the cage's wall.
  double worst = 0.0;
  const Eigen::Matrix3d turn = body.pose.rotation.transpose() * crush.frame.axes.transpose();
  const Vector3d shift =
      body.pose.rotation.transpose() * (crush.frame.origin_m - body.pose.translation);
  const double inward = body_is_a ? -1.0 : 1.0;
  constexpr double step_m = 0.02;
  for (std::size_t cell = 0; cell < own.depth_m.size(); ++cell) {
    const double depth = own.depth_m[cell];
    if (depth <= worst) continue;
    const double w = crush.grid.w_of(cell % crush.grid.columns);
    const double h = crush.grid.h_of(cell / crush.grid.columns);
    // Back along the way of the crush from its end, as long as that is within the cage.
    double reach = 0.0;
    while (reach < depth) {
      const Vector3d at = turn * Vector3d(own.end_m[cell] - inward * reach, w, h) + shift;
      const bool caged = at.x() <= core.cage_front_m && at.x() >= core.cage_rear_m &&
                         std::abs(at.y()) <= core.cage_half_width_m;
      if (!caged) break;
      reach += step_m;
    }
    worst = std::max(worst, std::min(reach, depth));
  }
  return worst;
}

std::string cdc_code(const Deformation& d) {
  if (d.region.empty() || d.body.empty()) return {};
  const Vector3d from = d.region.min.cast<double>();
  const Vector3d to = d.region.max.cast<double>();
  const Vector3d low = d.body.min.cast<double>();
  const Vector3d high = d.body.max.cast<double>();
  const Vector3d size = (high - low).cwiseMax(1e-9);
  // The face that the damage reaches away from least, counted in the body's size that way.
  const std::array<std::pair<double, char>, 5> reach{{
      {(high.x() - from.x()) / size.x(), 'F'},
      {(to.x() - low.x()) / size.x(), 'B'},
      {(high.y() - from.y()) / size.y(), 'L'},
      {(to.y() - low.y()) / size.y(), 'R'},
      {(high.z() - from.z()) / size.z(), 'T'},
  }};
  const char area = std::min_element(reach.begin(), reach.end())->second;
  const bool end = area == 'F' || area == 'B' || area == 'T';
  // From right to left across, from the rear to the front along.
  const char place = end ? place_of(thirds(from.y(), to.y(), low.y(), high.y()), "RCL")
                         : place_of(thirds(from.x(), to.x(), low.x(), high.x()), "BPF");
  // J224's unions are left with centre and front with passengers' part for Y.
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

Severity crash_severity(const PulseBody& a, const PulseBody& b, const Vector3d& point_m,
                        const Vector3d& along, const SeverityOptions& options) {
  return detail::severity_of(a, b, point_m, along,
                             simulate_pulse(a, b, point_m, along, options.pulse), options.crush);
}

Severity detail::severity_of(const PulseBody& a, const PulseBody& b, const Vector3d& point_m,
                             const Vector3d& along, const PulseResult& pulse,
                             const CrushOptions& options) {
  Severity severity;
  severity.pulse = pulse;
  if (pulse.acts) {
    const Vector3d force = pulse.b.impulse_ns;
    const double energy = std::max(0.0, pulse.dissipated_j - pulse.friction_j);
    severity.crush =
        crush(a, b, point_m, force.head<2>().norm() > 0.0 ? force : along, energy, options);
  }
  severity.a = describe(a, pulse.a, severity.crush.a, cage_intrusion_m(a, severity.crush, true),
                        pulse.slides);
  severity.b = describe(b, pulse.b, severity.crush.b, cage_intrusion_m(b, severity.crush, false),
                        pulse.slides);
  return severity;
}

}  // namespace crashrank
