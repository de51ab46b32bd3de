// What the simulation of one contact takes, plain and with the variants of a ranking's samples, and
// how far it is from four times finer steps.
//
//   contact_bench [--seed N] [--contacts N] [--repeats N] [--times-only] [--json] [--save FILE]
//
// Times are processor time of one thread. Cold: twice the last-level cache is written before the
// contact. Warm: the median of calls that follow at once.

#include "bench/crash/contact_set.hpp"
#include "bench/crash/contact_timing.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/internal/rank/harm.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace {

using namespace crashrank;
using bench::ContactCase;
using bench::CrashModel;
using bench::quantile;
using Eigen::Vector3d;

struct Options {
  std::uint64_t seed = 1;
  std::size_t contacts = 240;
  std::size_t repeats = 5;
  bool times_only = false;
  bool json = false;
  std::string save;
};

/// Four times finer steps than a ranking takes.
constexpr double finer = 4.0;

Result<std::vector<Vehicle>> describe_all(const std::vector<CrashModel>& models) {
  std::vector<Vehicle> vehicles;
  for (const CrashModel& m : models) {
    VehicleFacts facts;
    for (int kind = 0; kind <= static_cast<int>(BodyKind::building); ++kind) {
      if (m.kind == body_kind_name(static_cast<BodyKind>(kind))) {
        facts.kind = static_cast<BodyKind>(kind);
      }
    }
    if (m.moves) facts.mass_kg = m.mass_kg;
    Result<Vehicle> vehicle = describe_vehicle(m.model.mesh, facts);
    if (!vehicle) return vehicle.error();
    vehicles.push_back(std::move(*vehicle));
  }
  return vehicles;
}

/// The plain variant, then every pair of friction and strength of the default samples once, as
/// `rank` simulates a contact before its three numerical samples.
std::vector<ContactVariant> ranking_variants() {
  std::vector<ContactVariant> variants{{}};
  const double panels = friction_between(Surface::sheet_metal, Surface::sheet_metal);
  const std::vector<HarmSample> samples = harm_samples({});
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const HarmSample& s = samples[i];
    if (is_numerical(s)) continue;
    if (i > 1 && s.friction == samples[i - 1].friction && s.strength == samples[i - 1].strength) {
      continue;
    }
    variants.push_back({s.friction / panels, s.strength, 1.0});
  }
  return variants;
}

class Contacts {
public:
  explicit Contacts(const std::vector<Vehicle>& vehicles) : vehicles_(vehicles) {
    std::size_t pieces = 0;
    for (const Vehicle& v : vehicles) pieces = std::max(pieces, v.profile->pieces.size());
    workspace_.prepare(pieces, 0);
  }
  ContactOutcome simulate(const ContactCase& c, const ContactVariant& variant,
                          const ContactOptions& options = {}) {
    const ContactBody a{&vehicles_[c.a], c.pose_a, c.velocity_a};
    const ContactBody b{&vehicles_[c.b], c.pose_b, c.velocity_b};
    return simulate_contact(a, b, {}, c.point_m, variant, workspace_, options);
  }

private:
  const std::vector<Vehicle>& vehicles_;
  ContactWorkspace workspace_;
};

/// Differences from finer steps, the greater one of both bodies, by contact.
struct Errors {
  std::vector<double> delta_v_percent;  ///< of the closing speed
  std::vector<double> direction_deg;    ///< where delta-v is a twentieth of the closing speed
  std::vector<double> yaw_rate_degps;   ///< of cars and lorries: light bodies spin far faster
  std::size_t acts_differently = 0;
};

constexpr double degrees = 180.0 / 3.14159265358979;

double angle_deg(const Vector3d& p, const Vector3d& q) {
  return std::atan2(p.cross(q).norm(), p.dot(q)) * degrees;
}

bool is_long(const Vehicle& v) { return v.kind == BodyKind::car || v.kind == BodyKind::truck; }

void add_errors(const ContactOutcome& coarse, const ContactOutcome& fine, const Vehicle& a,
                const Vehicle& b, double closing_mps, Errors& errors) {
  if (coarse.acts != fine.acts) ++errors.acts_differently;
  if (!coarse.acts && !fine.acts) return;
  double delta_v = 0.0;
  double direction = -1.0;
  double yaw = -1.0;
  for (const auto& [p, q, v] :
       {std::tuple{&coarse.a, &fine.a, &a}, std::tuple{&coarse.b, &fine.b, &b}}) {
    delta_v = std::max(delta_v, (p->delta_v_mps - q->delta_v_mps).norm() / closing_mps);
    if (is_long(*v)) {
      yaw = std::max(yaw, std::abs(p->delta_yaw_rate_radps - q->delta_yaw_rate_radps));
    }
    if (q->delta_v_mps.norm() > 0.05 * closing_mps && coarse.acts) {
      direction = std::max(direction, angle_deg(p->delta_v_mps, q->delta_v_mps));
    }
  }
  errors.delta_v_percent.push_back(100.0 * delta_v);
  if (yaw >= 0.0) errors.yaw_rate_degps.push_back(yaw * degrees);
  if (direction >= 0.0) errors.direction_deg.push_back(direction);
}

struct Measured {
  bench::ContactTimes plain;
  bench::ContactTimes varied;  ///< all variants of a ranking
  std::vector<double> steps;
  std::vector<double> pieces;
  std::size_t variants = 0;
  std::size_t acting = 0;
  Errors errors;
};

Measured measure(const std::vector<Vehicle>& vehicles, const std::vector<ContactCase>& cases,
                 const Options& options) {
  const std::vector<ContactVariant> variants = ranking_variants();
  Measured measured;
  measured.variants = variants.size();
  Contacts contacts(vehicles);
  bench::CacheFlush flush;
  ContactOptions fine;
  fine.travel_m /= finer;
  fine.shortest_s /= finer;
  fine.longest_s /= finer;
  fine.speed_change /= finer;
  for (const ContactCase& c : cases) {
    ContactOutcome plain;
    bench::time_contact([&] { plain = contacts.simulate(c, variants.front()); }, options.repeats,
                        flush, measured.plain);
    bench::time_contact(
        [&] {
          for (const ContactVariant& variant : variants) contacts.simulate(c, variant);
        },
        options.repeats, flush, measured.varied);
    measured.steps.push_back(plain.steps);
    measured.pieces.push_back(static_cast<double>(plain.pieces));
    measured.acting += plain.acts ? 1 : 0;
    if (options.times_only) continue;
    add_errors(plain, contacts.simulate(c, variants.front(), fine), vehicles[c.a], vehicles[c.b],
               c.closing_mps, measured.errors);
  }
  return measured;
}

void print_spread(const char* name, const std::vector<double>& values, int digits) {
  std::printf("%-44s %9.*f %9.*f %9.*f\n", name, digits, quantile(values, 0.5), digits,
              quantile(values, 0.95), digits, quantile(values, 1.0));
}

void print_text(const Measured& m, const Options& options) {
  const std::string all = std::to_string(m.variants) + " variants, ms";
  std::printf("seed %llu, %zu contacts, %zu act; unit of triangle tests: %s\n",
              static_cast<unsigned long long>(options.seed), m.steps.size(), m.acting,
              vector_unit());
  std::printf("%-44s %9s %9s %9s\n", "", "median", "p95", "worst");
  print_spread("plain, cold caches, ms", m.plain.cold, 3);
  print_spread("plain, warm caches, ms", m.plain.warm, 3);
  print_spread((all + ", cold caches").c_str(), m.varied.cold, 3);
  print_spread((all + ", warm caches").c_str(), m.varied.warm, 3);
  print_spread("steps of the plain contact", m.steps, 0);
  print_spread("pieces moved in it", m.pieces, 0);
  if (options.times_only) return;
  std::printf("against steps four times finer (%zu contacts act in one of the two alone):\n",
              m.errors.acts_differently);
  print_spread("delta-v, % of the closing speed", m.errors.delta_v_percent, 3);
  print_spread("direction of delta-v, degrees", m.errors.direction_deg, 2);
  print_spread("yaw rate of cars and lorries, degrees/s", m.errors.yaw_rate_degps, 2);
}

void print_json_spread(const char* name, const std::vector<double>& values) {
  std::printf(R"(, "%s": {"median": %.6g, "p95": %.6g, "worst": %.6g})", name,
              quantile(values, 0.5), quantile(values, 0.95), quantile(values, 1.0));
}

void print_json(const Measured& m, const Options& options) {
  std::printf(R"({"seed": %llu, "contacts": %zu, "acting": %zu, "variants": %zu, )",
              static_cast<unsigned long long>(options.seed), m.steps.size(), m.acting, m.variants);
  std::printf(R"("vector_unit": "%s", "plain": )", vector_unit());
  bench::print_json(m.plain);
  std::printf(R"(, "varied": )");
  bench::print_json(m.varied);
  print_json_spread("steps", m.steps);
  print_json_spread("pieces", m.pieces);
  if (!options.times_only) {
    print_json_spread("delta_v_error_percent", m.errors.delta_v_percent);
    print_json_spread("direction_error_deg", m.errors.direction_deg);
    print_json_spread("yaw_rate_error_degps", m.errors.yaw_rate_degps);
  }
  std::printf("}\n");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times and errors of simulated contacts");
  Options options;
  app.add_option("--seed", options.seed, "Of the contacts");
  app.add_option("--contacts", options.contacts, "How many")->check(CLI::Range(1, 1'000'000));
  app.add_option("--repeats", options.repeats, "Warm calls for each contact")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--times-only", options.times_only, "No comparison with finer steps");
  app.add_flag("--json", options.json, "One JSON object");
  app.add_option("--save", options.save, "Write the contacts to this file");
  CLI11_PARSE(app, argc, argv);

  const Result<std::vector<CrashModel>> models = bench::shipped_crash_models();
  if (!models) {
    std::fprintf(stderr, "%s\n", models.error().message().c_str());
    return 3;
  }
  const Result<std::vector<Vehicle>> vehicles = describe_all(*models);
  if (!vehicles) {
    std::fprintf(stderr, "%s\n", vehicles.error().message().c_str());
    return 3;
  }
  const std::vector<ContactCase> cases =
      bench::draw_contacts(*models, options.contacts, options.seed);
  if (!options.save.empty() && !bench::save_contacts(options.save, cases)) {
    std::fprintf(stderr, "%s cannot be written\n", options.save.c_str());
    return 3;
  }
  const Measured measured = measure(*vehicles, cases, options);
  options.json ? print_json(measured, options) : print_text(measured, options);
  return 0;
}
