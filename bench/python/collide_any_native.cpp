// Time of `collide` with `any` over poses in a file, for collide_any_speed.py, which holds the
// Python package against it. Usage: collide_any_native A.crm B.crm POSES ROUNDS, where POSES holds
// row-major 4x4 matrices in doubles. Prints for each round the seconds of reading and checking the
// matrices and of the queries, then how many poses touch.

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/model.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

using namespace crashrank;

namespace {

using Clock = std::chrono::steady_clock;

template <class T> T value_or_exit(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message().c_str());
    std::exit(3);
  }
  return std::move(result).value();
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<double> read_doubles(const char* file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<double> values(bytes.size() / sizeof(double));
  std::copy_n(bytes.data(), values.size() * sizeof(double), reinterpret_cast<char*>(values.data()));
  return values;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const Model a = value_or_exit(load_model(argv[1])).stored.model;
  const Model b = value_or_exit(load_model(argv[2])).stored.model;
  const std::vector<double> matrices = read_doubles(argv[3]);
  const std::size_t count = matrices.size() / 16;
  CollideOptions options;
  options.any = true;
  ModelWorkspace workspace;
  workspace.prepare(a, b);
  std::vector<Pair> pairs;
  std::vector<char> touch(count);
  for (int round = 0; round < std::atoi(argv[4]); ++round) {
    const auto start = Clock::now();
    std::vector<Pose> poses;
    poses.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      poses.push_back(value_or_exit(pose_from_matrix({matrices.data() + 16 * i, 16})));
    }
    const double reading = seconds_since(start);
    const auto queried = Clock::now();
    for (std::size_t i = 0; i < count; ++i) {
      touch[i] = collide(a, b, poses[i], pairs, workspace, options).intersecting ? 1 : 0;
    }
    std::printf("%.9f %.9f\n", reading, seconds_since(queried));
  }
  std::size_t touching = 0;
  for (const char each : touch) touching += each != 0 ? 1U : 0U;
  std::printf("%zu\n", touching);
}
