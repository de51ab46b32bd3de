#include "crashrank/rank/ranker.hpp"

#include "base/hidden.hpp"
#include "crashrank/base/guarded.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "rank/near.hpp"
#include "rank/race.hpp"
#include "rank/refine.hpp"
#include "rank/scenario_check.hpp"
#include "rank/scene.hpp"
#include "rank/score_crash.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using detail::Race;
using detail::Refined;
using detail::RefineQuery;
using detail::RefineScratch;
using detail::StepEnd;
using detail::Watch;

/// Steps that are begun together, whatever the number of workers: answers cut by work depend on it.
constexpr std::size_t most_slots = 64;
constexpr std::size_t refined_together = 16;

/// How much sooner time is up for workers, so that what they know by then still counts: of a
/// hundred stretches of work between two looks at the clock 99 are shorter (bench/rank:
/// clock_looks).
constexpr std::chrono::microseconds ahead{30};

struct Slot {
  Refined state;
  StepEnd end;
  std::atomic<bool> done{false};  ///< the other two are whole
};

double seconds_between(Watch::Clock::time_point from, Watch::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  // FNV-1a over words, then a shift so that high bits reach low ones.
  constexpr std::uint64_t prime = 0x100000001b3;
  hash = (hash ^ word) * prime;
  return hash ^ (hash >> 32U);
}

std::uint64_t hash_of(View<const RankedCandidate> ranking) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const RankedCandidate& c : ranking) {
    hash = mixed(hash, c.candidate);
    hash = mixed(hash, static_cast<std::uint64_t>(c.stage) * 2 + (c.known ? 1 : 0));
    hash = mixed(hash, std::bit_cast<std::uint64_t>(c.score));
    hash = mixed(hash, std::bit_cast<std::uint64_t>(c.interval.lowest));
    hash = mixed(hash, std::bit_cast<std::uint64_t>(c.interval.highest));
  }
  return hash;
}

}  // namespace

struct CRASHRANK_HIDDEN Ranker::State {
  State(detail::Scene&& made, WorkerPool&& started)
      : scene(std::move(made)), pool(std::move(started)) {}

  detail::Scene scene;
  WorkerPool pool;
  RankerLimits limits;
  RankResult bodies;  ///< what `explain` begins with
  double prepare_s = 0.0;
  detail::ScoreBounds bounds;
  std::vector<RefineScratch> scratch;  ///< the calling thread's first
  std::vector<Refined> states;
  std::vector<RankedCandidate> ranking;
  Race race;
  std::array<Slot, most_slots> slots;
  std::array<std::uint32_t, most_slots> chosen{};

  // One round: set by the calling thread, read by all.
  View<const Candidate> candidates;
  Watch watch;
  Watch helpers_watch;
  double give_up_above = 0.0;
  std::size_t count = 0;
  std::atomic<std::size_t> next{0};

  /// What workers read of candidates when they may still be at it after the call has returned. No
  /// names.
  std::vector<Candidate> kept;
  bool leaves = false;  ///< the call returns at its time, whatever the workers are at
  bool left = false;    ///< it did so: they may still be at it

  ~State() { await_helpers(); }

  struct Helper {
    State* state = nullptr;
    std::uint32_t worker = 0;
  };
  std::vector<Helper> helpers;

  /// Before anything is changed that workers read.
  void await_helpers() noexcept {
    if (left) pool.wait_all();
    left = false;
  }

  void take_part(RefineScratch& own, const Watch& until) noexcept {
    while (!until.expired()) {
      const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= count) return;
      Slot& slot = slots[i];
      const RefineQuery query{scene, bounds, candidates[chosen[i]], give_up_above, until};
      slot.end = detail::refine(query, slot.state, own);
      slot.done.store(true, std::memory_order_release);
    }
  }

  /// Sets the candidates of a call, and whether it may leave its workers behind: where these look
  /// at the clock all along, and their candidates can be kept without memory.
  void take(View<const Candidate> asked) noexcept {
    candidates = asked;
    leaves = watch.runs() && pool.size() > 0 && detail::scored_by_pulses(scene) &&
             std::none_of(asked.begin(), asked.end(),
                          [](const Candidate& c) { return c.motion.holds_poses(); });
    helpers_watch = leaves ? Watch(watch.until() - ahead) : watch;
    if (!leaves) return;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      kept[i].motion = asked[i].motion;
      kept[i].acceleration_mps2 = asked[i].acceleration_mps2;
      kept[i].curvature_per_m = asked[i].curvature_per_m;
    }
    candidates = {kept.data(), asked.size()};
  }

  /// Takes the first `steps` of the chosen candidates one stage further, on all threads.
  void run_round(std::size_t steps, double limit) noexcept {
    give_up_above = limit;
    count = steps;
    next.store(0, std::memory_order_relaxed);
    for (std::size_t i = 0; i < steps; ++i) {
      slots[i].state = states[chosen[i]];
      slots[i].done.store(false, std::memory_order_relaxed);
    }
    const std::size_t wanted = std::min(helpers.size(), steps > 0 ? steps - 1 : 0);
    for (std::size_t i = 0; i < wanted; ++i) {
      const WorkerPool::Task task{[](void* context, std::uint32_t) {
                                    const Helper& helper = *static_cast<Helper*>(context);
                                    State& s = *helper.state;
                                    s.take_part(s.scratch[helper.worker], s.helpers_watch);
                                  },
                                  &helpers[i]};
      pool.post(static_cast<std::uint32_t>(i), task);
    }
    take_part(scratch.front(), watch);
    // All steps are begun by now: whoever has not woken yet need not.
    for (std::size_t i = 0; i < wanted; ++i) {
      WorkerPool::Task unneeded;
      pool.recall(static_cast<std::uint32_t>(i), unneeded);
    }
    if (leaves) {
      left = !pool.wait_all_until(watch.until());
    } else {
      pool.wait_all();
    }
  }

  /// Takes over what a round did, in its order, as far as the work allows. Returns false at the end
  /// of work or time.
  bool take_over(std::size_t steps, std::uint64_t budget, std::uint64_t& work) noexcept {
    bool in_time = true;
    for (std::size_t i = 0; i < steps; ++i) {
      const bool affordable = work < budget;
      const bool done = slots[i].done.load(std::memory_order_acquire);
      if (affordable && done) {
        states[chosen[i]] = slots[i].state;
        work += slots[i].end.work;
      }
      in_time = in_time && affordable && done && slots[i].end.finished;
      race.put_back(chosen[i], states);
    }
    return in_time;
  }

  /// Everything until time, work or questions run out.
  void refine_all(const RankBudget& budget, RankerEffort& effort) noexcept {
    const auto start = Watch::Clock::now();
    const auto all = static_cast<std::uint32_t>(candidates.size());
    bool going = budget.work > 0;
    std::uint32_t begin = 0;
    if (going && all > 1) {
      if (detail::all_are_clear(scene, candidates, watch, effort.work)) {
        for (; begin < all; ++begin) {
          detail::settle_as_clear(states[begin]);
          race.put_back(begin, states);
        }
      }
      going = effort.work < budget.work && !watch.expired();
    }
    while (begin < all && going) {
      const std::size_t steps = std::min<std::size_t>(most_slots, all - begin);
      for (std::size_t i = 0; i < steps; ++i) {
        chosen[i] = begin + static_cast<std::uint32_t>(i);
      }
      run_round(steps, std::numeric_limits<double>::infinity());
      begin += static_cast<std::uint32_t>(steps);
      going = take_over(steps, budget.work, effort.work) && !watch.expired();
    }
    const auto seen = Watch::Clock::now();
    effort.bounds_s = seconds_between(start, seen);
    while (going) {
      const bool deciding = !race.decided();
      const double limit = deciding ? race.limit() : std::numeric_limits<double>::infinity();
      const std::size_t steps = race.choose(states, refined_together, chosen.data());
      if (steps == 0) {
        if (budget.first_place_only || !race.resume(states)) break;
        continue;
      }
      run_round(steps, limit);
      going = take_over(steps, budget.work, effort.work) && !watch.expired();
    }
    effort.refining_s = seconds_between(seen, Watch::Clock::now());
  }

  void tell(RankerAnswer& answer) noexcept {
    const std::size_t all = candidates.size();
    race.mark(states);
    for (std::size_t i = 0; i < all; ++i) ranking[i] = states[i].told;
    std::sort(ranking.begin(), ranking.begin() + static_cast<std::ptrdiff_t>(all),
              detail::promises_more);
    answer.ranking = {ranking.data(), all};
    answer.complete = true;
    RankerEffort& effort = answer.effort;
    for (const RankedCandidate& c : answer.ranking) {
      answer.complete = answer.complete && c.known;
      answer.in_race += c.in_race ? 1 : 0;
      if (!c.known) {
        effort.left_early += c.in_race ? 0 : 1;
      } else if (c.stage == RankStage::near) {
        ++effort.without_search;
      } else if (c.stage == RankStage::searched) {
        ++effort.without_crash;
      } else {
        ++effort.fully_evaluated;
      }
    }
    answer.proved = answer.in_race <= 1;
    answer.hash = hash_of(answer.ranking);
  }
};

Ranker::Ranker(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Ranker::Ranker(Ranker&&) noexcept = default;
Ranker& Ranker::operator=(Ranker&&) noexcept = default;
Ranker::~Ranker() = default;

namespace {

Status within(const RankerLimits& limits, const Scenario& scenario, View<const Model> models) {
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

void prepare_scratch(const detail::Scene& scene, RefineScratch& scratch) {
  std::uint32_t deepest = scene.ego.model->tree.depth;
  for (const detail::Body& actor : scene.actors) {
    deepest = std::max(deepest, actor.model->tree.depth);
    scratch.evaluate.damage.collide.prepare(*scene.ego.model, *actor.model);
  }
  scratch.evaluate.impact.prepare(deepest, deepest);
  scratch.evaluate.near.reserve(scene.actors.size());
  scratch.evaluate.place.reserve(scene.actors.size());
  scratch.evaluate.hits.reserve(scene.actors.size());
  scratch.near.reserve(scene.actors.size());
  scratch.reach.prepare(scene.actors.size());
  // Poses at which surfaces meet list their pairs; twice as many as crash poses of dense meshes
  // have been seen to have.
  constexpr std::size_t pairs = std::size_t{1} << 17U;
  scratch.evaluate.damage.pairs.reserve(pairs);
  scratch.aftermath.prepare(scene);
  const Eigen::Vector3d size = scene.ego.model->mesh.bounds().extent().cast<double>();
  const double longest = size.norm();
  scratch.pulse.prepare(longest, std::min(longest, size.z() + 0.25 * longest), deepest,
                        detail::coarse(scene.harm.friction).pulse);
}

}  // namespace

Result<Ranker> Ranker::prepare(const Scenario& scenario, View<const Model> models,
                               const RankerOptions& options) {
  const auto start = Watch::Clock::now();
  return detail::guarded([&]() -> Result<Ranker> {
    const Status sound = detail::check_scenario(scenario);
    if (!sound) return sound.error();
    const Status fits = within(options.limits, scenario, models);
    if (!fits) return fits.error();
    RankResult bodies;
    RankOptions how = options.rank;
    if (how.harm) {
      const Status weighed = detail::check_harm(*how.harm, "harm");
      if (!weighed) return weighed.error();
    }
    how.harm = how.harm.value_or(scenario.harm);
    how.harm->intervals = false;
    Result<detail::Scene> scene = detail::make_scene(scenario, models, how, bodies);
    if (!scene) return scene.error();
    bodies.measure = scene->measure;
    bodies.harm = scene->harm;
    PoolOptions threads;
    threads.workers = std::min(std::max(how.workers, 1U) - 1U, max_workers);
    threads.pinned = options.pinned;
    threads.spin_us = options.spin_us;
    Result<WorkerPool> pool = WorkerPool::start(threads);
    if (!pool) return pool.error();
    auto state = std::make_unique<State>(std::move(*scene), std::move(*pool));
    state->limits = options.limits;
    state->bodies = std::move(bodies);
    state->bounds.prepare(state->scene);
    state->states.resize(options.limits.candidates);
    state->ranking.resize(options.limits.candidates);
    if (state->pool.size() > 0) state->kept.resize(options.limits.candidates);
    state->race.prepare(options.limits.candidates);
    state->scratch = std::vector<RefineScratch>(state->pool.size() + 1);
    for (RefineScratch& scratch : state->scratch) prepare_scratch(state->scene, scratch);
    for (std::uint32_t i = 0; i < state->pool.size(); ++i) {
      state->helpers.push_back({state.get(), i + 1});
    }
    state->prepare_s = seconds_between(start, Watch::Clock::now());
    return Ranker(std::move(state));
  });
}

Status Ranker::move_actors(const Pose& ego_start, View<const Motion> actors) noexcept {
  state_->await_helpers();
  detail::Scene& scene = state_->scene;
  if (actors.size() != scene.actors.size()) {
    return make_error(ErrorCode::usage, "there is not one motion for each actor",
                      "give them in the scenario's order");
  }
  for (std::size_t i = 0; i < actors.size(); ++i) scene.actors[i].motion = actors[i];
  scene.ego_start = ego_start;
  detail::place_actors(scene, state_->scratch.front().evaluate.impact);
  state_->bounds.update(scene);
  return Success{};
}

RankerAnswer Ranker::rank(View<const Candidate> candidates, const RankBudget& budget) noexcept {
  const auto start = Watch::Clock::now();
  State& s = *state_;
  RankerAnswer answer;
  if (candidates.size() > s.limits.candidates) {
    answer.status = make_error(ErrorCode::usage, "more candidates than the Ranker's limit",
                               "raise RankerLimits::candidates");
    return answer;
  }
  // What is left to do after the last look at the clock: an order and a hash.
  const auto count = static_cast<double>(candidates.size());
  const double closing_s = 4e-6 + 40e-9 * count * std::log2(count + 2.0);
  s.await_helpers();
  s.watch = Watch();
  constexpr double longest_s = 1e6;
  if (budget.deadline_s < longest_s) {
    const double seconds = std::max(budget.deadline_s - closing_s, 0.0);
    s.watch = Watch(start + std::chrono::duration_cast<Watch::Clock::duration>(
                                std::chrono::duration<double>(seconds)));
  }
  answer.effort.prepare_s = s.prepare_s;
  s.take(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    s.states[i] = detail::unrefined(s.scene, s.bounds, candidates[i], i);
  }
  s.race.begin(s.states, candidates.size());
  s.refine_all(budget, answer.effort);
  s.tell(answer);
  answer.elapsed_s = seconds_between(start, Watch::Clock::now());
  return answer;
}

Result<RankResult> Ranker::explain(View<const Candidate> candidates, const RankerAnswer& answer) {
  return detail::guarded([&]() -> Result<RankResult> {
    State& s = *state_;
    if (!answer.status) return answer.status.error();
    RankResult result = s.bodies;
    result.candidates.assign(candidates.begin(), candidates.end());
    result.ranking.resize(answer.ranking.size());
    detail::Scratch scratch;
    for (std::size_t i = 0; i < answer.ranking.size(); ++i) {
      const RankedCandidate& told = answer.ranking[i];
      CandidateResult& full = result.ranking[i];
      if (told.known) {
        full = detail::evaluate(s.scene, candidates[told.candidate], scratch, result.work);
      } else {
        full.collides = told.collides;
        full.score_interval = told.interval;
      }
      full.candidate = told.candidate;
    }
    for (const RankedCandidate& told : answer.ranking) {
      if (told.in_race) result.in_race.push_back(told.candidate);
    }
    result.complete = answer.complete;
    result.proved = answer.proved;
    result.elapsed_s = answer.elapsed_s;
    result.effort = answer.effort;
    detail::tell_stability(result);
    return result;
  });
}

}  // namespace crashrank
