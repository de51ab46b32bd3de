#include "rank/follow.hpp"

#include "rank/aftermath.hpp"
#include "rank/crash_setup.hpp"
#include "rank/damage.hpp"
#include "rank/meet.hpp"
#include "rank/near.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crashrank::detail {
namespace {

constexpr double step_s = 0.02;
constexpr int halvings = 10;  // to 20 microseconds, under a millimetre at 40 m/s

/// The search for the next body that the ego meets.
class Next {
public:
  Next(const Scene& scene, const Aftermath& aftermath, View<const std::size_t> met,
       const Watch& watch, Scratch& scratch, RankWork& work)
      : scene_(scene),
        aftermath_(aftermath),
        met_(met),
        watch_(watch),
        scratch_(scratch),
        work_(work) {}

  /// The first by time, then by actor.
  std::optional<Scratch::Hit> find(double from_s) {
    find_near(scene_, aftermath_.motion(), from_s, aftermath_.until_s(), scratch_, work_);
    const auto steps = static_cast<int>(std::ceil((aftermath_.until_s() - from_s) / step_s));
    for (int i = 0; i <= steps; ++i) {
      const double time_s = std::min(from_s + i * step_s, aftermath_.until_s());
      if (watch_.expired()) {
        stopped_ = true;
        return std::nullopt;
      }
      std::optional<Scratch::Hit> first;
      for (const Scratch::Near& near : scratch_.near) {
        if (time_s < scene_.slice_s[near.first_slice] ||
            time_s > scene_.slice_s[near.last_slice + 1] || is_met(near.actor) ||
            !intersect(near.actor, time_s, true)) {
          continue;
        }
        const Scratch::Hit hit = meeting(near.actor, std::max(time_s - step_s, from_s), time_s);
        if (!first || hit.impact.time_s < first->impact.time_s ||
            (hit.impact.time_s == first->impact.time_s && hit.actor < first->actor)) {
          first = hit;
        }
      }
      if (first) return first;
    }
    return std::nullopt;
  }

  bool stopped() const { return stopped_; }

private:
  bool is_met(std::size_t actor) const {
    return std::find(met_.begin(), met_.end(), actor) != met_.end();
  }

  bool intersect(std::size_t actor, double time_s, bool any) {
    const Body& other = scene_.actors[actor];
    CollideOptions options;
    options.any = any;
    const Pose b_in_a = relative(aftermath_.motion().pose_at(time_s), other.motion.pose_at(time_s));
    const CollideResult result = collide(*scene_.ego.model, *other.model, b_in_a,
                                         scratch_.damage.pairs, scratch_.damage.collide, options);
    work_.impact.bv_tests += result.work.bv_tests;
    work_.impact.primitive_tests += result.work.primitive_tests;
    ++work_.impact.poses;
    return result.intersecting;
  }

  /// When the surfaces, apart at `apart_s` unless that is the start, began to intersect.
  Scratch::Hit meeting(std::size_t actor, double apart_s, double touching_s) {
    for (int i = 0; i < halvings && apart_s < touching_s; ++i) {
      const double middle_s = 0.5 * (apart_s + touching_s);
      (intersect(actor, middle_s, true) ? touching_s : apart_s) = middle_s;
    }
    intersect(actor, touching_s, false);
    Impact impact;
    impact.state = ImpactState::contact;
    impact.time_s = touching_s;
    const TriangleMesh& mesh = scene_.ego.model->mesh;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Pair& pair : scratch_.damage.pairs) {
      const Triangle t = mesh.triangle(static_cast<std::size_t>(pair.a));
      middle += ((t.corner[0] + t.corner[1] + t.corner[2]) / 3.0F).cast<double>();
    }
    const auto count = static_cast<double>(std::max<std::size_t>(scratch_.damage.pairs.size(), 1));
    const Pose pose = aftermath_.motion().pose_at(touching_s);
    impact.point_a_m = pose.rotation * (middle / count) + pose.translation;
    impact.point_b_m = impact.point_a_m;
    if (!scratch_.damage.pairs.empty()) {
      const Pair& pair = *std::min_element(
          scratch_.damage.pairs.begin(), scratch_.damage.pairs.end(),
          [](const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
      impact.triangle_a = pair.a;
      impact.triangle_b = pair.b;
    }
    return {actor, impact};
  }

  const Scene& scene_;
  const Aftermath& aftermath_;
  View<const std::size_t> met_;
  const Watch& watch_;
  Scratch& scratch_;
  RankWork& work_;
  bool stopped_ = false;
};

}  // namespace

std::optional<Scratch::Hit> find_next(const Scene& scene, const Aftermath& aftermath,
                                      View<const std::size_t> met, double from_s,
                                      const Watch& watch, bool& stopped, Scratch& scratch,
                                      RankWork& work) {
  Next next(scene, aftermath, met, watch, scratch, work);
  const std::optional<Scratch::Hit> hit = next.find(from_s);
  stopped = next.stopped();
  return hit;
}

Contact make_following_contact(const Scene& scene, const EgoAtContact& ego,
                               const Scratch::Hit& hit) {
  Contact contact = make_contact(scene, ego, hit.actor, hit.impact);
  // Where surfaces already intersect, no facet tells a direction that means something.
  if (contact.closing.norm() > 0.0) contact.normal = contact.closing.normalized();
  contact.normal_speed_mps = contact.closing_speed_mps;
  return contact;
}

void follow(const Scene& scene, const Candidate& candidate, const EgoAtContact& first,
            const EgoAfterContact& left, Approach& found, Scratch& scratch, RankWork& work) {
  const Watch no_watch;
  std::vector<Contact>& contacts = found.result.contacts;
  std::vector<std::size_t>& met = found.met;
  EgoAtContact ego = first;
  EgoAfterContact after = left;
  Aftermath aftermath;
  while (contacts.size() < scene.harm.after.most_contacts) {
    const double start_s = contacts.back().time_of_impact_s;
    aftermath.begin(scene, candidate, start_s, ego, after);
    if (!(aftermath.until_s() > start_s)) break;
    bool stopped = false;
    const std::optional<Scratch::Hit> hit = find_next(scene, aftermath, {met.data(), met.size()},
                                                      start_s, no_watch, stopped, scratch, work);
    if (!hit) break;
    ego = aftermath.at(hit->impact.time_s);
    Contact contact = make_following_contact(scene, ego, *hit);
    const std::size_t met_before = met.size();
    add_met(scene, contact.actor, met);
    found.effects.emplace_back();
    after = simulate_variants(scene, ego, contact, met, scratch.crash, found.effects.back());
    contacts.push_back(std::move(contact));
    found.plans.push_back(plan_damage(scene, ego.pose, contacts.back(), hit->impact,
                                      scratch.crash.motion, found.met_since(met_before)));
  }
}

}  // namespace crashrank::detail
