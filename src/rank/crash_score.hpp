#pragma once

#include "crash/exposure.hpp"
#include "crashrank/internal/rank/harm.hpp"
#include "rank/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Effect of a contact on one of its two bodies.
struct SideEffect {
  std::size_t body = ego_body;  ///< index of an actor, or `ego_body`
  double delta_v_mps = 0.0;
  double crush_j = 0.0;
};

/// What a contact adds to scores that are sums over contacts.
struct ContactEffect {
  double restitution = 0.0;
  double dissipated_j = 0.0;
  double closing_energy_j = 0.0;  ///< see Contact; 0 except in the first contact of the pair
  std::array<SideEffect, 2> sides;
};

/// Effects of a simulated crash, as far as it was simulated.
struct CrashEffects {
  struct BodyCells {
    std::size_t body = ego_body;
    std::size_t first = 0;  ///< index of its first cell in `cells`
    std::size_t count = 0;
  };
  double begin_s = 0.0;  ///< time of the begin of the simulation
  std::vector<ContactEffect> contacts;
  std::vector<BodyCells> bodies;  ///< those with a contact
  std::vector<ExposureCell> cells;

  void clear();
  void add(std::size_t body, View<const ExposureCell> more);
  View<const ExposureCell> cells_of(const BodyCells& body) const {
    return {cells.data() + body.first, body.count};
  }
};

/// Upper bound on the intrusion: the depth of the middle of the passenger compartment, m.
double max_intrusion_m(const Vehicle& v);

/// The windows of one body in one sample, from which measures read their term.
class WindowReader {
public:
  /// `is_bound`: what the final simulation may add lowers no number.
  WindowReader(const Scene& scene, const CrashEffects& effects, const CrashEffects::BodyCells& body,
               const std::vector<ExposureWindow>& windows, const HarmSample& sample, bool is_bound)
      : scene_(scene),
        effects_(effects),
        body_(body),
        windows_(windows),
        sample_(sample),
        is_bound_(is_bound) {}

  bool is_ego() const { return body_.body == ego_body; }
  /// Probability that a person in or on the body is injured in at least one of its impacts.
  double risk() const;
  /// Sum of the exposures of its impacts, m/s.
  double summed_mps() const;
  /// Intrusion into its compartment, m.
  double intrusion_m() const;

private:
  double hazard(const ExposureWindow& window) const;

  const Scene& scene_;
  const CrashEffects& effects_;
  const CrashEffects::BodyCells& body_;
  const std::vector<ExposureWindow>& windows_;
  const HarmSample& sample_;
  bool is_bound_;
};

/// Inputs of the harm model for the people on a body; without a window those of a body at rest.
HarmExposure exposure_of(const Scene& scene, std::size_t body, const ExposureWindow* window);

/// Computes scores from the effects of a crash. All callers get the same sums in the same order.
class CrashScore {
public:
  /// Allocates; the members for single samples do not allocate afterwards.
  void prepare() { windows_.reserve(most_windows); }
  double score(const Scene& scene, const CrashEffects& effects, const HarmSample& sample);
  /// Lower bound on the score in the nominal sample of a simulation that goes on from `effects`.
  double lower_bound(const Scene& scene, const CrashEffects& effects);
  /// Adds to each score that in the sample with the same index.
  void add_scores(const Scene& scene, const CrashEffects& effects, View<const HarmSample> samples,
                  double* scores, bool is_bound = false);
  /// Exposure and risk in the nominal sample of every body with a contact, in the order of
  /// `effects.bodies`; the risk under measure harm only.
  std::vector<PersonRisk> people(const Scene& scene, const CrashEffects& effects);

private:
  void list(const Scene& scene, const CrashEffects& effects, const CrashEffects::BodyCells& body,
            double restitution);

  void list_some(const Scene& scene, const CrashEffects& effects,
                 const CrashEffects::BodyCells& body);

  std::vector<ExposureWindow> windows_;
};

}  // namespace crashrank::detail
