#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bench {

/// How far the bodies are from each other.
enum class Regime {
  deep,  ///< B's front 5 to 30 cm into A's side
  near,  ///< 1 to 10 cm short of touching
  far,   ///< boxes apart by 0.2 to 20 m
};
inline constexpr std::size_t regime_count = 3;
inline constexpr std::array<const char*, regime_count> regime_names{"deep", "near", "far"};

/// A body against a copy of itself, with the poses of the copy in its frame.
struct Workload {
  std::string name;
  crashrank::TriangleMesh mesh;
  std::array<std::vector<crashrank::Pose>, regime_count> poses;
};

/// One of the shipped models at another resolution, as data/ makes it.
crashrank::TriangleMesh shipped_model(const std::string& name, std::size_t triangles);

/// A mesh from a file, through the product's importer.
crashrank::Result<crashrank::TriangleMesh> imported_mesh(const std::string& path);

/// Looks for the poses with the exact collider: B drives at A's side along its own nose, the place
/// where the two touch first is found, and each regime starts from there.
crashrank::Result<Workload> make_workload(std::string name, crashrank::TriangleMesh mesh,
                                          std::size_t poses, std::uint64_t seed);

}  // namespace bench
