#include "tram.hpp"

#include "curve.hpp"
#include "field.hpp"
#include "seam.hpp"
#include "solids.hpp"
#include "surface.hpp"

#include <utility>

namespace generate {
namespace {

constexpr double end_length = 8.6;
constexpr double joint = 0.4;
constexpr double middle_length = 12.0;
constexpr double overhang = 2.6;  // from an end to the middle of its bogie
constexpr double roof_z = 3.26;
constexpr double skirt_z = 0.27;
constexpr double far = 40.0;
constexpr double across = -0.5;

// A section along x, `profile` from the side; ahead of `nose_x` it is drawn back towards its sides.
Field section(const Outline& profile, const Ramp& half, double nose_x) {
  const Ramp inset = {{0.3, 0.03}, {0.6, 0.0}, {2.2, 0.0}, {2.9, 0.06}, {3.25, 0.16}};
  return [=](const Vec3& p) {
    const double y = p.y() / 1.15;
    const double nose = 0.25 * std::clamp(p.x() - nose_x, 0.0, 2.0);
    const double bowed = p.x() + nose * (0.3 * y * y + 0.7 * y * y * y * y);
    const double ends = profile.distance({bowed, p.z() + 0.05 * y * y * std::max(0.0, p.z() - 2)});
    return smooth_max(ends, std::abs(p.y()) - half(p.x()) + inset(p.z()), 0.12);
  };
}

Panel side(const char* name, double from, double to, double low, double high) {
  return {name,
          View::side,
          rounded_polygon({{from, low}, {to, low}, {to, high}, {from, high}}),
          {-far, 0.7, 0},
          {far, far, far},
          true};
}

void add_rest(std::vector<Panel>* panels) {
  const Outline any = polygon({{-far, -far}, {far, -far}, {far, far}, {-far, far}});
  panels->push_back({"roof", View::top, any, {-far, -far, roof_z - 0.22}, {far, far, far}, false});
  panels->push_back({"floor", View::top, any, {-far, -far, 0}, {far, far, skirt_z + 0.05}, false});
  panels->push_back({"side", View::side, any, {-far, 0.9, 0}, {far, far, far}, true});
}

Model end_section(double edge) {
  const Outline profile({{8.40, skirt_z}, {8.54, 0.34}, {8.60, 0.55},   {8.60, 0.75},
                         {8.60, 0.95},    {8.50, 1.35}, {8.30, 1.90},   {8.02, 2.60},
                         {7.76, 3.00},    {7.40, 3.20}, {6.80, roof_z}, {4.00, roof_z},
                         {0, roof_z},     {0, roof_z},  {0, roof_z},    {0, skirt_z},
                         {0, skirt_z},    {0, skirt_z}, {4, skirt_z},   {8, skirt_z}});
  const Field body =
      section(profile, {{0, 1.15}, {6.6, 1.15}, {7.4, 1.12}, {8.0, 1.03}, {8.6, 0.84}}, 6.6);
  const auto front = [](const char* name, const std::vector<Vec2>& corners, bool paired) {
    return Panel{name,           View::front,     rounded_polygon(corners),
                 {7.2, -far, 0}, {far, far, far}, paired};
  };
  std::vector<Panel> panels = {
      front("windshield", {{across, 1.30}, {0.76, 1.34}, {0.72, 2.56}, {across, 2.66}}, false),
      front("headlamp", {{0.42, 0.86}, {0.74, 0.90}, {0.74, 1.06}, {0.42, 1.02}}, true),
      front("bumper", {{across, 0}, {2, 0}, {2, 0.74}, {across, 0.74}}, false),
      side("cab_window", 6.70, 7.55, 1.30, 2.45),
      side("door", 1.30, 2.60, 0.34, 2.45),
      side("window", 2.95, 6.30, 1.20, 2.45),
  };
  add_rest(&panels);
  Model model;
  const Mesh skin = extract_surface(body, {-0.6, -1.6, 0.0}, {9.2, 1.6, 3.8}, edge);
  add_panels(&model, body, skin, panels, "end", edge);
  model.add("roof_equipment", box({3.6, 0, 3.42}, {1.8, 0.75, 0.17}, 0.06, edge));
  return model;
}

Model middle_section(double edge) {
  const double l = middle_length;
  const Field body = section(polygon({{l, skirt_z}, {l, roof_z}, {0, roof_z}, {0, skirt_z}}),
                             {{0, 1.15}, {1, 1.15}}, far);
  std::vector<Panel> panels = {
      side("window_rear", 0.50, 3.90, 1.20, 2.45), side("door_rear", 4.25, 5.55, 0.34, 2.45),
      side("door_front", 6.45, 7.75, 0.34, 2.45), side("window_front", 8.10, 11.50, 1.20, 2.45)};
  add_rest(&panels);
  Model model;
  const Mesh skin = extract_surface(body, {-0.6, -1.6, 0.0}, {l + 0.6, 1.6, 3.8}, edge);
  add_panels(&model, body, skin, panels, "end", edge);
  model.add("roof_equipment", box({0.5 * l, 0, 3.42}, {3.5, 0.75, 0.17}, 0.06, edge));
  return model;
}

Model named(const std::string& prefix, Model model) {
  for (NamedMesh& part : model.parts) part.name = prefix + part.name;
  return model;
}

// Facing -x; the section is the same on both sides.
Model turned_round(Model model) {
  for (NamedMesh& part : model.parts) {
    for (Vec3& vertex : part.mesh.vertices) vertex.x() = -vertex.x();
    for (std::array<int, 3>& t : part.mesh.triangles) std::swap(t[1], t[2]);
  }
  return model;
}

void add_bogie(const std::string& place, double x, double edge, Model* model) {
  constexpr double half_base = 0.90;
  constexpr double radius = 0.30;
  constexpr double half_gauge = 0.50;
  const Vec3 half_tyre(0, 0.06, 0);
  for (const double axle_x : {x - half_base, x + half_base}) {
    const Vec3 wheel(axle_x, half_gauge, radius);
    model->add_both_sides("wheel_" + place,
                          bar(wheel - half_tyre, wheel + half_tyre, radius, radius, edge, 16));
    model->add("axle_" + place,
               bar({axle_x, -0.44, radius}, {axle_x, 0.44, radius}, 0.07, 0.07, edge));
  }
  model->add("bogie_" + place, box({x, 0, 0.42}, {1.20, 0.66, 0.10}, 0.0, edge));
}

}  // namespace

Model build_tram(double edge) {
  constexpr double rear_joint_x = end_length - overhang;
  constexpr double middle_x = rear_joint_x + joint;
  constexpr double front_joint_x = middle_x + middle_length;
  constexpr double front_x = front_joint_x + joint;
  const Model end = end_section(edge);
  Model model;
  model.append(named("front_", end), {front_x, 0, 0});
  model.append(named("middle_", middle_section(edge)), {middle_x, 0, 0});
  model.append(named("rear_", turned_round(end)), {rear_joint_x, 0, 0});
  for (const double x : {rear_joint_x, front_joint_x}) {
    model.add("bellows", box({x + 0.5 * joint, 0, 1.75}, {0.49 * joint, 1.02, 1.30}, 0.0, edge));
  }
  // Of the middle section's bogies, from its ends.
  constexpr double set_in = 2.0;
  for (const auto& [place, x] :
       {std::pair("rear", 0.0), std::pair("middle_rear", middle_x + set_in),
        std::pair("middle_front", front_joint_x - set_in),
        std::pair("front", front_x + end_length - overhang)}) {
    add_bogie(place, x, edge, &model);
  }
  return model;
}

}  // namespace generate
