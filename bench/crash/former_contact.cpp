// Times the contact simulation of versions before the contact law, for scripts/crash_bench_against,
// which compiles this file within such a version; no other build does.
//
//   former_contact CONTACTS REPEATS
//
// Simulates the contacts that `contact_bench --save` wrote as that version's ranking did: cells,
// steps and friction of `coarse`, one look at the surfaces for all variants, memory kept. Crush
// maps are left out. Prints what `contact_bench --times-only --json` prints of times.

#include "bench/crash/contact_set.hpp"
#include "bench/crash/contact_timing.hpp"

#include "crash/pulse_run.hpp"
#include "crashrank/crash/depth_map.hpp"
#include "crashrank/rank/harm.hpp"
#include "rank/contact_severity.hpp"
#include "rank/crash_setup.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace crashrank;
using Eigen::Vector3d;

std::vector<detail::Body> describe_all(const std::vector<bench::CrashModel>& models) {
  std::vector<detail::Body> bodies;
  for (const bench::CrashModel& m : models) {
    ScenarioModel stated;
    for (int kind = 0; kind <= static_cast<int>(BodyKind::building); ++kind) {
      if (m.kind == body_kind_name(static_cast<BodyKind>(kind))) {
        stated.kind = static_cast<BodyKind>(kind);
      }
    }
    detail::Body body;
    body.model = &m.model;
    body.mass_kg = m.moves ? m.mass_kg : std::numeric_limits<double>::infinity();
    detail::prepare_body(stated, body);
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<PulseVariant> ranking_variants() {
  const std::vector<HarmSample> samples = harm_samples({});
  std::vector<PulseVariant> variants{{samples.front().friction, 1.0}};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const PulseVariant wanted{samples[i].friction, samples[i].strength};
    const PulseVariant& last = variants.back();
    const bool same = wanted.friction == last.friction && wanted.strength == last.strength;
    if (variants.size() == 1 || !same) variants.push_back(wanted);
  }
  return variants;
}

/// As the ranking makes it of a body.
PulseBody pulse_body(const detail::Body& body, const Pose& pose, const Velocity& velocity) {
  PulseBody placed;
  placed.pose = pose;
  placed.mesh = &body.model->mesh;
  placed.tree = &body.model->tree;
  placed.rigid = place(body.mass, pose, velocity);
  placed.strength = body.strength;
  if (!placed.rigid.movable()) {
    placed.rigid.velocity = Velocity{};
    placed.strength = CrushStrength::unyielding();
  }
  return placed;
}

std::size_t simulate(const std::vector<detail::Body>& bodies, const bench::ContactCase& c,
                     const std::vector<PulseVariant>& variants, std::size_t count,
                     detail::PulseMemory& memory) {
  const SeverityOptions how = detail::coarse(variants.front().friction);
  const PulseBody a = pulse_body(bodies[c.a], c.pose_a, c.velocity_a);
  const PulseBody b = pulse_body(bodies[c.b], c.pose_b, c.velocity_b);
  const Vector3d along = c.velocity_a.linear_mps - c.velocity_b.linear_mps;
  if (!detail::can_press(a, b, along)) return 0;
  const ViewFrame frame = view_along(along, c.point_m);
  detail::look(a, b, frame, how.pulse, memory);
  std::size_t acting = 0;
  for (std::size_t i = 0; i < count; ++i) {
    detail::PulseRun run(a, b, frame, variants[i], how.pulse, memory);
    run.advance(std::numeric_limits<int>::max());
    if (run.result().acts) ++acting;
  }
  return acting;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const Result<std::vector<bench::CrashModel>> models = bench::shipped_crash_models();
  if (!models) return 3;
  const Result<std::vector<bench::ContactCase>> cases =
      bench::load_contacts(argv[1], models->size());
  if (!cases) {
    std::fprintf(stderr, "%s\n", cases.error().message().c_str());
    return 3;
  }
  const auto repeats = static_cast<std::size_t>(std::atoi(argv[2]));
  const std::vector<detail::Body> bodies = describe_all(*models);
  const std::vector<PulseVariant> variants = ranking_variants();
  detail::PulseMemory memory;
  bench::CacheFlush flush;
  bench::ContactTimes plain;
  bench::ContactTimes varied;
  std::size_t acting = 0;
  for (const bench::ContactCase& c : *cases) {
    acting += simulate(bodies, c, variants, 1, memory);
    bench::time_contact([&] { simulate(bodies, c, variants, 1, memory); }, repeats, flush, plain);
    bench::time_contact([&] { simulate(bodies, c, variants, variants.size(), memory); }, repeats,
                        flush, varied);
  }
  std::printf(R"({"contacts": %zu, "acting": %zu, "variants": %zu, "plain": )", cases->size(),
              acting, variants.size());
  bench::print_json(plain);
  std::printf(R"(, "varied": )");
  bench::print_json(varied);
  std::printf("}\n");
  return 0;
}
