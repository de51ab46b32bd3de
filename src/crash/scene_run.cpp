#include "crash/scene_run.hpp"

#include "crash/pair_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

constexpr auto no_pair = static_cast<std::uint32_t>(-1);
/// A free body is at rest if the speed of no outline point exceeds this, m/s.
constexpr double rest_mps = 0.02;
/// Bodies that press on each other are at rest if none in the scene is faster than this, m/s.
constexpr double still_mps = 0.001;

double speed_bound(const PlanarBody& body, double radius_m) {
  return plane_length(body.vx, body.vy) + radius_m * std::abs(body.spin);
}

}  // namespace

void SceneRun::prepare(std::size_t bodies, std::size_t pieces, bool tracks) {
  memory_.bodies.reserve(bodies);
  members_.reserve(bodies);
  chain_.reserve(bodies);
  posts_.reserve(bodies);
  near_.reserve(bodies * most_near);
  runs_.resize(most_at_once);
  begun_s_.resize(most_at_once);
  forced_s_.resize(most_at_once);
  active_.reserve(most_at_once);
  free_runs_.reserve(most_at_once);
  contacts_.reserve(most_contacts);
  if (tracks) {
    track_steps_.reserve(most_tracked_steps);
    track_.reserve(most_tracked);
  }
  records_.resize(std::min(most_recorded, bodies));
  for (ExposureRecord& record : records_) record.prepare();
  memory_.most_pooled = most_near_blocks;
  memory_.pool.reserve(std::min(2 * most_pairs * most_blocks(pieces), most_near_blocks));
  memory_.pairs.resize(most_pairs);
  for (BodyPair& pair : memory_.pairs) {
    pair.of_first.resize(pieces);
    pair.of_second.resize(pieces);
  }
}

void SceneRun::begin(View<const SceneBody> bodies, std::size_t first, std::size_t partner,
                     double start_s, const Vector3d& origin_m, const SceneOptions& options) {
  bodies_ = bodies;
  options_ = options;
  origin_m_ = Vector3d(origin_m.x(), origin_m.y(), 0.0);
  memory_.begin();
  // Contacts keep pointers to the bodies, so the array must not move.
  memory_.bodies.reserve(bodies.size());
  members_.assign(bodies.size(), {});
  near_.resize(bodies.size() * most_near);
  runs_.resize(most_at_once);
  begun_s_.resize(most_at_once);
  forced_s_.resize(most_at_once);
  chain_.clear();
  posts_.clear();
  active_.clear();
  free_runs_.clear();
  for (std::size_t k = most_at_once; k > 0; --k)
    free_runs_.push_back(static_cast<std::uint32_t>(k - 1));
  contacts_.clear();
  records_.resize(std::max(records_.size(), std::min(most_recorded, bodies.size())));
  recorded_ = 0;
  first_run_ = nullptr;
  start_s_ = now_s_ = placed_s_ = last_force_s_ = start_s;
  fastest_plan_mps_ = options.fastest_plan_mps;
  track_steps_.clear();
  track_.clear();
  track_ends_ = false;
  track_step_s_ = 0.0;
  limit_exceeded_ = false;
  steps_ = 0;
  ended_work_ = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vehicle& v = *bodies[i].vehicle;
    Member& m = members_[i];
    compute_extents(v, m);
    if (v.breakaway) posts_.push_back(static_cast<std::uint32_t>(i));
    m.state = v.stands() ? State::fixed : State::planned;
    ContactBody contact_body;
    contact_body.vehicle = &v;
    bodies[i].plan->state_at(start_s, contact_body.pose, contact_body.velocity);
    contact_body.pose.translation += bodies[i].shift_m;
    if (v.stands()) contact_body.velocity = {};
    memory_.add_body(contact_body, origin_m_, options.variant);
    m.pose = contact_body.pose;
    m.start = motion_of(i);
    m.placed_s = start_s;
    if (v.stands()) continue;
    const MotionBound bound = bodies[i].plan->bound(start_s, start_s + options.longest_s);
    fastest_plan_mps_ = std::max(
        fastest_plan_mps_,
        bound.speed_mps + bound.angular_radps * (m.radius_m + v.center_m.head<2>().norm()));
  }
  over_ = bodies.size() < 2;
  if (over_) return;
  track_fastest_mps_ = fastest_mps_ = fastest_plan_mps_;
  join_chain(first);
  list_near();
  track(0.0);
  open_contacts();
  first_run_ = live_with(first, partner);
  partner_ = partner;
}

ContactBody SceneRun::contact_body(std::size_t i) const {
  ContactBody body;
  const Member& m = members_[i];
  body.vehicle = bodies_[i].vehicle;
  if (m.state == State::planned) {
    bodies_[i].plan->state_at(now_s_, body.pose, body.velocity);
    body.pose.translation += bodies_[i].shift_m;
    return body;
  }
  const PlanarBody& now = memory_.bodies[i].motion;
  body.pose = moved_pose(m.pose, body.vehicle->center_m, place_of(m.start), place_of(now));
  if (m.state == State::fixed) return body;
  const Vector3d arm = body.pose.rotation * body.vehicle->center_m;
  body.velocity.linear_mps =
      Vector3d(now.vx + now.spin * arm.y(), now.vy - now.spin * arm.x(), 0.0);
  body.velocity.angular_radps.z() = now.spin;
  return body;
}

/// Places a planned body at its pose for the present time.
void SceneRun::place_planned(std::size_t i) {
  Member& m = members_[i];
  if (m.state != State::planned || m.placed_s == now_s_) return;
  m.placed_s = now_s_;
  const ContactBody body = contact_body(i);
  motion_of(i) = make_planar(body, origin_m_);
}

void SceneRun::join_chain(std::size_t i) {
  Member& m = members_[i];
  if (m.in_chain || m.state == State::fixed) return;
  m.in_chain = true;
  m.slack_m = -1.0;
  chain_.push_back(static_cast<std::uint32_t>(i));
}

/// Marks a body that a contact force acts on; a planned or resting body becomes free.
void SceneRun::mark_touched(std::size_t i) {
  Member& m = members_[i];
  m.pressed = true;
  if (m.state == State::fixed || m.state == State::free) return;
  if (m.state == State::planned) {
    m.pose = contact_body(i).pose;
    m.start = motion_of(i);
    m.state = State::free;
    join_chain(i);
    set_wheels(i);
  }
  m.state = State::free;
}

/// Loads the feet of posts with the contact forces of this step; those that break away become free.
void SceneRun::break_away() {
  for (const std::uint32_t i : posts_) {
    FootLoad load;
    for (const std::uint32_t k : active_) runs_[k].add_load(i, load);
    if (!memory_.load_post(i, load)) continue;
    members_[i].state = State::free;
    join_chain(i);
    set_wheels(i);
    for (const std::uint32_t k : active_) runs_[k].forget_held(i);
  }
}

void SceneRun::set_wheels(std::size_t i) {
  const SceneBody& body = bodies_[i];
  if (body.footing == nullptr) return;
  Member& m = members_[i];
  m.wheels = wheels_after(*body.footing, options_.after, body.steering_rad, body.brake, m.damaged);
}

/// Calls a function once for every pair of near bodies of which at least one is in the chain and at
/// least one moves.
template <typename Function> void SceneRun::for_each_near_pair(Function function) {
  // Loop by index, because the function may append bodies to the chain.
  for (std::size_t c = 0; c < chain_.size(); ++c) {
    const std::size_t i = chain_[c];
    const Member& m = members_[i];
    for (std::size_t k = 0; k < m.near; ++k) {
      const std::size_t j = near_[i * most_near + k];
      if (moves(i)) {
        if (j < i && members_[j].in_chain && moves(j) && has_listed(j, i)) continue;
      } else if (!moves(j) || members_[j].in_chain) {
        // A resting body is only paired here with bodies that still follow their plans; all other
        // moving bodies list it themselves.
        continue;
      }
      function(i, j);
    }
  }
}

double SceneRun::next_step_s() {
  double step_s = options_.rolling_step_s;
  for (const std::uint32_t k : active_) step_s = std::min(step_s, runs_[k].next_step_s());
  for_each_near_pair([&](std::size_t i, std::size_t j) {
    const double closing = closing_bound(i, j);
    if (!(closing * step_s > options_.contact.travel_m)) return;
    if (gap_lower_bound_m(i, j) - 0.5 * live_m > closing * step_s) return;
    // Closer pairs have an open contact, which limits the step itself.
    const double gap = gap_m(i, j);
    if (gap < live_m && live_with(i, j) != nullptr) return;
    const double free_m = std::max(gap - 0.5 * live_m, options_.contact.travel_m);
    step_s = std::min(step_s, std::max(free_m / closing, options_.contact.shortest_s));
  });
  return step_s;
}

ContactRun* SceneRun::live_with(std::size_t i, std::size_t j) {
  for (const std::uint32_t k : active_) {
    ContactRun& run = runs_[k];
    for (const std::uint32_t pair : run.pairs()) {
      const std::size_t second = memory_.pairs[pair].second;
      if ((run.first() == i && second == j) || (run.first() == j && second == i)) return &run;
    }
  }
  return nullptr;
}

/// Returns the index of the pair of two bodies, or `no_pair` if there is no room; `seen_before` is
/// set if they have had a contact before.
std::uint32_t SceneRun::pair_of(std::size_t i, std::size_t j, bool& seen_before) {
  for (std::size_t k = 0; k < memory_.pairs_in_use; ++k) {
    const BodyPair& pair = memory_.pairs[k];
    if ((pair.first == i && pair.second == j) || (pair.first == j && pair.second == i)) {
      seen_before = true;
      return static_cast<std::uint32_t>(k);
    }
  }
  seen_before = false;
  if (memory_.pairs_in_use == most_pairs) return no_pair;
  const bool swapped = goes_second(contact_body(i), contact_body(j));
  return memory_.take_pair(swapped ? j : i, swapped ? i : j);
}

void SceneRun::open_contact(std::size_t i, std::size_t j) {
  bool seen_before = false;
  const std::uint32_t index = pair_of(i, j, seen_before);
  if (index == no_pair || free_runs_.empty()) {
    limit_exceeded_ = true;
    return;
  }
  BodyPair& pair = memory_.pairs[index];
  if (seen_before) pair.begin_further_contact(steps_);
  const std::size_t first = pair.first;
  const std::size_t second = pair.second;
  for (const std::uint32_t k : active_) {
    ContactRun& run = runs_[k];
    if (run.first() != first || !adjoins_any(second, run)) continue;
    if (!run.add(index)) limit_exceeded_ = true;
    return;
  }
  const std::uint32_t k = free_runs_.back();
  free_runs_.pop_back();
  active_.push_back(k);
  begun_s_[k] = now_s_;
  runs_[k].begin(memory_, first, index, contact_body(first), contact_body(second), origin_m_,
                 options_.variant, options_.contact);
}

void SceneRun::open_contacts() {
  for_each_near_pair([&](std::size_t i, std::size_t j) {
    if (gap_lower_bound_m(i, j) > live_m || live_with(i, j) != nullptr) return;
    if (gap_m(i, j) < live_m) open_contact(i, j);
  });
}

/// Stops bodies that have come to rest; they stay so until a contact moves them. Ends the scene
/// when no body moves or its time is over.
void SceneRun::stop_resting_bodies() {
  bool all_rest = true;
  const bool all_still = std::all_of(chain_.begin(), chain_.end(), [&](std::uint32_t i) {
    return speed_bound(motion_of(i), members_[i].radius_m) < still_mps;
  });
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    PlanarBody& b = motion_of(i);
    const bool is_slow = speed_bound(b, m.radius_m) < rest_mps && (all_still || !m.pressed);
    if (m.state == State::free && is_slow) {
      b.vx = b.vy = b.spin = 0.0;
      m.state = State::rests;
    }
    m.pressed = false;
    all_rest = all_rest && m.state == State::rests;
  }
  const double end_s = std::max(last_force_s_ + options_.after_last_contact_s, options_.until_s);
  over_ = all_rest || now_s_ > end_s || now_s_ - start_s_ > options_.longest_s;
  if (!over_) return;
  for (const std::uint32_t k : active_) close_contact(runs_[k]);
  active_.clear();
}

std::int32_t SceneRun::current_cell() const noexcept {
  return static_cast<std::int32_t>(std::floor((now_s_ - start_s_) / exposure_cell_s));
}

void SceneRun::apply_contact_forces(double step_s) {
  for (const std::uint32_t i : chain_) {
    const PlanarBody& b = motion_of(i);
    Member& m = members_[i];
    m.action = {};
    m.state_before = {};
    m.state_before.forward_x = static_cast<float>(b.cosine);
    m.state_before.forward_y = static_cast<float>(b.sine);
    m.state_before.road_mps = static_cast<float>(plane_length(b.vx, b.vy));
  }
  for (const std::uint32_t k : active_) {
    ContactRun& run = runs_[k];
    run.apply_forces();
    if (!run.presses()) continue;
    for (const bool first : {true, false}) {
      Member& m = members_[first ? run.first() : run.second()];
      if (m.state != State::free) continue;
      m.action.add(run.step_action(first), 1.0);
      const double deepest_m = std::max(m.deepest_m, run.deepest_m(first));
      m.action.deepest_m += deepest_m - m.deepest_m;
      m.deepest_m = deepest_m;
    }
  }
  record_actions(step_s);
}

/// Adds the actions of the step to the records of the bodies.
void SceneRun::record_actions(double step_s) {
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    if (!(m.action.path_mps > 0.0)) continue;
    if (m.record == no_record) {
      if (recorded_ == records_.size()) {
        limit_exceeded_ = true;
        continue;
      }
      m.record = recorded_++;
      records_[m.record].begin();
    }
    const double change_mps = plane_length(m.action.dvx_mps, m.action.dvy_mps);
    m.action.cancelled_mps = 0.5 * std::max(0.0, m.action.path_mps - change_mps);
    m.changed_mps += change_mps;
    const double middle_s = now_s_ - start_s_;
    if (!records_[m.record].add(middle_s - 0.5 * step_s, middle_s + 0.5 * step_s, m.state_before,
                                m.action)) {
      limit_exceeded_ = true;
    }
  }
}

void SceneRun::step() {
  list_near();
  const double step_s = next_step_s();
  const double fastest_before_mps = fastest_mps_;
  fastest_mps_ = fastest_plan_mps_;
  for (const std::uint32_t i : chain_) {
    if (members_[i].state == State::free) motion_of(i).move(0.5 * step_s);
  }
  now_s_ += 0.5 * step_s;
  placed_s_ = now_s_;
  for (const std::uint32_t i : chain_) {
    place_planned(i);
    for (std::size_t k = 0; k < members_[i].near; ++k) place_planned(near_[i * most_near + k]);
  }
  open_contacts();
  track(step_s);
  for (const std::uint32_t k : active_) runs_[k].compute_forces(step_s);
  break_away();
  for (const std::uint32_t k : active_) {
    ContactRun& run = runs_[k];
    if (!run.presses()) continue;
    last_force_s_ = now_s_;
    if (!run.acts()) forced_s_[k] = now_s_;
    if (!run.acts() && &run != first_run_) {
      run.begin_at_first_force(contact_body(run.first()), contact_body(run.second()));
      begun_s_[k] = now_s_;
    }
    mark_touched(run.first());
    for (const std::uint32_t pair : run.pairs()) mark_touched(memory_.pairs[pair].second);
  }
  apply_contact_forces(step_s);
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    if (m.state != State::free) continue;
    PlanarBody& b = motion_of(i);
    if (bodies_[i].footing != nullptr) apply_road_forces(i, step_s);
    b.move(0.5 * step_s);
    fastest_mps_ = std::max(fastest_mps_, speed_bound(b, m.radius_m));
  }
  track_fastest_mps_ = std::max(track_fastest_mps_, fastest_mps_);
  now_s_ += 0.5 * step_s;
  compare_with_plans();
  ++steps_;
  for (std::size_t k = 0; k < active_.size();) {
    ContactRun& run = runs_[active_[k]];
    run.end_step();
    if (!run.over()) {
      ++k;
      continue;
    }
    close_contact(run);
    free_runs_.push_back(active_[k]);
    active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  // Both bodies of a pair may have moved this far.
  const double fastest_mps = std::max(fastest_before_mps, fastest_mps_);
  for (const std::uint32_t i : chain_) members_[i].slack_m -= 2.0 * step_s * fastest_mps;
  stop_resting_bodies();
}

bool SceneRun::advance(int steps) {
  for (int i = 0; i < steps && !over_; ++i) step();
  return !over_;
}

std::uint64_t SceneRun::work() const noexcept {
  std::uint64_t pieces = ended_work_;
  for (const std::uint32_t k : active_) pieces += runs_[k].work();
  return pieces;
}

}  // namespace crashrank::detail
