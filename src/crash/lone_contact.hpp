#pragma once

#include "crash/contact_run.hpp"

namespace crashrank::detail {

/// The contact of two bodies, or of one with several that nothing moves, without anything else that
/// acts on them: some steps at a time.
class LoneContact {
public:
  /// `workspace` serves one contact at a time; vehicles and workspace outlive it. `fixed` as in
  /// `simulate_contact`.
  LoneContact(const ContactBody& a, const ContactBody& b, View<const ContactBody> fixed,
              const Eigen::Vector3d& point_m, const ContactVariant& variant,
              const ContactOptions& options, ContactWorkspace& workspace);

  /// Takes at most so many steps; false once the contact is over.
  bool advance(int steps);
  /// The outcome as far as the contact has come.
  ContactOutcome outcome() const { return run_.outcome(swapped_); }
  const ContactRun& run() const noexcept { return run_; }
  /// Whether one of `fixed` bore a force.
  bool pressed(std::size_t fixed) const;

private:
  ContactWorkspace::State& state_;
  ContactRun run_;
  bool swapped_ = false;  ///< the run's first body is B
};

}  // namespace crashrank::detail
