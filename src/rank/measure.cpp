#include "crashrank/rank/measure.hpp"

#include <array>

namespace crashrank {
namespace {

struct MeasureEntry {
  Measure measure;
  const char* name;
  const char* unit;
};

constexpr std::array<MeasureEntry, 7> measures{{
    {Measure::polygons, "polygons", "triangles"},
    {Measure::area, "area", "m2"},
    {Measure::closing_energy, "closing-energy", "J"},
    {Measure::delta_v, "delta-v", "m/s"},
    {Measure::energy, "energy", "J"},
    {Measure::intrusion, "intrusion", "m"},
    {Measure::harm, "harm", "persons"},
}};

const MeasureEntry& entry_of(Measure measure) noexcept {
  for (const MeasureEntry& entry : measures) {
    if (entry.measure == measure) return entry;
  }
  return measures.front();
}

}  // namespace

const char* measure_name(Measure measure) noexcept { return entry_of(measure).name; }

const char* measure_unit(Measure measure) noexcept { return entry_of(measure).unit; }

bool needs_crash(Measure measure) noexcept {
  switch (measure) {
    case Measure::delta_v:
    case Measure::energy:
    case Measure::intrusion:
    case Measure::harm:
      return true;
    case Measure::polygons:
    case Measure::area:
    case Measure::closing_energy:
      break;
  }
  return false;
}

Result<Measure> measure_from_name(const std::string& name) {
  std::string known;
  for (const MeasureEntry& entry : measures) {
    if (name == entry.name) return entry.measure;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return make_error(ErrorCode::usage, "there is no measure \"" + name + "\"",
                    "choose one of " + known);
}

}  // namespace crashrank
