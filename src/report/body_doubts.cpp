#include "report/body_doubts.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/internal/interop/pi.hpp"
#include "crashrank/internal/motion/containment.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "report/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

/// What bodies of a kind are like, with room for rare ones; trams are buses, the longest of 56 m
/// (Budapest).
struct Plausible {
  BodyKind kind;
  double min_length_m;
  double max_length_m;
  double min_mass_kg;
  double max_mass_kg;
};

constexpr std::array<Plausible, 6> plausible_bodies{{{BodyKind::car, 2.0, 7.5, 250.0, 6000.0},
                                                     {BodyKind::truck, 3.5, 26.0, 1000.0, 80'000.0},
                                                     {BodyKind::bus, 4.5, 60.0, 1500.0, 100'000.0},
                                                     {BodyKind::motorcycle, 1.2, 3.5, 40.0, 900.0},
                                                     {BodyKind::bicycle, 0.8, 3.5, 8.0, 500.0},
                                                     {BodyKind::pedestrian, 0.4, 2.5, 5.0, 300.0}}};

const Plausible* plausible(BodyKind kind) {
  const auto found = std::find_if(plausible_bodies.begin(), plausible_bodies.end(),
                                  [kind](const Plausible& known) { return known.kind == kind; });
  return found == plausible_bodies.end() ? nullptr : found;
}

bool drives(BodyKind kind) { return plausible(kind) != nullptr && kind != BodyKind::pedestrian; }

/// A body at time 0.
struct Placed {
  const Model* model;
  BodyKind kind;
  Pose pose;
  Eigen::Vector3d min_m;  ///< corners of its box in world axes
  Eigen::Vector3d max_m;
};

Placed place(const Model& model, BodyKind kind, const Pose& pose) {
  Placed body{&model, kind, pose, {}, {}};
  const Box box = model.mesh.bounds();
  const Eigen::Vector3d middle = carry(pose, box.center());
  const Eigen::Vector3d half = pose.rotation.cwiseAbs() * (0.5 * box.extent().cast<double>());
  body.min_m = middle - half;
  body.max_m = middle + half;
  return body;
}

bool boxes_overlap(const Placed& a, const Placed& b) {
  return (a.min_m.array() <= b.max_m.array()).all() && (b.min_m.array() <= a.max_m.array()).all();
}

bool bodies_overlap(const Placed& a, const Placed& b, ModelWorkspace& workspace,
                    std::vector<Pair>& pairs) {
  if (!boxes_overlap(a, b)) return false;
  const Pose b_in_a = relative(a.pose, b.pose);
  CollideOptions how;
  how.any = true;
  workspace.prepare(*a.model, *b.model);
  if (collide(*a.model, *b.model, b_in_a, pairs, workspace, how).intersecting) return true;
  return containment(a.model->tree, b.model->tree, b_in_a) != Containment::apart;
}

std::string size_text(const Eigen::Vector3d& extent_m) {
  return fmt::format("{:.3g} x {:.3g} x {:.3g} m", extent_m.x(), extent_m.y(), extent_m.z());
}

/// Models that a body has, each once.
std::vector<std::size_t> used_models(const RankResult& result) {
  std::vector<std::size_t> used{result.ego.model};
  for (const RankedBody& actor : result.actors) used.push_back(actor.model);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

void doubt_shapes(const Scenario& scenario, View<const Model> models, const RankResult& result,
                  std::vector<std::string>& doubts) {
  for (const std::size_t i : used_models(result)) {
    const ScenarioModel& model = scenario.models[i];
    const Plausible* const known = plausible(model.kind);
    if (known == nullptr) continue;
    const Eigen::Vector3d extent_m = models[i].mesh.bounds().extent().cast<double>();
    const std::string body_text =
        fmt::format("models.{}: the {} is {} (length x width x height)", model.name,
                    body_kind_name(model.kind), size_text(extent_m));
    const double longest = extent_m.maxCoeff();
    if (longest < known->min_length_m || longest > known->max_length_m) {
      doubts.push_back(fmt::format("{}, but such a body is {:g} to {:g} m long; check its scale",
                                   body_text, known->min_length_m, known->max_length_m));
    }
    // As make_profile, which lets such a body stand on its lowest point.
    constexpr double below_ground_m = 0.3;
    const auto lowest_m = static_cast<double>(models[i].mesh.bounds().min.z());
    if (lowest_m < -below_ground_m) {
      doubts.push_back(fmt::format(
          "{}: it reaches {:.2g} m below the ground (z = 0 of its mesh) and is taken to stand on "
          "its "
          "lowest point; is it upside down, or its origin not on the ground? Check up and origin",
          body_text, -lowest_m));
    }
    if (!drives(model.kind)) continue;
    const MeshReading reading = guess_reading(models[i].mesh, model.transform, false);
    if (reading.has_axes_of(model.transform)) continue;
    doubts.push_back(
        model.box_m
            ? fmt::format("{}: it seems turned; box is [length, width, height]", body_text)
            : fmt::format("{}: it seems turned, by {}; read its mesh with up {} and forward "
                          "{}{}",
                          body_text, reading.shown_by, axis_name(reading.up),
                          axis_name(reading.forward),
                          reading.front_known ? "" : " or the opposite"));
  }
}

/// Says that the shape of a body is a guess.
void doubt_boxes(const Scenario& scenario, const RankResult& result,
                 std::vector<std::string>& doubts) {
  Counted boxes;
  for (const std::size_t i : used_models(result)) {
    const ScenarioModel& model = scenario.models[i];
    if (!model.box_m) continue;
    boxes.add(fmt::format("models.{} is a {} of {}", model.name, body_kind_name(model.kind),
                          size_text(*model.box_m)));
  }
  if (boxes.count == 0) return;
  doubts.push_back(fmt::format(
      "{} no mesh but a box, and the usual shape of its kind stretched to it: {}; name its mesh "
      "where there is one",
      boxes.many("body has", "bodies have"), boxes.examples()));
}

void doubt_masses(const Scenario& scenario, const RankResult& result,
                  std::vector<std::string>& doubts) {
  std::vector<std::size_t> seen;
  const auto doubt = [&](const RankedBody& body) {
    const ScenarioModel& model = scenario.models[body.model];
    const Plausible* const known = plausible(model.kind);
    if (known == nullptr || body.mass_guessed || !std::isfinite(body.mass_kg)) return;
    if (body.mass_kg >= known->min_mass_kg && body.mass_kg <= known->max_mass_kg) return;
    if (std::find(seen.begin(), seen.end(), body.model) != seen.end()) return;
    seen.push_back(body.model);
    doubts.push_back(
        fmt::format("models.{}: the {} has a mass of {:g} kg, but such a body has {:g} to {:g} kg; "
                    "give mass_kg "
                    "in kg",
                    model.name, body_kind_name(model.kind), body.mass_kg, known->min_mass_kg,
                    known->max_mass_kg));
  };
  doubt(result.ego);
  for (const RankedBody& actor : result.actors) doubt(actor);
}

/// Where a body stands, and the rise of its ground per metre. Level for bodies that lie.
struct Standing {
  Eigen::Vector3d at_m;
  Eigen::Vector2d slope;
  bool on_wheels;  ///< poles and persons stand upright on a slope
};

/// Steeper than any road.
constexpr double least_upright = 0.8;

Standing standing(const Placed& body) {
  const Eigen::Vector3d up = body.pose.rotation.col(2);
  if (!(up.z() >= least_upright)) {
    return {{body.pose.translation.x(), body.pose.translation.y(), body.min_m.z()},
            {0.0, 0.0},
            drives(body.kind)};
  }
  const auto lowest_m = static_cast<double>(body.model->mesh.bounds().min.z());
  return {body.pose.translation + lowest_m * up, -up.head<2>() / up.z(), drives(body.kind)};
}

/// How far the ground rises from the ego to an actor, at least and at most: on planes through the
/// ego and vehicles near the actor, itself included.
std::pair<double, double> ground_rise_m(const Standing& ego, const std::vector<Standing>& actors,
                                        std::size_t actor) {
  constexpr double near_m = 30.0;
  const Eigen::Vector2d way = (actors[actor].at_m - ego.at_m).head<2>();
  double lowest = ego.slope.dot(way);
  double highest = lowest;
  for (const Standing& other : actors) {
    if (!other.on_wheels || !((other.at_m - actors[actor].at_m).norm() <= near_m)) continue;
    lowest = std::min(lowest, other.slope.dot(way));
    highest = std::max(highest, other.slope.dot(way));
  }
  return {lowest, highest};
}

/// Heights are compared with the ego's: the world's ground may lie at any height and slope.
void doubt_heights(const Scenario& scenario, const RankResult& result, const Placed& ego,
                   const std::vector<Placed>& actors, std::vector<std::string>& doubts) {
  constexpr double least_m = 0.5;
  constexpr double steepest = 0.1;
  const Standing own = standing(ego);
  std::vector<Standing> stand;
  stand.reserve(actors.size());
  for (const Placed& actor : actors) stand.push_back(standing(actor));
  Counted above;
  Counted below;
  std::size_t movable = 0;
  double least_drop_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < actors.size(); ++i) {
    const Placed& actor = actors[i];
    if (i < result.actors.size() && !result.actors[i].has_outline) continue;
    const double distance_m = (actor.pose.translation - ego.pose.translation).head<2>().norm();
    const double allowed_m = least_m + steepest * distance_m;
    const double rise_m = stand[i].at_m.z() - own.at_m.z();
    const auto [lowest_m, highest_m] = ground_rise_m(own, stand, i);
    const double above_m = rise_m - highest_m;
    const double below_m = lowest_m - rise_m;
    const bool fixed = plausible(actor.kind) == nullptr;
    movable += fixed ? 0 : 1;
    if (above_m > allowed_m) {
      above.add(fmt::format("'{}' by {:.2g} m", scenario.actors[i].name, above_m));
    } else if (below_m > allowed_m && !fixed) {
      least_drop_m = std::min(least_drop_m, below_m);
      below.add(fmt::format("'{}' by {:.2g} m", scenario.actors[i].name, below_m));
    }
  }
  if (below.count > 0 && below.count == movable) {
    doubts.push_back(fmt::format(
        "the ego floats: it stands {:.2g} m or more above {}; check z_m of its pose and its mesh",
        least_drop_m, movable == 1 ? "the other" : "all others"));
    return;
  }
  if (above.count > 0) {
    doubts.push_back(fmt::format(
        "{} above the ground that the ego stands on: {}; check z_m of the pose and the mesh",
        above.many("body floats", "bodies float"), above.examples()));
  }
  if (below.count > 0) {
    doubts.push_back(fmt::format(
        "{} below the ground that the ego stands on: {}; check z_m of the pose and the mesh",
        below.many("body lies", "bodies lie"), below.examples()));
  }
}

/// Crashes read the outlines of a mesh that stands, whatever roll and pitch of the pose.
void doubt_lying(const Scenario& scenario, const Placed& ego, const std::vector<Placed>& actors,
                 std::vector<std::string>& doubts) {
  Counted lying;
  const auto doubt = [&](const Placed& body, const std::string& name, std::size_t model) {
    const double up = body.pose.rotation(2, 2);
    if (up >= least_upright) return;
    constexpr double deg_per_rad = 180.0 / pi;
    lying.add(fmt::format("'{}' by {:.0f} degrees (models.{})", name,
                          deg_per_rad * std::acos(std::clamp(up, -1.0, 1.0)),
                          scenario.models[model].name));
  };
  doubt(ego, "ego", scenario.ego.model);
  for (std::size_t i = 0; i < actors.size(); ++i) {
    doubt(actors[i], scenario.actors[i].name, scenario.actors[i].model);
  }
  if (lying.count == 0) return;
  doubts.push_back(fmt::format(
      "{} turned out of the upright by the pose, but crashes as if it stood: {}; give the model "
      "the axes up and forward that lay its mesh, and a level pose",
      lying.many("body is", "bodies are"), lying.examples()));
}

void doubt_overlaps(const Scenario& scenario, const std::vector<Placed>& actors,
                    std::vector<std::string>& doubts) {
  Counted overlaps;
  ModelWorkspace workspace;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < actors.size(); ++i) {
    for (std::size_t k = i + 1; k < actors.size(); ++k) {
      // Walls and poles may be put together from pieces.
      if (plausible(actors[i].kind) == nullptr && plausible(actors[k].kind) == nullptr) continue;
      const auto exists = [&](std::size_t of) {
        return scenario.actors[of].existence_probability > 0.0;
      };
      if (!exists(i) || !exists(k)) continue;
      if (!bodies_overlap(actors[i], actors[k], workspace, pairs)) continue;
      overlaps.add(fmt::format("'{}' and '{}'", scenario.actors[i].name, scenario.actors[k].name));
    }
  }
  if (overlaps.count == 0) return;
  doubts.push_back(fmt::format("{} at time 0: {}; move them apart",
                               overlaps.many("pair of bodies overlaps", "pairs of bodies overlap"),
                               overlaps.examples()));
}

}  // namespace

void Counted::add(const std::string& words) {
  if (count < described) first += (count == 0 ? "" : "; ") + words;
  ++count;
}

std::string Counted::examples() const {
  return count <= described ? first : fmt::format("{}; and {} more", first, count - described);
}

std::string Counted::many(const char* one, const char* more) const {
  return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more);
}

void doubt_bodies(const Scenario& scenario, View<const Model> models, const RankResult& result,
                  std::vector<std::string>& doubts) {
  doubt_boxes(scenario, result, doubts);
  doubt_shapes(scenario, models, result, doubts);
  doubt_masses(scenario, result, doubts);
  const ScenarioEgo& own = scenario.ego;
  const Placed ego = place(models[own.model], scenario.models[own.model].kind, own.pose);
  std::vector<Placed> actors;
  for (const ScenarioActor& actor : scenario.actors) {
    const Pose& pose = actor.poses.empty() ? actor.pose : actor.poses.front().pose;
    actors.push_back(place(models[actor.model], scenario.models[actor.model].kind, pose));
  }
  doubt_lying(scenario, ego, actors, doubts);
  doubt_heights(scenario, result, ego, actors, doubts);
  doubt_overlaps(scenario, actors, doubts);
}

}  // namespace crashrank::detail
