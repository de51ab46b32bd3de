#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/rank/contact.hpp"
#include "crashrank/rank/future_summary.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Most futures that are drawn.
inline constexpr std::size_t max_sampled_futures = 10'000;

/// Treatment of candidates that the vehicle cannot follow.
enum class Infeasible {
  demote,  ///< they follow all feasible ones
  /// They are removed from a complete ranking, unless no candidate is feasible; a partial ranking
  /// treats them as `demote`.
  drop,
  keep,  ///< they are ranked like all other candidates
};

/// The name on the command line: "demote", "drop", "keep".
CRASHRANK_API const char* infeasible_name(Infeasible infeasible) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<Infeasible> infeasible_from_name(const std::string& name);

/// What orders the candidates.
enum class RankOrder {
  score,  ///< the nominal score
  upper,  ///< the upper end of ScoreInterval: the most that the unknown parameters allow
};

/// The name on the command line: "score", "upper".
CRASHRANK_API const char* order_name(RankOrder order) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<RankOrder> order_from_name(const std::string& name);

/// What RankOptions::smooth adds: less than perception and localisation of vehicles leave open, and
/// more than the steps that a contact takes from catching to slipping. A design choice.
inline constexpr StateUncertainty small_errors{0.05, 0.0035, 0.1};
/// Most futures that are drawn for these errors alone.
inline constexpr std::size_t smooth_futures = 16;

/// How candidates are ranked.
struct RankOptions {
  std::optional<Measure> measure;  ///< absent: the scenario's
  /// Number of threads, 64 at most; 0 or 1: the calling thread does all the work. Threads share the
  /// candidates when they simulate; one dispatch holds the damage queries of every 16 candidates a
  /// thread. The answer has the same bits for every number of workers, policy and depth.
  unsigned workers = 1;
  Policy policy = Policy::late_match;  ///< policy by which the dispatcher assigns jobs to workers
  std::uint32_t depth = auto_depth;    ///< its distribution depth, 1 to `max_distribution_depth`
  std::optional<HarmOptions> harm;     ///< absent: the scenario's
  std::optional<RiskMeasure> risk;     ///< absent: the scenario's
  /// Number of futures to draw if there are too many combinations of predictions or if states have
  /// errors, 1 to `max_sampled_futures`.
  std::size_t sampled_futures = 64;
  Infeasible infeasible = Infeasible::demote;  ///< of candidates that the ego cannot follow
  RankOrder order = RankOrder::score;          ///< `Ranker` refuses `upper`: it has no samples
  /// Gives `small_errors` to every moving body whose state has none. Scores are then means over
  /// these, so no candidate is first for a centimetre by which a catch becomes a slip. A scenario
  /// with one future is drawn in `smooth_futures` of them, or in `sampled_futures` if they are
  /// fewer; it costs as many times as much.
  bool smooth = false;
  /// Number of places, from the first, of which damaged triangles and parts are found: of others
  /// damage is empty. The measures `polygons` and `area` find all.
  std::size_t damaged_places = std::numeric_limits<std::size_t>::max();
  bool records_motion = false;  ///< fills in CandidateResult::motion; `Ranker` ignores it
  ImpactOptions impact;         ///< `start_is_apart` is set internally
  /// Called before each simulation and after each candidate with the number of candidates evaluated
  /// and of all, by all workers, also concurrently; must return within microseconds and not throw.
  /// Returning false cancels the ranking: candidates not evaluated yet get bounds on their scores.
  /// Empty: all candidates are evaluated. `Ranker` ignores it, see RankBudget.
  std::function<bool(std::size_t evaluated, std::size_t candidates)> on_progress;
};

/// Bounds on a score. If the score is known: its range over the ranges of HarmOptions under the
/// chosen risk model (harm, delta-v, energy); both ends equal for the other measures. With a
/// contact without force (Contact::contact_without_force) in a future, `highest` is what the energy
/// of the scene allows there.
struct ScoreInterval {
  double lowest = 0.0;   ///< the score is not below
  double highest = 0.0;  ///< nor above
};

/// Risk of the people in or on one body.
struct PersonRisk {
  std::size_t body = ego_body;  ///< `ego_body`, or an index into Scenario::actors
  double persons = 0.0;         ///< number of people in or on it
  /// Probability of the outcome of the risk model (`risk_outcome`) for one of them, without
  /// weights: the mean over all futures, whatever the risk measure.
  double probability = 0.0;
  /// Exposure of the body: its greatest change of velocity by contact forces within 0.3 s, m/s. If
  /// several contacts squeeze it, their forces that cancel count up to the speed that its crush
  /// stands for. In the likeliest future.
  double exposure_mps = 0.0;
  double exposure_pdof_deg = 0.0;  ///< where that force comes from, clockwise from ahead
  double exposure_time_s = 0.0;    ///< when the exposure is reached, from the decision
};

/// The first moment at which a wheel leaves the road.
struct RoadLeaving {
  double time_s = 0.0;                                ///< from the decision
  double speed_mps = 0.0;                             ///< speed of the ego at that time
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();  ///< position of the wheel, world, m
};

/// State of the ego at the horizon, for a candidate without contact.
struct HorizonState {
  double speed_mps = 0.0;                                ///< >= 0
  double heading_rad = 0.0;                              ///< world, left positive, from x
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< of the body's origin, world, m
};

/// Largest distance that is computed, m.
inline constexpr double farthest_clearance_m = 50.0;

/// Larger distances and time gaps are equally safe in the order of candidates. A design choice.
inline constexpr double enough_distance_m = 5.0;
inline constexpr double enough_time_gap_s = 3.0;  ///< s

/// Longest time to collision after the horizon that is computed, s. A design choice: all plans end
/// at the horizon, and an extrapolation says little of a later time.
inline constexpr double longest_time_to_collision_s = 3.0;

/// A time to collision after the horizon below this decides among equal scores and is warned of, s:
/// braking and steering then avoid few crashes. Above it such times are alike, since a vehicle that
/// comes up to a queue still has time to brake. A design choice.
inline constexpr double imminent_crash_s = 1.0;

/// Bodies that close with less than this have no time to collision, m/s: rolling up to a queue and
/// a walker beside a standing car are no crash. A design choice.
inline constexpr double slow_crash_mps = 2.0;

/// A first contact whose crash was not simulated.
struct FirstTouch {
  std::size_t actor = 0;           ///< index into Scenario::actors
  double time_of_impact_s = 0.0;   ///< from the decision
  double closing_speed_mps = 0.0;  ///< of the points that touch, m/s
};

/// Outcome of a candidate. Contacts, damage and grazes are those of the likeliest
/// future; scores, samples and places are of all futures.
struct CandidateResult {
  std::size_t candidate = 0;    ///< index into RankResult::candidates
  std::optional<double> score;  ///< in the measure's unit; absent where only the interval is known
  ScoreInterval
      /// contains the score; if it is known, its range over the samples without numerical ones
      score_interval;
  /// Estimate of an absent score, see RankedCandidate::estimate; absent before the first contact is
  /// known.
  std::optional<double> score_estimate;
  /// Range of the score and its numerical samples (`is_numerical`); the score alone without such
  /// samples, the score interval if the score is not known.
  ScoreInterval numerical_interval;
  /// The first contacts of all futures are known: so are `collides`, `collision_probability` and,
  /// unless it does not count (Infeasible::keep), `feasible`, also where the score is not.
  bool searched = false;
  bool collides = false;  ///< the ego has a contact in the likeliest future
  /// The first contact in the likeliest future if the crash was not evaluated, or not explained in
  /// time: then contacts, damage and samples are absent although the score may be known.
  std::optional<FirstTouch> first_touch;
  /// Contacts of the ego in the order of their begin times: the first, from the exact search, then
  /// those of the simulated scene.
  std::vector<Contact> contacts;
  /// Contacts between other bodies in the same scene, in the order of their begin times.
  std::vector<FurtherContact> further;
  /// Simulated motion in the likeliest future of every body that a contact force acted on, the ego
  /// first, if RankOptions::records_motion asks for it.
  std::vector<BodyMotion> motion;
  /// The simulation reached a limit: 64 contacts in all, 64 pairs of bodies, 40 simultaneous
  /// contacts, for each body the 32 nearest within 5 m; or its exposure counts no more of what acts
  /// on a body after 9.6 s of contact forces.
  bool crowded = false;
  std::vector<Graze> grazes;  ///< before the first contact, in time order
  /// Damage of the ego from all contacts together; a triangle that is hit twice counts once.
  BodyDamage ego;
  std::vector<double> sample_scores;  ///< by RankResult::samples; empty where there are none
  /// If the score is known: the outcomes of the futures, the likeliest first, then by probability.
  std::vector<FutureOutcome> futures;
  double collision_probability = 0.0;  ///< probability that the ego has a contact
  /// If the measure is harm: risk of the people of every body that has a contact in some future,
  /// the ego first, then in the order of the actors.
  std::vector<PersonRisk> people;
  ManoeuvreDemand demand;  ///< demand of the plan as far as it is followed in any future
  bool feasible = true;    ///< the vehicle can follow it so far
  /// A wheel leaves the road before the first contact, in any future: in the likeliest if it does
  /// so there, otherwise in the one in which it is earliest. Probability: see `futures`.
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
  /// The actor with that time gap; absent as `nearest` is.
  std::optional<std::size_t> soonest;
  /// Time to collision at the horizon: the least time from the horizon until the ego's outline and
  /// any other's touch, seen from above and height by height, to 1 cm, if no body turns and
  /// each keeps the velocity that it has at the end of its plan or, if it brakes, the deceleration
  /// of the last half second until it stands; over the plans of all futures, s. Absent if it is
  /// longer than `longest_time_to_collision_s` or below `slow_crash_mps`, if the candidate has a
  /// contact in any future, and if the score is not known. A design choice: a contact just after
  /// the horizon is not part of the score, and this shows it.
  std::optional<double> time_to_collision_s;
  /// The actor with that time to collision; absent with it.
  std::optional<std::size_t> imminent;
  std::optional<HorizonState>
      at_horizon;  ///< state at the horizon, if it has no contact in the likeliest future
  /// Standard error of the score that comes from drawing a sample of futures, as if they were drawn
  /// independently, from what strata or fitted probabilities leave unexplained of the drawn scores.
  /// Absent without a sample, for worst and quantile, for cvar with fewer than 10 drawn futures in
  /// its tail, and where the drawn scores do not differ: futures that were not drawn may.
  std::optional<double> sampling_error;
  /// With a sample of futures: the score in each drawn future; the futures are the same for all
  /// candidates. Empty without a sample and where the score is not known.
  std::vector<double> drawn_scores;
  /// With a sample of futures: standard error of the difference of the scores of this candidate and
  /// the next in the ranking, from their differences in the drawn futures, as if these were drawn
  /// independently. 0 if all drawn futures differ alike. Absent for the last candidate, where a
  /// score is not known, without a sample, and where `sampling_error` cannot be computed for the
  /// risk measure.
  std::optional<double> sampling_error_to_next;
  /// Another sample of futures can reverse the order of this candidate and the next: their scores
  /// differ by at most `separable_errors` times `sampling_error_to_next`, or that error is unknown.
  /// False without a sample, between candidates that are tied, and if only one of them is feasible.
  bool within_sampling_error = false;
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
  /// Numerical errors can reverse the order of this candidate and the next: their numerical
  /// intervals overlap. The errors of two candidates are independent, so they are not compared
  /// sample by sample. False without numerical samples, and between candidates that are tied.
  bool within_numerical_error = false;
  /// The scores of this candidate and the next in the ranking differ (where one is not known: their
  /// intervals are disjoint), neither `within_numerical_error` nor `within_sampling_error`, and
  /// `overtaken` is at most `separable_share`. Never between candidates that are tied.
  bool separable = true;
};

/// Two places are separable if their order reverses in at most this share of the samples. A sample
/// applies to all candidates alike, so errors that affect both in the same way do not count, as
/// they would if intervals were compared.
inline constexpr double separable_share = 0.05;
/// With a sample of futures, scores that differ by at most this number of standard errors of their
/// difference are not separable.
inline constexpr double separable_errors = 2.0;

/// Properties of a body that the ranking used.
struct RankedBody {
  std::size_t model = 0;      ///< index into Scenario::models
  double mass_kg = 0.0;       ///< infinity: the body is fixed
  bool mass_guessed = false;  ///< the mass was derived from kind and size
  /// False: it has no material between 0.1 and 4 m over its ground, so nothing presses on it. First
  /// contacts with it are reported, forces are not simulated.
  bool has_outline = true;
};

/// Work of a ranking. It is the same for every number of workers, except `damage`, which includes
/// the box tests that distribute it.
struct RankWork {
  std::uint64_t box_tests = 0;       ///< of the broad phase
  std::uint64_t body_pairs = 0;      ///< pairs of bodies whose first contact was searched for
  ImpactWork impact;                 ///< of the search for first contacts
  std::uint64_t damage_queries = 0;  ///< poses at which intersecting triangles were listed
  CollideWork damage;                ///< of these queries
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

/// What the first place of a ranking rests on.
enum class RankBasis : std::uint8_t {
  braking,    ///< nothing that is known shows a better one than braking hardest, turning least
  coarse,     ///< it keeps clear of everybody by an estimate
  simulated,  ///< its score is known, and no known one is better; an unknown one may be
  proved,     ///< no other candidate can take the first place
};

/// "braking", "coarse", "simulated", "proved".
CRASHRANK_API const char* basis_name(RankBasis basis) noexcept;

/// Work and times of a call of a Ranker.
struct RankerEffort {
  /// tests of boxes and triangles, and outline pieces: the unit of a work budget
  std::uint64_t work = 0;
  std::size_t without_search = 0;  ///< number of scores known from the swept boxes alone
  /// number of scores known from the search for contacts, without a simulation
  std::size_t without_crash = 0;
  std::size_t fully_evaluated = 0;  ///< number of scores known from simulated crashes
  /// number of candidates that bounds proved not to be first, without full evaluation
  std::size_t left_early = 0;
  double prepare_s = 0.0;   ///< of Ranker::prepare, wall time, before the call
  double bounds_s = 0.0;    ///< in first steps of candidates: swept boxes and estimates
  double refining_s = 0.0;  ///< in all later steps
};

/// Result of a ranking, least harmful candidate first.
struct RankResult {
  Measure measure = Measure::polygons;  ///< the measure that was compared
  HarmOptions harm;                     ///< harm options that were used
  /// Samples in which harm, delta-v and energy were evaluated, the nominal one first, numerical
  /// ones last; empty for other measures and without HarmOptions::intervals.
  std::vector<HarmSample> samples;
  std::vector<Candidate> candidates;           ///< in the order of `make_candidates`
  std::vector<CandidateResult> ranking;        ///< every candidate except dropped ones, best first
  Infeasible infeasible = Infeasible::demote;  ///< as requested
  RankOrder order = RankOrder::score;          ///< as requested
  bool has_motion = false;                     ///< RankOptions::records_motion was requested
  /// indices into `candidates`, ascending; Infeasible::drop only
  std::vector<std::size_t> dropped;
  bool complete = true;                 ///< every score is known
  bool proved = true;                   ///< no other candidate can still take the first place
  RankBasis basis = RankBasis::proved;  ///< of the first place
  /// Candidates that can be first, most promising first. Of tied candidates with known scores only
  /// the first in the ranking is listed.
  std::vector<std::size_t> in_race;
  RankedBody ego;                      ///< the ego
  std::vector<RankedBody> actors;      ///< in the scenario's order
  FutureSummary futures;               ///< the futures in which candidates were evaluated
  RankWork work;                       ///< total work
  double elapsed_s = 0.0;              ///< wall time of the call
  std::optional<RankerEffort> effort;  ///< of a Ranker's answer
};

/// Ranks the candidates of a scenario by the harm or damage of their crashes. `models` correspond
/// to `Scenario::models` by index and are in body coordinates.
///
/// For every candidate the ego and the actors follow their motions until the horizon. The search
/// for the first contact cannot step over one (time_of_impact); a body inside another at the start
/// is a contact at time 0. From there the crash is simulated (the law of `simulate_contact`).
/// Damage is evaluated along the motion of each contact in the nominal sample, on which both bodies
/// overlap as rigid ones. A triangle is damaged if it intersects the other body at a recorded pose
/// (ContactMotion; about every 0.1 m of the path, including the greatest compression and the end of
/// the force), or if it passes through the surface between two poses, that is, if the straight path
/// of one of its corners crosses the surface. So a pole leaves a furrow, and a front that is
/// completely inside a wall counts. Bodies that do not press on each other damage only the first
/// pair of triangles. If both bodies deform, the overlap is the sum of both crush depths, so the
/// damage of each reaches deeper than its own crush.
///
/// The crash of a candidate is one simulated scene: the ego, the bodies that it hits, and those
/// that these hit in turn press on each other, and on the road with their tyres
/// (HarmOptions::after_contact sets braking), until all are at rest, or 3 s after the last force.
/// Crush remains when two bodies touch again. All other bodies keep their plans and pass through
/// each other. If a scene reaches its limits, `CandidateResult::crowded` is set.
///
/// Scores are sums over all contacts of the scene. `polygons` counts the damaged triangles of all
/// bodies and `area` adds their areas, a triangle that is hit twice once; `closing-energy` adds the
/// energy of the first contact of every pair, `energy` that of all, `intrusion` that of all bodies,
/// `delta-v` the exposures of the ego in separate impacts, and `harm` the weighted risks of all
/// people. A risk is that of injury in at least one impact of their body.
///
/// If actors have predictions, may be absent, or joint futures are listed, every candidate is
/// evaluated in each future, and the risk measure combines its scores. Futures that are equivalent
/// for a candidate are simulated once: those with the same plans of all bodies that came near the
/// simulation, so sharing does not change a bit. A fixed body has one plan, and one that may be
/// absent adjoins no other body.
///
/// Order: feasible before infeasible candidates (RankOptions::infeasible); lower score, or lower
/// upper end of its interval (RankOptions::order; places are then those of the upper ends alone,
/// and samples say nothing of them); lower
/// probability of a collision; in the likeliest future no contact before a graze; the longer time
/// to collision at the horizon, rounded to 10 ms, up to `imminent_crash_s`; in the likeliest future
/// staying on the road before leaving it; the larger least distance, rounded to 1 cm, up to
/// `enough_distance_m`; the larger least time gap, rounded to 10 ms, up to `enough_time_gap_s`; in
/// the likeliest future the later first contact, then the lower closing speed, or the lower speed
/// at the horizon. Candidates that agree in all of these are tied: they share a place and are
/// listed in the order of the candidates.
///
/// Cost: proportional to the candidates times the bodies that they come near. Errors: bad_input
/// (numbers beyond `scenario_limits` or not finite, poses not rigid or out of order, a missing or
/// empty model, an ego without mass), usage (number of models), internal (no memory). Safe from any
/// thread; allocates.
CRASHRANK_API Result<RankResult> rank(const Scenario& scenario, View<const Model> models,
                                      const RankOptions& options = {});

/// Row of the ranking that would be first in that order: the least score or upper end of the
/// candidates that infeasibility does not demote, ties to the earlier row; 0 for an empty ranking.
/// Linear in the candidates; safe from any thread.
CRASHRANK_API std::size_t first_by(const RankResult& result, RankOrder order) noexcept;

/// Row of the ranking that would be first without errors of states: the least score in the
/// likeliest future. Absent if there are no such errors, if the scenario allows several
/// combinations or if a score is not known. Linear in the candidates; safe from any thread.
CRASHRANK_API std::optional<std::size_t> first_without_errors(const RankResult& result) noexcept;

/// Number of samples of unknown parameters, without the numerical ones.
CRASHRANK_API std::size_t range_sample_count(const RankResult& result) noexcept;

/// Indices into RankResult::candidates of those that share the place of `ranking[index]`, in their
/// order, itself left out; empty where it is not tied. `index` is one of the ranking's. Linear in
/// their number; safe from any thread.
CRASHRANK_API std::vector<std::size_t> tied_with(const RankResult& result, std::size_t index);

}  // namespace crashrank
