#include "crashrank/report/ranking.hpp"
#include "report/bytes.hpp"
#include "report/glb.hpp"
#include "report/page_track.hpp"
#include "report/palette.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Json = nlohmann::ordered_json;
using PoseKey = detail::Sample<4>;  ///< x, y, z, heading

/// Triangles of a model in one colour, of the ego and of others.
struct Coloured {
  detail::Colour of_ego;
  detail::Colour of_others;
  std::string name;     ///< of the first part
  std::string corners;  ///< four bytes each
  std::size_t indices = 0;
};

/// A model's arrays, which all bodies of that model share.
struct SharedModel {
  std::size_t positions = 0;
  std::vector<Coloured> coloured;
};

/// Adds keys in between, so that the shorter of two turns between keys is the right one.
detail::Track with_short_turns(const detail::Track& track) {
  constexpr double longest_rad = 1.5;
  detail::Track keys;
  for (const PoseKey& key : track) {
    const PoseKey last = keys.empty() ? key : keys.back();
    const int steps = 1 + static_cast<int>(std::abs(key.at[3] - last.at[3]) / longest_rad);
    for (int step = 1; step <= steps; ++step) {
      PoseKey between = key;
      if (step < steps) {
        const double share = static_cast<double>(step) / steps;
        between.time_s = last.time_s + share * (key.time_s - last.time_s);
        for (std::size_t k = 0; k < between.at.size(); ++k) {
          between.at[k] = last.at[k] + share * (key.at[k] - last.at[k]);
        }
      }
      const bool is_later = keys.empty() || static_cast<float>(between.time_s) >
                                                static_cast<float>(keys.back().time_s);
      if (is_later) keys.push_back(between);
    }
  }
  return keys;
}

/// x, y, z, w: the turn to the heading of a body that leans.
Eigen::Vector4f rotation_of(const PoseKey& key, const Eigen::Quaterniond& tilt) {
  // Not from a matrix: the sign does not jump at half turns.
  const double half = 0.5 * key.at[3];
  const Eigen::Quaterniond turn(std::cos(half), 0.0, 0.0, std::sin(half));
  return (turn * tilt).coeffs().cast<float>();
}

class AnimationWriter {
public:
  AnimationWriter(const Scenario& scenario, View<const Model> models, const RankResult& result,
                  const CandidateResult& ranked)
      : scenario_(scenario),
        models_(models),
        ranked_(ranked),
        plan_(result.candidates[ranked.candidate]),
        shared_(models.size()) {}

  Result<std::string> write() {
    add_body(ego_body, "ego", scenario_.ego.model, scenario_.ego.pose, plan_.motion);
    for (std::size_t i = 0; i < scenario_.actors.size(); ++i) {
      const ScenarioActor& actor = scenario_.actors[i];
      if (!(actor.existence_probability > 0.0)) continue;
      add_body(i, actor.name, actor.model, actor.pose, detail::motion_of(actor));
    }
    Json children = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) children.push_back(i);
    nodes_.push_back({{"name", scenario_.name},
                      {"rotation", detail::gltf_axes()},
                      {"children", std::move(children)}});
    Json document{{"nodes", std::move(nodes_)},
                  {"meshes", std::move(meshes_)},
                  {"materials", std::move(materials_)}};
    if (!channels_.empty()) {
      document["animations"] = Json::array({{{"name", plan_.name},
                                             {"samplers", std::move(samplers_)},
                                             {"channels", std::move(channels_)}}});
    }
    return detail::glb_file(std::move(document), std::move(arrays_));
  }

private:
  /// Without a recorded motion all ends at the first contact, as in the page.
  double end_s() const {
    return ranked_.motion.empty() && !ranked_.contacts.empty()
               ? ranked_.contacts.front().time_of_impact_s
               : detail::played_end_s(scenario_, ranked_);
  }

  void add_body(std::size_t body, const std::string& name, std::size_t model, const Pose& start,
                const Motion& plan) {
    constexpr std::array<double, 4> tolerance{5e-4, 5e-4, 5e-4, 5e-4};
    const auto simulated =
        std::find_if(ranked_.motion.begin(), ranked_.motion.end(),
                     [body](const BodyMotion& motion) { return motion.body == body; });
    const detail::Track keys = with_short_turns(detail::thinned(
        detail::track_of(plan, simulated == ranked_.motion.end() ? nullptr : &*simulated, end_s()),
        tolerance));
    const Eigen::Quaterniond tilt(detail::tilt_of(start));
    const Eigen::Vector4f rotation = rotation_of(keys.front(), tilt);
    const auto& place = keys.front().at;
    nodes_.push_back({{"name", name},
                      {"mesh", mesh_of(model, body == ego_body)},
                      {"translation", {place[0], place[1], place[2]}},
                      {"rotation", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}}});
    if (keys.size() > 1) add_keys(keys, tilt);
  }

  /// Of the last node.
  void add_keys(const detail::Track& keys, const Eigen::Quaterniond& tilt) {
    std::string times;
    std::string translations;
    std::string rotations;
    for (const PoseKey& key : keys) {
      detail::put_f32(times, static_cast<float>(key.time_s));
      for (std::size_t k = 0; k < 3; ++k) {
        detail::put_f32(translations, static_cast<float>(key.at[k]));
      }
      for (const float value : rotation_of(key, tilt)) detail::put_f32(rotations, value);
    }
    const auto add = [&](const std::string& bytes, const char* type) {
      return arrays_.add(
          bytes, 0,
          {{"componentType", detail::gltf_float}, {"count", keys.size()}, {"type", type}});
    };
    const std::size_t input = add(times, "SCALAR");
    arrays_.accessors[input]["min"] = {static_cast<float>(keys.front().time_s)};
    arrays_.accessors[input]["max"] = {static_cast<float>(keys.back().time_s)};
    const auto channel = [&](const char* path, std::size_t output) {
      channels_.push_back({{"sampler", samplers_.size()},
                           {"target", {{"node", nodes_.size() - 1}, {"path", path}}}});
      samplers_.push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
    };
    channel("translation", add(translations, "VEC3"));
    channel("rotation", add(rotations, "VEC4"));
  }

  const SharedModel& shared_of(std::size_t model) {
    if (shared_[model]) return *shared_[model];
    const TriangleMesh& mesh = models_[model].mesh;
    SharedModel& shared = shared_[model].emplace();
    for (const Part& part : mesh.parts) {
      if (part.triangle_count == 0) continue;
      const detail::Colour of_ego = detail::part_colour(part.name, detail::ego_paint);
      const detail::Colour of_others = detail::part_colour(part.name, detail::other_paint);
      auto found =
          std::find_if(shared.coloured.begin(), shared.coloured.end(), [&](const Coloured& known) {
            return known.of_ego == of_ego && known.of_others == of_others;
          });
      if (found == shared.coloured.end()) {
        found = shared.coloured.insert(found, {of_ego, of_others, part.name, {}, 0});
      }
      for (std::uint32_t i = 0; i < part.triangle_count; ++i) {
        for (const std::uint32_t vertex : mesh.triangles[part.first_triangle + i]) {
          detail::put_u32(found->corners, vertex);
        }
      }
    }
    shared.positions = arrays_.add_positions(mesh.vertices);
    for (Coloured& one : shared.coloured) {
      one.indices = arrays_.add_indices(std::exchange(one.corners, {}));
    }
    return shared;
  }

  std::size_t material_of(const std::string& name, const detail::Colour& colour) {
    const auto found = std::find(colours_.begin(), colours_.end(), colour);
    const auto material = static_cast<std::size_t>(found - colours_.begin());
    if (found == colours_.end()) {
      colours_.push_back(colour);
      materials_.push_back(detail::gltf_material(name, colour));
    }
    return material;
  }

  std::size_t mesh_of(std::size_t model, bool is_ego) {
    const auto [known, is_new] = mesh_by_.try_emplace({model, is_ego}, meshes_.size());
    if (!is_new) return known->second;
    const SharedModel& shared = shared_of(model);
    Json primitives = Json::array();
    for (const Coloured& one : shared.coloured) {
      primitives.push_back(
          detail::gltf_triangles(shared.positions, one.indices,
                                 material_of(one.name, is_ego ? one.of_ego : one.of_others)));
    }
    meshes_.push_back(
        {{"name", scenario_.models[model].name}, {"primitives", std::move(primitives)}});
    return known->second;
  }

  const Scenario& scenario_;
  View<const Model> models_;
  const CandidateResult& ranked_;
  const Candidate& plan_;
  std::vector<std::optional<SharedModel>> shared_;  ///< by model
  std::map<std::pair<std::size_t, bool>, std::size_t> mesh_by_;
  std::vector<detail::Colour> colours_;  ///< by material
  detail::GlbArrays arrays_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  Json materials_ = Json::array();
  Json samplers_ = Json::array();
  Json channels_ = Json::array();
};

}  // namespace

Result<std::string> ranking_animation(const Scenario& scenario, View<const Model> models,
                                      const RankResult& result, std::size_t place) {
  if (place >= result.ranking.size()) {
    return make_error(ErrorCode::usage,
                      fmt::format("there is no candidate in row {} of a ranking of {}", place,
                                  result.ranking.size()),
                      "name a row from 0 on that it has");
  }
  const Scenario shown = is_uncertain(scenario) ? likeliest_future(scenario) : Scenario{};
  return AnimationWriter(is_uncertain(scenario) ? shown : scenario, models, result,
                         result.ranking[place])
      .write();
}

}  // namespace crashrank
