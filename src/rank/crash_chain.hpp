#pragma once

#include "crash/scene_run.hpp"
#include "rank/crash_score.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Smallest share of the grip of the tyres with which vehicles brake after a contact: 0.36 g on a
/// dry road, between coasting (0.1 g) and locked wheels (0.7 g). A manoeuvre that brakes harder
/// keeps its braking. A design choice.
inline constexpr double brake_after_contact = 0.45;

/// What the driver of a vehicle holds after a contact: what the plan held at that time.
struct HeldControls {
  double steering_rad = 0.0;  ///< of the front wheels, left positive
  double brake = 0.0;         ///< share of the grip, [0, 1]
};
HeldControls controls_after(const Scene& scene, const Motion& plan, const Vehicle& vehicle,
                            double contact_s);

/// Simulation of the scene that follows from the first contact of a candidate, a limited number of
/// steps at a time. One object serves any number of candidates in sequence; each thread needs its
/// own.
class CrashChain {
public:
  /// Allocates for the scene; no other member allocates.
  void prepare(const Scene& scene);

  /// Starts at the first contact of the ego on its motion in a future, with the actors on their
  /// plans in that future. The scene and the motion must outlive the run.
  void begin(const Scene& scene, const Motion& ego, std::size_t future, const Contact& first,
             const HarmSample& sample);
  /// Simulates at most `steps` steps; returns false once all bodies are at rest.
  bool advance(int steps) { return run_.advance(steps); }
  void finish();
  /// Does the same and records the motion of the bodies that a force acts on, the ego first.
  /// Allocates.
  void finish_recording(std::vector<BodyMotion>& motion);

  /// Contacts that had a force and have ended.
  View<const SceneContact> contacts() const { return run_.contacts(); }
  /// Body of that index in a contact: an actor or the ego. Of joined bodies it is the actor of the
  /// first contact or, otherwise, their first member.
  std::size_t body(std::size_t index) const { return actors_[index]; }
  std::size_t bodies() const { return actors_.size(); }
  /// Returns true if the outlines press on each other in the first contact.
  bool first_acts() const;
  /// Index that stands for a first contact without force.
  static constexpr std::size_t touch = std::numeric_limits<std::size_t>::max();
  /// Effects of all that was simulated so far; of an unfinished simulation those that remain when
  /// it goes on. The contacts are in the order of their begin times, a first contact without force
  /// before all others; `order` gets the index of each in `contacts`, or `touch`.
  void effects(CrashEffects& effects, std::vector<std::size_t>& order) const;
  const SceneRun& run() const noexcept { return run_; }
  /// Marks in `relevant` the plans of uncertain actors that influenced the simulation, or would
  /// have: those that came near its bodies.
  void mark_relevant_plans(const Scene& scene, std::vector<char>& relevant) const;

private:
  struct SortedBody {
    ContactBody at;
    SceneBody body;
    std::size_t actor = 0;
  };
  void sort_actors(double time_s);
  ContactEffect effect(std::size_t index) const;

  std::size_t first_actor_ = 0;
  double first_closing_mps_ = 0.0;
  double first_closing_energy_j_ = 0.0;
  double begin_s_ = 0.0;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  SceneRun run_;
  std::vector<SceneBody> bodies_;
  std::vector<std::size_t> actors_;  ///< by body of the run: actor index or `ego_body`
  std::vector<SortedBody> sorted_;
};

/// Velocity of the material of body a relative to that of body b at the begin of a contact, at the
/// mean point of the force then, horizontal, m/s.
Eigen::Vector3d closing_of(const SceneContact& contact);

/// ½·reduced mass·v²; one of the masses may be infinite. J.
double closing_energy_j(double mass_a_kg, double mass_b_kg, double speed_mps);

/// Factors of a sample relative to the default parameters of the contact law.
ContactVariant variant_of(const HarmSample& sample);

}  // namespace crashrank::detail
