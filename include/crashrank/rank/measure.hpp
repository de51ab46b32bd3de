#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/result.hpp"

#include <string>

namespace crashrank {

/// What a ranking compares. Every measure is 0 without contact, and lower is better.
enum class Measure {
  polygons,        ///< triangles that intersect, of both bodies (Wiseman & Grinberg 2016)
  area,            ///< area of those triangles, m²
  closing_energy,  ///< ½·m₁m₂/(m₁+m₂)·v² with the closing speed v at first contact, J
};

/// The measure's name in files and on the command line: "polygons", "area", "closing-energy".
CRASHRANK_API const char* measure_name(Measure measure) noexcept;
/// Unit of its scores: "triangles", "m2", "J".
CRASHRANK_API const char* measure_unit(Measure measure) noexcept;
/// Reads a name; the error (usage) lists those there are.
CRASHRANK_API Result<Measure> measure_from_name(const std::string& name);

}  // namespace crashrank
