#include "report/view_data.hpp"

#include "report/base64.hpp"
#include "report/palette.hpp"
#include "report/scene_views.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <set>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

constexpr Colour ego_paint{0.055F, 0.16F, 0.36F};
constexpr Colour other_paint{0.52F, 0.44F, 0.31F};

std::string hex(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", srgb(colour.red), srgb(colour.green),
                     srgb(colour.blue));
}

Json vector(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json model_json(const TriangleMesh& mesh) {
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    positions.insert(positions.end(), vertex.data(), vertex.data() + 3);
  }
  Json parts = Json::array();
  for (const Part& part : mesh.parts) {
    const std::string ego = hex(part_colour(part.name, ego_paint));
    const std::string other = hex(part_colour(part.name, other_paint));
    parts.push_back(Json::array({part.first_triangle, part.triangle_count, ego, other}));
  }
  return {
      {"positions", base64(positions.data(), positions.size() * sizeof(float))},
      {"indices", base64(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]))},
      {"parts", std::move(parts)}};
}

Json body_json(std::size_t model, const TriangleMesh& mesh, const BodyDamage& damage) {
  std::vector<std::uint8_t> bits((mesh.size() + 7) / 8, 0);
  for (const std::uint32_t triangle : damage.triangles) {
    bits[triangle / 8] = static_cast<std::uint8_t>(bits[triangle / 8] | 1U << triangle % 8);
  }
  Json pose = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.push_back(damage.pose.rotation(row, column));
    pose.push_back(damage.pose.translation[row]);
  }
  return {
      {"model", model}, {"pose", std::move(pose)}, {"damaged", base64(bits.data(), bits.size())}};
}

}  // namespace

ViewData view_data(const Scenario& scenario, View<const Model> models, const RankResult& result,
                   const std::vector<std::size_t>& places, std::size_t model_triangles) {
  ViewData data;
  std::set<std::size_t> used;
  const auto shown = [&](std::size_t model) {
    if (models[model].mesh.size() > model_triangles) {
      data.left_out = true;
      return false;
    }
    used.insert(model);
    return true;
  };
  Json scenes = Json::object();
  for (const std::size_t place : places) {
    const CandidateResult& ranked = result.ranking[place];
    // Who touches nothing is worth looking at where he is the best.
    if (ranked.contacts.empty() && place > 0) continue;
    Json bodies = Json::array();
    for (const SceneView& body : scene_views(scenario, models, result, place)) {
      if (shown(body.model)) {
        bodies.push_back(body_json(body.model, models[body.model].mesh, body.damage));
      }
    }
    if (bodies.empty()) continue;
    Eigen::Vector3d point;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitY();
    if (ranked.contacts.empty()) {
      point = result.candidates[ranked.candidate].motion.pose_at(scenario.horizon_s).translation;
    } else {
      point = ranked.contacts.front().point_m;
      normal = ranked.contacts.front().normal;
    }
    scenes[std::to_string(place + 1)] = {
        {"point", vector(point)}, {"normal", vector(normal)}, {"bodies", std::move(bodies)}};
  }
  Json meshes = Json::object();
  for (const std::size_t model : used) {
    meshes[std::to_string(model)] = model_json(models[model].mesh);
  }
  // Numbers, base64 and colours alone: nothing in it can end a script element.
  data.json = Json{{"models", std::move(meshes)}, {"scenes", std::move(scenes)}}.dump();
  return data;
}

}  // namespace crashrank::detail
