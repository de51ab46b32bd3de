#include "rank/anytime/step_rounds.hpp"

#include "rank/measure_table.hpp"

#include <algorithm>
#include <chrono>

namespace crashrank::detail {
namespace {

/// The deadline of the workers is earlier by this, so that their results still count: most
/// stretches of work between two checks of the clock are shorter (bench/rank: clock_looks).
constexpr std::chrono::microseconds worker_lead{30};

/// Measures that the damage is no part of find it in `explain` alone, which allocates.
void prepare_damage(const Scene& scene, DamageScratch& damage) {
  if (!scored_by_damage(scene.measure)) return;
  for (const Body& actor : scene.actors) damage.collide.prepare(*scene.ego.model, *actor.model);
  for (const std::optional<EnteringBody>& kind : scene.entering) {
    if (kind) damage.collide.prepare(*scene.ego.model, *kind->body.model);
  }
  // Capacity for the intersecting pairs at one pose: twice the largest number seen at crash poses
  // of dense meshes.
  constexpr std::size_t pairs = std::size_t{1} << 17U;
  damage.pairs.reserve(pairs);
}

}  // namespace

void StepRounds::prepare(std::size_t candidates) {
  scratch_ = std::vector<Scratch>(pool_.size() + 1);
  for (Scratch& scratch : scratch_) {
    scratch.prepare(scene_);
    prepare_damage(scene_, scratch.damage);
  }
  for (std::uint32_t i = 0; i < pool_.size(); ++i) helpers_.push_back({this, i + 1});
  if (pool_.size() > 0) copies_.resize(candidates);
  for (Slot& slot : slots_) slot.state.reserve(scene_.futures);
}

void StepRounds::await() noexcept {
  if (workers_running_) pool_.wait_all();
  workers_running_ = false;
}

bool StepRounds::await(const Deadline& limit) noexcept {
  if (!limit.is_set()) {
    await();
  } else if (workers_running_) {
    workers_running_ = !pool_.wait_all_until(limit.time());
  }
  return !workers_running_;
}

void StepRounds::begin(View<const Candidate> candidates, const Deadline& deadline) noexcept {
  candidates_ = candidates;
  deadline_ = deadline;
  const bool polls_clock = !scored_by_damage(scene_.measure);
  returns_at_deadline_ = deadline.is_set() && pool_.size() > 0 && polls_clock &&
                         std::none_of(candidates.begin(), candidates.end(),
                                      [](const Candidate& c) { return c.motion.holds_poses(); });
  workers_deadline_ = returns_at_deadline_ ? deadline.earlier_by(worker_lead) : deadline;
  if (!returns_at_deadline_) return;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    copies_[i].motion = candidates[i].motion;
    copies_[i].acceleration_mps2 = candidates[i].acceleration_mps2;
    copies_[i].curvature_per_m = candidates[i].curvature_per_m;
  }
  candidates_ = {copies_.data(), candidates.size()};
}

void StepRounds::run(const std::vector<CandidateState>& states, const std::uint32_t* chosen,
                     std::size_t steps, double stop_above, bool lowers) noexcept {
  stop_above_.store(stop_above, std::memory_order_relaxed);
  lowers_ = lowers && deadline_.is_set();
  count_ = steps;
  next_.store(0, std::memory_order_relaxed);
  for (std::size_t i = 0; i < steps; ++i) {
    chosen_[i] = chosen[i];
    slots_[i].state = states[chosen[i]];
    slots_[i].done.store(false, std::memory_order_relaxed);
  }
  const std::size_t wanted = std::min(helpers_.size(), steps > 0 ? steps - 1 : 0);
  std::size_t posted = 0;
  // Waking many workers takes long; do not wake them after their deadline.
  for (; posted < wanted && !workers_deadline_.expired(); ++posted) {
    const WorkerPool::Task task{[](void* context, std::uint32_t) {
                                  const Helper& helper = *static_cast<Helper*>(context);
                                  StepRounds& rounds = *helper.rounds;
                                  rounds.run_steps(rounds.scratch_[helper.worker],
                                                   rounds.workers_deadline_);
                                },
                                &helpers_[posted]};
    pool_.post(static_cast<std::uint32_t>(posted), task);
  }
  run_steps(caller_scratch(), deadline_);
  // All steps have started: cancel workers that have not woken yet.
  for (std::size_t i = 0; i < posted; ++i) {
    WorkerPool::Task unneeded;
    pool_.recall(static_cast<std::uint32_t>(i), unneeded);
  }
  if (returns_at_deadline_) {
    workers_running_ = !pool_.wait_all_until(deadline_.time());
  } else {
    pool_.wait_all();
  }
}

void StepRounds::run_steps(Scratch& own, const Deadline& deadline) noexcept {
  while (!deadline.expired()) {
    const std::size_t i = next_.fetch_add(1, std::memory_order_relaxed);
    if (i >= count_) return;
    Slot& slot = slots_[i];
    const RefineQuery query{scene_, bounds_, candidates_[chosen_[i]], stop_above_, deadline};
    slot.end = refine(query, slot.state, own);
    const RankedCandidate& result = slot.state.result;
    double limit = stop_above_.load(std::memory_order_relaxed);
    while (lowers_ && result.known && result.feasible && result.score < limit &&
           !stop_above_.compare_exchange_weak(limit, result.score, std::memory_order_relaxed)) {
    }
    slot.done.store(true, std::memory_order_release);
  }
}

StepRounds::Done StepRounds::done(std::size_t step) const noexcept {
  const Slot& slot = slots_[step];
  if (!slot.done.load(std::memory_order_acquire)) return {};
  return {&slot.state, slot.end};
}

}  // namespace crashrank::detail
