#include "rank/hits.hpp"

#include "crash/pair_order.hpp"
#include "rank/nearby_actors.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

bool starts_at_ego_pose(const Scene& scene, const Motion& motion) {
  const Pose pose = motion.pose_at(0.0);
  return pose.rotation == scene.ego_start.rotation &&
         pose.translation == scene.ego_start.translation;
}

ImpactOptions options_for(const Scene& scene, const Scratch& scratch, const Scratch::Near& near,
                          bool same_start) {
  ImpactOptions options = scene.impact;
  options.stop = scratch.stop.ask;
  options.stop_context = scratch.stop.context;
  options.start_is_apart =
      near.first_slice > 0 || (same_start && scene.apart_at_start[near.plan] != 0);
  return options;
}

void sort_by_time(std::vector<Scratch::Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Scratch::Hit& p, const Scratch::Hit& q) {
    return p.impact.time_s != q.impact.time_s ? p.impact.time_s < q.impact.time_s : p.plan < q.plan;
  });
}

}  // namespace

Impact find_impact(const Scene& scene, const Motion& ego, const Plan& plan, double from_s,
                   double until_s, ImpactWorkspace& workspace, const ImpactOptions& options) {
  const Body& actor = scene.actors[plan.actor];
  ContactBody p{scene.ego.vehicle.get(), {}, {}};
  ContactBody q{actor.vehicle.get(), {}, {}};
  ego.state_at(from_s, p.pose, p.velocity);
  plan.motion.state_at(from_s, q.pose, q.velocity);
  const AabbTree& ego_tree = scene.ego.model->tree;
  const AabbTree& actor_tree = actor.model->tree;
  if (!goes_second(p, q)) {
    return time_of_impact(ego_tree, ego, actor_tree, plan.motion, from_s, until_s, workspace,
                          options);
  }
  Impact impact =
      time_of_impact(actor_tree, plan.motion, ego_tree, ego, from_s, until_s, workspace, options);
  std::swap(impact.triangle_a, impact.triangle_b);
  std::swap(impact.point_a_m, impact.point_b_m);
  impact.normal = Eigen::Vector3d::Zero() - impact.normal;
  return impact;
}

bool find_hits(const Scene& scene, const Motion& ego, const FutureGroup& group, Scratch& scratch,
               RankWork& work) {
  constexpr double never_s = std::numeric_limits<double>::infinity();
  const Futures& futures = scene.futures;
  scratch.hits.clear();
  find_nearby_actors(scene, ego, group, 0.0, scene.slice_s.back(), scratch, work);
  const bool same_start = starts_at_ego_pose(scene, ego);
  bool decided = true;
  // Earliest contact found so far, by future.
  scratch.first_s.assign(futures.size(), never_s);
  // All plans that first come near in the same slice are searched until the same time, so that the
  // result does not depend on the order of the actors.
  scratch.until_s.assign(futures.size(), never_s);
  std::size_t slice = scene.slices.size();
  for (const Scratch::Near& near : scratch.near) {
    if (near.first_slice != slice) {
      slice = near.first_slice;
      scratch.until_s = scratch.first_s;
    }
    // Contacts after the first one of a future do not matter, so search until the latest first
    // contact of the futures with this plan.
    double until = 0.0;
    for (std::size_t f = group.begin; f < group.end; ++f) {
      if (futures.follows(f, near.plan)) until = std::max(until, scratch.until_s[f]);
    }
    const double from = scene.slice_s[near.first_slice];
    const double end = scene.slice_s[near.last_slice + 1];
    until = std::min(end, until);
    if (from > until) continue;
    const Plan& plan = futures.plans[near.plan];
    const ImpactOptions options = options_for(scene, scratch, near, same_start);
    Impact impact = find_impact(scene, ego, plan, from, until, scratch.impact, options);
    ++work.body_pairs;
    work.impact += impact.work;
    if (impact.hit() && until < end) {
      // The last bits of the time depend on the end of the search interval. Search the full
      // interval again, so that they do not depend on other actors.
      impact = find_impact(scene, ego, plan, from, end, scratch.impact, options);
      work.impact += impact.work;
    }
    if (impact.state == ImpactState::undecided) {
      decided = false;
      if (scratch.stopped()) break;
      continue;
    }
    if (impact.state == ImpactState::none) continue;
    scratch.hits.push_back({near.plan, plan.actor, impact});
    if (!impact.hit()) continue;
    for (std::size_t f = group.begin; f < group.end; ++f) {
      if (!futures.follows(f, near.plan)) continue;
      scratch.first_s[f] = std::min(scratch.first_s[f], impact.time_s);
    }
  }
  sort_by_time(scratch.hits);
  return decided;
}

const Scratch::Hit* first_hit(const Scene& scene, const Scratch& scratch, std::size_t future) {
  const auto hit = std::find_if(scratch.hits.begin(), scratch.hits.end(), [&](const auto& each) {
    return each.impact.hit() && scene.futures.follows(future, each.plan);
  });
  return hit != scratch.hits.end() ? &*hit : nullptr;
}

void mark_relevant_hits(const Scratch& scratch, const Scratch::Hit* first,
                        std::vector<char>& relevant) {
  for (const Scratch::Hit& hit : scratch.hits) {
    if (hit.impact.hit()) relevant[hit.plan] = 1;
    if (&hit == first) return;
  }
}

bool grazes_before(const Scene& scene, const Scratch& scratch, std::size_t future, double until_s) {
  return std::any_of(scratch.hits.begin(), scratch.hits.end(), [&](const Scratch::Hit& hit) {
    const bool grazing = hit.impact.state == ImpactState::grazing;
    return scene.futures.follows(future, hit.plan) && (grazing || hit.impact.grazed) &&
           (grazing ? hit.impact.time_s : hit.impact.graze_time_s) <= until_s;
  });
}

}  // namespace crashrank::detail
