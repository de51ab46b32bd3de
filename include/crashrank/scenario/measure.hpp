#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// What a ranking compares. Every measure is 0 without contact, and lower is better.
enum class Measure {
  polygons,        ///< triangles that intersect, of both bodies (Wiseman & Grinberg 2016)
  area,            ///< area of those triangles, m²
  closing_energy,  ///< ½·m₁m₂/(m₁+m₂)·v² v: closing speed of a pair's first contact, J
  delta_v,         ///< the ego's change of velocity in the crash, m/s
  energy,          ///< kinetic energy that the crash turns into damage and heat, J
  intrusion,       ///< how far the crush reaches into passengers' cages, both bodies', m
  harm,            ///< people hurt, as the weights of HarmOptions count them
};

/// The measure's name in files and on the command line: "polygons", "area", "closing-energy",
/// "delta-v", "energy", "intrusion", "harm".
CRASHRANK_API const char* measure_name(Measure measure) noexcept;
/// Unit of its scores: "triangles", "m2", "J", "m/s", "m", "persons".
CRASHRANK_API const char* measure_unit(Measure measure) noexcept;
/// What it counts, for a sentence and without an article: "people hurt, as weighted".
CRASHRANK_API const char* measure_meaning(Measure measure) noexcept;
/// Whether scoring it takes a simulation of the crash beyond first contact.
CRASHRANK_API bool needs_crash(Measure measure) noexcept;
/// Reads a name; the error (usage) lists those there are.
CRASHRANK_API Result<Measure> measure_from_name(const std::string& name);

}  // namespace crashrank
