#include "crashrank/crash/contact_law.hpp"

#include "crash/contact_run.hpp"

#include <limits>

namespace crashrank {

ContactWorkspace::ContactWorkspace() : state_(std::make_unique<State>()) {}
ContactWorkspace::~ContactWorkspace() = default;
ContactWorkspace::ContactWorkspace(ContactWorkspace&&) noexcept = default;
ContactWorkspace& ContactWorkspace::operator=(ContactWorkspace&&) noexcept = default;

void ContactWorkspace::prepare(std::size_t pieces, std::size_t fixed_bodies) {
  const std::size_t bodies = fixed_bodies + 2;
  State& state = *state_;
  if (state.near.size() < bodies) state.near.resize(bodies);
  for (detail::NearPieces& near : state.near) near.resize(pieces);
  state.bodies.reserve(bodies);
  state.records.reserve(bodies);
  state.forces.reserve(bodies);
  state.impulses.reserve(bodies);
  state.pressed.reserve(bodies);
}

double friction_between(Surface a, Surface b) noexcept {
  constexpr double on_steel = 0.1;
  constexpr double on_rubber = 0.5;
  constexpr double else_where = 0.3;
  if (a == Surface::rubber || b == Surface::rubber) return on_rubber;
  return a == Surface::steel || b == Surface::steel ? on_steel : else_where;
}

double restitution_at(double closing_mps) noexcept {
  return 0.26 + 0.15 / (1.0 + closing_mps / 4.0);
}

ContactOutcome simulate_contact(const ContactBody& a, const ContactBody& b,
                                View<const ContactBody> fixed, const Eigen::Vector3d& point_m,
                                const ContactVariant& variant, ContactWorkspace& workspace,
                                const ContactOptions& options) {
  detail::ContactRun run(a, b, fixed, point_m, variant, options, workspace);
  run.advance(std::numeric_limits<int>::max());
  return run.outcome();
}

}  // namespace crashrank
