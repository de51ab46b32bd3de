// What loading a model file takes, step by step, from the page cache.
//
//   load_bench [--triangles N] [--repeat N]
//
// Each step is timed by itself, the median of its repetitions; `load_model` is the whole.

#include "bench/timing.hpp"
#include "bench/workload.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/build.hpp"
#include "model/file_bytes.hpp"
#include "model/model_layout.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

using namespace crashrank;

namespace {

double median_s(int repeat, const std::function<bool()>& step) {
  std::vector<double> seconds;
  for (int i = 0; i < repeat; ++i) {
    const double start = bench::wall_s();
    if (!step()) std::exit(1);
    seconds.push_back(bench::wall_s() - start);
  }
  return bench::median(seconds);
}

void row(const char* what, double seconds, double whole) {
  std::printf("  %-44s %8.3f ms %6.1f %%\n", what, 1e3 * seconds, 100.0 * seconds / whole);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the loading of a model file");
  std::size_t triangles = 100'000;
  int repeat = 101;
  app.add_option("--triangles", triangles);
  app.add_option("--repeat", repeat);
  CLI11_PARSE(app, argc, argv);

  StoredModel stored;
  const double build = median_s(1, [&] {
    Result<Model> model = make_model(bench::shipped_model("hatch", triangles));
    if (model) stored.model = std::move(*model);
    return model.ok();
  });
  stored.mass = shell_properties(stored.model.mesh);
  const std::string path =
      (std::filesystem::temp_directory_path() / ("load_bench." + std::to_string(::getpid())))
          .string();
  const Status saved = save_model(stored, path, true);
  if (!saved) {
    std::fprintf(stderr, "%s\n", saved.error().message().c_str());
    return 3;
  }
  std::printf("%zu triangles, %zu nodes, %zu wide nodes, %zu clusters: %.2f MB\n",
              stored.model.mesh.size(), stored.model.tree.nodes.size(),
              stored.model.wide.nodes.size(), stored.model.wide.clusters.size(),
              1e-6 * static_cast<double>(std::filesystem::file_size(path)));
  std::printf("  %-44s %8.3f ms\n", "mesh made and tree built", 1e3 * build);

  for (const ModelStorage storage : {ModelStorage::mapped, ModelStorage::copied}) {
    LoadModelOptions options;
    options.storage = storage;
    std::vector<double> load_s;
    std::vector<double> release_s;
    for (int i = 0; i < repeat; ++i) {
      const double start = bench::wall_s();
      std::optional<Result<LoadedModel>> loaded(load_model(path, options));
      const double end = bench::wall_s();
      if (!*loaded) return 1;
      loaded.reset();
      load_s.push_back(end - start);
      release_s.push_back(bench::wall_s() - end);
    }
    const double whole = bench::median(load_s);
    std::printf("%s\n", storage == ModelStorage::mapped ? "mapped" : "copied");
    row("load_model", whole, whole);
    std::optional<Result<detail::FileBytes>> file;
    std::vector<double> bytes_s;
    for (int i = 0; i < repeat; ++i) {
      file.reset();
      const double start = bench::wall_s();
      file.emplace(detail::file_bytes(path, options));
      bytes_s.push_back(bench::wall_s() - start);
    }
    if (!*file) return 1;
    row(storage == ModelStorage::mapped ? "open and map" : "open and read", bench::median(bytes_s),
        whole);
    const View<const unsigned char> bytes = (*file)->bytes;
    // No check can be faster than this.
    volatile std::uint64_t seen = 0;
    row("least: each byte read once",
        median_s(repeat,
                 [&] {
                   std::uint64_t words[4] = {};
                   for (std::size_t at = 0; at + sizeof words <= bytes.size(); at += sizeof words) {
                     std::uint64_t next[4];
                     std::memcpy(next, bytes.data() + at, sizeof next);
                     for (std::size_t k = 0; k < 4; ++k) words[k] ^= next[k];
                   }
                   seen = words[0] ^ words[1] ^ words[2] ^ words[3];
                   return true;
                 }),
        whole);
    detail::ModelHeader header{};
    std::memcpy(&header, bytes.data(), sizeof header);
    const detail::ModelLayout layout = detail::layout_of(header);
    volatile std::uint32_t sum = 0;
    row("checksum",
        median_s(repeat,
                 [&] {
                   sum = detail::checksum_of(bytes, layout);
                   return true;
                 }),
        whole);
    const Result<LoadedModel> loaded = detail::decode_model(bytes, (*file)->keeper, false);
    if (!loaded) return 1;
    const Model& model = loaded->stored.model;
    row("vertices, parts, properties",
        median_s(repeat, [&] { return detail::check_stored(loaded->stored).ok(); }), whole);
    row("triangles and their corners by slot",
        median_s(repeat, [&] { return detail::validate_slots(model.tree, model.mesh).ok(); }),
        whole);
    row("binary tree, with the row above",
        median_s(repeat, [&] { return validate(model.tree, model.mesh).ok(); }), whole);
    row("wide tree, with both rows above", median_s(repeat, [&] { return validate(model).ok(); }),
        whole);
    row("release, not part of it", bench::median(release_s), whole);
  }
  std::filesystem::remove(path);
  return 0;
}
