#include "cost.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <vector>

namespace crashrank::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// B's middle in A's middle, then moved out along one axis until the boxes overlap by a share of
/// their extents.
std::vector<Pose> probes(const AabbTree& a, const AabbTree& b) {
  const Box& box_a = a.nodes[0].box;
  const Box& box_b = b.nodes[0].box;
  const Eigen::Vector3d middle_a = a.axes * box_a.center().cast<double>();
  const Eigen::Vector3d middle_b = b.axes * box_b.center().cast<double>();
  const Eigen::Vector3d reach = 0.5 * (box_a.extent() + box_b.extent()).cast<double>();
  std::vector<Pose> poses;
  for (const double overlap : {0.1, 0.01, 0.3}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Pose pose;
        pose.translation = middle_a - middle_b;
        pose.translation += side * (1.0 - overlap) * reach[axis] * a.axes.col(axis);
        poses.push_back(pose);
      }
    }
  }
  return poses;
}

struct Sample {
  double boxes = 0.0;
  double triangles = 0.0;
  double seconds = 0.0;
};

/// Minimises the sum of ((boxes·cb + triangles·cp) / seconds − 1)², both costs at least zero.
Cost fit(const std::vector<Sample>& samples) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double bb = 0.0;
  double bt = 0.0;
  double tt = 0.0;
  double b1 = 0.0;
  double t1 = 0.0;
  for (const Sample& sample : samples) {
    const double b = sample.boxes / sample.seconds;
    const double t = sample.triangles / sample.seconds;
    bb += b * b;
    bt += b * t;
    tt += t * t;
    b1 += b;
    t1 += t;
  }
  if (!(bb > 0.0)) return {none, none};
  if (!(tt > 0.0)) return {b1 / bb, none};
  const double determinant = bb * tt - bt * bt;
  if (!(determinant > 1e-9 * bb * tt)) return {none, none};
  const Cost cost{(b1 * tt - t1 * bt) / determinant, (t1 * bb - b1 * bt) / determinant};
  if (cost.cb_s < 0.0) return {0.0, t1 / tt};
  if (cost.cp_s < 0.0) return {b1 / bb, 0.0};
  return cost;
}

}  // namespace

Cost measure_cost(const Engine& engine, const Model& a, const Model& b) {
  constexpr std::size_t rounds = 5;  // the first warms the caches and counts for nothing
  constexpr double enough_s = 0.3;
  std::vector<Pair> pairs;
  std::vector<Sample> samples;
  const Clock::time_point start = Clock::now();
  for (const Pose& pose : probes(a.tree, b.tree)) {
    std::array<double, rounds> seconds{};
    Result<Answer> answer = Answer{};
    for (double& taken : seconds) {
      answer = engine(pose, false, pairs);
      if (!answer) return fit({});
      taken = answer->seconds;
    }
    std::sort(seconds.begin() + 1, seconds.end());
    if (!(seconds[rounds / 2] > 0.0)) continue;  // shorter than the clock's step
    const CollideWork& work = answer->result.work;
    samples.push_back({static_cast<double>(work.bv_tests),
                       static_cast<double>(work.primitive_tests), seconds[rounds / 2]});
    if (std::chrono::duration<double>(Clock::now() - start).count() > enough_s) break;
  }
  return fit(samples);
}

}  // namespace crashrank::cli
