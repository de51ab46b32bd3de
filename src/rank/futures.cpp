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

constexpr std::uint64_t sample_seed = 0x6372617368;

/// One number of the sequence that a state stands for (splitmix64, Steele, Lea & Flood 2014).
std::uint64_t next_word(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t word = state;
  word = (word ^ (word >> 30U)) * 0xbf58476d1ce4e5b9U;
  word = (word ^ (word >> 27U)) * 0x94d049bb133111ebU;
  return word ^ (word >> 31U);
}

/// In [0, 1).
double next_share(std::uint64_t& state) {
  return static_cast<double>(next_word(state) >> 11U) * 0x1.0p-53;
}

/// By its name, so that no sample depends on the order of the actors.
std::uint64_t seed_of(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash ^ sample_seed;
}

}  // namespace

Result<Futures> Futures::make(const Scenario& scenario, std::size_t sampled) {
  Futures made;
  made.actors_ = scenario.actors.size();
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
    const std::string place = "actors." + actor.name;
    made.first_plan_.push_back(static_cast<std::uint32_t>(made.plans.size()));
    made.existence_.push_back(actor.existence_probability);
    made.seed_.push_back(seed_of(actor.name));
    double sum = 0.0;
    for (const Prediction& prediction : actor.predictions) sum += prediction.probability;
    for (std::size_t k = 0; k < actor.predictions.size(); ++k) {
      const Prediction& prediction = actor.predictions[k];
      add(i, prediction, prediction.probability / sum,
          place + ".predictions[" + std::to_string(k) + "]");
    }
    std::size_t moved = 0;
    for (std::size_t f = 0; f < scenario.futures.size(); ++f) {
      for (const FutureMotion& motion : scenario.futures[f].motions) {
        if (motion.actor != i) continue;
        ++moved;
        add(i, motion.motion, 1.0, "futures[" + std::to_string(f) + "].motions." + actor.name);
      }
    }
    if (actor.predictions.empty() && (moved == 0 || moved < scenario.futures.size())) {
      add(i, actor, 1.0, place);
    }
  }
  if (!sound) return sound.error();
  made.first_plan_.push_back(static_cast<std::uint32_t>(made.plans.size()));

  FutureSummary& summary = made.summary;
  summary.risk = scenario.risk;
  if (!scenario.futures.empty()) {
    summary.method = FutureMethod::joint;
    summary.combinations = static_cast<double>(scenario.futures.size());
    made.add_joint(scenario);
  } else {
    summary.combinations = 1.0;
    for (std::size_t i = 0; i < made.actors_; ++i) {
      constexpr double countable = 1e300;
      summary.combinations =
          std::min(summary.combinations * static_cast<double>(made.choices(i)), countable);
    }
    if (summary.combinations <= static_cast<double>(most_combinations)) {
      summary.method = summary.combinations > 1.0 ? FutureMethod::all : FutureMethod::certain;
      made.add_combinations();
    } else {
      summary.method = FutureMethod::sampled;
      summary.sampled = std::max<std::size_t>(sampled, 1);
      made.strata_.resize(summary.sampled);
      made.add_sample();
    }
  }
  summary.futures = made.size();
  made.note_followed();
  return made;
}

void Futures::note_followed() {
  followed_.assign(plans.size(), 0);
  for (std::size_t f = 0; f < size(); ++f) {
    if (!(probability_[f] > 0.0)) continue;
    for (std::size_t i = 0; i < actors_; ++i) {
      if (const std::uint32_t p = plan(f, i); p != absent) followed_[p] = 1;
    }
  }
}

std::size_t Futures::choices(std::size_t actor) const {
  const std::size_t count = first_plan_[actor + 1] - first_plan_[actor];
  if (existence_[actor] == 0.0) return 1;
  return existence_[actor] < 1.0 ? count + 1 : count;
}

std::uint32_t Futures::plan_of_choice(std::size_t actor, std::size_t choice) const {
  const auto plan = first_plan_[actor] + static_cast<std::uint32_t>(choice);
  return existence_[actor] == 0.0 || plan >= first_plan_[actor + 1] ? absent : plan;
}

double Futures::choice_probability(std::size_t actor, std::size_t choice) const {
  const std::uint32_t plan = plan_of_choice(actor, choice);
  return plan == absent ? 1.0 - existence_[actor] : existence_[actor] * plans[plan].probability;
}

std::size_t Futures::likeliest_choice(std::size_t actor) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < choices(actor); ++k) {
    if (choice_probability(actor, k) > choice_probability(actor, best)) best = k;
  }
  return best;
}

bool Futures::is_certain(std::size_t actor) const {
  return existence_[actor] == 1.0 && first_plan_[actor + 1] - first_plan_[actor] == 1;
}

void Futures::add_joint(const Scenario& scenario) {
  double sum = 0.0;
  for (const JointFuture& future : scenario.futures) sum += future.probability;
  // Each actor's plans: one for each future that lists it, in their order, then its own.
  std::vector<std::uint32_t> next(first_plan_.begin(), first_plan_.end() - 1);
  for (const JointFuture& future : scenario.futures) {
    probability_.push_back(future.probability / sum);
    const std::size_t row = plan_of_.size();
    for (std::size_t i = 0; i < actors_; ++i) plan_of_.push_back(first_plan_[i + 1] - 1);
    for (const FutureMotion& moved : future.motions)
      plan_of_[row + moved.actor] = next[moved.actor]++;
  }
  likeliest_ = static_cast<std::size_t>(std::max_element(probability_.begin(), probability_.end()) -
                                        probability_.begin());
}

void Futures::add_combinations() {
  probability_.clear();
  plan_of_.clear();
  std::vector<std::size_t>::size_type count = 1;
  for (std::size_t i = 0; i < actors_; ++i) count *= choices(i);
  likeliest_ = 0;
  for (std::size_t f = 0; f < count; ++f) {
    double probability = 1.0;
    bool is_likeliest = true;
    std::size_t rest = f;
    for (std::size_t i = 0; i < actors_; ++i) {
      const std::size_t choice = rest % choices(i);
      rest /= choices(i);
      probability *= choice_probability(i, choice);
      is_likeliest = is_likeliest && choice == likeliest_choice(i);
      plan_of_.push_back(plan_of_choice(i, choice));
    }
    probability_.push_back(probability);
    if (is_likeliest) likeliest_ = f;
  }
}

/// A Latin hypercube (McKay, Beckman & Conover 1979): each actor's probabilities are cut into as
/// many equal strata as there are samples, and each sample takes one of every actor.
void Futures::add_sample() {
  const std::size_t count = summary.sampled;
  probability_.assign(count, 1.0 / static_cast<double>(count));
  plan_of_.assign(count * actors_, absent);
  for (std::size_t i = 0; i < actors_; ++i) draw(i);
  probability_.push_back(0.0);
  for (std::size_t i = 0; i < actors_; ++i) {
    plan_of_.push_back(plan_of_choice(i, likeliest_choice(i)));
  }
  likeliest_ = count;
}

void Futures::draw(std::size_t actor) {
  std::uint64_t state = seed_[actor];
  const std::size_t count = strata_.size();
  std::iota(strata_.begin(), strata_.end(), 0U);
  for (std::size_t k = count; k > 1; --k) {
    std::swap(strata_[k - 1], strata_[next_word(state) % k]);
  }
  for (std::size_t f = 0; f < count; ++f) {
    const double share =
        (static_cast<double>(strata_[f]) + next_share(state)) / static_cast<double>(count);
    double reached = 0.0;
    std::size_t choice = 0;
    for (; choice + 1 < choices(actor); ++choice) {
      reached += choice_probability(actor, choice);
      if (share < reached) break;
    }
    plan_of_[f * actors_ + actor] = plan_of_choice(actor, choice);
  }
}

void Futures::split(std::size_t future, const std::vector<char>& felt,
                    std::vector<std::uint32_t>& futures, std::vector<std::uint32_t>& others) const {
  const auto felt_plan = [&](std::size_t of, std::size_t actor) {
    const std::uint32_t p = plan(of, actor);
    return p != absent && felt[p] != 0 ? p : absent;
  };
  std::size_t kept = 0;
  for (const std::uint32_t other : futures) {
    bool same = true;
    for (std::size_t i = 0; i < actors_ && same; ++i) {
      same = felt_plan(future, i) == felt_plan(other, i);
    }
    if (same) {
      futures[kept++] = other;
    } else {
      others.push_back(other);
    }
  }
  futures.resize(kept);
}

void Futures::weigh(View<const double> probabilities) {
  for (std::size_t p = 0; p < plans.size(); ++p) plans[p].probability = probabilities[p];
  if (summary.method == FutureMethod::sampled) {
    add_sample();
  } else if (summary.method != FutureMethod::joint) {
    add_combinations();
  }
  note_followed();
}

}  // namespace crashrank::detail
