#include "roadside.hpp"

#include "field.hpp"
#include "solids.hpp"
#include "surface.hpp"

namespace generate {

Model build_jersey_barrier(double edge) {
  // Upright foot of 75 mm, 55 degrees to 330 mm, then 84 degrees to the top.
  const std::vector<Vec2> section = {{-0.305, 0.0},   {0.305, 0.0},   {0.305, 0.075},
                                     {0.127, 0.330},  {0.076, 0.810}, {-0.076, 0.810},
                                     {-0.127, 0.330}, {-0.305, 0.075}};
  Model model;
  model.add("barrier", prism(section, -2.0, 2.0, edge));
  return model;
}

Model build_pole(double edge) {
  Model model;
  model.add("pole", bar({0, 0, 0}, {0, 0, 6.0}, 0.127, 0.127, edge, 16));
  return model;
}

Model build_wall(double edge) {
  Model model;
  model.add("wall", box({0.125, 0, 1.25}, {0.125, 5.0, 1.25}, 0.0, edge));
  return model;
}

Model build_tree(double edge) {
  Model model;
  model.add("trunk", bar({0, 0, 0}, {0, 0, 3.2}, 0.20, 0.15, edge, 12));
  const Field crown = [](const Vec3& p) {
    const double lower = ellipsoid(p, {0, 0, 4.3}, {1.9, 1.9, 1.5});
    return smooth_min(lower, ellipsoid(p, {0, 0, 5.6}, {1.4, 1.4, 1.6}), 0.4);
  };
  model.add("crown", extract_surface(crown, {-2.4, -2.4, 2.4}, {2.4, 2.4, 7.6}, 4.0 * edge));
  return model;
}

Model build_guard_rail(double edge) {
  // The W beam's section, outer face towards -y: depth 81 mm, height 310 mm, its middle 0.6 m high.
  const std::vector<Vec2> section = {{-0.010, -0.155}, {-0.081, -0.115}, {-0.081, -0.075},
                                     {-0.010, -0.025}, {-0.010, 0.025},  {-0.081, 0.075},
                                     {-0.081, 0.115},  {-0.010, 0.155}};
  constexpr double half_length = 4.1;
  constexpr double thickness = 0.003;
  constexpr double middle_z = 0.60;
  const int along = steps(2.0 * half_length, edge);
  std::vector<std::vector<Vec3>> outer;
  std::vector<std::vector<Vec3>> inner;
  for (const Vec2& corner : section) {
    std::vector<Vec3> row;
    for (int i = 0; i <= along; ++i) {
      row.emplace_back(half_length * (2.0 * i / along - 1.0), corner.x(), middle_z + corner.y());
    }
    outer.push_back(row);
    for (Vec3& place : row) place.y() += thickness;
    inner.insert(inner.begin(), row);
  }
  Model model;
  model.add("beam", sheet(outer));
  model.add("beam", sheet(inner));
  for (const double x : {-4.0, 0.0, 4.0}) {
    const Vec3 middle(x, 0.06, 0.37);
    model.add("post", box(middle, {0.05, 0.05, 0.37}, 0.0, edge));
  }
  return model;
}

}  // namespace generate
