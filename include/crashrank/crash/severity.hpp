#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/export.hpp"
#include "crashrank/crash/crush.hpp"
#include "crashrank/crash/pulse.hpp"

#include <Eigen/Core>

#include <string>

namespace crashrank {

/// What a crash is to one body.
struct BodySeverity {
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< in the body's axes before the crash
  double delta_v_total_mps = 0.0;                         ///< its length
  double yaw_rate_change_radps = 0.0;                     ///< left positive
  double pdof_deg = 0.0;                                  ///< see BodyImpulse
  int clock = 12;               ///< the same as an hour of the clock, 12 ahead
  double crush_energy_j = 0.0;  ///< taken by the body's own deformation
  double ees_mps = 0.0;         ///< energy-equivalent speed, m/s
  double crush_m = 0.0;         ///< deepest
  double intrusion_m = 0.0;     ///< of the part of the passengers' cage that was pushed in furthest
  std::string cdc;              ///< collision deformation classification; empty without damage
};

/// What is worst inside: how far the crush reaches into the cage of `strength`; 0 for bodies
/// without one, which carry nobody inside (motorcycles, bicycles, people on foot).
CRASHRANK_API double cage_intrusion_m(const PulseBody& body, const CrushResult& crush,
                                      bool body_is_a);

/// Both bodies' severity from the pulse, and the crush of what it dissipated less friction.
struct Severity {
  PulseResult pulse;  ///< the crush phase
  CrushResult crush;  ///< how deep both went
  BodySeverity a;     ///< of A
  BodySeverity b;     ///< of B
};

/// How a crash is simulated and measured.
struct SeverityOptions {
  PulseOptions pulse;  ///< of the crush phase
  CrushOptions crush;  ///< of its measurement
};

/// From first contact to severity: the pulse along the closing direction, then crush maps along the
/// force that came of it. `along` as in `simulate_pulse`.
CRASHRANK_API Severity crash_severity(const PulseBody& a, const PulseBody& b,
                                      const Eigen::Vector3d& point_m, const Eigen::Vector3d& along,
                                      const SeverityOptions& options = {});

/// Where and how a body is deformed, for `cdc_code`; body coordinates, m.
struct Deformation {
  double pdof_deg = 0.0;   ///< degrees clockwise from ahead
  Box region;              ///< of the moved surface
  Box body;                ///< bounds of the body
  double depth_m = 0.0;    ///< m
  bool sideswipe = false;  ///< along the side rather than into it
};

/// Seven characters after SAE J224: clock direction (01 to 12), area (F, B, L, R, T), place across
/// or along it (L, C, R or F, P, B, their unions Y and Z, D for all), place in height (A all, E
/// below the belt, H above the frame, M between, G above the belt, L below the frame), kind (W
/// wide, N narrower than 0.41 m, S sideswipe) and extent zone 1 to 9. Belt and frame stand at 0.62
/// and 0.35 of the height; extent zones are ninths of half the length (front, rear), of the width
/// (sides) or of the height, this project's reading of a standard whose zones follow each car's
/// windows. Empty without a region.
CRASHRANK_API std::string cdc_code(const Deformation& deformation);

}  // namespace crashrank
