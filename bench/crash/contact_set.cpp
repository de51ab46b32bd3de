#include "bench/crash/contact_set.hpp"

#include "bench/workload.hpp"
#include "catalogue.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/motion/time_of_impact.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <utility>

namespace bench {
namespace {

using namespace crashrank;
using Eigen::Vector3d;

constexpr double half_turn = 3.14159265358979;

double uniform(std::mt19937_64& engine, double low, double high) {
  return low + (high - low) * (static_cast<double>(engine() >> 11U) * 0x1p-53);
}

std::size_t below(std::mt19937_64& engine, std::size_t count) { return engine() % count; }

bool kind_moves(const std::string& kind) {
  return kind != "barrier" && kind != "pole" && kind != "building";
}

/// Half of what a box covers across the x axis of the world, and the middle of that.
struct Across {
  double half_m = 0.0;
  double middle_m = 0.0;
};

Across across(const Box& box, const Pose& pose) {
  const Vector3d middle = pose.rotation * box.center().cast<double>();
  const Vector3d half = pose.rotation.cwiseAbs() * (0.5 * box.extent().cast<double>());
  return {half.y(), middle.y()};
}

double radius_of(const Box& box) {
  return box.min.cast<double>().cwiseAbs().cwiseMax(box.max.cast<double>().cwiseAbs()).norm();
}

/// The numbers of a contact, in the order of the file.
std::array<double*, 14> fields(ContactCase& c, std::array<double, 2>& yaws) {
  Velocity& a = c.velocity_a;
  Velocity& b = c.velocity_b;
  return {&c.pose_a.translation.x(),
          &c.pose_a.translation.y(),
          &yaws[0],
          &a.linear_mps.x(),
          &a.linear_mps.y(),
          &c.pose_b.translation.x(),
          &c.pose_b.translation.y(),
          &yaws[1],
          &b.linear_mps.x(),
          &b.linear_mps.y(),
          &c.closing_mps,
          &c.point_m.x(),
          &c.point_m.y(),
          &c.point_m.z()};
}

Pose heading(double yaw) { return pose_from_angles({0, 0, 0}, yaw, 0, 0); }

}  // namespace

Result<std::vector<CrashModel>> shipped_crash_models() {
  std::vector<CrashModel> models;
  for (const generate::Entry& entry : generate::catalogue()) {
    Result<Model> model = make_model(shipped_model(entry.name, entry.triangles));
    if (!model) return model.error();
    models.push_back(
        {entry.name, entry.kind, entry.mass_kg, kind_moves(entry.kind), std::move(*model)});
  }
  return models;
}

std::vector<ContactCase> draw_contacts(const std::vector<CrashModel>& models, std::size_t count,
                                       std::uint64_t seed) {
  constexpr std::array<const char*, 4> egos{"hatch", "sedan", "truck", "motorcycle"};
  std::mt19937_64 engine(seed);
  ImpactWorkspace workspace;
  std::vector<ContactCase> cases;
  while (cases.size() < count) {
    ContactCase c;
    const std::string ego = egos[cases.size() % egos.size()];
    while (models[c.a].name != ego) ++c.a;
    c.b = below(engine, models.size());
    c.closing_mps = uniform(engine, 4.0, 40.0);
    // B at the origin, A comes along x.
    c.pose_a = heading(uniform(engine, -half_turn, half_turn));
    c.pose_b = heading(uniform(engine, -half_turn, half_turn));
    const double share = models[c.b].moves ? std::max(0.0, uniform(engine, -0.5, 0.5)) : 0.0;
    c.velocity_a.linear_mps.x() = (1.0 - share) * c.closing_mps;
    c.velocity_b.linear_mps.x() = -share * c.closing_mps;
    const Box box_a = models[c.a].model.mesh.bounds();
    const Box box_b = models[c.b].model.mesh.bounds();
    const Across of_a = across(box_a, c.pose_a);
    const Across of_b = across(box_b, c.pose_b);
    const double reach = of_a.half_m + of_b.half_m;
    const double apart = radius_of(box_a) + radius_of(box_b) + 0.1;
    c.pose_a.translation.x() = -apart;
    c.pose_a.translation.y() = of_b.middle_m - of_a.middle_m + uniform(engine, -reach, reach);
    const Impact impact = time_of_impact(models[c.a].model.tree, FreeMotion{c.pose_a, c.velocity_a},
                                         models[c.b].model.tree, FreeMotion{c.pose_b, c.velocity_b},
                                         0.0, 2.0 * apart / c.closing_mps, workspace);
    if (impact.state != ImpactState::contact) continue;
    c.pose_a.translation += impact.time_s * c.velocity_a.linear_mps;
    c.pose_b.translation += impact.time_s * c.velocity_b.linear_mps;
    c.point_m = 0.5 * (impact.point_a_m + impact.point_b_m);
    cases.push_back(c);
  }
  return cases;
}

bool save_contacts(const std::string& path, const std::vector<ContactCase>& cases) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  for (ContactCase c : cases) {
    std::array<double, 2> yaws{std::atan2(c.pose_a.rotation(1, 0), c.pose_a.rotation(0, 0)),
                               std::atan2(c.pose_b.rotation(1, 0), c.pose_b.rotation(0, 0))};
    std::fprintf(file, "%zu %zu", c.a, c.b);
    for (const double* field : fields(c, yaws)) std::fprintf(file, " %.17g", *field);
    std::fprintf(file, "\n");
  }
  return std::fclose(file) == 0;
}

Result<std::vector<ContactCase>> load_contacts(const std::string& path, std::size_t models) {
  std::ifstream file(path);
  std::vector<ContactCase> cases;
  for (ContactCase c; file >> c.a >> c.b; c = {}) {
    std::array<double, 2> yaws{};
    for (double* field : fields(c, yaws)) file >> *field;
    if (!file || c.a >= models || c.b >= models) break;
    c.pose_a.rotation = heading(yaws[0]).rotation;
    c.pose_b.rotation = heading(yaws[1]).rotation;
    cases.push_back(c);
  }
  if (cases.empty() || !file.eof()) {
    return make_error(ErrorCode::bad_input, path + " holds no contacts of contact_bench --save");
  }
  return cases;
}

}  // namespace bench
