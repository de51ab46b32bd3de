#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/crash/depth_map.hpp"
#include "crashrank/crash/pulse.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace crashrank {

/// How finely crush is measured.
struct CrushOptions {
  double cell_m = 0.05;     ///< width and height of the cells of the crush map
  double step_m = 0.02;     ///< by which the bodies are pressed together
  double deepest_m = 20.0;  ///< no further than this, whatever energy is left
};

/// How far a part was pushed in.
struct PartIntrusion {
  std::uint32_t part = 0;    ///< index into the mesh's parts
  double intrusion_m = 0.0;  ///< of its point that was pushed furthest
  double area_m2 = 0.0;      ///< of its surface that was moved
};

/// What the crush does to one body.
struct BodyCrush {
  std::vector<double> depth_m;  ///< by cell of the map, along the view; 0 where untouched
  std::vector<double> end_m;    ///< by cell: where (u) its face ends up, once crushed
  double deepest_m = 0.0;       ///< m
  double volume_m3 = 0.0;       ///< ∬ C dw dh
  double energy_j = 0.0;        ///< taken by it, J
  /// Speed at which the body would have to hit a rigid obstacle to take that energy (ISO 12353):
  /// E = m·EES²/2. 0 for a body that nothing moves.
  double ees_mps = 0.0;
  std::vector<std::uint32_t> triangles;  ///< moved, in mesh order, rising
  double area_m2 = 0.0;              ///< moved surface; of a triangle, the part of it that moved
  std::vector<PartIntrusion> parts;  ///< those moved, rising
};

/// Crush of both bodies.
struct CrushResult {
  ViewFrame frame;         ///< along what it was measured
  ViewGrid grid;           ///< of both maps, in the world as the bodies lay
  double pressed_m = 0.0;  ///< how far they were pressed together past first touch
  double energy_j = 0.0;   ///< of both; the energy asked for unless the depth ended first
  BodyCrush a;             ///< of A
  BodyCrush b;             ///< of B
};

/// Crush maps of two bodies at first contact. They are pressed together along `along` (horizontal,
/// A towards B: against the direction that the force on A comes from) without turning, until the
/// work ∬ F(C) dC dw against both equals `energy_j`. Surfaces yield in turn: in every cell both
/// bodies bear the same pressure. What lies behind the surface is taken along once the surface has
/// come to it (parts have no thickness left between them), so a bumper, a cooler and an engine are
/// moved in that order, and intrusion is each part's own.
/// Depth, volume, area and intrusion are those of the surfaces, sampled in cells: they converge
/// when the mesh is refined. O(cells·depth/step + triangles). Allocates. Safe from any thread.
CRASHRANK_API CrushResult crush(const PulseBody& a, const PulseBody& b,
                                const Eigen::Vector3d& point_m, const Eigen::Vector3d& along,
                                double energy_j, const CrushOptions& options = {});

}  // namespace crashrank
