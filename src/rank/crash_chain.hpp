#pragma once

#include "crash/scene_run.hpp"
#include "rank/scene.hpp"
#include "rank/tally.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Share of the tyres' grip with which vehicles brake after a contact, or more where the manoeuvre
/// did: 0.36 g on a dry road, between a free roll (0.1 g) and locked wheels (0.7 g). A choice.
inline constexpr double brake_after_contact = 0.45;

/// Everything that follows from a candidate's first contact, simulated some steps at a time. One
/// object serves any number of candidates, one after another; one for each thread.
class CrashChain {
public:
  /// Room for the scene: nothing allocates after it.
  void prepare(const Scene& scene);

  /// Begins with the ego on its motion in a future at its first contact, the actors on their plans
  /// in that future; all of them outlive the run.
  void begin(const Scene& scene, const Motion& ego, std::size_t future, const Contact& first,
             const HarmSample& sample);
  /// Takes at most so many steps; false once everything rests.
  bool advance(int steps) { return run_.advance(steps); }
  void finish();

  /// Contacts with a force that are over.
  View<const SceneContact> contacts() const { return run_.contacts(); }
  /// The bodies of those: an actor, or the ego; of joined bodies the first contact's, or the first
  /// member.
  std::size_t body(std::size_t index) const { return actors_[index]; }
  /// Effect of the contact of that index in `contacts`, whatever follows it.
  ContactEffect effect(std::size_t index) const;
  /// Stands for the first contact where the outlines do not press: an effect without effects.
  static constexpr std::size_t without_force = static_cast<std::size_t>(-1);
  /// Effects of all contacts by their begins. `order`: the index of each in `contacts`.
  void effects(std::vector<ContactEffect>& effects, std::vector<std::size_t>& order) const;
  const SceneRun& run() const noexcept { return run_; }
  /// Marks the plans that came near the chain while it was simulated, or would have.
  void mark_relevant_plans(const Scene& scene, std::vector<char>& relevant) const;

private:
  struct SortedBody {
    ContactBody at;
    SceneBody body;
    std::size_t actor = 0;
  };
  void sort_actors(double time_s);

  const Contact* first_ = nullptr;
  SceneRun run_;
  std::vector<SceneBody> bodies_;
  std::vector<std::size_t> actors_;  ///< by body of the run
  std::vector<SortedBody> sorted_;
};

/// Velocity of the lower body's material against the other's as a contact begins, where its force
/// acts in the mean, m/s.
Eigen::Vector3d closing_of(const SceneContact& contact);

/// ½·reduced mass·v²; one of the masses may be infinite. J.
double closing_energy_j(double mass_a_kg, double mass_b_kg, double speed_mps);

/// The factors of a sample on the contact law's own values.
ContactVariant variant_of(const HarmSample& sample);

}  // namespace crashrank::detail
