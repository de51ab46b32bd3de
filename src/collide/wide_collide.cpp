// Four vector units span what matters: SSE2, SSE4, AVX2, AVX-512. Those between only cost build
// time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#include "crashrank/collide/wide_collide.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collide/wide_collide.cpp"
#include <hwy/foreach_target.h>
// The per-target code comes after foreach_target.
#include "collide/box_kernel-inl.hpp"
#include "collide/triangle_kernel-inl.hpp"

#if HWY_ONCE

#include "collide/wide_query.hpp"
#include "crashrank/internal/base/products.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/round_up.hpp"

#include <cmath>
#include <cstring>

namespace crashrank {
namespace detail {

HWY_EXPORT(wide_traverse);

/// Margins of the float box test. Let S = |t|₁ + 3·(largest coordinates of A's and B's root box).
/// With u = 2^-24, a transformed centre is a sum of four terms, none above S in magnitude, from
/// factors rounded once: off by at most 7·u·S. A transformed half extent: 5·u·S. Their difference
/// and sum with the other box's: 3·u·S. The double-precision margins of `box_transform` cover the
/// rest. 32·u·S = 2^-19·S is used.
WideQuery make_query(const Model& a, const Model& b, const BoxTransform& to, double size,
                     const Pose& pose, bool any) {
  WideQuery query{};
  const Eigen::Vector3d back = detail::rotate(to.rotation.transpose(), to.translation);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int k = 3 * i + j;
      query.rotation[k] = static_cast<float>(to.rotation(i, j));
      query.abs_rotation[k] = std::abs(query.rotation[k]);
      query.body_rotation[k] = static_cast<float>(pose.rotation(i, j));
    }
    query.a_from_b[i] = static_cast<float>(to.translation[i]);
    query.b_from_a[i] = static_cast<float>(-back[i]);
  }
  query.margin_a = round_up(0x1p-19 * size + to.margin_a);
  query.margin_b = round_up(0x1p-19 * size + to.margin_b);
  query.pose = &pose;
  // `carry` rounds four times in double; each sum stays below `size`.
  query.carry_error = round_up(0x1p-50 * size);
  // Three times 17.4·u and twice 4.6 times the skew: see `test_pairs`.
  const Eigen::Matrix3d skew =
      detail::multiply(pose.rotation.transpose(), pose.rotation) - Eigen::Matrix3d::Identity();
  query.per_reach = round_up(52.0 * 0x1p-24 + 10.0 * skew.cwiseAbs().rowwise().sum().maxCoeff());
  query.reach_per_error = round_up(2.2 / static_cast<double>(query.per_reach));
  query.body_boxes = a.tree.axes_are_world && b.tree.axes_are_world;
  query.a_nodes = a.wide.nodes.data();
  query.b_nodes = b.wide.nodes.data();
  query.a_clusters = a.wide.clusters.data();
  query.b_clusters = b.wide.clusters.data();
  query.any = any;
  return query;
}

/// One corner of a node's box. Read as four floats at once, which its node has, rather than as
/// three.
HWY_INLINE Lanes corner_lanes(const Eigen::Vector3f& corner) {
  static_assert(sizeof(Box) == 24 && sizeof(Node) == 32);
  Lanes read;
  std::memcpy(&read, reinterpret_cast<const char*>(&corner), sizeof read);
  return three(read);
}

/// Whether B certainly misses A's box wherever it is turned: whether the ball around B's origin
/// that encloses its box misses. The cheapest test there is. With u = 2^-24, A the largest and |b|
/// the farthest corner of a box from its origin: every coordinate of the gap is rounded by at most
/// 2·u·(|t| + A), so that the distance d of the two is off by less than 4·u·(|t| + A). The test
/// asks for d² > 1.01·|b|² and d > 2^-8·|t| and d > 2^-8·A: d is off by less than 2^-13 of itself
/// and above 1.004·|b|, while a pose stretches lengths by at most 2e-6 and `carry` rounds by 2^-50.
/// Squares that leave the range of floats, or come near, leave it undecided.
HWY_INLINE bool origin_ball_misses(const Node& a, const Node& b, const Pose& b_in_a) {
  const Lanes a_min = corner_lanes(a.box.min);
  const Lanes a_max = corner_lanes(a.box.max);
  const Lanes b_min = corner_lanes(b.box.min);
  const Lanes b_max = corner_lanes(b.box.max);
  const Eigen::Vector3d& at = b_in_a.translation;
  const Lanes t{static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                0.0F};
  const Lanes gap = greater(greater(a_min - t, t - a_max), all_lanes(0.0F));
  const Lanes b_far = greater(-b_min, b_max);
  const Lanes a_far = greater(-a_min, a_max);
  const Lanes difference = gap * gap - all_lanes(1.01F) * (b_far * b_far) -
                           all_lanes(0x1p-16F) * (t * t + a_far * a_far);
  const float certain = difference[0] + difference[1] + difference[2];
  return certain > 1e-30F && certain < 1e30F;
}

/// Whether a ball around B's box certainly misses A's box, in a third of the time that it takes to
/// set up a query. Let S bound every coordinate and the translation, summed as below. The ball's
/// centre is carried with an error below 2^-50·S; the pose stretches lengths by at most 2e-6
/// (`max_rigidity_error` on the entries of RᵀR), `carry` rounds by less than 2^-48·S and the
/// squares by 2^-50 of themselves. The slack kept is 2^-40 of S and 2^-16 of the squared radius.
/// NaN and infinity are not apart, nor are sizes whose squares overflow.
bool ball_misses(const Box& a, const Box& b, const Pose& b_in_a) {
  const Eigen::Vector3d a_min = a.min.cast<double>();
  const Eigen::Vector3d a_max = a.max.cast<double>();
  const Eigen::Vector3d b_min = b.min.cast<double>();
  const Eigen::Vector3d b_max = b.max.cast<double>();
  const Eigen::Vector3d b_center = 0.5 * (b_min + b_max);
  const Eigen::Vector3d& t = b_in_a.translation;
  const Eigen::Vector3d at = detail::rotate(b_in_a.rotation, b_center) + t;
  const Eigen::Vector3d gap = (a_min - at).cwiseMax(at - a_max);
  const double size = t.cwiseAbs().sum() + (a_max - a_min).sum() + 2.0 * b_center.cwiseAbs().sum() +
                      (a_min + a_max).cwiseAbs().sum();
  const double certain = gap.maxCoeff() - 0x1p-40 * size;
  return certain > 0.0 &&
         certain * certain > 0.25 * (1.0 + 0x1p-16) * (b_max - b_min).squaredNorm();
}

namespace {

/// A query that is not decided by the cheapest test. A function of its own, because what it keeps
/// on the stack would cost those that are.
HWY_NOINLINE void collide_near(const Model& a, std::uint32_t a_node, const Model& b,
                               std::uint32_t b_node, const Pose& b_in_a, std::vector<Pair>& pairs,
                               ModelWorkspace& workspace, const CollideOptions& options,
                               CollideResult& result) {
  const Box& a_box = a.tree.nodes[a_node].box;
  const Box& b_box = b.tree.nodes[b_node].box;
  if (a.tree.axes_are_world && b.tree.axes_are_world && ball_misses(a_box, b_box, b_in_a)) return;
  const BoxTransform to = box_transform(a.tree, b.tree, b_in_a);
  if (!boxes_may_touch(a_box, b_box, to)) return;
  workspace.prepare(a, b);
  const double size =
      to.translation.cwiseAbs().sum() +
      3.0 * (largest_coordinate(a.tree.nodes[0].box) + largest_coordinate(b.tree.nodes[0].box));
  const bool wide = !a.wide.empty() && !b.wide.empty() && size < max_wide_size &&
                    a.wide.lanes_of[a_node].lanes != 0 && b.wide.lanes_of[b_node].lanes != 0;
  if (wide) {
    const WideQuery query = make_query(a, b, to, size, b_in_a, options.any);
    const WideLanes& from_a = a.wide.lanes_of[a_node];
    const WideLanes& from_b = b.wide.lanes_of[b_node];
    WideSink sink{&pairs, workspace.wide.data(), workspace.wide.size(), result.work};
    HWY_DYNAMIC_DISPATCH(wide_traverse)
    (query, WideTask{from_a.node, from_b.node, from_a.lanes, from_b.lanes}, sink);
    result.work = sink.work;
  } else {
    collide_below(a.tree, a_node, b.tree, b_node, b_in_a, to, pairs, workspace.scalar, options,
                  result.work);
  }
  result.pairs = pairs.size();
  result.intersecting = !pairs.empty();
}

HWY_INLINE CollideResult collide_from(const Model& a, std::uint32_t a_node, const Model& b,
                                      std::uint32_t b_node, const Pose& b_in_a,
                                      std::vector<Pair>& pairs, ModelWorkspace& workspace,
                                      const CollideOptions& options) {
  pairs.clear();
  CollideResult result;
  result.work.bv_tests = 1;
  const bool world = a.tree.axes_are_world && b.tree.axes_are_world;
  if (world && origin_ball_misses(a.tree.nodes[a_node], b.tree.nodes[b_node], b_in_a)) {
    return result;
  }
  collide_near(a, a_node, b, b_node, b_in_a, pairs, workspace, options, result);
  return result;
}

}  // namespace
}  // namespace detail

CollideResult collide(const Model& a, std::uint32_t a_node, const Model& b, std::uint32_t b_node,
                      const Pose& b_in_a, std::vector<Pair>& pairs, ModelWorkspace& workspace,
                      const CollideOptions& options) {
  return detail::collide_from(a, a_node, b, b_node, b_in_a, pairs, workspace, options);
}

CollideResult collide(const Model& a, const Model& b, const Pose& b_in_a, std::vector<Pair>& pairs,
                      ModelWorkspace& workspace, const CollideOptions& options) {
  return detail::collide_from(a, 0, b, 0, b_in_a, pairs, workspace, options);
}

const char* vector_unit() noexcept {
  // The best of the targets that were compiled in and that this processor has: the lowest bit.
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & (~usable + 1));
}

}  // namespace crashrank
#endif
