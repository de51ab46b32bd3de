// Holds collide() against brute force in exact arithmetic on reduced meshes and against FCL on full
// ones, over random poses of the shipped models.

#include "crashrank/collide/collide.hpp"
#include "crashrank/tree/build.hpp"
#include "oracle/body_poses.hpp"
#include "oracle/fcl_pairs.hpp"
#include "oracle/shipped_models.hpp"
#include "oracle/triangle_oracle.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

namespace {

using crashrank::AabbTree;
using crashrank::Pair;
using crashrank::Pose;
using crashrank::TriangleMesh;

struct Body {
  std::string name;
  TriangleMesh mesh;
  std::vector<AabbTree> trees;  // one a way of building
  std::unique_ptr<oracle::FclMesh> fcl;
};

struct Options {
  std::uint64_t poses = 300;
  std::uint64_t seed = 1;
  std::string check = "brute";
  std::size_t triangles = 600;
  std::string folder;
  std::vector<std::string> models;
};

oracle::Triangle to_oracle(const crashrank::TriangleD& t) {
  oracle::Triangle result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = {t.corner[i].x(), t.corner[i].y(), t.corner[i].z()};
  }
  return result;
}

// Extents of a triangle along nine directions: the axes and the sums and differences of two
// coordinates. Rounding is monotone, so that intervals of rounded sums that do not overlap belong
// to exact ones that do not overlap either: triangles told apart here share no point.
struct Extents {
  std::array<double, 9> least;
  std::array<double, 9> most;

  explicit Extents(const oracle::Triangle& t) {
    least.fill(INFINITY);
    most.fill(-INFINITY);
    for (const auto& [x, y, z] : t) {
      const std::array<double, 9> at{x, y, z, x + y, x - y, y + z, y - z, z + x, z - x};
      for (std::size_t k = 0; k < at.size(); ++k) {
        least[k] = std::min(least[k], at[k]);
        most[k] = std::max(most[k], at[k]);
      }
    }
  }
  bool apart(const Extents& other) const {
    for (std::size_t k = 0; k < least.size(); ++k) {
      if (most[k] < other.least[k] || other.most[k] < least[k]) return true;
    }
    return false;
  }
};

// All triangles of a mesh in A's frame.
struct Placed {
  std::vector<oracle::Triangle> triangle;
  std::vector<Extents> extents;

  Placed(const TriangleMesh& mesh, const Pose* pose) {
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const crashrank::Triangle t = mesh.triangle(i);
      triangle.push_back(
          to_oracle(pose == nullptr ? crashrank::to_double(t) : crashrank::carry(*pose, t)));
      extents.emplace_back(triangle.back());
    }
  }
};

std::vector<Pair> brute_force(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
  const Placed pa(a, nullptr);
  const Placed pb(b, &pose);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (pa.extents[i].apart(pb.extents[j])) continue;
      if (oracle::rational_intersects(pa.triangle[i], pb.triangle[j])) {
        pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
  }
  return pairs;
}

bool truth(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose, Pair pair) {
  return oracle::rational_intersects(
      to_oracle(crashrank::to_double(a.triangle(static_cast<std::size_t>(pair.a)))),
      to_oracle(crashrank::carry(pose, b.triangle(static_cast<std::size_t>(pair.b)))));
}

struct Count {
  std::uint64_t pairs = 0;     // true ones
  std::uint64_t touching = 0;  // poses with at least one
  std::uint64_t missed = 0;
  std::uint64_t invented = 0;
  std::uint64_t any_wrong = 0;  // poses where "any" contradicts "all"
  std::uint64_t fcl_missed = 0;
  std::uint64_t fcl_invented = 0;
};

std::vector<Pair> difference(const std::vector<Pair>& from, const std::vector<Pair>& what) {
  std::vector<Pair> rest;
  std::set_difference(from.begin(), from.end(), what.begin(), what.end(), std::back_inserter(rest));
  return rest;
}

class Campaign {
public:
  explicit Campaign(const Options& options) : options_(options), random_(options.seed) {}

  bool load() {
    for (const std::string& name : options_.models) {
      auto mesh = oracle::read_obj(options_.folder + "/" + name + ".obj");
      if (!mesh) {
        std::fprintf(stderr, "%s\n", mesh.error().message().c_str());
        return false;
      }
      Body body{name, std::move(*mesh), {}, nullptr};
      if (options_.check == "brute") body.mesh = oracle::reduced_to(body.mesh, options_.triangles);
      if (!build_trees(body)) return false;
      if (options_.check == "fcl") body.fcl = std::make_unique<oracle::FclMesh>(body.mesh);
      std::printf("%s: %zu triangles\n", name.c_str(), body.mesh.size());
      bodies_.push_back(std::move(body));
    }
    return true;
  }

  void run() {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    for (std::uint64_t n = 0; n < options_.poses; ++n) {
      check_pose();
      if (terminal && n % 20 == 0) {
        std::fprintf(stderr, "\r%5.1f %%",
                     100.0 * static_cast<double>(n) / static_cast<double>(options_.poses));
      }
    }
    if (terminal) std::fputs("\r        \r", stderr);
  }

  const Count& count() const { return count_; }

private:
  bool build_trees(Body& body) {
    using crashrank::BoxFrame;
    using crashrank::SplitRule;
    const bool brute = options_.check == "brute";
    std::vector<crashrank::BuildOptions> ways{{}};
    if (brute) {
      ways = {{SplitRule::min_relative_segment, BoxFrame::world, 4},
              {SplitRule::min_relative_segment, BoxFrame::gaussian, 1},
              {SplitRule::paper, BoxFrame::world, 1},
              {SplitRule::sah, BoxFrame::gaussian, 8},
              {SplitRule::median, BoxFrame::world, 2}};
    }
    for (const crashrank::BuildOptions& way : ways) {
      auto tree = build_tree(body.mesh, way);
      if (!tree) {
        std::fprintf(stderr, "%s: %s\n", body.name.c_str(), tree.error().message().c_str());
        return false;
      }
      body.trees.push_back(std::move(*tree));
    }
    return true;
  }

  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(random_.integer(0, static_cast<std::int64_t>(count) - 1));
  }

  void check_pose() {
    const Body& a = bodies_[pick(bodies_.size())];
    const Body& b = bodies_[pick(bodies_.size())];
    const AabbTree& tree_a = a.trees[pick(a.trees.size())];
    const AabbTree& tree_b = b.trees[pick(b.trees.size())];
    const Pose pose = oracle::random_pose(random_, a.mesh.bounds(), b.mesh.bounds());

    std::vector<Pair> ours;
    collide(tree_a, tree_b, pose, ours, workspace_);
    std::sort(ours.begin(), ours.end());
    std::vector<Pair> one;
    const bool any = collide(tree_a, tree_b, pose, one, workspace_, {true}).intersecting;
    if (any == ours.empty()) ++count_.any_wrong;

    const std::vector<Pair> theirs =
        options_.check == "brute" ? brute_force(a.mesh, b.mesh, pose) : a.fcl->pairs(*b.fcl, pose);
    std::uint64_t missed = 0;
    std::uint64_t invented = 0;
    for (const Pair pair : difference(theirs, ours)) {
      (truth(a.mesh, b.mesh, pose, pair) ? missed : count_.fcl_invented) += 1;
    }
    for (const Pair pair : difference(ours, theirs)) {
      (truth(a.mesh, b.mesh, pose, pair) ? count_.fcl_missed : invented) += 1;
    }
    if (missed + invented > 0) {
      std::fprintf(stderr, "%s against %s: %llu missed, %llu invented\n", a.name.c_str(),
                   b.name.c_str(), static_cast<unsigned long long>(missed),
                   static_cast<unsigned long long>(invented));
    }
    count_.missed += missed;
    count_.invented += invented;
    count_.pairs += ours.size() + missed - invented;
    if (!ours.empty()) ++count_.touching;
  }

  Options options_;
  oracle::Random random_;
  std::vector<Body> bodies_;
  crashrank::CollideWorkspace workspace_;
  Count count_;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.folder = CRASHRANK_MODEL_FOLDER;
  options.models = {"hatch", "sedan", "truck", "motorcycle", "pedestrian", "jersey_barrier"};
  CLI::App app{"Holds crashrank's pair sets against brute force and FCL"};
  app.add_option("--poses", options.poses, "random poses; the nightly size is 10000");
  app.add_option("--seed", options.seed, "seed of the poses");
  app.add_option("--check", options.check,
                 "exact brute force on reduced meshes, or FCL on full ones")
      ->check(CLI::IsMember({"brute", "fcl"}));
  app.add_option("--triangles", options.triangles, "size of the reduced meshes");
  app.add_option("--models", options.models, "names of shipped models")->delimiter(',');
  app.add_option("--folder", options.folder, "where the models' OBJ files are");
  CLI11_PARSE(app, argc, argv);

  std::printf("seed %llu\n", static_cast<unsigned long long>(options.seed));
  Campaign campaign(options);
  if (!campaign.load()) return 1;
  campaign.run();

  const Count& count = campaign.count();
  std::printf("%llu poses, %llu touching, %llu pairs: %llu missed, %llu invented, %llu wrong any\n",
              static_cast<unsigned long long>(options.poses),
              static_cast<unsigned long long>(count.touching),
              static_cast<unsigned long long>(count.pairs),
              static_cast<unsigned long long>(count.missed),
              static_cast<unsigned long long>(count.invented),
              static_cast<unsigned long long>(count.any_wrong));
  if (options.check == "fcl") {
    std::printf("FCL differs, and is wrong by exact arithmetic: %llu missed, %llu invented\n",
                static_cast<unsigned long long>(count.fcl_missed),
                static_cast<unsigned long long>(count.fcl_invented));
  }
  std::printf("%.1f s of processor time\n",
              static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC));
  if (count.touching == 0) {
    std::puts("no pose touched: nothing was checked");
    return 1;
  }
  return count.missed + count.invented + count.any_wrong == 0 ? 0 : 1;
}
