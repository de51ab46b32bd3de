#include "catalogue.hpp"

#include "bicycle.hpp"
#include "car.hpp"
#include "human.hpp"
#include "motorcycle.hpp"
#include "roadside.hpp"
#include "semitrailer.hpp"
#include "tram.hpp"
#include "truck.hpp"
#include "wheelchair.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace generate {
namespace {

double thousandths(double value) { return std::floor(value * 1000.0 + 0.5) / 1000.0; }

// With commas between thousands.
std::string grouped(double value) {
  std::ostringstream number;
  number << std::setprecision(12) << value;
  std::string text = number.str();
  for (std::size_t i = std::min(text.find('.'), text.size()); i > 3;) text.insert(i -= 3, 1, ',');
  return text;
}

bool stands_out(const std::string& part) { return part.rfind("mirror", 0) == 0; }

}  // namespace

const std::vector<Entry>& catalogue() {
  static const std::vector<Entry> entries = {
      {"hatch", "Compact five-door hatchback", "car", 10000, 0.112,
       [](double edge) { return build_car(hatch_design(), edge); }, 2.55, 1200.0, 1650.0,
       Vec3(1.53, 0.0, 0.54), "centre of the rear axle on the ground",
       "Size and mass of the European supermini class: 4.0-4.15 m long, 1,080-1,200 kg empty, a "
       "driver of 75 kg added. Yaw inertia: mass times the square of 0.29 lengths, the ratio "
       "published for a mid-size saloon of 1,621 kg and 3,167 kg m2."},
      {"sedan", "Mid-size four-door saloon", "car", 60000, 0.03954,
       [](double edge) { return build_car(sedan_design(), edge); }, 2.80, 1680.0, 3280.0,
       Vec3(1.66, 0.0, 0.55), "centre of the rear axle on the ground",
       "Size and mass of the mid-size class: 4.85-4.90 m long, 1,550-1,650 kg empty, a driver of "
       "75 kg added. Yaw inertia: as for the hatch, 3,167 kg m2 at 1,621 kg scaled by mass."},
      {"truck", "Two-axle rigid lorry with box body", "truck", 16000, 0.17, build_truck, 5.50,
       14000.0, 106000.0, Vec3(2.30, 0.0, 1.45), "centre of the rear axle on the ground",
       "Distribution lorry of the 18 t class, some two thirds laden; width 2.55 m and the rear "
       "under-run bar's clearance under 0.55 m are the legal limits in Europe. Yaw inertia: an "
       "even block of that length and width."},
      {"motorcycle", "Roadster motorcycle with rider", "motorcycle", 12000, 0.0543,
       build_motorcycle, 1.42, 285.0, 58.0, Vec3(0.66, 0.0, 0.72),
       "centre of the rear axle on the ground",
       "Middle-weight roadster, 205 kg ready to ride, and a rider of 80 kg with clothing. Yaw "
       "inertia: radius of gyration of 0.45 m."},
      {"pedestrian", "Adult of 1.75 m, walking", "pedestrian", 4000, 0.036, build_pedestrian, 0.0,
       75.0, 1.4, Vec3(0.03, 0.0, 0.97), "on the ground under the pelvis",
       "Median adult: 1.75 m, 75 kg, centre of mass at 55 % of the height, 1.4 kg m2 about the "
       "upright axis."},
      {"jersey_barrier", "New Jersey concrete barrier, one element of 4 m", "barrier", 1600, 0.125,
       build_jersey_barrier, 0.0, 2420.0, 3300.0, Vec3(0.0, 0.0, 0.31),
       "on the ground in the middle, the barrier along x",
       "The classic section: 610 mm wide at the foot, 813 mm high, faces of 55 and 84 degrees; "
       "0.253 m2 of concrete at 2,400 kg/m3."},
      {"pole", "Rigid pole of 254 mm diameter", "pole", 1600, 0.09, build_pole, 0.0, 700.0, 6.0,
       Vec3(0.0, 0.0, 3.0), "on the ground on the pole's axis",
       "254 mm is the diameter of the rigid pole of side impact tests; 6 m of concrete column."},
      {"wall", "Brick wall, 10 m by 2.5 m", "building", 1600, 0.28, build_wall, 0.0, 11250.0,
       93800.0, Vec3(0.125, 0.0, 1.25), "on the ground in the middle of the face towards -x",
       "A one-brick wall of 0.25 m at 1,800 kg/m3."},
      {"bicycle", "City bicycle with adult rider", "bicycle", 9000, 0.040, build_bicycle, 1.06,
       94.0, 5.9, Vec3(0.31, 0.0, 0.99), "centre of the rear axle on the ground",
       "Wheels of 622 mm rims; mass, and 0.25 m of radius of gyration in yaw, of the benchmark "
       "bicycle with rider (Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463, 2007)."},
      {"child", "Child of six years, 1.14 m, walking", "pedestrian", 4000, 0.02345, build_child,
       0.0, 23.4, 0.18, Vec3(0.02, 0.0, 0.63), "on the ground under the pelvis",
       "Height and mass of the Hybrid III dummy of a six-year-old child (49 CFR 572 subpart N); "
       "the "
       "adult's proportions and radius of gyration scaled by height."},
      {"tree", "Avenue tree, trunk of 0.40 m at the ground", "pole", 1500, 0.15, build_tree, 0.0,
       700.0, 350.0, Vec3(0.0, 0.0, 3.2), "on the ground on the trunk's axis",
       "A choice: trunks above 0.10 m count as fixed objects (AASHTO Roadside Design Guide); the "
       "crown begins 2.9 m over the ground."},
      {"guard_rail", "Steel guard rail, two spans of 4 m", "barrier", 1500, 0.13, build_guard_rail,
       0.0, 180.0, 800.0, Vec3(0.0, 0.0, 0.55), "on the ground in the middle, the rail along x",
       "The W beam of EN 1317 systems in common use: 310 mm high, 81 mm deep, 3 mm thick, upper "
       "edge "
       "0.75 m over the ground, posts 4 m apart; 12 kg for each metre of beam."},
      {"van", "Panel van, high roof", "car", 10000, 0.16, build_van, 3.64, 2500.0, 7500.0,
       Vec3(2.11, 0.0, 0.75), "centre of the rear axle on the ground",
       "Volkswagen Crafter of 2017, medium wheelbase, from memory of its data sheet: 5.99 m x "
       "2.04 m x 2.59 m, wheelbase 3.64 m; 2,100 kg empty with driver, 400 kg of load. Kind car: "
       "strength, risk and yaw inertia (as for the hatch) follow its mass and length."},
      {"semitrailer", "Tractor with semi-trailer in line, 16.5 m", "truck", 16000, 0.20,
       build_semitrailer, 10.73, 30000.0, 697000.0, Vec3(3.95, 0.0, 1.60),
       "on the ground under the middle axle of the trailer",
       "Directive 96/53/EC: 16.50 m in all, 12.00 m behind the king pin, 2.04 m from it to any "
       "point of the trailer's front, 2.55 m wide, 4.00 m high, 40 t; tractor of 7.5 t, trailer "
       "of 6.8 t, laden by two thirds. Axles 7.70 m behind the king pin and 1.31 m apart, and a "
       "tractor wheelbase of 3.70 m, are usual. One rigid body: the coupling does not bend. "
       "Wheelbase: from the middle axle of the trailer to the steered one. Side guards of UN R73 "
       "bear 1 kN and are left out. Yaw inertia: an even block."},
      {"tram", "Low-floor tram of three sections, 30 m", "bus", 16000, 0.26, build_tram, 24.80,
       46800.0, 3.53e6, Vec3(12.40, 0.0, 1.40), "on the rails under the middle of the rear bogie",
       "Flexity Classic of Essen: 30 m x 2.30 m in three sections (International Railway "
       "Journal), 42 t (MVG, mhvg.de); and 64 seated passengers of 75 kg. Other measures are "
       "choices: roof equipment to 3.59 m, skirts from 0.27 m, wheels of 0.60 m, bogies of 1.80 m. "
       "Kind bus. One rigid body: sections do not bend, and rails do not hold it after a contact. "
       "Wheelbase: between the outer bogies. Yaw inertia: an even block."},
      {"wheelchair", "Hand-driven wheelchair with an adult", "pedestrian", 6000, 0.036,
       build_wheelchair, 0.42, 93.0, 3.5, Vec3(0.20, 0.0, 0.68),
       "centre of the axle of the large wheels on the ground",
       "Within ISO 7193 (1.20 m x 0.70 m, 1.09 m high without the person); wheels of 0.61 m, a "
       "chair of 18 kg and an adult of 75 kg: choices. Kind pedestrian: strength and injury risk "
       "of a person on foot, who falls and slides; the frame is as soft as the person and the "
       "wheels do not roll. Yaw inertia: radius of gyration of 0.19 m; state it, that of a person "
       "on foot is a third."},
  };
  return entries;
}

Model build_sized(const Entry& entry, std::size_t triangles) {
  const double wanted = static_cast<double>(triangles);
  const auto off = [&](const Model& model) {
    return std::abs(static_cast<double>(model.triangle_count()) / wanted - 1.0);
  };
  double edge = entry.start_edge * std::sqrt(static_cast<double>(entry.triangles) / wanted);
  Model best = entry.build(edge);
  Model last = best;
  for (int round = 0; round < 6 && off(best) >= 0.015; ++round) {
    edge *= std::sqrt(static_cast<double>(last.triangle_count()) / wanted);
    last = entry.build(edge);
    if (off(last) < off(best)) best = last;
  }
  return best;
}

std::string about(const Entry& entry) {
  return entry.title +
         ", made by crashrank-generate. Apache-2.0.\n# Metres; x forward, y left, z up; origin: " +
         entry.origin + ".";
}

std::string to_json(const Entry& entry, const Model& model) {
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = -low;
  double half_width = 0.0;
  for (const NamedMesh& part : model.parts) {
    for (const Vec3& v : part.mesh.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
      if (!stands_out(part.name)) half_width = std::max(half_width, std::abs(v.y()));
    }
  }
  nlohmann::ordered_json json;
  json["name"] = entry.name;
  json["file"] = entry.name + ".obj";
  json["title"] = entry.title;
  json["kind"] = entry.kind;
  json["triangles"] = model.triangle_count();
  json["parts"] = model.parts.size();
  json["length_m"] = thousandths(high.x() - low.x());
  json["width_m"] = thousandths(2.0 * half_width);
  json["width_over_mirrors_m"] = thousandths(high.y() - low.y());
  json["height_m"] = thousandths(high.z() - low.z());
  if (entry.wheelbase_m > 0.0) json["wheelbase_m"] = entry.wheelbase_m;
  json["mass_kg"] = entry.mass_kg;
  json["izz_kgm2"] = entry.izz_kgm2;
  json["center_of_mass_m"] = {entry.center_of_mass_m.x(), entry.center_of_mass_m.y(),
                              entry.center_of_mass_m.z()};
  json["origin"] = entry.origin;
  json["facts"] = entry.facts;
  return json.dump(2);
}

std::string to_row(const Entry& entry, const Model& model) {
  const auto json = nlohmann::json::parse(to_json(entry, model));
  const auto measure = [&](const char* key) { return json.at(key).get<double>(); };
  std::ostringstream row;
  row << std::fixed << std::setprecision(2) << "| " << entry.name << " | " << entry.title << " | "
      << grouped(measure("triangles")) << " | " << measure("length_m") << " × "
      << measure("width_m") << " × " << measure("height_m") << " | ";
  if (entry.wheelbase_m > 0.0) {
    row << entry.wheelbase_m;
  } else {
    row << "–";
  }
  row << " | " << grouped(entry.mass_kg) << " | " << grouped(entry.izz_kgm2) << " |\n";
  return row.str();
}

}  // namespace generate
