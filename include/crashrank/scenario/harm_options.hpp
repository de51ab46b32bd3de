#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/internal/base/export.hpp"

#include <cstddef>
#include <string>

namespace crashrank {

/// Weights of risks and numbers of people. Every default is a choice that the user is responsible
/// for, not a finding: all persons count alike, one person in each vehicle, and property counts
/// nothing. All >= 0 and at most `harm_limits::weight`.
struct HarmWeights {
  double ego_occupant = 1.0;     ///< a person in the ego
  double other_occupant = 1.0;   ///< a person in another vehicle
  double pedestrian = 1.0;       ///< a person on foot
  double cyclist = 1.0;          ///< a person on a bicycle
  double motorcyclist = 1.0;     ///< a person on a motorcycle
  double property_per_mj = 0.0;  ///< for every MJ of deformation

  double people_in_ego = 1.0;    ///< persons
  double people_in_car = 1.0;    ///< persons, in each
  double people_in_truck = 1.0;  ///< persons, in each
  double people_in_bus = 10.0;   ///< persons, in each
};

/// Ranges of parameters that are not known well. All their corners are the samples from which a
/// ranking computes how stable it is.
struct HarmRanges {
  double least_friction = 0.1;  ///< between the bodies
  double most_friction = 0.6;   ///< between the bodies
  double least_strength = 0.7;  ///< stiffness, times the default strength of all bodies
  double most_strength = 1.4;   ///< times the default
  /// Times the restitution of the contact law, which is never more than 0.5. The law has 0.26
  /// to 0.41 in fresh structure; measured are 0.2 to 0.4 at a delta-v of 0.9 to 2.2 m/s, about 0.1
  /// at medium and high speed (SAE 931842): factors of 0.5 to 1.3.
  double least_restitution = 0.5;
  double most_restitution = 1.5;  ///< times the law's
  /// Times the speed at which the risk curves are read, for the width of the curves themselves; of
  /// occupants and of people outside cars each by itself, since their curves come from different
  /// data.
  double least_risk_speed = 0.9;
  double most_risk_speed = 1.1;  ///< times the speed
  /// Samples use every risk model, not only the chosen one.
  bool all_models = true;
};

/// How harm is counted.
struct HarmOptions {
  RiskModel model = RiskModel::tum;  ///< published curves
  HarmWeights weights;               ///< weights and numbers of people
  HarmRanges ranges;                 ///< ranges of uncertain parameters
  double friction = 0.3;             ///< between the bodies
  /// What undamaged wheels of all vehicles do after a contact. `brakes`: with 0.45 of the grip,
  /// the ego with more where its manoeuvre did. Bodies without wheels slide.
  AfterContact after_contact = AfterContact::brakes;
  double least_struck_share = 0.3;  ///< of earlier versions, [0, 1]; without effect
  bool intervals =
      true;  ///< evaluate the samples: the time of five to six simulations in place of one
  /// Times the steps of the simulation, [1/64, 8]: shows what they change. Not a key of files.
  double step = 1.0;
  /// Age and sex of all pedestrians, for the curves that have coefficients of them; empty: the mean
  /// person of the curve's sample.
  PedestrianDescription pedestrian;
};

/// One combination of values of the uncertain parameters. The same sample applies to every
/// candidate and every contact: errors that all of them have in common do not change their order.
struct HarmSample {
  double friction = 0.3;             ///< between the bodies
  double strength = 1.0;             ///< times the default
  double restitution = 1.0;          ///< times the contact law's
  RiskModel model = RiskModel::tum;  ///< published curves
  double occupant_speed = 1.0;       ///< times the speed at which an occupant's curve is read
  double outside_speed = 1.0;        ///< and that of people outside cars
  double step = 1.0;                 ///< times the steps of the simulation, see `sample_step`
  /// The ego's plan is shifted this far to the left of its velocity relative to the body that it
  /// touches first, m.
  double shift_m = 0.0;
  bool numerical = false;  ///< it varies the numerical method, not an uncertain parameter
};

/// Steps of all samples but the nominal one, times those of the nominal one: samples compare
/// candidates with each other and state ranges of tens of per cent, for which longer steps are
/// accurate enough. A numerical sample states the difference: half of the scores of chains change
/// by less than 1 %.
inline constexpr double sample_step = 1.5;

/// True if the sample varies the numerical method, not an uncertain parameter.
constexpr bool is_numerical(const HarmSample& sample) noexcept { return sample.numerical; }

/// Samples that vary how contacts are computed.
inline constexpr std::size_t numerical_samples = 3;

/// Bounds on what a profile may ask for; the published schema states the same numbers.
namespace harm_limits {
inline constexpr std::size_t file_bytes = std::size_t{1} << 20;  ///< of a profile
inline constexpr double weight = 1e6;                            ///< most
inline constexpr double people = 1000.0;                         ///< most in a vehicle
inline constexpr double friction = 10.0;                         ///< most
inline constexpr double min_strength = 0.01;                     ///< least factor
inline constexpr double max_strength = 100.0;                    ///< most
inline constexpr double restitution = 10.0;                      ///< most factor
inline constexpr double min_risk_speed = 0.1;                    ///< least factor
inline constexpr double max_risk_speed = 10.0;                   ///< most
inline constexpr double deceleration_mps2 = 50.0;                ///< most, m/s²
inline constexpr double after_s = 60.0;                          ///< longest, s
inline constexpr double age_years = 120.0;                       ///< most
inline constexpr double min_step = 1.0 / 64.0;                   ///< least factor
inline constexpr double max_step = 8.0;                          ///< most
inline constexpr std::size_t contacts = 16;                      ///< most of a candidate
}  // namespace harm_limits

/// Quantity that a ranking compares. Each is 0 without contact, and lower is better.
enum class Measure {
  polygons,        ///< triangles that intersect, of both bodies (Wiseman & Grinberg 2016)
  area,            ///< area of those triangles, m²
  closing_energy,  ///< ½·m₁m₂/(m₁+m₂)·v² v: closing speed of a pair's first contact, J
  delta_v,         ///< the ego's change of velocity in the crash, m/s
  energy,          ///< kinetic energy that the crash turns into damage and heat, J
  intrusion,       ///< how far the crush reaches into passengers' cages, both bodies', m
  harm,            ///< people hurt, as the weights of HarmOptions count them
};

/// The measure's name in files and on the command line: "polygons", "area", "closing-energy",
/// "delta-v", "energy", "intrusion", "harm".
CRASHRANK_API const char* measure_name(Measure measure) noexcept;
/// Unit of its scores: "triangles", "m2", "J", "m/s", "m", "persons".
CRASHRANK_API const char* measure_unit(Measure measure) noexcept;
/// What it counts, for a sentence and without an article: "people hurt, as weighted".
CRASHRANK_API const char* measure_meaning(Measure measure) noexcept;
/// Whether scoring it takes a simulation of the crash beyond first contact.
CRASHRANK_API bool needs_crash(Measure measure) noexcept;
/// Reads a name; the error (usage) lists those there are.
CRASHRANK_API Result<Measure> measure_from_name(const std::string& name);

/// How the scores of several futures become one.
enum class RiskKind {
  expected,  ///< the mean, each future weighted by its probability
  cvar,      ///< the mean of the worst share 1 - level; a future at the border counts in part
  worst,     ///< the greatest score of any future with a probability above 0
  quantile,  ///< the least score that is not exceeded with probability `level`
};

/// A risk measure: monotone in every future's score, and the score itself for a single future.
struct RiskMeasure {
  RiskKind kind = RiskKind::expected;  ///< which
  double level = 0.0;                  ///< of cvar and quantile, above 0 and below 1
};

/// Reads "expected", "worst", "cvar:X" or "quantile:X" with X above 0 and below 1. Errors: usage.
CRASHRANK_API Result<RiskMeasure> risk_from_name(const std::string& name);
/// The name that `risk_from_name` reads.
CRASHRANK_API std::string risk_name(const RiskMeasure& risk);

/// Reads a profile: weights of persons, numbers of people, the risk model, and the ranges of
/// uncertain parameters. The format is data/profile.schema.json. What the profile leaves out stays
/// as in `otherwise`, so that a profile can be laid over a scenario's own. The text is not trusted:
/// every error is bad_input or limit_exceeded and names the file and the key path, as
/// "weights.pedestrian", or line and column where the text is no JSON. `file` only names it.
CRASHRANK_API Result<HarmOptions> parse_profile(const std::string& text, const std::string& file,
                                                const HarmOptions& otherwise = {});

/// Reads the file, at most `harm_limits::file_bytes`. Errors also: not_found.
CRASHRANK_API Result<HarmOptions> load_profile_file(const std::string& file,
                                                    const HarmOptions& otherwise = {});

}  // namespace crashrank
