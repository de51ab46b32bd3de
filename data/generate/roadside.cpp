#include "roadside.hpp"

#include "solids.hpp"

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

}  // namespace generate
