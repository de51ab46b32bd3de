#include "rank/futures.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "scenario/motion_check.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace crashrank::detail {
namespace {

/// Numbers of combinations above this count as this.
constexpr double countable = 1e300;

bool has_errors(const Scenario& scenario) {
  return scenario.ego.uncertainty.any() ||
         std::any_of(scenario.actors.begin(), scenario.actors.end(),
                     [](const ScenarioActor& actor) { return actor.perception.any(); });
}

}  // namespace

Result<Futures> Futures::make(const Scenario& scenario, std::size_t sampled) {
  Futures made;
  made.actors_ = scenario.actors.size();
  made.left_out_.assign(made.actors_, 0);
  made.reached_.assign(made.actors_, 1);
  Status sound = Success{};
  const auto add = [&](std::size_t actor, const ActorMotion& motion, double probability,
                       const std::string& place) {
    Result<Motion> plan = make_motion(motion, place);
    if (plan) {
      if (const char* const fault = motion_fault(*plan, scenario.horizon_s)) {
        if (sound) sound = refused_motion(place, "its motion", fault);
      }
      made.plans.push_back({actor, std::move(*plan), probability});
    } else if (sound) {
      sound = plan.error();
    }
  };
  for (std::size_t i = 0; i < made.actors_; ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const std::string place = actor_place(i, actor.name);
    made.first_plan_.push_back(static_cast<std::uint32_t>(made.plans.size()));
    made.existence_.push_back(actor.existence_probability);
    made.seed_.push_back(seed_of(actor.name));
    for (std::size_t k = 0; k < actor.predictions.size(); ++k) {
      const Prediction& prediction = actor.predictions[k];
      add(i, prediction, prediction.probability, place + ".predictions[" + std::to_string(k) + "]");
    }
    double present = 1.0;
    std::size_t moved = 0;
    std::size_t absences = 0;
    for (std::size_t f = 0; f < scenario.futures.size(); ++f) {
      for (const FutureMotion& motion : scenario.futures[f].motions) {
        if (motion.actor != i) continue;
        ++moved;
        add(i, motion.motion, 1.0, "futures[" + std::to_string(f) + "].motions." + actor.name);
      }
      const std::vector<std::size_t>& missing = scenario.futures[f].absent;
      if (std::find(missing.begin(), missing.end(), i) == missing.end()) continue;
      ++absences;
      present -= scenario.futures[f].probability;
    }
    if (actor.predictions.empty() && (moved == 0 || moved + absences < scenario.futures.size())) {
      add(i, actor, 1.0, place);
    }
    // An actor with any absence is not certain, however improbable the absence is.
    constexpr double just_below_one = 1.0 - 1e-15;
    if (absences > 0) made.existence_.back() = std::clamp(present, 0.0, just_below_one);
  }
  if (!sound) return sound.error();
  made.own_plans_ = made.plans.size();
  made.first_plan_.push_back(static_cast<std::uint32_t>(made.own_plans_));

  FutureSummary& summary = made.summary;
  summary.risk = scenario.risk;
  summary.sampled = std::max<std::size_t>(sampled, 1);
  summary.has_state_errors = has_errors(scenario);
  made.choices_.prepare(made.first_plan_, made.existence_);
  if (!scenario.futures.empty()) made.read_joint(scenario);
  made.update_choices();
  made.by_seed_.resize(made.actors_);
  std::iota(made.by_seed_.begin(), made.by_seed_.end(), std::size_t{0});
  std::stable_sort(made.by_seed_.begin(), made.by_seed_.end(),
                   [&](std::size_t p, std::size_t q) { return made.seed_[p] < made.seed_[q]; });
  made.strata_.prepare(summary.sampled);
  made.sample_.prepare(summary.sampled, std::max<std::size_t>(made.actors_, 1),
                       std::max(made.own_plans_ + made.actors_, made.joint_.written()));
  summary.drawn.reserve(summary.sampled);
  summary.fitted.choices.reserve(summary.sampled * made.actors_);
  if (summary.has_state_errors) made.read_errors(scenario);
  made.reserve();
  made.list_futures();
  return made;
}

void Futures::reserve() {
  constexpr auto listed = static_cast<double>(max_combinations);
  const std::size_t drawn = summary.sampled + 1;
  const double combinations = choices_.most_combinations();
  if (summary.has_state_errors) {
    max_future_count_ = drawn;
  } else if (is_joint()) {
    max_future_count_ = joint_.written();
  } else {
    max_future_count_ = combinations <= listed ? static_cast<std::size_t>(combinations)
                                               : std::max(max_combinations, drawn);
  }
  probability_.reserve(max_future_count_);
  plan_of_.reserve(max_future_count_ * actors_);
  followed_.reserve(plans.size());
}

bool Futures::update_choices() {
  bool changed = choices_.update(plans);
  if (is_joint()) changed = joint_.update(choices_) || changed;
  double combinations = 1.0;
  for (std::size_t i = 0; i < actors_; ++i) {
    combinations = std::min(combinations * static_cast<double>(choices_.count(i)), countable);
  }
  summary.combinations = is_joint() ? static_cast<double>(joint_.size()) : combinations;
  return changed;
}

void Futures::update_motions() {
  if (update_choices()) {
    std::fill(reached_.begin(), reached_.end(), char{1});
    list_futures();
  }
  displace_plans();
}

void Futures::set_existence(std::size_t actor, bool exists) {
  existence_[actor] = exists ? 1.0 : 0.0;
  choices_.set_existence(actor, existence_[actor]);
  std::fill(reached_.begin(), reached_.end(), char{1});
  list_futures();
}

/// Lists all futures, or draws a sample if there are too many.
void Futures::list_futures() {
  leave_out();
  const double combined = is_joint() ? summary.combinations : count_combinations();
  const bool lists = is_joint() || combined <= double{max_combinations};
  summary.sampled = summary.undrawn = 0;
  summary.drawn.clear();
  summary.fitted.actors = 0;
  summary.fitted.choices.clear();
  if (summary.has_state_errors || !lists) {
    summary.method = FutureMethod::sampled;
    summary.sampled = strata_.samples();
    add_sample();
  } else if (is_joint()) {
    summary.method = FutureMethod::joint;
    add_joint();
  } else {
    summary.method = summary.combinations > 1.0 ? FutureMethod::all : FutureMethod::certain;
    add_combinations();
  }
  summary.futures = size();
}

double Futures::count_combinations() const {
  double count = 1.0;
  for (std::size_t i = 0; i < actors_; ++i) {
    count = std::min(count * static_cast<double>(combined_choices(i)), countable);
  }
  return count;
}

bool Futures::can_leave_out() const noexcept {
  return !is_joint() && choices_.most_combinations() > 1.0;
}

bool Futures::leave_out_beyond(const std::vector<char>& ring, char last) {
  bool same = true;
  for (std::size_t i = 0; i < actors_; ++i) {
    const char near = ring[i] <= last || choices_.count(i) == 1 ? 1 : 0;
    same = same && near == reached_[i];
    reached_[i] = near;
  }
  if (!same) list_futures();
  return !same;
}

/// Leaves out the actors that no candidate reaches if all combinations of the others are listed. A
/// sample draws them as stated.
void Futures::leave_out() {
  const auto none = [this] {
    std::fill(left_out_.begin(), left_out_.end(), char{0});
    summary.left_out = 0;
  };
  none();
  if (is_joint() || summary.has_state_errors) return;
  for (std::size_t i = 0; i < actors_; ++i) {
    left_out_[i] = reached_[i] == 0 && choices_.count(i) > 1 ? 1 : 0;
    summary.left_out += static_cast<std::size_t>(left_out_[i]);
  }
  if (count_combinations() > double{max_combinations}) none();
}

bool Futures::mark_needed(const std::vector<char>& relevant, std::vector<char>& needed) const {
  if (!leaves_out()) return false;
  bool any = false;
  for (std::size_t p = 0; p < own_plans_; ++p) {
    if (relevant[p] == 0 || left_out_[plans[p].actor] == 0) continue;
    needed[plans[p].actor] = 1;
    any = true;
  }
  return any;
}

double Futures::combinations_within(const std::vector<char>& ring, char last) const {
  double count = 1.0;
  for (std::size_t i = 0; i < actors_; ++i) {
    if (ring[i] <= last)
      count = std::min(count * static_cast<double>(choices_.count(i)), countable);
  }
  return count;
}

void Futures::mark_followed_plans() {
  followed_.assign(plans.size(), 0);
  for (std::size_t f = 0; f < size(); ++f) {
    if (!(probability_[f] > 0.0)) continue;
    for (std::size_t i = 0; i < actors_; ++i) {
      if (const std::uint32_t p = plan(f, i); p != absent) followed_[p] = 1;
    }
  }
  for (std::size_t p = 0; p < own_plans_; ++p) {
    const std::size_t actor = plans[p].actor;
    if (left_out_[actor] != 0 && existence_[actor] > 0.0) followed_[p] = 1;
  }
}

bool Futures::is_certain(std::size_t actor) const {
  return existence_[actor] == 1.0 && first_plan_[actor + 1] - first_plan_[actor] == 1 &&
         (displaced_.empty() || displaced_[actor] == not_displaced);
}

void Futures::read_joint(const Scenario& scenario) {
  // The plans of an actor are ordered: one for each future that lists it, then its own motion.
  std::vector<std::uint32_t> next(first_plan_.begin(), first_plan_.end() - 1);
  std::vector<std::uint32_t> followed;
  for (const JointFuture& future : scenario.futures) {
    const std::size_t row = followed.size();
    for (std::size_t i = 0; i < actors_; ++i) followed.push_back(first_plan_[i + 1] - 1);
    for (const FutureMotion& moved : future.motions)
      followed[row + moved.actor] = next[moved.actor]++;
    for (const std::size_t actor : future.absent) followed[row + actor] = absent;
  }
  joint_.prepare(scenario, std::move(followed));
}

void Futures::add_joint() {
  probability_.clear();
  plan_of_.clear();
  for (std::size_t f = 0; f < joint_.size(); ++f) {
    probability_.push_back(joint_.probability(f));
    for (std::size_t i = 0; i < actors_; ++i) plan_of_.push_back(joint_.plan(choices_, f, i));
  }
  likeliest_ = joint_.likeliest();
  mark_followed_plans();
}

void Futures::add_combinations() {
  probability_.clear();
  plan_of_.clear();
  const auto count = static_cast<std::size_t>(count_combinations());
  likeliest_ = 0;
  for (std::size_t f = 0; f < count; ++f) {
    double probability = 1.0;
    bool is_likeliest = true;
    std::size_t rest = f;
    for (std::size_t i = 0; i < actors_; ++i) {
      const bool is_out = left_out_[i] != 0;
      const std::size_t choice = is_out ? choices_.likeliest(i) : rest % choices_.count(i);
      rest /= combined_choices(i);
      if (!is_out) probability *= choices_.probability(i, choice);
      is_likeliest = is_likeliest && choice == choices_.likeliest(i);
      plan_of_.push_back(choices_.plan(i, choice));
    }
    probability_.push_back(probability);
    if (is_likeliest) likeliest_ = f;
  }
  mark_followed_plans();
}

/// Draws the errors of all states and allocates the displaced plans.
void Futures::read_errors(const Scenario& scenario) {
  const std::size_t count = summary.sampled;
  ego_uncertainty_ = scenario.ego.uncertainty;
  if (displaces_ego()) {
    ego_errors_.assign(count + 1, {});
    strata_.draw(reserved_seed("ego"), ego_uncertainty_, ego_errors_.data());
    for (const StateError& error : ego_errors_) {
      ego_speed_errors_[0] = std::min(ego_speed_errors_[0], error.speed_mps);
      ego_speed_errors_[1] = std::max(ego_speed_errors_[1], error.speed_mps);
    }
  }
  displaced_.assign(actors_, not_displaced);
  for (std::size_t i = 0; i < actors_; ++i) {
    if (!scenario.actors[i].perception.any()) continue;
    displaced_[i] = static_cast<std::uint32_t>(plans.size());
    errors_.resize(errors_.size() + count);
    strata_.draw(seed_of(scenario.actors[i].name), scenario.actors[i].perception,
                 errors_.data() + (displaced_[i] - own_plans_));
    const Plan own = plans[first_plan_[i]];
    plans.resize(plans.size() + count, own);
  }
  base_plans_.assign(errors_.size(), absent);
}

void Futures::add_sample() {
  const std::size_t count = summary.sampled;
  plan_of_.assign((count + 1) * actors_, absent);
  likeliest_ = count;
  draw_plans();
  summary.drawn.assign(sample_.drawn().begin(), sample_.drawn().end());
  summary.fitted = sample_.fitted();
  summary.undrawn = sample_.undrawn();
  probability_.clear();
  for (const DrawnFuture& drawn : summary.drawn) probability_.push_back(drawn.probability);
  probability_.push_back(0.0);
  mark_followed_plans();
  std::fill(base_plans_.begin(), base_plans_.end(), absent);
  for (std::size_t i = 0; i < displaced_.size(); ++i) {
    if (displaced_[i] == not_displaced) continue;
    for (std::size_t f = 0; f < count; ++f) {
      std::uint32_t& plan = plan_of_[f * actors_ + i];
      if (plan == absent) continue;
      const std::uint32_t moved = displaced_[i] + static_cast<std::uint32_t>(f);
      base_plans_[moved - own_plans_] = plan;
      followed_[moved] = 1;
      plan = moved;
    }
  }
  displace_plans();
}

void Futures::displace_plans() {
  for (std::size_t k = 0; k < base_plans_.size(); ++k) {
    Plan& moved = plans[own_plans_ + k];
    // A future in which the actor is absent has no base plan: the unused displaced plan then gets
    // the first one.
    moved.motion =
        plans[base_plans_[k] != absent ? base_plans_[k] : first_plan_[moved.actor]].motion;
    moved.motion.displace(errors_[k]);
  }
}

/// Draws what every actor does. Variables are in the order of their seeds, so that the order of
/// actors has no effect.
void Futures::draw_plans() {
  sample_.clear();
  if (is_joint()) {
    sample_.add_variable(reserved_seed("futures"));
    for (std::size_t k = 0; k < joint_.size(); ++k) sample_.add_choice(joint_.probability(k));
  } else {
    for (const std::size_t i : by_seed_) {
      if (choices_.count(i) == 1) continue;
      sample_.add_variable(seed_[i], reached_[i] != 0);
      for (std::size_t k = 0; k < choices_.count(i); ++k) {
        sample_.add_choice(choices_.probability(i, k));
      }
    }
  }
  sample_.draw(strata_);
  std::size_t variable = 0;
  for (const std::size_t i : by_seed_) {
    const bool drawn = !is_joint() && choices_.count(i) > 1;
    for (std::size_t f = 0; f < summary.sampled; ++f) {
      plan_of_[f * actors_ + i] = is_joint() ? joint_.plan(choices_, sample_.choice(f, 0), i)
                                  : drawn    ? choices_.plan(i, sample_.choice(f, variable))
                                             : choices_.plan(i, 0);
    }
    plan_of_[likeliest_ * actors_ + i] = is_joint() ? joint_.plan(choices_, joint_.likeliest(), i)
                                                    : choices_.plan(i, choices_.likeliest(i));
    if (drawn) ++variable;
  }
}

void Futures::split(std::size_t future, const std::vector<char>& relevant,
                    std::vector<std::uint32_t>& futures, std::vector<std::uint32_t>& others) const {
  const auto relevant_plan = [&](std::size_t of, std::size_t actor) {
    const std::uint32_t p = plan(of, actor);
    return p != absent && relevant[p] != 0 ? p : absent;
  };
  std::size_t kept = 0;
  for (const std::uint32_t other : futures) {
    bool same = true;
    for (std::size_t i = 0; i < actors_ && same; ++i) {
      same = relevant_plan(future, i) == relevant_plan(other, i);
    }
    if (same) {
      futures[kept++] = other;
    } else {
      others.push_back(other);
    }
  }
  futures.resize(kept);
}

void Futures::set_probabilities(View<const double> probabilities) {
  for (std::size_t p = 0; p < own_plans_; ++p) plans[p].probability = probabilities[p];
  update_choices();
  list_futures();
}

}  // namespace crashrank::detail
