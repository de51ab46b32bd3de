#include "bench/workload.hpp"

#include "catalogue.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/tree/build.hpp"
#ifdef CRASHRANK_BENCH_IMPORT
#include "crashrank/mesh/import.hpp"
#endif

#include <random>
#include <utility>

namespace bench {
namespace {

using crashrank::AabbTree;
using crashrank::Pose;

constexpr double pi = 3.14159265358979;

class Search {
public:
  Search(const AabbTree& tree, const crashrank::Box& bounds, std::uint64_t seed)
      : tree_(tree), bounds_(bounds), random_(seed) {}

  /// One approach: the poses of all three regimes along it. False when it passes A by.
  bool approach(std::array<Pose, regime_count>& found) {
    const Eigen::Vector3d size = bounds_.extent().cast<double>();
    const Eigen::Vector3d center = bounds_.center().cast<double>();
    const double side = real(0.0, 1.0) < 0.5 ? 1.0 : -1.0;
    Pose aligned =
        crashrank::pose_from_angles(Eigen::Vector3d::Zero(), side * pi / 2.0 + real(-0.35, 0.35),
                                    real(-0.02, 0.02), real(-0.02, 0.02));
    const Eigen::Vector3d forward = aligned.rotation.col(0);
    aligned.translation = center - aligned.rotation * center;
    aligned.translation.x() += real(-0.3, 0.3) * size.x();
    aligned.translation.z() = real(-0.05, 0.05) * size.z();
    const auto at = [&](double distance) {
      Pose pose = aligned;
      pose.translation -= distance * forward;
      return pose;
    };
    const double span = size.norm();
    double apart = span + 1.0;
    if (touches(at(apart))) return false;
    const double step = 0.01 * span;
    while (apart > 0.0 && !touches(at(apart - step))) apart -= step;
    if (apart <= 0.0) return false;
    double touching = apart - step;
    for (int i = 0; i < 30; ++i) {
      const double middle = 0.5 * (apart + touching);
      (touches(at(middle)) ? touching : apart) = middle;
    }
    found = {at(touching - real(0.05, 0.30)), at(apart + real(0.01, 0.10)),
             at(span + real(0.2, 20.0))};
    return touches(found[0]) && !touches(found[1]) && !touches(found[2]);
  }

private:
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11U) * 0x1p-53);
  }
  bool touches(const Pose& pose) {
    return collide(tree_, tree_, pose, pairs_, workspace_, {true}).intersecting;
  }

  const AabbTree& tree_;
  crashrank::Box bounds_;
  std::mt19937_64 random_;
  std::vector<crashrank::Pair> pairs_;
  crashrank::CollideWorkspace workspace_;
};

}  // namespace

crashrank::TriangleMesh shipped_model(const std::string& name, std::size_t triangles) {
  crashrank::TriangleMesh mesh;
  for (const generate::Entry& entry : generate::catalogue()) {
    if (entry.name != name) continue;
    for (const generate::NamedMesh& part : build_sized(entry, triangles).parts) {
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
      for (const generate::Vec3& v : part.mesh.vertices)
        mesh.vertices.emplace_back(v.cast<float>());
      for (const std::array<int, 3>& t : part.mesh.triangles) {
        mesh.triangles.push_back({base + static_cast<std::uint32_t>(t[0]),
                                  base + static_cast<std::uint32_t>(t[1]),
                                  base + static_cast<std::uint32_t>(t[2])});
      }
      mesh.parts.push_back(
          {part.name, first, static_cast<std::uint32_t>(part.mesh.triangles.size())});
    }
  }
  return mesh;
}

crashrank::Result<crashrank::TriangleMesh> imported_mesh(const std::string& path) {
#ifdef CRASHRANK_BENCH_IMPORT
  crashrank::ImportOptions options;
  options.importer = CRASHRANK_BENCH_IMPORT;
  auto imported = crashrank::import_mesh(path, options);
  if (!imported) return imported.error();
  return std::move(imported->mesh);
#else
  return crashrank::make_error(crashrank::ErrorCode::usage,
                               path + " cannot be read: built without mesh import");
#endif
}

crashrank::Result<Workload> make_workload(std::string name, crashrank::TriangleMesh mesh,
                                          std::size_t poses, std::uint64_t seed) {
  Workload workload{std::move(name), std::move(mesh), {}};
  const auto tree = build_tree(workload.mesh);
  if (!tree) return tree.error();
  Search search(*tree, workload.mesh.bounds(), seed);
  for (std::size_t tries = 0; workload.poses[0].size() < poses; ++tries) {
    if (tries > 100 * poses) {
      return crashrank::make_error(crashrank::ErrorCode::bad_input,
                                   workload.name + ": no poses found that touch");
    }
    std::array<Pose, regime_count> found;
    if (!search.approach(found)) continue;
    for (std::size_t i = 0; i < regime_count; ++i) workload.poses[i].push_back(found[i]);
  }
  return workload;
}

}  // namespace bench
