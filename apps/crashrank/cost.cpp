#include "cost.hpp"

#include "crashrank/collide/collide.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

namespace crashrank::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// B's middle in A's middle, then moved out along one axis until the boxes overlap by a share of
/// their extents.
std::vector<Pose> probes(const AabbTree& a, const AabbTree& b) {
  const Box& box_a = a.nodes[0].box;
  const Box& box_b = b.nodes[0].box;
  const Eigen::Vector3d middle_a = a.axes * box_a.center().cast<double>();
  const Eigen::Vector3d middle_b = b.axes * box_b.center().cast<double>();
  const Eigen::Vector3d reach = 0.5 * (box_a.extent() + box_b.extent()).cast<double>();
  std::vector<Pose> poses;
  for (const double overlap : {0.02, 0.1, 0.3}) {
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

}  // namespace

Cost measure_cost(const AabbTree& a, const AabbTree& b) {
  constexpr int rounds = 3;  // the first warms the caches and counts for nothing
  constexpr double enough_s = 0.3;
  CollideWorkspace workspace;
  workspace.prepare(a.depth, b.depth);
  std::vector<Pair> pairs;
  double box_s = 0.0;
  double full_s = 0.0;
  CollideWork work;
  const Clock::time_point start = Clock::now();
  for (const Pose& pose : probes(a, b)) {
    for (int round = 0; round < rounds; ++round) {
      CollideWork boxes;
      const Clock::time_point before = Clock::now();
      traverse(a, b, box_transform(a, b, pose), {0, 0}, workspace.stack, boxes,
               [](const Node&, const Node&) { return true; });
      const double traversed = seconds_since(before);
      const Clock::time_point between = Clock::now();
      const CollideResult result = collide(a, b, pose, pairs, workspace);
      const double collided = seconds_since(between);
      if (round == 0) continue;
      box_s += traversed;
      full_s += collided;
      work += result.work;
    }
    if (seconds_since(start) > enough_s) break;
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Cost cost;
  cost.cb_s = work.bv_tests > 0 ? box_s / static_cast<double>(work.bv_tests) : none;
  cost.cp_s = work.primitive_tests > 0
                  ? std::fmax(0.0, full_s - box_s) / static_cast<double>(work.primitive_tests)
                  : none;
  return cost;
}

}  // namespace crashrank::cli
