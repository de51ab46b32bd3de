#include "crash/scene_run.hpp"

#include "crash/pair_order.hpp"
#include "crashrank/crash/pdof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Bodies nearer than this may press within the next steps, m.
constexpr double live_m = 0.15;
/// Bodies nearer than this are in each other's lists, m.
constexpr double listed_m = 5.0;
constexpr double standard_gravity = 9.80665;
constexpr auto no_pair = static_cast<std::uint32_t>(-1);
/// Bodies slower than this at their rims have come to rest, m/s.
constexpr double rest_mps = 0.02;

double rim_speed(const PlanarBody& body, double rim_m) {
  return std::hypot(body.vx, body.vy) + rim_m * std::abs(body.spin);
}

}  // namespace

void SceneRun::prepare(std::size_t bodies, std::size_t pieces) {
  memory_.bodies.reserve(bodies);
  members_.reserve(bodies);
  chain_.reserve(bodies);
  near_.reserve(bodies * most_near);
  runs_.resize(most_at_once);
  begun_s_.resize(most_at_once);
  goes_on_.resize(most_at_once);
  live_.reserve(most_at_once);
  spare_.reserve(most_at_once);
  contacts_.reserve(most_contacts);
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
  // Contacts refer to the bodies in place.
  memory_.bodies.reserve(bodies.size());
  members_.assign(bodies.size(), {});
  near_.resize(bodies.size() * most_near);
  runs_.resize(most_at_once);
  begun_s_.resize(most_at_once);
  goes_on_.resize(most_at_once);
  chain_.clear();
  live_.clear();
  spare_.clear();
  for (std::size_t k = most_at_once; k > 0; --k)
    spare_.push_back(static_cast<std::uint32_t>(k - 1));
  contacts_.clear();
  first_run_ = nullptr;
  start_s_ = now_s_ = last_force_s_ = start_s;
  fastest_plan_mps_ = 0.0;
  crowded_ = false;
  steps_ = 0;
  ended_work_ = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vehicle& v = *bodies[i].vehicle;
    Member& m = members_[i];
    const Silhouettes& s = v.silhouettes;
    m.half_x = 0.5 * static_cast<double>(s.max_x - s.min_x);
    m.half_y = 0.5 * static_cast<double>(s.max_y - s.min_y);
    m.box_x = static_cast<double>(s.min_x) + m.half_x - v.center_m.x();
    m.box_y = static_cast<double>(s.min_y) + m.half_y - v.center_m.y();
    m.rim_m = std::hypot(std::abs(m.box_x) + m.half_x, std::abs(m.box_y) + m.half_y);
    m.state = v.movable() ? State::planned : State::fixed;
    ContactBody given;
    given.vehicle = &v;
    bodies[i].plan->state_at(start_s, given.pose, given.velocity);
    given.pose.translation += bodies[i].shift_m;
    if (!v.movable()) given.velocity = {};
    memory_.add_body(given, origin_m_, options.variant);
    m.pose = given.pose;
    m.start = motion_of(i);
    m.placed_s = start_s;
    if (!v.movable()) continue;
    const MotionBound bound = bodies[i].plan->bound(start_s, start_s + options.longest_s);
    fastest_plan_mps_ =
        std::max(fastest_plan_mps_,
                 bound.speed_mps + bound.angular_radps * (m.rim_m + v.center_m.head<2>().norm()));
  }
  over_ = bodies.size() < 2;
  if (over_) return;
  fastest_mps_ = fastest_plan_mps_;
  join_chain(first);
  list_near();
  open_contacts();
  first_run_ = live_with(first, partner);
}

ContactBody SceneRun::given(std::size_t i) const {
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

/// Puts a planned body where it is now.
void SceneRun::place(std::size_t i) {
  Member& m = members_[i];
  if (m.state != State::planned || m.placed_s == now_s_) return;
  m.placed_s = now_s_;
  const ContactBody body = given(i);
  motion_of(i) = make_planar(body, origin_m_);
}

void SceneRun::join_chain(std::size_t i) {
  Member& m = members_[i];
  if (m.in_chain || m.state == State::fixed) return;
  m.in_chain = true;
  m.slack_m = -1.0;
  chain_.push_back(static_cast<std::uint32_t>(i));
}

/// From its plan to what acts on it; from rest, too.
void SceneRun::touch(std::size_t i) {
  Member& m = members_[i];
  m.pressed = true;
  if (m.state == State::fixed || m.state == State::free) return;
  if (m.state == State::planned) {
    m.pose = given(i).pose;
    m.start = motion_of(i);
    m.state = State::free;
    join_chain(i);
    set_wheels(i);
  }
  m.state = State::free;
}

void SceneRun::set_wheels(std::size_t i) {
  const SceneBody& body = bodies_[i];
  if (body.footing == nullptr) return;
  Member& m = members_[i];
  m.wheels = wheels_after(*body.footing, options_.after, body.steering_rad, body.brake, m.damaged);
}

/// No smaller than the distance of their outlines: the greatest along the axes of both boxes.
double SceneRun::gap_m(std::size_t i, std::size_t j) const {
  const Member& m = members_[i];
  const Member& n = members_[j];
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  const double x =
      q.x + q.cosine * n.box_x - q.sine * n.box_y - (p.x + p.cosine * m.box_x - p.sine * m.box_y);
  const double y =
      q.y + q.sine * n.box_x + q.cosine * n.box_y - (p.y + p.sine * m.box_x + p.cosine * m.box_y);
  const double c = std::abs(p.cosine * q.cosine + p.sine * q.sine);
  const double s = std::abs(p.cosine * q.sine - p.sine * q.cosine);
  const double along_p =
      std::abs(p.cosine * x + p.sine * y) - m.half_x - c * n.half_x - s * n.half_y;
  const double beside_p =
      std::abs(p.cosine * y - p.sine * x) - m.half_y - s * n.half_x - c * n.half_y;
  const double along_q =
      std::abs(q.cosine * x + q.sine * y) - n.half_x - c * m.half_x - s * m.half_y;
  const double beside_q =
      std::abs(q.cosine * y - q.sine * x) - n.half_y - s * m.half_x - c * m.half_y;
  return std::max(std::max(along_p, beside_p), std::max(along_q, beside_q));
}

/// No two of their points are faster against each other.
double SceneRun::closing_bound(std::size_t i, std::size_t j) const {
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  // The sum of both turns first: it does not depend on which is which.
  const double turning =
      members_[i].rim_m * std::abs(p.spin) + members_[j].rim_m * std::abs(q.spin);
  return std::hypot(p.vx - q.vx, p.vy - q.vy) + turning;
}

bool SceneRun::lists(std::size_t i, std::size_t j) const {
  const auto begin = near_.begin() + static_cast<std::ptrdiff_t>(i * most_near);
  const auto end = begin + static_cast<std::ptrdiff_t>(members_[i].near);
  return std::find(begin, end, j) != end;
}

/// The nearest bodies within `listed_m`.
void SceneRun::list_near(std::size_t i) {
  Member& m = members_[i];
  m.near = 0;
  m.slack_m = listed_m;
  std::uint32_t* const list = near_.data() + i * most_near;
  const Vehicle& own = *bodies_[i].vehicle;
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    if (j == i || !can_press(own, *bodies_[j].vehicle)) continue;
    place(j);
    const double gap = gap_m(i, j);
    if (gap > listed_m) continue;
    if (m.near < most_near) {
      list[m.near++] = static_cast<std::uint32_t>(j);
      continue;
    }
    crowded_ = true;
    std::size_t furthest = 0;
    for (std::size_t k = 1; k < most_near; ++k) {
      if (gap_m(i, list[k]) > gap_m(i, list[furthest])) furthest = k;
    }
    if (gap_m(i, list[furthest]) > gap) list[furthest] = static_cast<std::uint32_t>(j);
  }
}

void SceneRun::list_near() {
  // Before the next list none that is left out comes so near as to press.
  const double needed_m = live_m + 2.0 * options_.rolling_step_s * fastest_mps_;
  for (const std::uint32_t i : chain_) {
    if (members_[i].state != State::rests && members_[i].slack_m < needed_m) list_near(i);
  }
}

/// Every pair of which one is in the chain and moves, once.
template <typename Each> void SceneRun::each_near_pair(Each each) {
  // By index: what is touched in it joins the chain.
  for (std::size_t c = 0; c < chain_.size(); ++c) {
    const std::size_t i = chain_[c];
    const Member& m = members_[i];
    if (!moves(i)) continue;
    for (std::size_t k = 0; k < m.near; ++k) {
      const std::size_t j = near_[i * most_near + k];
      if (j < i && members_[j].in_chain && moves(j) && lists(j, i)) continue;
      each(i, j);
    }
  }
}

double SceneRun::next_step_s() {
  double step_s = options_.rolling_step_s;
  for (const std::uint32_t k : live_) step_s = std::min(step_s, runs_[k].next_step_s());
  each_near_pair([&](std::size_t i, std::size_t j) {
    const double closing = closing_bound(i, j);
    if (!(closing * step_s > options_.contact.travel_m)) return;
    // Nearer ones are live and say themselves what they need.
    const double gap = gap_m(i, j);
    if (gap < live_m && live_with(i, j) != nullptr) return;
    const double free_m = std::max(gap - 0.5 * live_m, options_.contact.travel_m);
    step_s = std::min(step_s, std::max(free_m / closing, options_.contact.shortest_s));
  });
  return step_s;
}

ContactRun* SceneRun::live_with(std::size_t i, std::size_t j) {
  for (const std::uint32_t k : live_) {
    ContactRun& run = runs_[k];
    for (const std::uint32_t pair : run.pairs()) {
      const std::size_t second = memory_.pairs[pair].second;
      if ((run.first() == i && second == j) || (run.first() == j && second == i)) return &run;
    }
  }
  return nullptr;
}

/// Index of what is remembered of the two, or `no_pair`; `in_memory`: they have met before.
std::uint32_t SceneRun::pair_of(std::size_t i, std::size_t j, bool& in_memory) {
  for (std::size_t k = 0; k < memory_.pairs_in_use; ++k) {
    const BodyPair& pair = memory_.pairs[k];
    if ((pair.first == i && pair.second == j) || (pair.first == j && pair.second == i)) {
      in_memory = true;
      return static_cast<std::uint32_t>(k);
    }
  }
  in_memory = false;
  if (memory_.pairs_in_use == most_pairs) return no_pair;
  const bool swapped = goes_second(given(i), given(j));
  return memory_.take_pair(swapped ? j : i, swapped ? i : j);
}

void SceneRun::open(std::size_t i, std::size_t j) {
  bool in_memory = false;
  const std::uint32_t index = pair_of(i, j, in_memory);
  if (index == no_pair || spare_.empty()) {
    crowded_ = true;
    return;
  }
  BodyPair& pair = memory_.pairs[index];
  if (in_memory) pair.meet_again(steps_);
  const std::size_t first = pair.first;
  const std::size_t second = pair.second;
  if (members_[second].state == State::fixed) {
    for (const std::uint32_t k : live_) {
      ContactRun& run = runs_[k];
      if (run.first() != first || members_[run.second()].state != State::fixed) continue;
      if (!run.add(index)) crowded_ = true;
      return;
    }
  }
  const std::uint32_t k = spare_.back();
  spare_.pop_back();
  live_.push_back(k);
  begun_s_[k] = now_s_;
  goes_on_[k] = now_s_ < pair.faded_until_s ? 1 : 0;
  runs_[k].begin(memory_, first, index, given(first), given(second), origin_m_, options_.variant,
                 options_.contact);
}

void SceneRun::open_contacts() {
  each_near_pair([&](std::size_t i, std::size_t j) {
    if (gap_m(i, j) < live_m && live_with(i, j) == nullptr) open(i, j);
  });
}

void SceneRun::lock_damaged_wheels(std::size_t i, const Box& damaged) {
  const Footing* const footing = bodies_[i].footing;
  if (footing == nullptr || !footing->wheels || damaged.empty()) return;
  // A tyre reaches so far around its middle.
  constexpr double tyre_x_m = 0.3;
  constexpr double tyre_y_m = 0.1;
  const Vector3d& center = bodies_[i].vehicle->center_m;
  const Eigen::Array2d y = footing->y_m + center.y();
  unsigned bit = 1;
  for (const double axle_m : {footing->front_m + center.x(), footing->rear_m + center.x()}) {
    for (int side = 0; side < 2; ++side, bit *= 2) {
      const bool reached = axle_m > static_cast<double>(damaged.min.x()) - tyre_x_m &&
                           axle_m < static_cast<double>(damaged.max.x()) + tyre_x_m &&
                           y[side] > static_cast<double>(damaged.min.y()) - tyre_y_m &&
                           y[side] < static_cast<double>(damaged.max.y()) + tyre_y_m;
      if (reached) members_[i].damaged = static_cast<std::uint8_t>(members_[i].damaged | bit);
    }
  }
  set_wheels(i);
}

void SceneRun::close(ContactRun& run) {
  ended_work_ += run.work();
  for (const std::uint32_t k : run.pairs()) {
    memory_.pairs[k].left_at_step = steps_;
    if (run.faded()) memory_.pairs[k].faded_until_s = now_s_ + SceneContact::faded_s;
  }
  if (run.acts()) {
    const std::size_t first = run.first();
    const std::size_t second = run.most_pressed();
    // What moves comes first, of two the lower.
    const bool swapped = members_[first].state == State::fixed ||
                         (second < first && members_[second].state != State::fixed);
    const ContactOutcome outcome = run.outcome(swapped);
    lock_damaged_wheels(first, (swapped ? outcome.b : outcome.a).damaged);
    lock_damaged_wheels(second, (swapped ? outcome.a : outcome.b).damaged);
    tell(run, outcome, swapped);
  }
  if (&run == first_run_) first_run_ = nullptr;
}

namespace {

/// The share of a later contact's change of velocity, which begins as `given`, that is one: what
/// only makes up for what slows the body, since the earlier force or meanwhile, is none.
double lasting_share(const BodyContact& more, const ContactBody& given, const BodyContact& whole) {
  const double change = more.delta_v_mps.norm();
  if (!(change > 0.0)) return 1.0;
  const Vector3d arm = given.pose.rotation * given.vehicle->center_m;
  const Vector3d begin = given.velocity.linear_mps + given.velocity.angular_radps.cross(arm);
  const Vector3d along = more.delta_v_mps / (change * change);
  const double lost = std::clamp((whole.after.linear_mps - begin).dot(along), 0.0, 1.0);
  return std::clamp((more.after.linear_mps - begin).dot(along) - lost, 0.0, 1.0);
}

/// Since its begin, s.
double rubbed_until_s(const SceneContact& contact) {
  const ContactMotion& motion = contact.outcome.motion;
  return motion.poses[motion.count - 1].time_s;
}

/// Adds what rubbing on after the contact does to one of them: its velocity is that of before.
void add_body(const BodyContact& more, BodyContact& whole) {
  whole.after = more.after;
  whole.crush_depth_m = std::max(whole.crush_depth_m, more.crush_depth_m);
  whole.crush_energy_j += more.crush_energy_j;
  whole.intrusion_m = std::max(whole.intrusion_m, more.intrusion_m);
  whole.damaged.grow(more.damaged);
}

/// Adds rubbing on, which begins `later_s` after the contact.
void add_rubbing(const ContactOutcome& more, double later_s, ContactOutcome& whole) {
  whole.dissipated_j += more.dissipated_j;
  whole.friction_j += more.friction_j;
  add_body(more.a, whole.a);
  add_body(more.b, whole.b);
  ContactPoses last = more.motion.poses[more.motion.count - 1];
  last.time_s += later_s;
  if (whole.motion.count < ContactMotion::most) ++whole.motion.count;
  whole.motion.poses[whole.motion.count - 1] = last;
}

}  // namespace

void SceneRun::tell_pressed(const ContactRun& run, SceneContact& told) const {
  for (const std::uint32_t k : run.pairs()) {
    const BodyPair& pair = memory_.pairs[k];
    const auto end = told.pressed.begin() + static_cast<std::ptrdiff_t>(told.pressed_count);
    if (!pair.pressed || told.pressed_count == SceneContact::most_pressed ||
        std::find(told.pressed.begin(), end, pair.second) != end) {
      continue;
    }
    told.pressed[told.pressed_count++] = pair.second;
  }
}

void SceneRun::tell(const ContactRun& run, const ContactOutcome& outcome, bool swapped) {
  const std::size_t first = run.first();
  const std::size_t second = run.most_pressed();
  const bool stands = members_[second].state == State::fixed;
  const auto a = static_cast<std::uint32_t>(swapped ? second : first);
  const auto b = static_cast<std::uint32_t>(swapped ? first : second);
  const double begin_s = begun_s_[static_cast<std::size_t>(&run - runs_.data())];
  for (std::size_t k = contacts_.size(); k > 0; --k) {
    SceneContact& earlier = contacts_[k - 1];
    if (earlier.a != a || earlier.b != b) continue;
    const double later_s = begin_s - earlier.begin_s;
    if (later_s - rubbed_until_s(earlier) > SceneContact::same_contact_s) break;
    const ContactBody& given_a = swapped ? run.given_second() : run.given_first();
    const ContactBody& given_b = swapped ? run.given_first() : run.given_second();
    const double change = std::max(
        lasting_share(outcome.a, given_a, earlier.outcome.a) * outcome.a.delta_v_mps.norm(),
        lasting_share(outcome.b, given_b, earlier.outcome.b) * outcome.b.delta_v_mps.norm());
    if (change > SceneContact::rubbing_mps) break;
    add_rubbing(outcome, later_s, earlier.outcome);
    if (stands) tell_pressed(run, earlier);
    return;
  }
  if (contacts_.size() == most_contacts) {
    crowded_ = true;
    return;
  }
  contacts_.push_back({});
  SceneContact& told = contacts_.back();
  told.a = a;
  told.b = b;
  told.begin_s = begin_s;
  told.goes_on = goes_on_[static_cast<std::size_t>(&run - runs_.data())] != 0;
  told.is_first = &run == first_run_;
  told.outcome = outcome;
  const ContactBody given_second = stands ? given(second) : run.given_second();
  told.given_a = swapped ? given_second : run.given_first();
  told.given_b = swapped ? run.given_first() : given_second;
  if (!stands) return;
  tell_pressed(run, told);
  // Of several that nothing moves the contact may have begun with another.
  ContactMotion& motion = told.outcome.motion;
  for (std::size_t k = 0; k < motion.count; ++k) {
    (swapped ? motion.poses[k].a : motion.poses[k].b) = given_second.pose;
  }
}

/// What has come to rest stays until it is pushed.
void SceneRun::settle() {
  bool all_rest = true;
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    PlanarBody& b = motion_of(i);
    if (m.state == State::free && !m.pressed && rim_speed(b, m.rim_m) < rest_mps) {
      b.vx = b.vy = b.spin = 0.0;
      m.state = State::rests;
    }
    m.pressed = false;
    all_rest = all_rest && m.state == State::rests;
  }
  over_ = all_rest || now_s_ - last_force_s_ > options_.after_last_contact_s ||
          now_s_ - start_s_ > options_.longest_s;
  if (!over_) return;
  for (const std::uint32_t k : live_) close(runs_[k]);
  live_.clear();
}

/// Forces of the road. During an impact they are left out, as impact mechanics does: the contact
/// law is validated without them.
void SceneRun::drive_on_road(std::size_t i, double step_s) {
  // A contact whose force is no larger than a few of the road's pushes its body along: what the
  // road takes of it at once is no change of velocity.
  constexpr double pushing = 2.0;
  constexpr double impact_s = 0.05;
  const SceneBody& body = bodies_[i];
  const double grip =
      body.footing->wheels ? options_.grip : std::min(options_.grip, options_.sliding_grip);
  const double pushed_mps = pushing * grip * standard_gravity * step_s;
  Member& m = members_[i];
  const auto each_run = [&](auto&& each) {
    for (const std::uint32_t k : live_) {
      ContactRun& run = runs_[k];
      if (run.presses() && (run.first() == i || run.second() == i)) each(run, run.first() == i);
    }
  };
  each_run([&](const ContactRun& run, bool is_first) {
    if (run.step_change_mps(is_first).norm() > pushed_mps) m.struck_s = now_s_;
  });
  if (now_s_ - m.struck_s < impact_s) return;
  PlanarBody& b = motion_of(i);
  const PlanarBody before = b;
  drive(*body.footing, m.wheels, grip, step_s, b);
  each_run([&](ContactRun& run, bool is_first) {
    const Eigen::Vector2d pushed = run.step_change_mps(is_first);
    const double change2 = pushed.squaredNorm();
    if (!(change2 > 0.0)) return;
    const double against =
        -((b.vx - before.vx) * pushed.x() + (b.vy - before.vy) * pushed.y()) / change2;
    run.take_back(is_first, std::clamp(against, 0.0, 1.0));
  });
}

void SceneRun::step() {
  list_near();
  const double step_s = next_step_s();
  fastest_mps_ = fastest_plan_mps_;
  for (const std::uint32_t i : chain_) {
    if (members_[i].state == State::free) motion_of(i).move(0.5 * step_s);
  }
  now_s_ += 0.5 * step_s;
  for (const std::uint32_t i : chain_) {
    place(i);
    if (!moves(i)) continue;
    for (std::size_t k = 0; k < members_[i].near; ++k) place(near_[i * most_near + k]);
  }
  open_contacts();
  for (const std::uint32_t k : live_) runs_[k].feel(step_s);
  for (const std::uint32_t k : live_) {
    ContactRun& run = runs_[k];
    if (!run.presses()) continue;
    last_force_s_ = now_s_;
    if (!run.acts() && &run != first_run_) {
      run.begin_here(given(run.first()), given(run.second()));
      begun_s_[k] = now_s_;
    }
    touch(run.first());
    for (const std::uint32_t pair : run.pairs()) touch(memory_.pairs[pair].second);
  }
  for (const std::uint32_t k : live_) runs_[k].press();
  for (const std::uint32_t i : chain_) {
    Member& m = members_[i];
    if (m.state != State::free) continue;
    PlanarBody& b = motion_of(i);
    if (bodies_[i].footing != nullptr) drive_on_road(i, step_s);
    b.move(0.5 * step_s);
    fastest_mps_ = std::max(fastest_mps_, rim_speed(b, m.rim_m));
  }
  now_s_ += 0.5 * step_s;
  ++steps_;
  for (std::size_t k = 0; k < live_.size();) {
    ContactRun& run = runs_[live_[k]];
    run.end_step();
    if (!run.over()) {
      ++k;
      continue;
    }
    close(run);
    spare_.push_back(live_[k]);
    live_.erase(live_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  // Both of a pair may have moved as far.
  for (const std::uint32_t i : chain_) members_[i].slack_m -= 2.0 * step_s * fastest_mps_;
  settle();
}

bool SceneRun::advance(int steps) {
  for (int i = 0; i < steps && !over_; ++i) step();
  return !over_;
}

std::uint64_t SceneRun::work() const noexcept {
  std::uint64_t pieces = ended_work_;
  for (const std::uint32_t k : live_) pieces += runs_[k].work();
  return pieces;
}

}  // namespace crashrank::detail
