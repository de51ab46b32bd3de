#include "crashrank/scenario/harm_options.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace crashrank {

namespace {

/// What users read of a measure. How it is computed is in rank/measure.cpp.
struct MeasureText {
  Measure measure = Measure::polygons;
  const char* name = "";
  const char* unit = "";
  const char* meaning = "";  ///< for a sentence, without an article
  bool needs_crash = true;   ///< scoring it takes a simulation beyond first contact
};

constexpr std::array<MeasureText, 7> texts{{
    {Measure::polygons, "polygons", "triangles", "damaged triangles of all bodies", false},
    {Measure::area, "area", "m2", "damaged surface of all bodies", false},
    {Measure::closing_energy, "closing-energy", "J",
     "kinetic energy that the crash could turn into damage", false},
    {Measure::delta_v, "delta-v", "m/s", "the own vehicle's change of velocity", true},
    {Measure::energy, "energy", "J", "energy turned into damage", true},
    {Measure::intrusion, "intrusion", "m", "depth of the crush in passengers' cages", true},
    {Measure::harm, "harm", "persons", "people hurt, as weighted", true},
}};

constexpr bool each_in_its_place() {
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (static_cast<std::size_t>(texts[i].measure) != i) return false;
  }
  return true;
}
static_assert(each_in_its_place(), "texts are in the order of the enumerators");

const MeasureText& text_of(Measure measure) noexcept {
  return texts[static_cast<std::size_t>(measure)];
}

}  // namespace

const char* measure_name(Measure measure) noexcept { return text_of(measure).name; }

const char* measure_unit(Measure measure) noexcept { return text_of(measure).unit; }

const char* measure_meaning(Measure measure) noexcept { return text_of(measure).meaning; }

bool needs_crash(Measure measure) noexcept { return text_of(measure).needs_crash; }

Result<Measure> measure_from_name(const std::string& name) {
  std::string known;
  for (const MeasureText& text : texts) {
    if (name == text.name) return text.measure;
    known += (known.empty() ? "" : ", ") + std::string(text.name);
  }
  return make_error(ErrorCode::usage, "there is no measure \"" + name + "\"",
                    "choose one of " + known);
}

}  // namespace crashrank
