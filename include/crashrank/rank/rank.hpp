#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Most futures that are drawn.
inline constexpr std::size_t max_sampled_futures = 10'000;

/// Treatment of candidates that the vehicle cannot follow.
enum class Infeasible {
  demote,  ///< they rank behind all feasible ones
  /// They are left out of a complete ranking, unless there is no feasible one; else as `demote`.
  drop,
  keep,  ///< they are ranked like all others
};

/// The name on the command line: "demote", "drop", "keep".
CRASHRANK_API const char* infeasible_name(Infeasible infeasible) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<Infeasible> infeasible_from_name(const std::string& name);

/// How candidates are ranked.
struct RankOptions {
  std::optional<Measure> measure;  ///< absent: the scenario's
  /// Threads that share the work, 64 at most; 0 or 1: the calling thread does all. They share the
  /// candidates when looking for contacts, and one dispatch holds the damage queries of every 16
  /// candidates a thread. The answer has the same bits for every number, policy and depth.
  unsigned workers = 1;
  Policy policy = Policy::late_match;  ///< how the dispatch's jobs find their workers
  std::uint32_t depth = auto_depth;    ///< its distribution depth, 1 to `max_distribution_depth`
  std::optional<HarmOptions> harm;     ///< absent: the scenario's
  std::optional<RiskMeasure> risk;     ///< absent: the scenario's
  /// Futures that are drawn where combinations of predictions are too many or states have errors, 1
  /// to `max_sampled_futures`.
  std::size_t sampled_futures = 64;
  Infeasible infeasible = Infeasible::demote;  ///< of candidates that the ego cannot follow
  ImpactOptions impact;                        ///< `start_is_apart` is decided inside
  /// Called before each simulation and after each candidate with the number of candidates evaluated
  /// and of all, by all workers, also concurrently; must return within microseconds and not throw.
  /// Returning false cancels the ranking: candidates not evaluated yet get bounds on their scores.
  /// Empty: all candidates are evaluated. `Ranker` ignores it, see RankBudget.
  std::function<bool(std::size_t evaluated, std::size_t candidates)> on_progress;
};

/// Damage of a crash to one body.
struct BodyDamage {
  /// Triangles that intersect the other body, or pass through its surface, while the two move as
  /// the simulated contact moves them, in mesh order, rising: see `rank`. A body that lies inside
  /// the other at the start counts whole.
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> parts;  ///< indices of the mesh's parts that those belong to, rising
  double area_m2 = 0.0;              ///< of those triangles
  Box region;  ///< where the surfaces intersect, in body coordinates; empty if they do not
  Pose pose;   ///< body to world at first contact
};

/// Bounds on a score. If the score is known: its range over the ranges of HarmOptions under the
/// chosen risk model (harm, delta-v, energy); both ends equal for the other measures.
struct ScoreInterval {
  double lowest = 0.0;   ///< the score is not below
  double highest = 0.0;  ///< nor above
};

/// Mechanical result of a crash for one body. Velocities in its own axes before the crash.
struct BodyOutcome {
  double delta_v_mps = 0.0;            ///< magnitude
  double delta_v_x_mps = 0.0;          ///< forward, m/s
  double delta_v_y_mps = 0.0;          ///< to the left, m/s
  double yaw_rate_change_radps = 0.0;  ///< to the left, rad/s
  /// Of the event that the contact belongs to: contacts of one body that overlap in time or lie
  /// less than 0.1 s apart change its velocity together. Harm reads the greatest that it reached.
  double event_delta_v_mps = 0.0;
  double event_yaw_rate_change_radps = 0.0;  ///< of the event, to the left, rad/s
  double pdof_deg = 0.0;        ///< where the force comes from, clockwise from ahead, [0, 360)
  int clock = 12;               ///< the PDOF as an hour, 12 ahead
  double crush_energy_j = 0.0;  ///< turned into its deformation, J
  double ees_mps = 0.0;         ///< energy-equivalent speed, m/s
  double crush_m = 0.0;         ///< deepest, m
  double intrusion_m = 0.0;     ///< into the compartment, beyond earlier ones of the two, m
  double harm = 0.0;            ///< persons, as weighted; measure harm only
  std::string cdc;              ///< collision deformation classification, SAE J224
};

/// Result of a contact for its two bodies, each in the state that earlier contacts left it in.
struct ContactSeverity {
  /// Harm was evaluated (measures that need it). The changes of velocity are the simulation's in
  /// any case: the same numbers under every measure.
  bool simulated = false;
  bool slides = false;        ///< the surfaces slide past each other
  double duration_s = 0.0;    ///< of the crush phase, s
  double dissipated_j = 0.0;  ///< turned into damage and heat, J
  BodyOutcome ego;            ///< result for the ego
  BodyOutcome other;          ///< result for the other
  double harm = 0.0;          ///< persons, as weighted
};

/// A contact of the ego with another body. Points and directions in world coordinates. Of contacts
/// after the first, which the simulation finds, `gap_m` is 0, `point_m` the mean point of the force
/// and `normal` the direction of `closing`.
struct Contact {
  /// Index into Scenario::actors; of joined fixed bodies the one touched first, later the one hit.
  std::size_t actor = 0;
  ImpactState state = ImpactState::contact;  ///< relation of the bodies
  double time_of_impact_s = 0.0;             ///< from the decision, s
  double gap_m = 0.0;                        ///< between the surfaces then, at most the tolerance
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< point of contact, world, m
  /// Unit, from the ego towards the other; zero for a body that lies inside another.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();  ///< ego's velocity less the other's there
  /// Its length.
  double closing_speed_mps = 0.0;
  /// Its component along the normal, m/s. Depends on the facet that is touched first.
  double normal_speed_mps = 0.0;
  /// ½·m₁m₂/(m₁+m₂)·closing_speed²: all that the crash could turn into damage if the bodies stuck
  /// together and their velocities passed through the common centre of mass.
  double closing_energy_j = 0.0;
  /// Duration of the simulated motion along which the damage was read, from the contact's begin to
  /// the end of its force, s: `severity.duration_s`. 0 where the bodies do not press on each other.
  double crush_s = 0.0;
  /// Greatest distance in that motion of the ego's point at `point_m` from where it was at first
  /// contact, in the other body's frame, m. Both bodies' crush together in a square hit; more where
  /// they slide past each other.
  double crush_m = 0.0;
  /// Damage to the ego, including that by fixed bodies that adjoin `actor` and that the ego presses
  /// on in the same contact.
  BodyDamage ego;
  BodyDamage other;          ///< damage to `actor`
  ContactSeverity severity;  ///< the crash that begins with it
  std::size_t event = 0;     ///< number of the ego's event that it belongs to, from 1; 0: no force
};

/// Stands for the ego where a body is named by an index into Scenario::actors.
inline constexpr std::size_t ego_body = static_cast<std::size_t>(-1);

/// A contact between two bodies that are not the ego, one of which was hit before by the ego or by
/// what it had hit. World axes.
struct FurtherContact {
  std::size_t a = 0;    ///< index into Scenario::actors; it moves, as b may
  std::size_t b = 0;    ///< and the other
  double time_s = 0.0;  ///< from the decision, s
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< mean point of the force, m
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();  ///< a's velocity less b's there, m/s
  double closing_speed_mps = 0.0;                     ///< its length
  double closing_energy_j = 0.0;                      ///< as in Contact
  bool slides = false;                                ///< past each other rather than into
  double duration_s = 0.0;                            ///< of the force, s
  double dissipated_j = 0.0;                          ///< turned into damage and heat, J
  double harm = 0.0;                                  ///< persons, as weighted
  BodyOutcome outcome_a;                              ///< what it does to a
  BodyOutcome outcome_b;                              ///< and to b
  BodyDamage damage_a;                                ///< triangles of a
  BodyDamage damage_b;                                ///< and of b
};

/// A pass closer than the tolerance that touches nothing.
struct Graze {
  std::size_t actor = 0;  ///< index into Scenario::actors
  double time_s = 0.0;    ///< s
};

/// Where the futures of a ranking come from.
enum class FutureMethod {
  certain,  ///< every actor exists and follows one motion: there is one future
  joint,    ///< the scenario lists joint futures
  all,      ///< all combinations of independent predictions
  sampled,  ///< a Latin hypercube sample of them, the same for all candidates and in every run
};

/// The futures of a ranking.
struct FutureSummary {
  FutureMethod method = FutureMethod::certain;  ///< where they come from
  std::size_t futures = 1;    ///< evaluated; with `sampled`, the likeliest is one more
  std::size_t sampled = 0;    ///< of these drawn, each with the same probability
  double combinations = 1.0;  ///< that the scenario allows
  /// Actors with several choices that no candidate, nor what follows from its crash, comes near:
  /// they multiply no futures, all of which have their likeliest choice.
  std::size_t left_out = 0;
  RiskMeasure risk;               ///< how their scores become one
  bool has_state_errors = false;  ///< drawn with errors of positions, headings and speeds
};

/// Outcome of a candidate in futures that do not differ for it: all bodies that act in its crash,
/// or might have, move alike in them.
struct FutureOutcome {
  double probability = 0.0;        ///< of these futures together; 0: the likeliest, beside a sample
  std::size_t futures = 1;         ///< how many
  bool is_likeliest = false;       ///< the likeliest future is one of them
  double score = 0.0;              ///< in the measure's unit
  bool collides = false;           ///< the ego has a contact
  std::size_t actor = 0;           ///< if it collides: the first body, index into Scenario::actors
  double time_of_impact_s = 0.0;   ///< from the decision
  double closing_speed_mps = 0.0;  ///< of the points that touch first
  std::size_t contacts = 0;        ///< with a force, those between others included
};

/// Risk of the people in or on one body.
struct PersonRisk {
  std::size_t body = ego_body;  ///< `ego_body`, or an index into Scenario::actors
  double persons = 0.0;         ///< in or on it
  /// Of the risk model's outcome (`risk_outcome`) for one of them, without weights: the mean over
  /// all futures, whatever the risk measure.
  double probability = 0.0;
};

/// The first moment at which a wheel leaves the road.
struct RoadLeaving {
  double time_s = 0.0;                                ///< from the decision
  double speed_mps = 0.0;                             ///< of the ego then
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();  ///< where the wheel is, world, m
};

/// Where the ego is at the horizon, if nothing was hit.
struct HorizonState {
  double speed_mps = 0.0;                                ///< >= 0
  double heading_rad = 0.0;                              ///< world, left positive, from x
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< of the body's origin, world, m
};

/// Largest distance that is searched for, m.
inline constexpr double farthest_clearance_m = 50.0;

/// Distances and time gaps beyond these are no safer: in the order they count alike. A choice.
inline constexpr double enough_distance_m = 5.0;
inline constexpr double enough_time_gap_s = 3.0;  ///< s

/// A first contact of which no crash is known yet.
struct FirstTouch {
  std::size_t actor = 0;           ///< index into Scenario::actors
  double time_of_impact_s = 0.0;   ///< from the decision
  double closing_speed_mps = 0.0;  ///< of the points that meet
};

/// Outcome of a candidate. Contacts, damage and grazes are those of the likeliest
/// future; scores, samples and places are of all futures.
struct CandidateResult {
  std::size_t candidate = 0;    ///< index into RankResult::candidates
  std::optional<double> score;  ///< in the measure's unit; absent where only the interval is known
  ScoreInterval
      score_interval;  ///< contains the score; range over the samples without numerical ones
  /// Estimate of an absent score, see RankedCandidate::estimate; absent before the first contact is
  /// known.
  std::optional<double> score_estimate;
  /// Least and greatest of the score and its numerical samples (`is_numerical`); the score alone
  /// where there are none, the score's interval where the score is not known.
  ScoreInterval numerical_interval;
  /// The first contacts of all futures are known: so are `collides`, `collision_probability` and,
  /// unless it does not count (Infeasible::keep), `feasible`, also where the score is not.
  bool searched = false;
  bool collides = false;  ///< it has a contact in the likeliest future
  /// The first contact in the likeliest future, where it is all that is known of the crash.
  std::optional<FirstTouch> first_touch;
  /// The ego's, in the order of their begins: the first, which the exact search found, then those
  /// of the simulated scene that follows from it.
  std::vector<Contact> contacts;
  /// Those between others that follow from it, in the order of their begins.
  std::vector<FurtherContact> further;
  /// The scene had more bodies close together, or more contacts, than it follows or reports: 64
  /// contacts in all, 64 pairs of bodies, 40 contacts at once, of a body the 32 nearest within 5 m.
  bool crowded = false;
  std::vector<Graze> grazes;  ///< before the first contact, in time order
  /// The ego's damage from all contacts together; a triangle hit twice counts once.
  BodyDamage ego;
  std::vector<double> sample_scores;  ///< by RankResult::samples; empty where there are none
  /// Where the score is known: what the futures lead to, the likeliest first, then by probability.
  std::vector<FutureOutcome> futures;
  double collision_probability = 0.0;  ///< of a contact of the ego's
  /// Where the measure is harm: of every body with people that has a contact in some future, the
  /// ego first, then in the actors' order.
  std::vector<PersonRisk> people;
  ManoeuvreDemand demand;  ///< as far as it is followed in any future
  bool feasible = true;    ///< the vehicle can follow it so far
  /// Before its first contact in the likeliest future, a wheel leaves the road.
  std::optional<RoadLeaving> leaves_road;
  /// Between the ego's outline and any other's, seen from above and height by height, along the
  /// plans of all futures until the horizon, m; 0 if it has a contact in one of them, absent if no
  /// body comes nearer than `farthest_clearance_m` or the score is not known.
  std::optional<double> least_distance_m;
  /// The actor at that distance; absent with it and if there is a contact.
  std::optional<std::size_t> nearest;
  /// Post-encroachment time: the least time between the ego and another that moves at one place,
  /// by the rectangles around their outlines, along the plans of all futures until the horizon, s;
  /// 0 if it has a contact in one of them, absent if no two paths cross.
  std::optional<double> least_time_gap_s;
  /// The actor that is there so soon before or after; absent as `nearest` is.
  std::optional<std::size_t> soonest;
  std::optional<HorizonState>
      at_horizon;  ///< state at the horizon, if it has no contact in the likeliest future
  /// Standard error of the score that comes from drawing a sample of futures, as if they were drawn
  /// independently. Absent without a sample, for worst and quantile, for cvar with fewer than 10
  /// drawn futures in its tail, and where the drawn scores do not differ: futures that were not
  /// drawn may.
  std::optional<double> sampling_error;
  /// Place in the ranking, from 1. Candidates that are tied share it: 1, 2, 2, 4.
  std::size_t place = 1;
  /// Number of candidates in that place, this one included; 1: not tied. They are neighbours in
  /// RankResult::ranking; `tied_with` lists them.
  std::size_t sharing = 1;
  /// Best and worst place over the samples but the numerical ones, from 0; `place` - 1 where there
  /// are none. Candidates that are tied and score alike in a sample share their place in it. Of a
  /// partial answer: the place of the complete one, without samples, lies between them.
  std::size_t best_place = 0;
  std::size_t worst_place = 0;  ///< and the worst
  /// Share of the samples, numerical ones left out, in which the next in the ranking scores lower
  /// than this one.
  double overtaken = 0.0;
  /// Numerical error may turn the order of this candidate and the next: their numerical intervals
  /// meet. The errors of two candidates are independent, so they are not compared sample by sample.
  /// False without numerical samples, and between candidates that are tied.
  bool within_numerical_error = false;
  /// The scores of this candidate and the next in the ranking differ (where one is not known: their
  /// intervals are disjoint), not `within_numerical_error`, and `overtaken` is at most
  /// `separable_share`. Never between candidates that are tied.
  bool separable = true;
};

/// Two places are separable while their order reverses in no more than this share of the
/// samples. Since a sample holds for all candidates alike, what is wrong in the same way for both
/// does not count against them, as it would if their intervals were compared.
inline constexpr double separable_share = 0.05;

/// A body as it was ranked with.
struct RankedBody {
  std::size_t model = 0;      ///< index into Scenario::models
  double mass_kg = 0.0;       ///< infinity: does not move
  bool mass_guessed = false;  ///< from kind and size
};

/// Work done, the same for every number of workers but for `damage`, which also counts the box
/// tests that share it out.
struct RankWork {
  std::uint64_t box_tests = 0;       ///< of the broad phase
  std::uint64_t body_pairs = 0;      ///< bodies that came near enough for a closer look
  ImpactWork impact;                 ///< looking for first contacts
  std::uint64_t damage_queries = 0;  ///< poses at which intersecting triangles were listed
  CollideWork damage;                ///< done by those
  std::uint64_t paths = 0;           ///< corners whose path through the other body was traced
  std::uint64_t crash_steps = 0;     ///< of simulated scenes
  std::uint64_t crash_pieces = 0;    ///< pieces of outlines moved in them

  /// Adds up.
  RankWork& operator+=(const RankWork& other) {
    box_tests += other.box_tests;
    body_pairs += other.body_pairs;
    impact += other.impact;
    damage_queries += other.damage_queries;
    damage += other.damage;
    paths += other.paths;
    crash_steps += other.crash_steps;
    crash_pieces += other.crash_pieces;
    return *this;
  }
};

/// What a Ranker's call did and how long it took.
struct RankerEffort {
  std::uint64_t work = 0;           ///< boxes, triangles, outline pieces: what a budget cuts
  std::size_t without_search = 0;   ///< scores known from the swept boxes alone
  std::size_t without_crash = 0;    ///< and from the search for contacts, no crash simulated
  std::size_t fully_evaluated = 0;  ///< scores known from simulated crashes
  std::size_t left_early = 0;  ///< bounds showed that they cannot be first; not evaluated fully
  double prepare_s = 0.0;      ///< of Ranker::prepare, wall time, before the call
  double bounds_s = 0.0;       ///< in the swept boxes' round
  double refining_s = 0.0;     ///< in all rounds after it
};

/// The answer, least harmful first.
struct RankResult {
  Measure measure = Measure::polygons;  ///< what was compared
  HarmOptions harm;                     ///< as it was counted with
  /// In which harm, delta-v and energy were evaluated, the first where nothing varies; empty for
  /// other measures and without HarmOptions::intervals. Numerical ones come last.
  std::vector<HarmSample> samples;
  std::vector<Candidate> candidates;           ///< in the order of `make_candidates`
  std::vector<CandidateResult> ranking;        ///< every candidate but the dropped once, best first
  Infeasible infeasible = Infeasible::demote;  ///< as it was ranked with
  std::vector<std::size_t> dropped;  ///< indices into `candidates`, rising; Infeasible::drop only
  bool complete = true;              ///< every score is known
  bool proved = true;                ///< no other candidate can still take the first place
  /// Candidates that can be first, best guess first. Of known scores the first in the ranking
  /// stands for those that are tied with it.
  std::vector<std::size_t> in_race;
  RankedBody ego;                      ///< the ego
  std::vector<RankedBody> actors;      ///< in the scenario's order
  FutureSummary futures;               ///< that the candidates were evaluated in
  RankWork work;                       ///< done for all
  double elapsed_s = 0.0;              ///< wall time of the call
  std::optional<RankerEffort> effort;  ///< of a Ranker's answer
};

/// Ranks the candidates of a scenario by the harm or damage of their crashes. `models` belong to
/// `Scenario::models`, index by index, in body coordinates.
///
/// For every candidate the ego and the actors follow their motions until the horizon. First contact
/// is found without stepping over any (time_of_impact); a body inside another at the start is a
/// contact at time 0. From there the crash is simulated (the law of `simulate_contact`), and with
/// nothing varied every triangle that touches the other body of a contact along the simulated
/// motion, on which both overlap as rigid ones, is damaged: those that intersect it at one of the
/// recorded poses (ContactMotion), about every 0.1 m of the way, the greatest compression and the
/// end of the force among them; and those that it passed through between two poses, a corner's
/// straight way crossing its surface. So a pole leaves a furrow, and a front that is wholly inside
/// a wall counts. Bodies that do not press on each other damage the first pair of triangles alone.
/// Where both bodies give way, the overlap is the sum of both crush depths: each body's damage then
/// reaches deeper than its own crush.
///
/// The crash of a candidate is one simulated scene: the ego, what it hits, what that is pushed into
/// and so on press on each other and on the road with their tyres (HarmOptions::after_contact says
/// what their wheels do), until everything rests, or 3 s after the last force. What is crushed
/// stays crushed when two bodies touch again. All other bodies keep their plans, do not react and
/// pass through each other. Where a scene reaches its limits, `CandidateResult::crowded` is set.
///
/// Scores add up over all contacts of the scene, those between others included: `polygons` counts
/// damaged triangles of all bodies, `area` adds their areas, a triangle that is hit twice once;
/// `closing-energy` adds the energy of every pair's first contact, `energy` all, `intrusion` both
/// bodies', `delta-v` the changes of velocity in the ego's events, `harm` everybody's risk as
/// weighted. An event is a body's contacts that begin less than 0.1 s after the end of one before;
/// the risk of the people in a body is that of injury in at least one of its events.
///
/// Where actors have predictions, may not exist, or joint futures are listed, every candidate is
/// evaluated in each future and its scores become one by the risk measure. Futures that do not
/// differ for a candidate are simulated once; what such a simulation may share is decided by the
/// bodies that came near it, so that sharing changes no bit. A body that nothing moves follows one
/// plan, and one that may not exist adjoins no other.
///
/// Order: what the ego can follow before what it cannot (RankOptions::infeasible); lower score;
/// lower probability of a collision; in the likeliest future a clean miss before a graze, and
/// staying on the road; the larger least distance, to a centimetre and up to `enough_distance_m`,
/// and least time gap, to 10 ms and up to `enough_time_gap_s`; in the likeliest future the
/// later first contact, the lower closing speed, or the lower speed at the horizon. Candidates that
/// agree in all of these are tied: they share a place and are listed in the order of the
/// candidates.
///
/// Cost: about the candidates times the bodies they come near. Errors: bad_input (numbers out
/// of `scenario_limits` or not finite, poses not rigid or out of order, missing or empty model, ego
/// without mass), usage (number of models), internal (no memory).
/// Safe from any thread; allocates.
CRASHRANK_API Result<RankResult> rank(const Scenario& scenario, View<const Model> models,
                                      const RankOptions& options = {});

/// Number of an answer's samples of what is not known: without the numerical ones.
CRASHRANK_API std::size_t range_sample_count(const RankResult& result) noexcept;

/// Indices into RankResult::candidates of those that share the place of `ranking[index]`, in their
/// order, itself left out; empty where it is not tied. `index` is one of the ranking's. Linear in
/// their number; safe from any thread.
CRASHRANK_API std::vector<std::size_t> tied_with(const RankResult& result, std::size_t index);

}  // namespace crashrank
