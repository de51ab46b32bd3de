#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace crashrank {

/// Sizes for which a Ranker allocates memory; larger inputs are rejected.
struct RankerLimits {
  std::size_t candidates = 1024;      ///< largest number
  std::size_t actors = 64;            ///< largest number
  std::size_t triangles = 4'000'000;  ///< of any one model
};

/// Options of a Ranker and its memory.
struct RankerOptions {
  /// Measure, harm, impact and workers: the calling thread and `workers` - 1 more share the work.
  /// Samples of the harm ranges are not evaluated, whatever HarmOptions::intervals says.
  RankOptions rank;
  RankerLimits limits;        ///< sizes for which memory is allocated
  std::int32_t spin_us = -1;  ///< see PoolOptions
};

/// Limits of a ranking.
struct RankBudget {
  /// Time from the call, s; at or below 0 it returns at once. Infinity: no deadline.
  double deadline_s = std::numeric_limits<double>::infinity();
  /// Limit of the work in tests of boxes, triangles and outline pieces. The answer is the same on
  /// every machine and for every number of workers.
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  /// Ends as soon as the first place is proved.
  bool first_place_only = false;
  /// Any thread may set this to end the call soon with a partial answer; null: never. Read whenever
  /// the clock is read. Has to stay valid until the Ranker's next call or its end.
  const std::atomic<bool>* cancel = nullptr;
  /// Set to the number of candidates with a known score after each round of steps, for other
  /// threads to read; null: not reported.
  std::atomic<std::size_t>* known = nullptr;
};

/// How far a candidate was evaluated.
enum class RankStage : std::uint8_t {
  unseen,    ///< only the upper bound from the available energy is known
  near,      ///< the bodies that its swept boxes overlap are known; exact if there are none
  searched,  ///< its first contact is known; exact if there is none
  scored,    ///< its score is known
};

/// One candidate of an answer.
struct RankedCandidate {
  std::size_t candidate = 0;            ///< index into the candidates of the call
  RankStage stage = RankStage::unseen;  ///< how far it was evaluated
  bool known = false;                   ///< `score` is the final one
  bool in_race = true;                  ///< can still be first
  double score = 0.0;                   ///< valid if `known`
  ScoreInterval interval;               ///< contains the final score at every stage
  /// Estimate of a score that is not known, within the interval, but not a bound itself: futures
  /// that are not simulated yet count as a crash of the boxes around the bodies, before the stage
  /// `searched` the likeliest one alone. At the stage `unseen` it is the upper bound. Candidates
  /// are ordered by scores and estimates, those of the stage `unseen` after all others.
  double estimate = 0.0;
  /// From the stage `searched` on: probability that the ego has a contact.
  double collision_probability = 0.0;
  /// From the stage `searched` on: its first contact in the likeliest future.
  bool collides = false;
  bool grazes = false;  ///< the ego grazes an actor before that
  /// The vehicle can follow it until its first contact, or feasibility is ignored
  /// (Infeasible::keep). This and the next five are final where the score is known, the first from
  /// the stage `searched` on; true as long as nothing else is known.
  bool feasible = true;
  bool leaves_road = false;  ///< before the first contact, in any future
  /// As in CandidateResult, but infinity if absent there, and 0 while it is not known, m.
  double least_distance_m = 0.0;
  double least_time_gap_s = 0.0;     ///< likewise, s
  double time_to_collision_s = 0.0;  ///< likewise, s; infinity if it has a contact in any future
  double end_speed_mps = 0.0;        ///< at the horizon; 0 for candidates that collide
  std::size_t actor = 0;             ///< index into Scenario::actors
  double time_of_impact_s = 0.0;     ///< from the decision
  /// Of the points that touch. Measures that simulate the crash are not valid above
  /// `fastest_contact_mps`.
  double closing_speed_mps = 0.0;
  /// In a future, once the score is known: see Contact::contact_without_force. The interval then
  /// extends from the score to what the energy of the scene allows.
  bool contact_without_force = false;
};

/// An answer, most promising first; refers to the Ranker's memory, valid until its next call.
struct RankerAnswer {
  Status status = Success{};            ///< error if the call was rejected; then nothing is ranked
  View<const RankedCandidate> ranking;  ///< every candidate once
  RankBasis basis = RankBasis::proved;  ///< of the first place
  bool complete = false;                ///< every score is known
  bool proved = false;                  ///< no other candidate can still take the first place
  std::size_t in_race = 0;              ///< number of candidates that can be first
  double elapsed_s = 0.0;               ///< from the call until just before it returns
  RankerEffort effort;                  ///< work and times
  /// Hash of the ranking: order, stages and the bits of scores and intervals. Equal answers have
  /// equal hashes on every machine.
  std::uint64_t hash = 0;
};

/// Motion of the ego at time 0.
struct EgoMotion {
  double speed_mps = 0.0;       ///< along its forward axis; negative when reversing
  double yaw_rate_radps = 0.0;  ///< left positive
};

/// The motions of a scenario's plans, in the order of `Ranker::plans`. Errors: bad_input for poses
/// out of order or motions beyond `scenario_limits`.
CRASHRANK_API Result<std::vector<Motion>> plan_motions(const Scenario& scenario);

/// Ranks candidates within a deadline, in memory allocated beforehand.
///
/// Every candidate has an interval that contains its final score. Candidates that can
/// still be first are refined first, in order of promise; once the first place is
/// proved, the others follow. Stages: the bodies that the swept boxes overlap (none:
/// the score is 0); the search for the first contact (none: 0); the simulation of the
/// crash. This stops as soon as the candidate cannot be first: the contacts so far give
/// a lower bound, the available energy an upper bound.
///
/// `rank` does not allocate, throw or lock, and its only system calls wake and await
/// its own workers. Exception: measures `polygons` and `area`, whose last stage
/// allocates.
///
/// At its deadline a call returns without waiting for workers in the middle of a step.
/// These stop at their next reading of the clock and read only the models until then.
/// The next call first waits for them, `rank` until its own deadline at most. With the
/// measures above and for candidates with timed motions a call waits for its workers
/// instead. docs/evidence/ranking-times.md has the lateness of answers. Without a
/// deadline scores and order have the bits of `crashrank::rank`.
///
/// One thread at a time may call the members; different Rankers are independent.
class CRASHRANK_API Ranker {
public:
  /// Starts the workers and prepares memory and scenario. `models` must outlive the Ranker. Errors:
  /// as `crashrank::rank`; usage if limits are exceeded.
  static Result<Ranker> prepare(const Scenario& scenario, View<const Model> models,
                                const RankerOptions& options = {});

  /// Moves the Ranker with its workers.
  Ranker(Ranker&&) noexcept;
  Ranker& operator=(Ranker&&) noexcept;  ///< Ends the workers of the target, then moves.
  /// Ends the workers.
  ~Ranker();

  /// A plan of an actor. Plans are ordered by actor; those of an actor are its predictions in their
  /// order, or the motions that joint futures give it, followed by its own motion if some future
  /// does not replace it. Errors of states are added internally, as drawn for the scenario. Number
  /// and order of the plans never change.
  struct Plan {
    std::size_t actor = 0;     ///< index into Scenario::actors
    double probability = 1.0;  ///< that the actor follows it, if it exists; not of joint futures
  };
  /// Returns the plans of all actors; allocates.
  std::vector<Plan> plans() const;

  /// Sets a new situation: the start pose of the ego, and the motion of each actor on each of its
  /// plans in the order of `plans`: one for each actor if nothing is uncertain. First waits for
  /// workers that the last call left running. Then takes a few µs for each actor, and as much for
  /// each future if its state has errors. Allocates only for timed motions. Errors, without any
  /// change: usage for a wrong number of motions; bad_input for a pose or motion that is not
  /// finite or exceeds `scenario_limits` within the horizon; out_of_memory. `ego` is the present
  /// motion of the ego; without it the demand of timed poses excludes the transition at their
  /// begin.
  Status move_actors(const Pose& ego_start, View<const Motion> actors,
                     std::optional<EgoMotion> ego = std::nullopt) noexcept;

  /// Lets a body enter the scene in place of an actor of the scenario that keeps a place: it has an
  /// existence_probability of 0, one motion and a model that moves, and there are no joint futures.
  /// Until then, and after `leave`, no future has it, its motion is not read, and it costs some
  /// nanoseconds a call. `actor` is its index in Scenario::actors, which answers refer to; `model`
  /// that of any model in Scenario::models that moves, whatever the place was prepared with;
  /// `motion` in world coordinates from time 0, which `move_actors` changes from then on;
  /// `occupants` as in ScenarioActor. Answers have the bits of a Ranker prepared with that actor
  /// and an existence_probability of 1. Takes as long as `move_actors` and waits like it, plus, for
  /// measure `area`, microseconds for every thousand triangles; allocates for timed motions only.
  /// Errors, without any change: usage for an actor that keeps no place or whose place is taken,
  /// and for a model that does not exist or does not move; bad_input for a motion as in
  /// `move_actors` or occupants out of range; out_of_memory.
  Status enter(std::size_t actor, std::size_t model, const Motion& motion,
               std::optional<double> occupants = std::nullopt) noexcept;
  /// Whether the actor keeps a place, free or taken, and the model exists and moves.
  bool can_enter(std::size_t actor, std::size_t model) const noexcept;
  /// Takes the body out of such a place, which is free again. Time and waiting as `enter`; never
  /// allocates. Errors, without any change: usage for an actor that keeps no place, or a free one.
  Status leave(std::size_t actor) noexcept;

  /// Sets the probabilities of the plans: above 0, with a sum of 1 for each actor. Samples are
  /// drawn again from the same strata, so they change as little as the probabilities. Waits like
  /// `move_actors`; does not allocate. Errors, without any change: usage for a wrong number of
  /// values or joint futures; bad_input for values that are not probabilities.
  Status weigh_plans(View<const double> probabilities) noexcept;

  /// Ranks candidates, which must stay valid until the call returns. Errors, in an otherwise empty
  /// answer: usage for too many candidates or a NaN deadline; bad_input for a candidate whose
  /// motion is not finite, exceeds `scenario_limits` within the horizon, or does not start at the
  /// pose of the ego (within 1 m, 30°), for example because it was made before `move_actors`;
  /// out_of_memory if the text of an error cannot be allocated.
  RankerAnswer rank(View<const Candidate> candidates, const RankBudget& budget = {}) noexcept;

  /// Returns the result of `crashrank::rank` for an answer. If the answer is complete, the results
  /// are equal, including samples and intervals (HarmOptions::intervals). Otherwise there are no
  /// samples; known candidates have contacts and damage, the others intervals, and places are given
  /// as far as they are decided. Allocates, and evaluates the known candidates once more, the first
  /// first, on the calling thread. After `limit_s` or when any thread sets `cancel` the rest
  /// keeps score and first touch alone (FirstTouch), and there are no samples; the candidate under
  /// way is ended.
  Result<RankResult> explain(View<const Candidate> candidates, const RankerAnswer& answer,
                             const std::atomic<bool>* cancel = nullptr,
                             double limit_s = std::numeric_limits<double>::infinity());

private:
  struct State;
  explicit Ranker(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

/// Shortest time that `rank_within` spends on the explanation of an answer with a deadline, s: what
/// a person who waits for a table does not mind. A design choice.
inline constexpr double least_explanation_s = 1.0;

/// Ranks like `crashrank::rank` within a budget: prepares a Ranker, ranks the candidates of the
/// scenario and explains the answer after the deadline, for as long as the deadline or
/// `explanation_s`. Without a budget use `rank`, which shares all work among threads. Policy and
/// depth have no effect. Errors: as `rank`.
CRASHRANK_API Result<RankResult> rank_within(const Scenario& scenario, View<const Model> models,
                                             const RankOptions& options, const RankBudget& budget,
                                             double explanation_s = least_explanation_s);

}  // namespace crashrank
