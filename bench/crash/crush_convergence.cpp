// One car at four resolutions, driven into a pole: what the crash tells and how it converges, with
// the mesh and with the cells of the crush map.
#include "catalogue.hpp"

#include "crashrank/crash/severity.hpp"
#include "crashrank/crash/time_of_impact.hpp"
#include "crashrank/tree/model.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace crashrank;

TriangleMesh mesh_of(const generate::Model& model) {
  TriangleMesh mesh;
  for (const generate::NamedMesh& named : model.parts) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    for (const generate::Vec3& v : named.mesh.vertices) mesh.vertices.push_back(v.cast<float>());
    for (const auto& t : named.mesh.triangles) {
      mesh.triangles.push_back({base + static_cast<std::uint32_t>(t[0]),
                                base + static_cast<std::uint32_t>(t[1]),
                                base + static_cast<std::uint32_t>(t[2])});
    }
    mesh.parts.push_back(
        {named.name, first, static_cast<std::uint32_t>(mesh.triangles.size()) - first});
  }
  return mesh;
}

const generate::Entry& entry(const std::string& name) {
  for (const generate::Entry& e : generate::catalogue()) {
    if (e.name == name) return e;
  }
  std::abort();
}

}  // namespace

int main() {
  const generate::Entry& car = entry("sedan");
  Result<Model> pole = make_model(mesh_of(generate::build_sized(entry("pole"), 1600)));
  if (!pole) return 1;
  std::printf("%8s %9s %10s %10s %8s %9s %9s %9s %9s %10s\n", "cell mm", "triangles", "delta-v",
              "yaw deg/s", "crush m", "volume m3", "area m2", "damaged", "EES m/s", "engine m");
  for (const std::size_t triangles : {8000U, 16000U, 32000U, 64000U}) {
    Result<Model> model = make_model(mesh_of(generate::build_sized(car, triangles)));
    if (!model) return 1;
    FreeMotion drive;
    drive.start.translation = Eigen::Vector3d(-5.0, -0.3, 0.0);
    drive.velocity.linear_mps.x() = 15.0;
    const Motion motion(drive);
    ImpactWorkspace workspace;
    const Impact impact =
        time_of_impact(model->tree, motion, pole->tree, Motion(), 0.0, 1.0, workspace);
    PulseBody a;
    a.mesh = &model->mesh;
    a.pose = motion.pose_at(impact.time_s);
    MassProperties mass;
    mass.mass_kg = car.mass_kg;
    mass.center_m = car.center_of_mass_m;
    mass.inertia_kgm2 *= car.izz_kgm2;
    a.rigid = place(mass, a.pose, motion.velocity_at(impact.time_s));
    a.strength = car_strength({car.mass_kg, 1.86, 0.0, car.wheelbase_m});
    PulseBody b;
    b.mesh = &pole->mesh;
    b.strength = CrushStrength::unyielding();
    for (const double cell : {0.1, 0.05, 0.025, 0.0125}) {
      SeverityOptions options;
      options.crush.cell_m = cell;
      const Severity s = crash_severity(a, b, impact.point_a_m, Eigen::Vector3d::UnitX(), options);
      double engine = 0.0;
      for (const PartIntrusion& part : s.crush.a.parts) {
        if (model->mesh.parts[part.part].name == "engine") engine = part.intrusion_m;
      }
      std::printf("%8.1f %9zu %10.3f %10.2f %8.4f %9.4f %9.3f %9zu %9.3f %10.4f\n", 1e3 * cell,
                  model->mesh.size(), s.a.delta_v_total_mps,
                  s.a.yaw_rate_change_radps * 57.29577951308232, s.a.crush_m, s.crush.a.volume_m3,
                  s.crush.a.area_m2, s.crush.a.triangles.size(), s.a.ees_mps, engine);
    }
  }
  return 0;
}
