#include "crash/lone_contact.hpp"

#include "crash/pair_order.hpp"

namespace crashrank::detail {

LoneContact::LoneContact(const ContactBody& a, const ContactBody& b, View<const ContactBody> fixed,
                         const Eigen::Vector3d& point_m, const ContactVariant& variant,
                         const ContactOptions& options, ContactWorkspace& workspace)
    : state_(workspace.state()), swapped_(goes_second(a, b)) {
  const ContactBody& first = swapped_ ? b : a;
  const ContactBody& second = swapped_ ? a : b;
  const Eigen::Vector3d origin_m(point_m.x(), point_m.y(), 0.0);
  state_.begin();
  const std::size_t others = 1 + (second.vehicle->movable() ? 0 : fixed.size());
  state_.bodies.reserve(others + 1);
  state_.add_body(first, origin_m, variant);
  state_.add_body(second, origin_m, variant);
  run_.begin(state_, 0, state_.take_pair(0, 1), first, second, origin_m, variant, options);
  for (std::size_t k = 1; k < others; ++k) {
    state_.add_body(fixed[k - 1], origin_m, variant);
    run_.add(state_.take_pair(0, k + 1));
  }
}

bool LoneContact::advance(int steps) {
  for (int i = 0; i < steps && !run_.over(); ++i) {
    const double step_s = run_.next_step_s();
    for (PressedBody& body : state_.bodies) body.motion.move(0.5 * step_s);
    run_.compute_forces(step_s);
    for (std::size_t body = 0; body < state_.bodies.size(); ++body) {
      if (!state_.bodies[body].vehicle->breakaway) continue;
      FootLoad load;
      run_.add_load(body, load);
      if (state_.load_post(body, load)) run_.forget_held(body);
    }
    run_.apply_forces();
    for (PressedBody& body : state_.bodies) body.motion.move(0.5 * step_s);
    run_.end_step();
  }
  return !run_.over();
}

bool LoneContact::pressed(std::size_t fixed) const {
  return fixed + 1 < run_.pairs().size() && state_.pairs[run_.pairs()[fixed + 1]].pressed;
}

}  // namespace crashrank::detail
