#include "report/page_data.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "report/contact_order.hpp"
#include "report/damage_summary.hpp"
#include "report/page_mesh.hpp"
#include "report/page_rows.hpp"
#include "report/page_track.hpp"
#include "report/plan_view.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

/// To the millimetre, millisecond and so on.
double thousandths(double value) { return std::round(1e3 * value) / 1e3; }

Json plane_json(const Eigen::Vector2d& v) {
  return Json::array({thousandths(v.x()), thousandths(v.y())});
}

/// Bodies on a page: -1 is the ego, others are indices into Scenario::actors.
int number_of(std::size_t body) { return body == ego_body ? -1 : static_cast<int>(body); }

bool is_fixed(BodyKind kind) {
  return kind == BodyKind::barrier || kind == BodyKind::pole || kind == BodyKind::building;
}

Json ring_json(const std::vector<Eigen::Vector2d>& ring) {
  Json corners = Json::array();
  for (const Eigen::Vector2d& corner : ring) corners.push_back(plane_json(corner));
  return corners;
}

/// One side of a contact.
struct Side {
  std::size_t body = ego_body;
  const BodyOutcome* outcome = nullptr;
  const BodyDamage* damage = nullptr;
};

/// A contact of two sides, the ego's or between others.
struct Meeting {
  explicit Meeting(const AnyContact& contact) : time_s(contact.time_s()) {
    if (const Contact* own = contact.own; own != nullptr) {
      sides = {Side{ego_body, &own->severity.ego, &own->ego},
               Side{own->actor, &own->severity.other, &own->other}};
      point_m = own->point_m;
      closing_mps = own->closing_speed_mps;
      duration_s = own->severity.duration_s;
      harm = own->severity.harm;
    } else {
      const FurtherContact& further = *contact.further;
      sides = {Side{further.a, &further.outcome_a, &further.damage_a},
               Side{further.b, &further.outcome_b, &further.damage_b}};
      point_m = further.point_m;
      closing_mps = further.closing_speed_mps;
      duration_s = further.duration_s;
      harm = further.harm;
    }
  }

  double time_s;
  std::array<Side, 2> sides{};
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  double closing_mps = 0.0;
  double duration_s = 0.0;
  double harm = 0.0;
};

/// Change of a body's velocity in world axes.
Json kick_json(const Side& side) {
  const Eigen::Vector3d kick =
      side.damage->pose.rotation *
      Eigen::Vector3d(side.outcome->delta_v_x_mps, side.outcome->delta_v_y_mps, 0.0);
  return plane_json(kick.head<2>());
}

Json contacts_json(const CandidateResult& ranked) {
  Json contacts = Json::array();
  for (const AnyContact& each : contacts_in_order(ranked)) {
    const Meeting contact(each);
    contacts.push_back(
        {{"t", thousandths(contact.time_s)},
         {"bodies", {number_of(contact.sides[0].body), number_of(contact.sides[1].body)}},
         {"at",
          {thousandths(contact.point_m.x()), thousandths(contact.point_m.y()),
           thousandths(contact.point_m.z())}},
         {"closing", thousandths(contact.closing_mps)},
         {"kicks", {kick_json(contact.sides[0]), kick_json(contact.sides[1])}},
         {"harm", thousandths(contact.harm)}});
  }
  return contacts;
}

/// Where contacts press a body in: from the time, for the duration, along the direction (body
/// axes), to the depth, within the box.
Json dents_json(const CandidateResult& ranked, std::size_t body) {
  constexpr double least_m = 0.02;
  constexpr double rad_per_deg = 0.017453292519943295;
  Json dents = Json::array();
  for (const AnyContact& each : contacts_in_order(ranked)) {
    const Meeting contact(each);
    for (const Side& side : contact.sides) {
      const Box& box = side.damage->region;
      if (side.body != body || side.outcome->crush_m < least_m || box.empty()) continue;
      const double from = rad_per_deg * side.outcome->pdof_deg;
      dents.push_back(
          {{"t", thousandths(contact.time_s)},
           {"for", thousandths(contact.duration_s)},
           {"along", {thousandths(-std::cos(from)), thousandths(std::sin(from))}},
           {"depth", thousandths(side.outcome->crush_m)},
           {"box",
            {thousandths(box.min.x()), thousandths(box.min.y()), thousandths(box.min.z()),
             thousandths(box.max.x()), thousandths(box.max.y()), thousandths(box.max.z())}}});
    }
  }
  return dents;
}

Json futures_json(const CandidateResult& ranked) {
  constexpr std::size_t most = 24;
  Json futures = Json::array();
  if (ranked.futures.size() < 2) return futures;
  for (const FutureOutcome& future : ranked.futures) {
    if (futures.size() == most) break;
    Json entry{{"p", thousandths(future.probability)},
               {"score", std::stod(fmt::format("{:.4g}", future.score))},
               {"likeliest", future.is_likeliest}};
    if (future.collides) {
      entry["body"] = future.actor;
      entry["t"] = thousandths(future.time_of_impact_s);
      entry["closing"] = thousandths(future.closing_speed_mps);
    }
    if (future.leaves_road) entry["leaves"] = true;
    futures.push_back(std::move(entry));
  }
  return futures;
}

class Writer {
public:
  Writer(const Scenario& asked, const Scenario& scenario, View<const Model> models,
         const RankResult& result, const std::vector<std::size_t>& places,
         std::size_t model_triangles)
      : asked_(asked),
        scenario_(scenario),
        models_(models),
        result_(result),
        places_(places),
        meshes_(models.size()),
        most_triangles_(std::min(most_page_triangles, model_triangles)) {
    for (const ScenarioActor& actor : scenario.actors) plans_.push_back(motion_of(actor));
    until_s_ = scenario.horizon_s;
    for (const std::size_t place : places)
      until_s_ = std::max(until_s_, played_end_s(scenario, result.ranking[place]));
  }

  Json write(const std::vector<std::string>& scores) {
    Json candidates = Json::array();
    for (const std::size_t place : places_) candidates.push_back(candidate_json(place));
    Json actors = Json::array();
    for (std::size_t i = 0; i < scenario_.actors.size(); ++i) actors.push_back(actor_json(i));
    Json road = Json::array();
    for (const Area& area : scenario_.road.drivable) {
      Json rings = Json::array({ring_json(area.outer)});
      for (const auto& hole : area.holes) rings.push_back(ring_json(hole));
      road.push_back(std::move(rings));
    }
    Json rows = Json::array();
    for (std::size_t place = 0; place < result_.ranking.size(); ++place) {
      rows.push_back(row_json(page_row(scenario_, result_, scores, place)));
    }
    Json models = Json::array();
    for (std::size_t i = 0; i < models_.size(); ++i) models.push_back(model_json(i));
    return {{"measure", measure_name(result_.measure)},
            {"unit", measure_unit(result_.measure)},
            {"full", full_bar(result_)},
            {"horizon", scenario_.horizon_s},
            {"ego", {{"model", scenario_.ego.model}, {"tilt", tilt_json(scenario_.ego.pose)}}},
            {"models", std::move(models)},
            {"actors", std::move(actors)},
            {"road", std::move(road)},
            {"candidates", std::move(candidates)},
            {"rows", std::move(rows)},
            {"stability", stability_json(result_)}};
  }

  bool is_coarser() const {
    return std::any_of(meshes_.begin(), meshes_.end(),
                       [](const auto& mesh) { return mesh && mesh->is_coarser(); });
  }

private:
  const PageMesh& mesh_of(std::size_t model) {
    if (!meshes_[model]) meshes_[model].emplace(models_[model].mesh, most_triangles_);
    return *meshes_[model];
  }

  Json model_json(std::size_t model) {
    const Box box = models_[model].mesh.bounds();
    Json outline = Json::array();
    for (const Eigen::Vector2d& corner : outline_of(models_[model].mesh)) {
      outline.push_back(plane_json(corner));
    }
    const BodyKind kind = scenario_.models[model].kind;
    Json entry{{"kind", body_kind_name(kind)},
               {"fixed", is_fixed(kind)},
               {"height", box.empty() ? 0.0 : thousandths(box.max.z())},
               {"outline", std::move(outline)}};
    // Of models that no body of the page has, nothing is drawn.
    if (is_used(model)) entry["mesh"] = mesh_of(model).json();
    return entry;
  }

  bool is_used(std::size_t model) const {
    return !places_.empty() &&
           (model == scenario_.ego.model ||
            std::any_of(scenario_.actors.begin(), scenario_.actors.end(),
                        [model](const ScenarioActor& actor) { return actor.model == model; }));
  }

  /// How a body leans beside its heading, row by row; null where it stands upright.
  static Json tilt_json(const Pose& pose) {
    const Eigen::Matrix3d tilt = tilt_of(pose);
    constexpr double rounding = 1e-6;
    if ((tilt - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < rounding) return nullptr;
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rows.push_back(thousandths(tilt(row, column)));
    }
    return rows;
  }

  Json actor_json(std::size_t i) {
    const ScenarioActor& actor = scenario_.actors[i];
    const double existence = asked_.actors[i].existence_probability;
    Json plan = track_json(track_of(plans_[i], until_s_));
    Json others = Json::array();
    double elsewhere = 1.0 - existence;
    const auto add = [&](const ActorMotion& stated, double probability) {
      Json track = track_json(track_of(motion_of(stated), until_s_));
      if (track == plan) return;
      elsewhere += probability;
      others.push_back({{"p", thousandths(probability)}, {"plan", std::move(track)}});
    };
    for (const Prediction& prediction : asked_.actors[i].predictions) {
      add(prediction, prediction.probability * existence);
    }
    for (const JointFuture& future : asked_.futures) {
      for (const FutureMotion& moved : future.motions) {
        if (moved.actor == i) add(moved.motion, future.probability);
      }
      const bool is_absent =
          std::find(future.absent.begin(), future.absent.end(), i) != future.absent.end();
      if (is_absent) elsewhere += future.probability;
    }
    return {{"name", escape_terminal(actor.name)},
            {"model", actor.model},
            {"tilt", tilt_json(actor.pose)},
            {"p", thousandths(std::max(0.0, 1.0 - elsewhere))},
            {"exists", actor.existence_probability > 0.0},
            {"plan", std::move(plan)},
            {"others", std::move(others)}};
  }

  Json candidate_json(std::size_t place) {
    const CandidateResult& ranked = result_.ranking[place];
    const Motion& plan = result_.candidates[ranked.candidate].motion;
    // Damage of every body that a contact touches, and its simulated motion where there is one.
    std::map<int, Json> bodies;
    if (!ranked.contacts.empty()) {
      bodies[-1]["damage"] = mesh_of(scenario_.ego.model).damage(ranked.ego.triangles);
    }
    for (const DamagedBody& body : damaged_others(scenario_, models_, ranked)) {
      bodies[number_of(body.actor)]["damage"] =
          mesh_of(scenario_.actors[body.actor].model).damage(body.damage.triangles);
    }
    for (auto& [number, body] : bodies) {
      Json dents = dents_json(ranked, number < 0 ? ego_body : static_cast<std::size_t>(number));
      if (!dents.empty()) body["dents"] = std::move(dents);
    }
    for (const BodyMotion& motion : ranked.motion) {
      if (motion.t_s.empty()) continue;
      Json& body = bodies[number_of(motion.body)];
      body["motion"] =
          track_json(track_of(motion, motion.body == ego_body ? plan : plans_[motion.body]));
      body["exposure"] = exposure_json(motion);
    }
    Json list = Json::array();
    for (auto& [number, body] : bodies) {
      Json entry{{"body", number}};
      entry.update(body);
      list.push_back(std::move(entry));
    }
    Json entry{{"row", place},
               {"end", thousandths(played_end_s(scenario_, ranked))},
               {"plan", track_json(track_of(plan, until_s_))},
               {"bodies", std::move(list)},
               {"contacts", contacts_json(ranked)},
               {"futures", futures_json(ranked)}};
    if (ranked.leaves_road) {
      entry["leaves"] = {{"t", thousandths(ranked.leaves_road->time_s)},
                         {"at", plane_json(ranked.leaves_road->point_m)}};
    }
    return entry;
  }

  const Scenario& asked_;
  const Scenario& scenario_;
  View<const Model> models_;
  const RankResult& result_;
  const std::vector<std::size_t>& places_;
  std::vector<Motion> plans_;                    ///< by actor
  std::vector<std::optional<PageMesh>> meshes_;  ///< by model, made when first asked for
  std::size_t most_triangles_;
  double until_s_ = 0.0;
};

}  // namespace

PageData page_data(const Scenario& asked, const Scenario& scenario, View<const Model> models,
                   const RankResult& result, const std::vector<std::string>& scores,
                   const std::vector<std::size_t>& places, std::size_t model_triangles) {
  Writer writer(asked, scenario, models, result, places, model_triangles);
  const std::string text =
      writer.write(scores).dump(-1, ' ', false, Json::error_handler_t::replace);
  PageData data;
  data.is_coarser = writer.is_coarser();
  // No name can end the script element that holds it.
  for (const char c : text) {
    if (c == '<') {
      data.json += "\\u003c";
    } else {
      data.json += c;
    }
  }
  return data;
}

}  // namespace crashrank::detail
