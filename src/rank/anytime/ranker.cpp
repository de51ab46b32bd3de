#include "crashrank/rank/anytime/ranker.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "rank/anytime/ranker_state.hpp"
#include "rank/order.hpp"
#include "rank/reach.hpp"
#include "scenario/motion_check.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {

namespace {

using detail::CandidateState;
using detail::Deadline;
using detail::seconds_between;

Deadline ends_after(double seconds, Deadline::Clock::time_point start,
                    const std::atomic<bool>* cancel) noexcept {
  constexpr double longest_s = 1e6;
  if (!(seconds < longest_s)) return Deadline(cancel);
  return Deadline(start + std::chrono::duration_cast<Deadline::Clock::duration>(
                              std::chrono::duration<double>(std::max(seconds, 0.0))),
                  cancel);
}

}  // namespace

Ranker::Ranker(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Ranker::Ranker(Ranker&&) noexcept = default;
Ranker& Ranker::operator=(Ranker&&) noexcept = default;
Ranker::~Ranker() = default;

namespace {

Status check_limits(const RankerLimits& limits, const Scenario& scenario,
                    View<const Model> models) {
  if (scenario.actors.size() > limits.actors) {
    return make_error(ErrorCode::usage, "the scenario has more actors than the Ranker's limit",
                      "raise RankerLimits::actors");
  }
  for (const Model& model : models) {
    if (model.mesh.size() > limits.triangles) {
      return make_error(ErrorCode::usage, "a model has more triangles than the Ranker's limit",
                        "raise RankerLimits::triangles or simplify the model");
    }
  }
  return Success{};
}

Error refused_motion_of(const char* whose, std::size_t index, const char* fault) {
  return detail::refused_motion(whose + std::string("[") + std::to_string(index) + "]",
                                "its motion", fault);
}

Status check_call(View<const Candidate> candidates, const RankBudget& budget,
                  const detail::Scene& scene, std::size_t most) {
  if (candidates.size() > most) {
    return make_error(ErrorCode::usage, "more candidates than the Ranker's limit",
                      "raise RankerLimits::candidates");
  }
  if (std::isnan(budget.deadline_s)) {
    return make_error(ErrorCode::usage, "the deadline is not a number",
                      "give seconds, infinity for none");
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (const char* const fault = detail::motion_fault(candidate.motion, scene.slice_s.back())) {
      return refused_motion_of("candidates", i, fault);
    }
    if (!detail::begins_at(candidate.motion.pose_at(0.0), scene.ego_start)) {
      Error error = refused_motion_of("candidates", i,
                                      "begins more than 1 m or 30 degrees from the ego's pose");
      error.remedy = "make the candidates again after each move_actors";
      return error;
    }
    // These values break ties.
    if (!std::isfinite(candidate.acceleration_mps2) || !std::isfinite(candidate.curvature_per_m)) {
      return refused_motion_of("candidates", i,
                               "has an acceleration or curvature that is not finite");
    }
  }
  return Success{};
}

}  // namespace

Result<Ranker> Ranker::prepare(const Scenario& scenario, View<const Model> models,
                               const RankerOptions& options) {
  const auto start = Deadline::Clock::now();
  return detail::guarded([&]() -> Result<Ranker> {
    if (Status shared = detail::check_workers(options.rank.workers); !shared) return shared.error();
    const Status sound = detail::check_scenario(scenario);
    if (!sound) return sound.error();
    const Status fits = check_limits(options.limits, scenario, models);
    if (!fits) return fits.error();
    RankResult bodies;
    const RankOptions& how = options.rank;
    if (how.order != RankOrder::score) {
      return make_error(ErrorCode::usage, "an answer in time has no samples for the order 'upper'",
                        "order by score, or rank without a deadline, a budget or --first-place");
    }
    if (how.harm) {
      const Status weighed = detail::check_harm(*how.harm, "harm");
      if (!weighed) return weighed.error();
    }
    Result<detail::Scene> scene = detail::make_scene(scenario, models, how, bodies);
    if (!scene) return scene.error();
    bodies.measure = scene->measure;
    bodies.harm = scene->harm;
    PoolOptions threads;
    threads.workers = std::min(std::max(how.workers, 1U) - 1U, max_workers);
    threads.spin_us = options.spin_us;
    Result<WorkerPool> pool = WorkerPool::start(threads);
    if (!pool) return pool.error();
    std::vector<HarmSample> samples;
    samples.swap(scene->samples);
    auto state = std::make_unique<State>(std::move(*scene), std::move(*pool));
    state->samples = std::move(samples);
    state->limits = options.limits;
    state->bodies = std::move(bodies);
    state->bounds.prepare(state->scene);
    state->states.resize(options.limits.candidates);
    for (CandidateState& each : state->states) each.reserve(state->scene.futures);
    state->ranking.resize(options.limits.candidates);
    state->queue.prepare(options.limits.candidates);
    state->rounds.prepare(options.limits.candidates);
    state->new_motions.resize(state->scene.futures.own_plans());
    state->rings.resize(state->scene.actors.size());
    state->needed.resize(state->scene.actors.size());
    for (std::size_t i = 0; i < state->scene.actors.size(); ++i) {
      const bool moves = !state->scene.actors[i].vehicle->stands();
      state->places.push_back(moves && state->scene.futures.can_enter(i) ? 1 : 0);
    }
    state->prepare_s = seconds_between(start, Deadline::Clock::now());
    return Ranker(std::move(state));
  });
}

Status Ranker::move_actors(const Pose& ego_start, View<const Motion> actors,
                           std::optional<EgoMotion> ego) noexcept {
  state_->rounds.await();
  return detail::guarded([&]() -> Status {
    detail::Scene& scene = state_->scene;
    std::vector<Motion>& new_motions = state_->new_motions;
    std::vector<detail::Plan>& plans = scene.futures.plans;
    if (actors.size() != new_motions.size()) {
      return make_error(ErrorCode::usage, "there is not one motion for each actor's plan",
                        "give them in the order of Ranker::plans");
    }
    if (const char* const fault = detail::pose_fault(ego_start)) {
      return detail::refused_motion("ego", "its pose", fault);
    }
    if (ego && !(std::abs(ego->speed_mps) <= scenario_limits::fastest_mps &&
                 std::isfinite(ego->yaw_rate_radps))) {
      return detail::refused_motion("ego", "its motion", "is not finite or faster than 300 m/s");
    }
    for (std::size_t i = 0; i < actors.size(); ++i) {
      if (!scene.futures.exists(plans[i].actor)) {
        new_motions[i] = plans[i].motion;
        continue;
      }
      if (const char* const fault = detail::motion_fault(actors[i], scene.slice_s.back())) {
        return refused_motion_of("actors", i, fault);
      }
      new_motions[i] = actors[i];
    }
    // Nothing can fail from here on.
    for (std::size_t i = 0; i < actors.size(); ++i) std::swap(plans[i].motion, new_motions[i]);
    scene.futures.update_motions();
    scene.ego_start = ego_start;
    scene.limits.speed_mps = ego ? ego->speed_mps : std::numeric_limits<double>::quiet_NaN();
    scene.limits.yaw_rate_radps = ego ? ego->yaw_rate_radps : 0.0;
    detail::update_plans(scene, state_->rounds.caller_scratch().impact);
    state_->bounds.update(scene);
    return Success{};
  });
}

bool Ranker::can_enter(std::size_t actor, std::size_t model) const noexcept {
  const auto& entering = state_->scene.entering;
  return actor < state_->places.size() && state_->places[actor] != 0 && model < entering.size() &&
         entering[model].has_value();
}

Status Ranker::enter(std::size_t actor, std::size_t model, const Motion& motion,
                     std::optional<double> occupants) noexcept {
  state_->rounds.await();
  return detail::guarded([&]() -> Status {
    detail::Scene& scene = state_->scene;
    if (Status open = state_->check_place(actor, false); !open) return open;
    if (!can_enter(actor, model)) {
      return make_error(ErrorCode::usage, "no body of the model can enter",
                        "name a model of the scenario that moves");
    }
    if (const char* const fault = detail::motion_fault(motion, scene.slice_s.back())) {
      return refused_motion_of("actors", actor, fault);
    }
    if (occupants && !(*occupants >= 0.0 && *occupants <= harm_limits::people)) {
      return make_error(ErrorCode::bad_input, "the number of occupants is out of range",
                        "give 0 to 1000, or none for the default of its kind");
    }
    Motion own = motion;
    // Nothing can fail from here on.
    const detail::EnteringBody& entering = *scene.entering[model];
    scene.actors[actor] = entering.body;
    scene.actors[actor].occupants = occupants;
    state_->bodies.actors[actor] = entering.ranked;
    std::swap(scene.futures.plans[scene.futures.first_plan(actor)].motion, own);
    state_->set_existence(actor, true);
    return Success{};
  });
}

Status Ranker::leave(std::size_t actor) noexcept {
  state_->rounds.await();
  return detail::guarded([&]() -> Status {
    if (Status taken = state_->check_place(actor, true); !taken) return taken;
    state_->set_existence(actor, false);
    return Success{};
  });
}

Result<std::vector<Motion>> plan_motions(const Scenario& scenario) {
  return detail::guarded([&]() -> Result<std::vector<Motion>> {
    Result<detail::Futures> futures = detail::Futures::make(scenario, 1);
    if (!futures) return futures.error();
    std::vector<Motion> motions;
    for (std::size_t i = 0; i < futures->own_plans(); ++i) {
      motions.push_back(std::move(futures->plans[i].motion));
    }
    return motions;
  });
}

std::vector<Ranker::Plan> Ranker::plans() const {
  std::vector<Plan> plans;
  const detail::Futures& futures = state_->scene.futures;
  for (std::size_t i = 0; i < futures.own_plans(); ++i) {
    plans.push_back({futures.plans[i].actor, futures.plan_probability(i)});
  }
  return plans;
}

Status Ranker::weigh_plans(View<const double> probabilities) noexcept {
  state_->rounds.await();
  return detail::guarded([&]() -> Status {
    detail::Futures& futures = state_->scene.futures;
    if (futures.is_joint() || probabilities.size() != futures.own_plans()) {
      return make_error(ErrorCode::usage, "there is not one probability for each actor's plan",
                        "give them in the order of Ranker::plans; joint futures have none");
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < probabilities.size(); ++i) {
      sum += probabilities[i];
      const std::size_t actor = futures.plans[i].actor;
      const bool is_last = i + 1 == probabilities.size() || futures.plans[i + 1].actor != actor;
      const bool sums = std::abs(sum - 1.0) <= scenario_limits::probability_sum;
      if (!(probabilities[i] > 0.0) || (is_last && !sums)) {
        return Error{ErrorCode::bad_input,
                     {},
                     "probabilities[" + std::to_string(i) + "]",
                     "is not above 0, or those of its actor do not sum to 1",
                     "give positive numbers that sum to 1 within 1e-6"};
      }
      if (is_last) sum = 0.0;
    }
    futures.set_probabilities(probabilities);
    if (futures.own_plans() < futures.plans.size()) {
      detail::update_plans(state_->scene, state_->rounds.caller_scratch().impact);
      state_->bounds.update(state_->scene);
    }
    return Success{};
  });
}

RankerAnswer Ranker::rank(View<const Candidate> candidates, const RankBudget& budget) noexcept {
  const auto start = Deadline::Clock::now();
  State& s = *state_;
  RankerAnswer answer;
  answer.status =
      detail::guarded([&] { return check_call(candidates, budget, s.scene, s.limits.candidates); });
  if (!answer.status) return answer;
  // Reserve for the work after the last check of the clock: sorting and hashing.
  const auto count = static_cast<double>(candidates.size());
  const double finishing_s = 4e-6 + 40e-9 * count * std::log2(count + 2.0);
  const Deadline deadline = ends_after(budget.deadline_s - finishing_s, start, budget.cancel);
  answer.effort.prepare_s = s.prepare_s;
  s.begin(candidates);
  if (s.rounds.await(deadline)) {
    s.rounds.begin(candidates, deadline);
    s.refine_in_futures(candidates, budget, answer.effort);
  }
  s.write_answer(answer, candidates.size());
  answer.elapsed_s = seconds_between(start, Deadline::Clock::now());
  return answer;
}

Result<RankResult> Ranker::explain(View<const Candidate> candidates, const RankerAnswer& answer,
                                   const std::atomic<bool>* cancel, double limit_s) {
  const auto start = Deadline::Clock::now();
  return detail::guarded([&]() -> Result<RankResult> {
    State& s = *state_;
    if (!answer.status) return answer.status.error();
    RankResult result = s.bodies;
    /// Gives the scene its samples while a complete answer is evaluated.
    struct WithSamples {
      detail::Scene& scene;
      ~WithSamples() { scene.samples.clear(); }
    };
    const WithSamples guard{s.scene};
    if (answer.complete) {
      s.rounds.await();
      s.scene.samples = s.samples;
      result.samples = s.samples;
    }
    result.candidates.assign(candidates.begin(), candidates.end());
    result.ranking.resize(answer.ranking.size());
    const Deadline deadline = ends_after(limit_s, start, cancel);
    bool in_time = s.explain_all(candidates, answer, deadline, result);
    // Crashes of the samples can reach further than the nominal ones.
    for (int repeats = 0; detail::include_needed_actors(s.scene, s.needed, repeats, s.rings);
         ++repeats) {
      in_time = s.explain_all(candidates, answer, deadline, result);
    }
    // Samples compare candidates, so they say nothing where some have none.
    if (!in_time) result.samples.clear();
    result.futures = s.scene.futures.summary;
    for (const RankedCandidate& ranked : answer.ranking) {
      if (ranked.in_race) result.in_race.push_back(ranked.candidate);
    }
    result.complete = answer.complete;
    result.infeasible = s.scene.infeasible;
    detail::drop_infeasible(result);
    result.proved = answer.proved;
    result.basis = answer.basis;
    result.elapsed_s = answer.elapsed_s;
    result.effort = answer.effort;
    detail::compute_stability(result);
    return result;
  });
}

}  // namespace crashrank
