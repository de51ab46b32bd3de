#include "common.hpp"

#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/make_model.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace crashrank::bench {

void give_up(const std::string& why) {
  std::fprintf(stderr, "dispatch_bench: %s\n", why.c_str());
  std::exit(1);
}

Model load_model(const std::string& path) {
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) give_up(imported.error().message());
  Result<Model> model = make_model(std::move(imported->mesh));
  if (!model) give_up(model.error().message());
  return std::move(*model);
}

namespace {

template <class Source> PartIndex index_of(const Source& source) {
  Result<PartIndex> index = PartIndex::make(source);
  if (!index) give_up(index.error().message());
  return std::move(*index);
}

}  // namespace

void load(Scene& scene, const std::string& a, const std::string& b, const std::string& poses) {
  scene.a = load_model(a);
  scene.b = load_model(b);
  for (const Model* model : {&scene.a, &scene.b}) {
    scene.scalar.push_back(index_of(model->tree));
    scene.fast.push_back(index_of(*model));
  }
  std::ifstream in(poses);
  std::array<double, 16> numbers{};
  for (std::size_t i = 0; in >> numbers[i];) {
    if (++i < numbers.size()) continue;
    i = 0;
    const Result<Pose> pose = pose_from_matrix({numbers.data(), numbers.size()});
    if (!pose) give_up(poses + ": " + pose.error().message());
    scene.poses.push_back(*pose);
  }
  if (scene.poses.empty()) give_up(poses + ": no poses");
}

std::vector<DispatchQuery> Scene::queries(Kernel kernel) const {
  const std::vector<PartIndex>& indices = kernel == Kernel::fast ? fast : scalar;
  std::vector<DispatchQuery> queries;
  queries.reserve(poses.size());
  for (const Pose& pose : poses) queries.push_back({&indices[0], &indices[1], pose});
  return queries;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Dispatcher start(std::uint32_t workers, double spin_s) {
  PoolOptions pool;
  pool.workers = workers;
  if (spin_s > 0.0) pool.spin_us = static_cast<std::int32_t>(spin_s * 1e6);
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  if (!dispatcher) give_up(dispatcher.error().message());
  return std::move(*dispatcher);
}

DispatchReport run(Dispatcher& dispatcher, View<const DispatchQuery> queries, PairLists& pairs,
                   const DispatchOptions& options) {
  Result<DispatchReport> report = dispatcher.run(queries, pairs, options);
  if (!report) give_up(report.error().message());
  return *report;
}

DispatchRecording record(Dispatcher& one_worker, View<const DispatchQuery> queries,
                         DispatchOptions options, int times) {
  DispatchRecording best;
  DispatchRecording again;
  PairLists pairs;
  options.recording = &again;
  options.caller_works = false;
  for (int i = 0; i < times; ++i) {
    run(one_worker, queries, pairs, options);
    if (i == 0) {
      best = again;
    } else {
      keep_smaller(best, again);
    }
  }
  return best;
}

ReplayReport replayed(const DispatchRecording& recording, const ReplayOptions& options) {
  Result<ReplayReport> report = replay(recording, options);
  if (!report) give_up(report.error().message());
  return *report;
}

const char* store_name(StoreMode store) {
  return store == StoreMode::shared ? "shared" : "private";
}

const char* kernel_name(Kernel kernel) { return kernel == Kernel::fast ? "fast" : "scalar"; }

}  // namespace crashrank::bench
