#pragma once

#include "crash/contact_run.hpp"

namespace crashrank::detail {

/// Simulates a contact on which nothing else acts, of two bodies or of one body with several fixed
/// ones, a few steps at a time.
class LoneContact {
public:
  /// A workspace serves one contact at a time; vehicles and workspace have to outlive it. `fixed`
  /// as in `simulate_contact`.
  LoneContact(const ContactBody& a, const ContactBody& b, View<const ContactBody> fixed,
              const Eigen::Vector3d& point_m, const ContactVariant& variant,
              const ContactOptions& options, ContactWorkspace& workspace);

  /// Takes up to `steps` steps; returns false once the contact is over.
  bool advance(int steps);
  /// The outcome up to now.
  ContactOutcome outcome() const { return run_.outcome(swapped_); }
  const ContactRun& run() const noexcept { return run_; }
  /// Returns true if a force acted on the given body of `fixed`.
  bool pressed(std::size_t fixed) const;

private:
  ContactWorkspace::State& state_;
  ContactRun run_;
  bool swapped_ = false;  ///< the first body of the run is B
};

}  // namespace crashrank::detail
