#include "rank/hits.hpp"

#include "crash/pair_order.hpp"
#include "rank/near.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

bool starts_as_the_ego(const Scene& scene, const Motion& motion) {
  const Pose pose = motion.pose_at(0.0);
  return pose.rotation == scene.ego_start.rotation &&
         pose.translation == scene.ego_start.translation;
}

/// First contact of the ego with an actor. The search runs on the pair in the order of
/// `goes_second`, so that exchanging their roles changes no bit of time and points.
Impact find_impact(const Scene& scene, const Motion& ego, const Body& actor, double from_s,
                   double until_s, ImpactWorkspace& workspace, const ImpactOptions& options) {
  ContactBody p{&scene.ego.vehicle, {}, {}};
  ContactBody q{&actor.vehicle, {}, {}};
  ego.state_at(from_s, p.pose, p.velocity);
  actor.motion.state_at(from_s, q.pose, q.velocity);
  const AabbTree& ego_tree = scene.ego.model->tree;
  const AabbTree& actor_tree = actor.model->tree;
  if (!goes_second(p, q)) {
    return time_of_impact(ego_tree, ego, actor_tree, actor.motion, from_s, until_s, workspace,
                          options);
  }
  Impact impact =
      time_of_impact(actor_tree, actor.motion, ego_tree, ego, from_s, until_s, workspace, options);
  std::swap(impact.triangle_a, impact.triangle_b);
  std::swap(impact.point_a_m, impact.point_b_m);
  impact.normal = Eigen::Vector3d::Zero() - impact.normal;
  return impact;
}

}  // namespace

bool find_hits(const Scene& scene, const Motion& ego, Scratch& scratch, RankWork& work) {
  scratch.hits.clear();
  find_near(scene, ego, 0.0, scene.slice_s.back(), scratch, work);
  const bool same_start = starts_as_the_ego(scene, ego);
  bool decided = true;
  double first_s = std::numeric_limits<double>::infinity();
  // All that come near in the same slice are asked up to the same time, so that no answer depends
  // on the order of the actors.
  double until_s = first_s;
  std::size_t slice = scene.slices.size();
  for (const Scratch::Near& near : scratch.near) {
    if (near.first_slice != slice) {
      slice = near.first_slice;
      until_s = first_s;
    }
    const double from = scene.slice_s[near.first_slice];
    const double until = std::min(scene.slice_s[near.last_slice + 1], until_s);
    if (from > until) continue;
    const Body& actor = scene.actors[near.actor];
    ImpactOptions options = scene.impact;
    options.stop = scratch.stop;
    options.stop_context = scratch.stop_context;
    options.start_is_apart =
        near.first_slice > 0 || (same_start && scene.apart_at_start[near.actor] != 0);
    const Impact impact = find_impact(scene, ego, actor, from, until, scratch.impact, options);
    ++work.body_pairs;
    work.impact += impact.work;
    if (impact.state == ImpactState::undecided) {
      decided = false;
      if (scratch.stopped()) break;
      continue;
    }
    if (impact.state == ImpactState::none) continue;
    scratch.hits.push_back({near.actor, impact});
    if (impact.hit()) first_s = std::min(first_s, impact.time_s);
  }
  std::sort(scratch.hits.begin(), scratch.hits.end(),
            [](const Scratch::Hit& p, const Scratch::Hit& q) {
              return p.impact.time_s != q.impact.time_s ? p.impact.time_s < q.impact.time_s
                                                        : p.actor < q.actor;
            });
  return decided;
}

bool grazes_before(const Scratch& scratch, double until_s) {
  return std::any_of(scratch.hits.begin(), scratch.hits.end(), [until_s](const Scratch::Hit& hit) {
    const bool grazing = hit.impact.state == ImpactState::grazing;
    return (grazing || hit.impact.grazed) &&
           (grazing ? hit.impact.time_s : hit.impact.graze_time_s) <= until_s;
  });
}

}  // namespace crashrank::detail
