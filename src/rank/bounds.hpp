#pragma once

#include "crash/contact_run.hpp"
#include "rank/contact_severity.hpp"
#include "rank/crash_setup.hpp"
#include "rank/scene.hpp"
#include "rank/tally.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// What scores of a scene cannot exceed, prepared once for all its candidates. Rests on what the
/// pulse promises: energy is never gained, momentum conserved.
class ScoreBounds {
public:
  /// Makes room for a scene's actors and reads what does not change with their motions.
  void prepare(const Scene& scene);
  /// Reads the actors' motions. Allocates nothing.
  void update(const Scene& scene);

  /// No crash of a candidate that moves so can score more, whatever it meets.
  double most(const Scene& scene, const Motion& ego) const;
  /// The same where its first contact can only be with those.
  double most_with_first(const Scene& scene, const Motion& ego,
                         const std::vector<std::size_t>& first) const;
  /// What contacts after some can add: none of `met` again, `left` in number at most.
  Later most_after(const Scene& scene, const Motion& ego, View<const std::size_t> met,
                   std::size_t left) const;
  double ego_surface_m2() const noexcept { return ego_surface_m2_; }
  double actor_surface_m2(std::size_t actor) const { return surface_m2_[actor]; }

private:
  double energy_j(const Scene& scene, const Motion& ego) const;
  /// With the ego's people.
  double whole(const Later& later) const { return later.most + (later.any ? ego_people_ : 0.0); }

  std::vector<double> term_;        ///< by actor: the most that its people suffer, any speed
  std::vector<double> energy_;      ///< by actor: kinetic energy, J
  std::vector<double> surface_m2_;  ///< by actor
  std::vector<std::size_t> order_;  ///< actors by falling term
  double ego_people_ = 0.0;         ///< as weighted
  double ego_surface_m2_ = 0.0;
  double triangles_ = 0.0;  ///< of the ego and all actors
  double area_m2_ = 0.0;
  double energy_sum_j_ = 0.0;
};

/// What is known of a contact when all that is known is how the bodies meet.
PendingContact pending_at_contact(const CrashSetup& crash, const Contact& contact);

/// The same in the middle of its simulation.
PendingContact pending_in_run(const CrashSetup& crash, const Contact& contact,
                              const ContactRun& run);

}  // namespace crashrank::detail
