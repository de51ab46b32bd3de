#include "crashrank/crash/contact_law.hpp"

#include "crash/lone_contact.hpp"

#include <algorithm>
#include <limits>

namespace crashrank {

ContactWorkspace::ContactWorkspace() : state_(std::make_unique<State>()) {}
ContactWorkspace::~ContactWorkspace() = default;
ContactWorkspace::ContactWorkspace(ContactWorkspace&&) noexcept = default;
ContactWorkspace& ContactWorkspace::operator=(ContactWorkspace&&) noexcept = default;

void ContactWorkspace::State::begin() {
  bodies.clear();
  pairs_in_use = 0;
  could_be_near = 0;
  pool.clear();
}

void ContactWorkspace::State::add_body(const ContactBody& body, const Eigen::Vector3d& origin_m,
                                       const ContactVariant& variant) {
  bodies.push_back({body.vehicle,
                    {body.vehicle->strength, variant.strength},
                    detail::make_planar(body, origin_m)});
}

std::uint32_t ContactWorkspace::State::take_pair(std::size_t first, std::size_t second) {
  if (pairs_in_use == pairs.size()) pairs.emplace_back();
  detail::BodyPair& pair = pairs[pairs_in_use];
  for (const std::size_t body : {first, second}) {
    const std::size_t pieces = bodies[body].vehicle->profile->pieces.size();
    (body == first ? pair.of_first : pair.of_second).resize(pieces);
    could_be_near += detail::most_blocks(pieces);
  }
  pool.reserve(std::min(could_be_near, most_pooled));
  pair.begin(first, second, pool);
  return static_cast<std::uint32_t>(pairs_in_use++);
}

bool ContactWorkspace::State::load_post(std::size_t body, const detail::FootLoad& load) {
  detail::PressedBody& post = bodies[body];
  const Vehicle& vehicle = *post.vehicle;
  const bool held = !(post.foot_load > 1.0);
  double free = 1.0;
  if (held) {
    const double before = post.foot_load;
    post.foot_load = load.over(*vehicle.breakaway);
    if (!(post.foot_load > 1.0)) return false;
    free = (post.foot_load - 1.0) / (post.foot_load - before);
  }
  post.motion.inverse_mass = free / vehicle.mass_kg;
  post.motion.inverse_inertia = free / vehicle.yaw_inertia_kgm2;
  return held;
}

void ContactWorkspace::prepare(std::size_t pieces, std::size_t fixed_bodies) {
  State& state = *state_;
  state.bodies.reserve(fixed_bodies + 2);
  if (state.pairs.size() < fixed_bodies + 1) state.pairs.resize(fixed_bodies + 1);
  for (detail::BodyPair& pair : state.pairs) {
    pair.of_first.resize(pieces);
    pair.of_second.resize(pieces);
  }
  state.pool.reserve(2 * (fixed_bodies + 1) * detail::most_blocks(pieces));
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
  detail::LoneContact run(a, b, fixed, point_m, variant, options, workspace);
  run.advance(std::numeric_limits<int>::max());
  return run.outcome();
}

}  // namespace crashrank
