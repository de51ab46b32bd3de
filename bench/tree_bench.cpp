// Build times and quality of trees, per mesh and split rule. Meshes are made here (a car-like body
// at several resolutions, a soup of loose triangles) or read from the files named.
//
//   tree_bench [--rounds N] [--paper] [MESH...]
//
// Every round builds each row once, one after the other, so that a change in the machine's mood
// falls on all alike; the table gives medians. --paper adds the literal rule, which takes seconds.

#include "crashrank/internal/tree/quality.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/tree/build.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace crashrank;

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

struct Row {
  std::string name;
  BuildOptions options;
  std::vector<double> seconds;
  TreeQuality quality;
};

// Two triangles a cell of a grid over [0,1]², bent into a surface by `place(u, v)`.
template <class Place>
void add_surface(TriangleMesh& mesh, std::uint32_t across, std::uint32_t along,
                 const Place& place) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i <= across; ++i) {
    for (std::uint32_t j = 0; j <= along; ++j) {
      mesh.vertices.push_back(
          place(static_cast<double>(i) / across, static_cast<double>(j) / along));
    }
  }
  for (std::uint32_t i = 0; i < across; ++i) {
    for (std::uint32_t j = 0; j < along; ++j) {
      const std::uint32_t a = base + i * (along + 1) + j;
      const std::uint32_t b = a + along + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({b, b + 1, a + 1});
    }
  }
}

// A rounded box of 4.6 x 1.9 x 1.4 m, finer towards its front, on four wheels.
NamedMesh car_like(std::size_t triangles) {
  constexpr double pi = 3.14159265358979323846;
  NamedMesh result{"car-like", {}};
  const auto power = [](double x) { return std::copysign(std::pow(std::abs(x), 0.4), x); };
  const double body = 0.8 * static_cast<double>(triangles) / 2.0;
  const auto side = static_cast<std::uint32_t>(std::sqrt(body));
  add_surface(result.mesh, side, side, [&](double u, double v) -> Eigen::Vector3f {
    const double polar = pi * u * u;
    const double turn = 2.0 * pi * v;
    return Eigen::Vector3d(2.3 * power(std::cos(polar)),
                           0.95 * power(std::sin(polar)) * power(std::cos(turn)),
                           0.7 + 0.7 * power(std::sin(polar)) * power(std::sin(turn)))
        .cast<float>();
  });
  const auto wheel = static_cast<std::uint32_t>(std::sqrt(body / 16.0));
  for (const double x : {-1.3, 1.4}) {
    for (const double y : {-0.85, 0.85}) {
      add_surface(result.mesh, wheel, wheel, [&](double u, double v) -> Eigen::Vector3f {
        const double ring = 0.25 + 0.08 * std::cos(2.0 * pi * v);
        return Eigen::Vector3d(x + ring * std::cos(2.0 * pi * u), y + 0.1 * std::sin(2.0 * pi * v),
                               0.33 + ring * std::sin(2.0 * pi * u))
            .cast<float>();
      });
    }
  }
  return result;
}

NamedMesh soup(std::size_t triangles) {
  NamedMesh result{"soup", {}};
  std::mt19937_64 random(1);
  const auto unit = [&random] { return static_cast<float>(random() >> 40U) * 0x1p-24F; };
  for (std::size_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3f at(4.0F * unit(), 2.0F * unit(), unit());
    const auto first = static_cast<std::uint32_t>(result.mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      const float x = unit();
      const float y = unit();
      const float z = unit();
      result.mesh.vertices.emplace_back(at + 0.02F * Eigen::Vector3f(x, y, z));
    }
    result.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

std::vector<Row> rows(bool with_paper) {
  std::vector<Row> all;
  const auto add = [&all](const char* name, SplitRule rule, std::uint32_t leaf, bool fill,
                          std::uint32_t passes, std::uint32_t threads = 1) {
    Row row;
    row.name = name;
    row.options.rule = rule;
    row.options.leaf_size = leaf;
    row.options.fill_leaves = fill;
    row.options.reinsertion_passes = passes;
    row.options.threads = threads;
    all.push_back(std::move(row));
  };
  add("min-relative-segment", SplitRule::min_relative_segment, 4, false, 0);
  add("min-relative-segment, 2 threads", SplitRule::min_relative_segment, 4, false, 0, 2);
  add("sah", SplitRule::sah, 4, false, 0);
  add("median", SplitRule::median, 4, false, 0);
  add("min-relative-segment fill 4", SplitRule::min_relative_segment, 4, true, 0);
  add("sah fill 4", SplitRule::sah, 4, true, 0);
  add("min-relative-segment fill 8", SplitRule::min_relative_segment, 8, true, 0);
  add("sah fill 8", SplitRule::sah, 8, true, 0);
  add("min-relative-segment + 2 reinsertions", SplitRule::min_relative_segment, 4, false, 2);
  add("sah + 2 reinsertions", SplitRule::sah, 4, false, 2);
  if (with_paper) add("paper", SplitRule::paper, 1, true, 0);
  return all;
}

bool measure(const NamedMesh& body, std::size_t rounds, bool with_paper) {
  std::vector<Row> table = rows(with_paper);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (Row& row : table) {
      const auto begin = std::chrono::steady_clock::now();
      const Result<AabbTree> tree = build_tree(body.mesh, row.options);
      const auto end = std::chrono::steady_clock::now();
      if (!tree) {
        std::fprintf(stderr, "%s: %s\n", body.name.c_str(), tree.error().message().c_str());
        return false;
      }
      row.seconds.push_back(std::chrono::duration<double>(end - begin).count());
      row.quality = assess(*tree);
    }
  }
  std::printf("\n%s, %zu triangles, medians of %zu\n", body.name.c_str(), body.mesh.size(), rounds);
  std::printf("%-38s %9s %9s %8s %6s %8s %9s %8s\n", "rule", "build ms", "ms/100k", "nodes",
              "depth", "tri/leaf", "surf.cost", "byte/tri");
  for (Row& row : table) {
    std::nth_element(row.seconds.begin(),
                     row.seconds.begin() + static_cast<std::ptrdiff_t>(rounds / 2),
                     row.seconds.end());
    const double median = row.seconds[rounds / 2];
    const auto triangles = static_cast<double>(body.mesh.size());
    std::printf("%-38s %9.2f %9.2f %8zu %6u %8.2f %9.1f %8.1f\n", row.name.c_str(), median * 1e3,
                median * 1e8 / triangles, row.quality.nodes, row.quality.depth,
                row.quality.triangles_per_leaf, row.quality.surface_cost,
                static_cast<double>(row.quality.bytes) / triangles);
  }
  return true;
}

int run(const std::vector<std::string>& arguments) {
  std::size_t rounds = 9;
  bool with_paper = false;
  std::vector<NamedMesh> meshes;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--paper") {
      with_paper = true;
    } else if (arguments[i] == "--rounds" && i + 1 < arguments.size()) {
      const long given = std::strtol(arguments[++i].c_str(), nullptr, 10);
      if (given < 1) {
        std::fprintf(stderr, "--rounds needs a number from 1\n");
        return 2;
      }
      rounds = static_cast<std::size_t>(given);
    } else {
      Result<ImportedMesh> imported = import_mesh(arguments[i]);
      if (!imported) {
        std::fprintf(stderr, "%s\n", imported.error().message().c_str());
        return 3;
      }
      meshes.push_back({arguments[i], std::move(imported->mesh)});
    }
  }
  if (meshes.empty()) {
    for (const std::size_t triangles : {std::size_t{10'000}, std::size_t{100'000}}) {
      meshes.push_back(car_like(triangles));
      meshes.push_back(soup(triangles));
    }
    meshes.push_back(car_like(500'000));
  }
  for (const NamedMesh& body : meshes) {
    if (!measure(body, rounds, with_paper)) return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run({argv + 1, argv + argc}); }
