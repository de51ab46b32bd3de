#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// How far damage reaches in from the face of the body that it is nearest to, counted in the body's
/// size that way: crush depth as it is measured from outside, m. 0 without damage.
CRASHRANK_API double damage_depth_m(const Box& region, const Box& body);

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
