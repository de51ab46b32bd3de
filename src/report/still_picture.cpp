#include "report/still_picture.hpp"

#include "crashrank/report/ranking.hpp"
#include "report/scene_views.hpp"

#include <vector>

namespace crashrank::detail {

Result<std::string> still_picture(const Scenario& scenario, View<const Model> models,
                                  const RankResult& result, std::size_t place) {
  const std::vector<SceneView> views = scene_views(scenario, models, result, place);
  std::vector<PictureBody> bodies;
  bodies.reserve(views.size());
  for (const SceneView& view : views) {
    bodies.push_back({&models[view.model].mesh, view.damage.pose, view.damage.triangles});
  }
  constexpr double beside_deg = 40.0;
  PictureOptions options;
  options.width_px = 800;
  options.height_px = 420;
  options.azimuth_deg = azimuth_of_damage_deg(bodies.front()) + beside_deg;
  const Result<Image> image = draw_picture(bodies, options);
  if (!image) return image.error();
  return png(*image);
}

}  // namespace crashrank::detail
