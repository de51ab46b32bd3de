#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/export.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/crash/time_of_impact.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/rank/candidate.hpp"
#include "crashrank/rank/harm.hpp"
#include "crashrank/rank/measure.hpp"
#include "crashrank/rank/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// How candidates are ranked.
struct RankOptions {
  std::optional<Measure> measure;  ///< absent: the scenario's
  /// Threads that share the work, 64 at most; 0 or 1: the calling thread does all. They share the
  /// candidates when looking for contacts, and one dispatch holds the queries of all candidates'
  /// damage. The answer has the same bits for every number, policy and depth.
  unsigned workers = 1;
  Policy policy = Policy::late_match;  ///< how the dispatch's jobs find their workers
  std::uint32_t depth = auto_depth;    ///< its distribution depth, 1 to `max_distribution_depth`
  std::optional<HarmOptions> harm;     ///< absent: the scenario's
  ImpactOptions impact;                ///< `start_is_apart` is decided inside
};

/// What a crash does to one body.
struct BodyDamage {
  /// Triangles that intersect the other body, or pass through its surface, while the two move as
  /// the simulated contact moves them, in mesh order, rising: see `rank`. A body that lies inside
  /// the other at the start counts whole.
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> parts;  ///< indices of the mesh's parts that those belong to, rising
  double area_m2 = 0.0;              ///< of those triangles
  Box region;  ///< where the surfaces meet, in body coordinates; empty when they do not
  Pose pose;   ///< body to world at first contact
};

/// Bounds on a score. Where the score is known: what the ranges of HarmOptions leave open of it
/// under the chosen risk model (harm, delta-v, energy), equal for the other measures.
struct ScoreInterval {
  double lowest = 0.0;   ///< the score is not below
  double highest = 0.0;  ///< nor above
};

/// What a crash does to one body. Velocities in its own axes before the crash.
struct BodyOutcome {
  double delta_v_mps = 0.0;            ///< magnitude
  double delta_v_x_mps = 0.0;          ///< forward, m/s
  double delta_v_y_mps = 0.0;          ///< to the left, m/s
  double yaw_rate_change_radps = 0.0;  ///< to the left, rad/s
  /// Of the event that the contact belongs to: contacts of one body that overlap in time or lie
  /// less than 0.1 s apart change its velocity together. What harm reads.
  double event_delta_v_mps = 0.0;
  double event_yaw_rate_change_radps = 0.0;  ///< of the event, to the left, rad/s
  double pdof_deg = 0.0;        ///< where the force comes from, clockwise from ahead, [0, 360)
  int clock = 12;               ///< the PDOF as an hour, 12 ahead
  double crush_energy_j = 0.0;  ///< from here on 0 unless the crash was simulated
  double ees_mps = 0.0;         ///< energy-equivalent speed, m/s
  double crush_m = 0.0;         ///< deepest, m
  double intrusion_m = 0.0;     ///< into the passengers' cage, m
  double harm = 0.0;            ///< persons, as weighted
  std::string cdc;              ///< collision deformation classification, SAE J224
};

/// The crash with one body: it as it moves when met, the ego as the contacts before left it.
struct ContactSeverity {
  /// Harm was evaluated (measures that need it). The changes of velocity are the simulation's in
  /// any case: the same numbers under every measure.
  bool simulated = false;
  bool slides = false;        ///< past each other rather than into
  double duration_s = 0.0;    ///< of the crush phase, s
  double dissipated_j = 0.0;  ///< turned into damage and heat, J
  BodyOutcome ego;            ///< what it does to the ego
  BodyOutcome other;          ///< and to the other
  double harm = 0.0;          ///< persons, as weighted
};

/// One body hit by a candidate. Points and directions in world coordinates.
struct Contact {
  std::size_t actor = 0;                     ///< index into Scenario::actors
  ImpactState state = ImpactState::contact;  ///< how the bodies meet
  double time_of_impact_s = 0.0;             ///< from the decision, s
  double gap_m = 0.0;                        ///< between the surfaces then, at most the tolerance
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< where they meet, world, m
  /// Unit, from the ego towards the other; zero for a body that lies inside another.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();  ///< ego's velocity less the other's there
  /// Its length.
  double closing_speed_mps = 0.0;
  /// Its share along the normal: what brings the surfaces together. Depends on the facet met first.
  double normal_speed_mps = 0.0;
  /// ½·m₁m₂/(m₁+m₂)·closing_speed²: all that the crash could turn into damage if the bodies stuck
  /// together and their velocities passed through the common centre of mass.
  double closing_energy_j = 0.0;
  /// Duration of the simulated motion along which the damage was read, from first contact to the
  /// end of the force, s. 0 where the bodies do not press on each other. It is
  /// `severity.duration_s`, but for a body that nothing moves and that the ego pressed on in an
  /// earlier contact along its plan already: that contact's motion then holds for both.
  double crush_s = 0.0;
  /// Greatest distance in that motion of the ego's point at `point_m` from where it was at first
  /// contact, in the other body's frame, m. Both bodies' crush together in a square hit; more where
  /// they slide past each other.
  double crush_m = 0.0;
  /// What it damages of the ego, by further bodies that nothing moves and that the ego presses on
  /// in the same contact included.
  BodyDamage ego;
  BodyDamage other;          ///< and of `actor`
  ContactSeverity severity;  ///< the crash that begins with it
  std::size_t event = 0;     ///< number of the ego's event that it belongs to, from 1
};

/// A pass closer than the tolerance that touches nothing.
struct Graze {
  std::size_t actor = 0;  ///< index into Scenario::actors
  double time_s = 0.0;    ///< s
};

/// What choosing a candidate leads to.
struct CandidateResult {
  std::size_t candidate = 0;    ///< index into RankResult::candidates
  std::optional<double> score;  ///< in the measure's unit; absent where only the interval is known
  ScoreInterval
      score_interval;  ///< what the score is within; of the samples without numerical ones
  /// Least and greatest of the score and its numerical samples (`is_numerical`); the score alone
  /// where there are none, the score's interval where the score is not known.
  ScoreInterval numerical_interval;
  bool collides = false;  ///< it touches somebody
  /// In time order (then by actor). Measures that simulate the crash: the first contact, then what
  /// the ego meets as the crash leaves it (AfterImpact). The others: the first contact and all that
  /// begin no later than 0.05 s after it along the planned motion.
  std::vector<Contact> contacts;
  std::vector<Graze> grazes;  ///< before the first contact, in time order
  /// The ego's damage from all contacts together; a triangle hit twice counts once.
  BodyDamage ego;
  std::vector<double> sample_scores;  ///< by RankResult::samples; empty where there are none
  /// Place in the ranking, from 1. Candidates that are tied share it: 1, 2, 2, 4.
  std::size_t place = 1;
  /// Number of candidates in that place, this one included; 1: not tied. They are neighbours in
  /// RankResult::ranking; `tied_with` lists them.
  std::size_t sharing = 1;
  /// Best and worst place over the samples but the numerical ones, from 0; `place` - 1 where there
  /// are none. Candidates that are tied and score alike in a sample share their place in it.
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

/// Two places are separable while their order turns round in no more than this share of the
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
  std::uint64_t paths = 0;           ///< corners whose way through the other body was followed

  /// Adds up.
  RankWork& operator+=(const RankWork& other) {
    box_tests += other.box_tests;
    body_pairs += other.body_pairs;
    impact += other.impact;
    damage_queries += other.damage_queries;
    damage += other.damage;
    paths += other.paths;
    return *this;
  }
};

/// What a Ranker's call did and how long it took.
struct RankerEffort {
  std::uint64_t work = 0;           ///< tests of boxes, triangles and facets: what a budget cuts
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
  std::vector<Candidate> candidates;     ///< in the order of `make_candidates`
  std::vector<CandidateResult> ranking;  ///< every candidate once, best first
  bool complete = true;                  ///< every score is known
  bool proved = true;                    ///< no other candidate can still take the first place
  /// Candidates that can be first, best guess first. Of known scores the first in the ranking
  /// stands for those that are tied with it.
  std::vector<std::size_t> in_race;
  RankedBody ego;                      ///< the ego
  std::vector<RankedBody> actors;      ///< in the scenario's order
  RankWork work;                       ///< done for all
  double elapsed_s = 0.0;              ///< wall time of the call
  std::optional<RankerEffort> effort;  ///< where a Ranker told it
};

/// Ranks the candidates of a scenario by what they would destroy. `models` belong to
/// `Scenario::models`, index by index, in body coordinates.
///
/// For every candidate the ego and the actors follow their motions until the horizon. First contact
/// is found without stepping over any (time_of_impact); a body inside another at the start is a
/// contact at time 0. From there the contact is simulated (`simulate_contact`, nothing varied), and
/// every triangle that meets the other body along the simulated motion, on which both bodies
/// overlap as rigid ones, is damaged: those that intersect it at one of the recorded poses
/// (ContactMotion), about every 0.1 m of the way, the greatest compression and the end of the force
/// among them; and those that it passed through between two poses, a corner's straight way crossing
/// its surface. So a pole leaves a furrow, and a front that is wholly inside a wall counts. Bodies
/// that do not press on each other damage the first pair of triangles alone. Where both bodies give
/// way, the overlap is the sum of both crush depths: each body's damage then reaches deeper than
/// its own crush.
///
/// Scores add up over the contacts: `polygons` counts damaged triangles of the ego and of all hit,
/// `area` adds their areas, `closing-energy` and `energy` the contacts' energies, `delta-v` the
/// ego's changes of velocity, `intrusion` both bodies', `harm` everybody's risk as weighted.
/// Measures that simulate the crash (harm, delta-v, energy, intrusion) go on after a contact: the
/// ego leaves it with the velocity and yaw rate of the crash, slowed evenly (AfterImpact), and what
/// it meets then is a further contact that begins with what is left, up to a limit of contacts and
/// time. Bodies met at the same time are taken in turn. No body is met twice, and bodies that were
/// hit are not followed. The other measures take the planned motion and each contact by itself.
/// Order: lower score; then what touches
/// nothing before what does, a clean miss before a graze; then the later first contact; then the
/// lower closing speed. Candidates that agree in all of these are tied: they share a place and are
/// listed in the order of the candidates.
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
