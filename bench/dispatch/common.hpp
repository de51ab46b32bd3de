#pragma once

#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/model/model.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::bench {

/// Two bodies with their part indices for both kernels, and where the second one stands.
struct Scene {
  Model a;
  Model b;
  std::vector<PartIndex> scalar;  ///< of A and of B, made from the trees
  std::vector<PartIndex> fast;    ///< the same, made from the models
  std::vector<Pose> poses;

  std::vector<DispatchQuery> queries(Kernel kernel) const;
};

/// Reads two meshes and a file of poses; ends the program with a message where that fails.
/// The scene must not be moved afterwards.
void load(Scene& scene, const std::string& a, const std::string& b, const std::string& poses);

/// Reads a mesh and builds its trees; ends the program with a message where that fails.
Model load_model(const std::string& path);

/// Ends the program with a message.
[[noreturn]] void give_up(const std::string& why);

double median(std::vector<double> values);

/// Starts workers that spin so long before they sleep; 0: as the library has it.
Dispatcher start(std::uint32_t workers, double spin_s = 0.0);

/// Runs a dispatch that has to succeed.
DispatchReport run(Dispatcher& dispatcher, View<const DispatchQuery> queries, PairLists& pairs,
                   const DispatchOptions& options);

/// Records a dispatch on one worker, keeping the smallest of `times` times of every job.
DispatchRecording record(Dispatcher& one_worker, View<const DispatchQuery> queries,
                         DispatchOptions options, int times);

/// Replays a recording that has to be sound.
ReplayReport replayed(const DispatchRecording& recording, const ReplayOptions& options);

const char* store_name(StoreMode store);
const char* kernel_name(Kernel kernel);

// The commands.
void estimates(const Scene& scene);
void goals(const Scene& scene);
void overhead(const Scene& scene);
void plan(const Scene& scene);
void validate(const Scene& scene);
void print_poses(const Model& a, const Model& b, int count, std::uint64_t seed);

}  // namespace crashrank::bench
