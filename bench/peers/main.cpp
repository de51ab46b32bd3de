// The side-by-side run: crashrank and the colliders it is compared with, on the same meshes and
// poses, in one process, interleaved.

#include "bench/workload.hpp"
#include "measure.hpp"
#include "table.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace {

struct Options {
  std::vector<std::size_t> triangles{10'000, 100'000, 500'000};
  std::vector<std::string> only;
  std::size_t poses = 20;
  std::uint64_t seed = 1;
  std::string csv;
  std::string svg;
  peers::MeasureOptions measure;
};

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

bool write(const std::string& path, const std::string& text) {
  if (path.empty()) return true;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::fprintf(stderr, "%s: cannot be written\n", path.c_str());
  return static_cast<bool>(file);
}

std::vector<std::unique_ptr<peers::Peer>> chosen_peers(const Options& options) {
  std::vector<std::unique_ptr<peers::Peer>> chosen;
  for (auto& peer : peers::make_peers()) {
    bool wanted = options.only.empty() || chosen.empty();
    for (const std::string& name : options.only) {
      wanted = wanted || peer->name().find(name) != std::string::npos;
    }
    if (wanted) chosen.push_back(std::move(peer));
  }
  return chosen;
}

bool run(const Options& options, std::string name, crashrank::TriangleMesh mesh,
         std::vector<peers::Row>& rows) {
  auto workload =
      bench::make_workload(std::move(name), std::move(mesh), options.poses, options.seed);
  if (!workload) {
    std::fprintf(stderr, "%s\n", workload.error().message().c_str());
    return false;
  }
  auto peers = chosen_peers(options);
  const std::vector<peers::Row> more = measure(*workload, peers, options.measure);
  std::fputs(to_text(more).c_str(), stdout);
  std::fflush(stdout);
  rows.insert(rows.end(), more.begin(), more.end());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Measures crashrank and other colliders side by side, one thread each"};
  app.add_option("--triangles", options.triangles,
                 "sizes of the shipped cars to measure on, 0 for none")
      ->delimiter(',');
  app.add_option("--peers", options.only, "measure only peers whose name contains one of these")
      ->delimiter(',');
  app.add_option("--poses", options.poses, "poses a regime");
  app.add_option("--rounds", options.measure.rounds, "rounds over all poses and peers");
  app.add_option("--budget", options.measure.budget_s, "seconds to repeat one query for");
  app.add_option("--regimes", options.measure.regimes, "of deep, near, far")->delimiter(',');
  app.add_option("--modes", options.measure.modes, "of all, any and 'all, cycled'");
  app.add_option("--seed", options.seed, "seed of the poses");
  app.add_option("--csv", options.csv, "file to write all rows to");
  app.add_option("--svg", options.svg, "file to write the chart to");
  app.footer("CRASHRANK_BENCH_MESH names a mesh file to measure on as well.");
  CLI11_PARSE(app, argc, argv);
  options.measure.progress = isatty(STDERR_FILENO) != 0;

  std::printf("%s, seed %llu, %zu poses a regime, %d rounds; microseconds a query\n\n",
              processor().c_str(), static_cast<unsigned long long>(options.seed), options.poses,
              options.measure.rounds);
  std::vector<peers::Row> rows;
  bool good = true;
  for (const std::size_t triangles : options.triangles) {
    if (triangles == 0) continue;
    const std::string car = triangles <= 20'000 ? "hatch" : "sedan";
    good = run(options, car, bench::shipped_model(car, triangles), rows) && good;
  }
  if (const char* path = std::getenv("CRASHRANK_BENCH_MESH"); path != nullptr) {
    auto mesh = bench::imported_mesh(path);
    if (mesh) {
      const std::string name = std::string(path).substr(std::string(path).find_last_of('/') + 1);
      good = run(options, name, std::move(*mesh), rows) && good;
    } else {
      std::fprintf(stderr, "%s\n", mesh.error().message().c_str());
      good = false;
    }
  }
  good = write(options.csv, to_csv(rows)) && write(options.svg, to_svg(rows)) && good;
  return good ? 0 : 1;
}
