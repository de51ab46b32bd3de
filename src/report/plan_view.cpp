#include "report/plan_view.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/candidate.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace crashrank::detail {
namespace {

// The part of the world that is drawn, m, and its size on the page.
constexpr double half_width_m = 16.0;
constexpr double half_height_m = 10.0;
constexpr double pixels_per_m = 20.0;

/// Leaves out corners that lie within 2 cm of the line between those that stay.
Outline thinned(const Outline& hull) {
  constexpr double near_m = 0.02;
  Outline kept;
  std::size_t next = 0;
  for (std::size_t first = 0; first < hull.size(); first = next) {
    kept.push_back(hull[first]);
    const auto is_straight = [&](std::size_t last) {
      const Eigen::Vector2d along = (hull[last % hull.size()] - hull[first]).normalized();
      for (std::size_t i = first + 1; i < last; ++i) {
        const Eigen::Vector2d from = hull[i] - hull[first];
        if (std::abs(along.x() * from.y() - along.y() * from.x()) > near_m) return false;
      }
      return true;
    };
    for (next = first + 1; next < hull.size() && is_straight(next + 1);) ++next;
  }
  return kept;
}

Eigen::Vector2d ground(const Pose& pose, const Eigen::Vector2d& point) {
  return (pose.rotation * Eigen::Vector3d(point.x(), point.y(), 0.0) + pose.translation).head<2>();
}

/// A name, cut to a width in pixels, and its width, of wide letters at the plan's size of 12.
std::pair<std::string, double> fitted(const std::string& name, double most) {
  constexpr double letter = 7.5;
  constexpr double other = 12.0;  // Chinese, say
  double width = 0.0;
  std::size_t kept = 0;  // what fits before an ellipsis
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    if ((byte & 0xC0U) == 0x80U) continue;  // within a character of UTF-8
    if (width + other <= most) kept = i;
    width += byte < 0x80U ? letter : other;
  }
  if (width <= most) return {name, width};
  return {name.substr(0, kept) + "\u2026", most};
}

// World to page: x right, y up. As wide a page for any part of the world.
class Canvas {
public:
  explicit Canvas(const Eigen::Vector2d& middle,
                  const Eigen::Vector2d& half_m = {half_width_m, half_height_m})
      : middle_(middle), half_m_(half_m), scale_(half_width_m * pixels_per_m / half_m.x()) {}

  Eigen::Vector2d operator()(const Eigen::Vector2d& world) const {
    return {(world.x() - middle_.x() + half_m_.x()) * scale_,
            (middle_.y() - world.y() + half_m_.y()) * scale_};
  }

  std::string scale_bar() const {
    const double y = 2.0 * half_m_.y() * scale_ - 14.0;
    return fmt::format(
        "<path class='scale' d='M14 {0:.0f} H{1:.0f}'/><text x='14' y='{2:.0f}'>5 m</text>\n", y,
        14.0 + 5.0 * scale_, y - 6.0);
  }

  /// A name at a point, moved inwards and cut where it would reach beyond the page.
  std::string label(const Eigen::Vector2d& world, const std::string& name) const {
    constexpr double edge = 4.0;
    constexpr double ascent = 12.0;
    const Eigen::Vector2d page = 2.0 * scale_ * half_m_;
    const Eigen::Vector2d p = (*this)(world);
    const auto [text, width] = fitted(name, page.x() - 2.0 * edge);
    return fmt::format("<text x='{:.0f}' y='{:.0f}'>{}</text>\n",
                       std::max(edge, std::min(p.x(), page.x() - edge - width)),
                       std::clamp(p.y(), edge + ascent, page.y() - edge), escape_xml(text));
  }

  bool shows(const Eigen::Vector2d& world, double reach) const {
    return std::abs(world.x() - middle_.x()) < half_m_.x() + reach &&
           std::abs(world.y() - middle_.y()) < half_m_.y() + reach;
  }

  std::string path(const Outline& world) const {
    std::string text;
    for (const Eigen::Vector2d& point : world) {
      const Eigen::Vector2d p = (*this)(point);
      text += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
    }
    return text;
  }

  std::string body(const Outline& outline, const Pose& pose, const char* css_class) const {
    Outline world;
    world.reserve(outline.size());
    for (const Eigen::Vector2d& point : outline) world.push_back(ground(pose, point));
    return fmt::format("<polygon class='{}' points='{}'/>\n", css_class, path(world));
  }

  // A wedge at the front shows the heading of a body.
  std::string nose(const Outline& outline, const Pose& pose) const {
    double front = outline.front().x();
    double middle = 0.0;
    for (const Eigen::Vector2d& point : outline) {
      front = std::max(front, point.x());
      middle += point.y() / static_cast<double>(outline.size());
    }
    const Outline wedge{ground(pose, {front - 0.2, middle}),
                        ground(pose, {front - 0.9, middle + 0.35}),
                        ground(pose, {front - 0.9, middle - 0.35})};
    return fmt::format("<polygon class='nose' points='{}'/>\n", path(wedge));
  }

private:
  Eigen::Vector2d middle_;
  Eigen::Vector2d half_m_;  ///< what is drawn to each side
  double scale_;            ///< pixels per metre
};

Outline hull_of_damage(const TriangleMesh& mesh, const BodyDamage& damage) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(3 * damage.triangles.size());
  for (const std::uint32_t index : damage.triangles) {
    for (const std::uint32_t vertex : mesh.triangles[index]) {
      points.emplace_back(mesh.vertices[vertex].x(), mesh.vertices[vertex].y());
    }
  }
  return convex_hull(std::move(points));
}

Eigen::Vector3d closing_velocity(const Motion& ego, const Motion& other, const Contact& contact) {
  Pose ego_pose;
  Pose other_pose;
  Velocity ego_velocity;
  Velocity other_velocity;
  ego.state_at(contact.time_of_impact_s, ego_pose, ego_velocity);
  other.state_at(contact.time_of_impact_s, other_pose, other_velocity);
  return velocity_of_point(ego_velocity, ego_pose.translation, contact.point_m) -
         velocity_of_point(other_velocity, other_pose.translation, contact.point_m);
}

std::string arrow(const Canvas& canvas, const Eigen::Vector2d& at,
                  const Eigen::Vector2d& velocity) {
  constexpr double seconds = 0.15;  // a metre of arrow for every 6.7 m/s
  if (!(velocity.norm() > 0.0)) return {};
  const Eigen::Vector2d tip = canvas(at);
  const Eigen::Vector2d tail = canvas(at - seconds * velocity);
  const Eigen::Vector2d along = (tip - tail).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d left = tip - 9.0 * along + 4.0 * across;
  const Eigen::Vector2d right = tip - 9.0 * along - 4.0 * across;
  return fmt::format(
      "<path class='closing' d='M{:.1f} {:.1f} L{:.1f} {:.1f} M{:.1f} {:.1f} L{:.1f} {:.1f} "
      "L{:.1f} {:.1f}'/>\n",
      tail.x(), tail.y(), tip.x(), tip.y(), left.x(), left.y(), tip.x(), tip.y(), right.x(),
      right.y());
}

/// How much larger than usual a page around `middle` has to be so that no edge cuts an outline; a
/// wall longer than the page twice as large is cut.
double growth(const Eigen::Vector2d& middle, const Outline& outline, const Pose& pose) {
  constexpr double margin_m = 0.5;
  double grown = 1.0;
  for (const Eigen::Vector2d& point : outline) {
    const Eigen::Vector2d away = (ground(pose, point) - middle).cwiseAbs();
    grown = std::max(
        {grown, (away.x() + margin_m) / half_width_m, (away.y() + margin_m) / half_height_m});
  }
  return std::min(grown, 2.0);
}

/// What is drivable; without areas all is.
std::string road(const Canvas& canvas, const Road& road) {
  std::string svg;
  for (const Area& area : road.drivable) {
    svg += "<path class='road' d='M" + canvas.path(area.outer) + "Z";
    for (const auto& hole : area.holes) svg += " M" + canvas.path(hole) + "Z";
    svg += "'/>\n";
  }
  return svg.empty() ? svg : "<rect class='ground' width='100%' height='100%'/>\n" + svg;
}

std::string way(const Canvas& canvas, const Motion& motion, double until_s) {
  constexpr int steps = 48;
  Outline points;
  for (int i = 0; i <= steps; ++i) {
    points.emplace_back(motion.pose_at(until_s * i / steps).translation.head<2>());
  }
  return fmt::format("<polyline class='way' points='{}'/>\n", canvas.path(points));
}

}  // namespace

Outline outline_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    points.emplace_back(vertex.x(), vertex.y());
  }
  return thinned(convex_hull(std::move(points)));
}

PlanView::PlanView(const Scenario& scenario, View<const Model> models, const RankResult& result)
    : scenario_(scenario), models_(models), result_(result) {
  for (const Model& model : models) outlines_.push_back(outline_of(model.mesh));
  for (const ScenarioActor& actor : scenario.actors) {
    Result<Motion> motion = make_motion(actor);
    motions_.push_back(motion ? std::move(*motion) : Motion::at_rest(actor.pose));
  }
}

std::string PlanView::draw(std::size_t place) const {
  const CandidateResult& ranked = result_.ranking[place];
  const Motion& ego = result_.candidates[ranked.candidate].motion;
  const bool hit = !ranked.contacts.empty();
  const double time_s = hit ? ranked.contacts.front().time_of_impact_s : scenario_.horizon_s;
  const Pose ego_pose = ego.pose_at(time_s);
  const Eigen::Vector2d middle = hit ? ranked.contacts.front().point_m.head<2>().eval()
                                     : ego_pose.translation.head<2>().eval();
  double grown = growth(middle, outlines_[scenario_.ego.model], ego_pose);
  if (hit) {
    const Contact& first = ranked.contacts.front();
    grown = std::max(grown, growth(middle, outline_of_actor(first.actor), first.other.pose));
  }
  const Canvas canvas(middle, grown * Eigen::Vector2d(half_width_m, half_height_m));

  std::string svg =
      fmt::format("<svg class='plan' viewBox='0 0 {:.0f} {:.0f}' role='img'>\n",
                  2.0 * half_width_m * pixels_per_m, 2.0 * half_height_m * pixels_per_m);
  svg += "<title>Seen from above at " +
         (hit ? fmt::format("first contact, {:.3f} s", time_s)
              : fmt::format("the horizon, {:.1f} s", time_s)) +
         "</title>\n";
  svg += road(canvas, scenario_.road);
  std::string labels;
  for (std::size_t i = 0; i < scenario_.actors.size(); ++i) {
    if (scenario_.actors[i].existence_probability == 0.0) continue;
    const Pose pose = motions_[i].pose_at(time_s);
    const Eigen::Vector2d at = pose.translation.head<2>();
    if (!canvas.shows(at, 30.0)) continue;
    const bool is_hit = std::any_of(ranked.contacts.begin(), ranked.contacts.end(),
                                    [i](const Contact& contact) { return contact.actor == i; }) ||
                        std::any_of(ranked.further.begin(), ranked.further.end(),
                                    [i](const FurtherContact& contact) {
                                      return contact.a == i || contact.b == i;
                                    });
    svg += canvas.body(outline_of_actor(i), pose, is_hit ? "other" : "bystander");
    const BodyKind kind = scenario_.models[scenario_.actors[i].model].kind;
    if (kind != BodyKind::barrier && kind != BodyKind::pole && kind != BodyKind::building) {
      svg += canvas.nose(outline_of_actor(i), pose);
    }
    // Of a crash, those that take part; more names would lie over each other.
    if ((is_hit || !hit) && canvas.shows(at, 0.0)) {
      labels += canvas.label(at, scenario_.actors[i].name);
    }
  }
  const Outline& own = outlines_[scenario_.ego.model];
  svg += canvas.body(own, ego.pose_at(0.0), "start");
  svg += way(canvas, ego, time_s);
  svg += canvas.body(own, ego_pose, "ego");
  svg += canvas.nose(own, ego_pose);
  if (hit) {
    const Contact& first = ranked.contacts.front();
    svg += canvas.body(hull_of_damage(models_[scenario_.ego.model].mesh, first.ego), first.ego.pose,
                       "damage");
    svg +=
        canvas.body(hull_of_damage(models_[scenario_.actors[first.actor].model].mesh, first.other),
                    first.other.pose, "damage");
    svg += arrow(canvas, first.point_m.head<2>(),
                 closing_velocity(ego, motions_[first.actor], first).head<2>());
  }
  for (const FurtherContact& contact : ranked.further) {
    const Eigen::Vector2d at = contact.point_m.head<2>();
    if (!canvas.shows(at, 0.0)) continue;
    const Eigen::Vector2d p = canvas(at);
    svg += fmt::format(
        "<circle class='further' cx='{:.1f}' cy='{:.1f}' r='9'><title>{} / {}, {:.3f} s</title>"
        "</circle>\n",
        p.x(), p.y(), escape_xml(scenario_.actors[contact.a].name),
        escape_xml(scenario_.actors[contact.b].name), contact.time_s);
  }
  return svg + labels + canvas.scale_bar() + "</svg>\n";
}

}  // namespace crashrank::detail

namespace crashrank {
namespace {

/// Of a plan that stands alone; the page of a report has its own.
constexpr const char* plan_style =
    "<style>svg{background:#eceef0}text{font:12px sans-serif;fill:#4a5057}.ground{fill:#dfe6d8}"
    ".road{fill:#eceef0;fill-rule:evenodd;stroke:#aab29f}.ego{fill:#4a7ab8;stroke:#24466f}"
    ".bystander{fill:#cdd1d6;stroke:#8d949c}.nose{fill:#fff}"
    ".way{fill:none;stroke:#24466f;stroke-dasharray:6 5}.scale{fill:none;stroke:#4a5057}</style>\n";

/// The likeliest or only motion, and all others that an actor may follow.
std::vector<Motion> motions_of(const Scenario& scenario, std::size_t actor) {
  std::vector<Motion> motions;
  const auto add = [&](const ActorMotion& stated) {
    if (Result<Motion> motion = make_motion(stated, {})) motions.push_back(std::move(*motion));
  };
  for (const Prediction& prediction : scenario.actors[actor].predictions) add(prediction);
  for (const JointFuture& future : scenario.futures) {
    for (const FutureMotion& moved : future.motions) {
      if (moved.actor == actor) add(moved.motion);
    }
  }
  if (motions.empty()) add(scenario.actors[actor]);
  return motions;
}

}  // namespace

std::string scenario_plan(const Scenario& scenario, View<const Model> models) {
  constexpr double margin_m = 4.0;
  std::vector<detail::Outline> outlines;
  for (const Model& model : models) outlines.push_back(detail::outline_of(model.mesh));
  std::vector<std::vector<Motion>> motions;
  Eigen::AlignedBox2d shown;
  const auto show = [&](std::size_t model, const Pose& pose) {
    for (const Eigen::Vector2d& point : outlines[model]) shown.extend(detail::ground(pose, point));
  };
  show(scenario.ego.model, scenario.ego.pose);
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    motions.push_back(motions_of(scenario, i));
    for (const Motion& motion : motions[i]) show(scenario.actors[i].model, motion.pose_at(0.0));
  }
  const Eigen::Vector2d half =
      (0.5 * shown.sizes().array() + margin_m)
          .max(Eigen::Array2d(detail::half_width_m, detail::half_height_m));
  const detail::Canvas canvas(shown.center(), half);
  const Eigen::Vector2d page = 2.0 * detail::half_width_m * detail::pixels_per_m / half.x() * half;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {:.0f} {:.0f}'>\n<title>{}, from above "
      "at time 0</title>\n",
      page.x(), page.y(), escape_xml(scenario.name));
  svg += plan_style + detail::road(canvas, scenario.road);
  std::string labels = canvas.label(scenario.ego.pose.translation.head<2>(), "ego");
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    for (const Motion& motion : motions[i]) {
      const Pose pose = motion.pose_at(0.0);
      svg += canvas.body(outlines[actor.model], pose, "bystander");
      if (motion.velocity_at(0.0).linear_mps.norm() == 0.0 && !motion.holds_poses()) continue;
      svg += canvas.nose(outlines[actor.model], pose);
      svg += detail::way(canvas, motion, scenario.horizon_s);
    }
    if (motions[i].empty()) continue;
    labels += canvas.label(motions[i].front().pose_at(0.0).translation.head<2>(), actor.name);
  }
  svg += canvas.body(outlines[scenario.ego.model], scenario.ego.pose, "ego");
  svg += canvas.nose(outlines[scenario.ego.model], scenario.ego.pose);
  return svg + labels + canvas.scale_bar() + "</svg>\n";
}

}  // namespace crashrank
