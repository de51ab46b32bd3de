#pragma once

#include "bench/timing.hpp"
#include "bench/workload.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/build.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace bench {

using namespace crashrank;

struct Options {
  std::vector<std::size_t> triangles;
  std::vector<std::string> files;
  std::size_t poses = 20;
  std::size_t rounds = 5;
  std::uint64_t seed = 1;
  bool paper = false;
};

inline std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// One query at one pose: its least time and the work it did.
struct Sample {
  double seconds = 1e300;
  CollideWork work;
  std::size_t pairs = 0;
};

/// The two engines and the two questions.
enum class Ask { wide, scalar, wide_any };
inline constexpr std::size_t ask_count = 3;

struct Contestant {
  std::string name;
  Model model;
  std::vector<double> build_s;
  std::vector<double> two_threads_s;
  std::vector<Sample> samples[regime_count][ask_count];
  std::vector<double> cycled_s;  // a query, deep, all pairs

  CollideResult ask(Ask what, const Pose& pose) {
    if (what == Ask::scalar) {
      return collide(model.tree, model.tree, pose, pairs_, workspace_.scalar);
    }
    return collide(model, model, pose, pairs_, workspace_, {what == Ask::wide_any});
  }
  void measure(Regime regime, Ask what, const std::vector<Pose>& poses, std::size_t index) {
    std::vector<Sample>& all =
        samples[static_cast<std::size_t>(regime)][static_cast<std::size_t>(what)];
    all.resize(poses.size());
    Sample& sample = all[index];
    int repeats = 1;
    for (double took = 0.0; took < 20e-6; repeats *= 2) {
      CollideResult result;
      const double start = now_s();
      for (int k = 0; k < repeats; ++k) result = ask(what, poses[index]);
      took = now_s() - start;
      sample.work = result.work;
      sample.pairs = result.pairs;
      if (took >= 20e-6) sample.seconds = std::min(sample.seconds, took / repeats);
    }
  }
  void cycle(const std::vector<Pose>& poses) {
    const double start = now_s();
    for (const Pose& pose : poses) ask(Ask::wide, pose);
    cycled_s.push_back((now_s() - start) / static_cast<double>(poses.size()));
  }
  double seconds(Regime regime, Ask what) const {
    std::vector<double> values;
    for (const Sample& s :
         samples[static_cast<std::size_t>(regime)][static_cast<std::size_t>(what)]) {
      values.push_back(s.seconds);
    }
    return median(std::move(values));
  }
  const std::vector<Sample>& deep(Ask what) const {
    return samples[0][static_cast<std::size_t>(what)];
  }

private:
  std::vector<Pair> pairs_;
  ModelWorkspace workspace_;
};

inline Model built(const TriangleMesh& mesh, const BuildOptions& options, double& seconds) {
  const double start = wall_s();
  Result<Model> model = make_model(mesh, options);
  seconds = wall_s() - start;
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message().c_str());
    std::exit(1);
  }
  return std::move(*model);
}

/// Times one body at several sizes on the same poses and fits how a query grows. False where it
/// could not be run.
bool grow(const Options& options);

}  // namespace bench
