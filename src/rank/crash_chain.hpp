#pragma once

#include "crash/scene_run.hpp"
#include "rank/scene.hpp"
#include "rank/tally.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Smallest share of the grip of the tyres with which vehicles brake after a contact: 0.36 g on a
/// dry road, between coasting (0.1 g) and locked wheels (0.7 g). A manoeuvre that brakes harder
/// keeps its braking. A design choice.
inline constexpr double brake_after_contact = 0.45;

/// A contact of the ego with an actor while both follow their plans.
struct Touch {
  Contact contact;
  std::int32_t triangle_ego = -1;  ///< triangles that touch first; negative if there are none
  std::int32_t triangle_other = -1;
  Pose ego;  ///< poses and speeds at that time
  Pose other;
  double ego_mps = 0.0;
  double other_mps = 0.0;
  bool presses_later = false;  ///< the same bodies have a contact with a force, too
};

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

  /// Contacts that had a force and have ended.
  View<const SceneContact> contacts() const { return run_.contacts(); }
  /// Body of that index in a contact: an actor or the ego. Of joined bodies it is the actor of the
  /// first contact or, otherwise, their first member.
  std::size_t body(std::size_t index) const { return actors_[index]; }
  /// Effect of the contact with that index in `contacts`, independent of later contacts.
  ContactEffect effect(std::size_t index) const;
  /// Returns true if the outlines press on each other in the first contact.
  bool first_acts() const;
  /// Time of the first force, until which all bodies follow their plans; infinity if there is none.
  double first_force_s() const;
  /// Indices from this one on stand for touches, which have an effect with zero forces.
  static constexpr std::size_t touch = std::numeric_limits<std::size_t>::max() / 2;
  /// Effects of all contacts in the order of their begin times, those of `touches` first if the
  /// first contact has no force. `order` gets the index of each in `contacts`, or `touch` and its
  /// index in `touches`.
  void effects(View<const Touch> touches, std::vector<ContactEffect>& effects,
               std::vector<std::size_t>& order) const;
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

  std::size_t first_actor_ = 0;
  double first_closing_mps_ = 0.0;
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
