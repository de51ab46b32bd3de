#include "crashrank/collide/collide.hpp"

#include "collide/box_gap.hpp"
#include "collide/triangle_distance.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace crashrank {
namespace {

class Search {
public:
  Search(const AabbTree& a, const AabbTree& b, const Pose& b_in_a, DistanceWorkspace& workspace,
         double cutoff)
      : a_(a),
        b_(b),
        b_in_a_(b_in_a),
        to_(box_transform(a, b, b_in_a)),
        shrink_b_(detail::shrink_along_b(to_)),
        stack_(workspace.stack),
        limit_(cutoff) {
    const std::size_t needed = traversal_stack_size(a.depth, b.depth);
    if (stack_.size() < needed) stack_.resize(needed);
  }

  DistanceResult run() {
    std::size_t waiting = 0;
    Entry entry = pair(0, 0);
    bool more = keep(entry);
    while (more && result_.upper_m > 0.0) {
      const Node& na = a_.nodes[entry.a];
      const Node& nb = b_.nodes[entry.b];
      if (na.is_leaf() && nb.is_leaf()) {
        leaves(na, nb);
      } else {
        const bool split_a =
            nb.is_leaf() || (!na.is_leaf() && half_area(na.box) >= half_area(nb.box));
        Entry near = split_a ? pair(na.first, entry.b) : pair(entry.a, nb.first);
        Entry far = split_a ? pair(na.first + 1, entry.b) : pair(entry.a, nb.first + 1);
        if (far.lower_m < near.lower_m) std::swap(near, far);
        if (keep(far)) stack_[waiting++] = far;
        if (keep(near)) {
          entry = near;
          continue;
        }
      }
      more = false;
      while (!more && waiting > 0) {
        entry = stack_[--waiting];
        more = keep(entry);
      }
    }
    if (result_.triangle_a < 0) {
      result_.beyond_cutoff = true;
      result_.distance_m = left_out_;
    }
    return result_;
  }

private:
  using Entry = DistanceWorkspace::Entry;

  Entry pair(std::uint32_t a, std::uint32_t b) {
    ++result_.work.bv_tests;
    const detail::BoxGap gap = detail::box_gap(a_.nodes[a].box, b_.nodes[b].box, to_);
    return {a, b, std::max(gap.along_a.norm() * (1.0 - 0x1p-48), gap.along_b.norm() * shrink_b_)};
  }

  /// Boxes as far apart as the best points known hold nothing nearer.
  bool keep(const Entry& entry) {
    if (entry.lower_m < limit_ || (entry.lower_m == limit_ && result_.triangle_a < 0)) return true;
    left_out_ = std::min(left_out_, entry.lower_m);
    return false;
  }

  void leaves(const Node& na, const Node& nb) {
    for (std::uint32_t j = nb.first; j < nb.first + nb.count; ++j) {
      const TriangleD tb = carry(b_in_a_, b_.triangles[j]);
      for (std::uint32_t i = na.first; i < na.first + na.count; ++i) {
        ++result_.work.primitive_tests;
        const TriangleGap gap =
            triangle_distance(to_double(a_.triangles[i]), tb, result_.work.exact_tests);
        if (gap.lower > limit_) {
          left_out_ = std::min(left_out_, gap.lower);
          continue;
        }
        const bool first = result_.triangle_a < 0;
        if (first || gap.upper < result_.upper_m) {
          result_.upper_m = gap.upper;
          result_.triangle_a = static_cast<std::int32_t>(a_.order[i]);
          result_.triangle_b = static_cast<std::int32_t>(b_.order[j]);
          result_.point_a_m = gap.point_a;
          result_.point_b_m = gap.point_b;
        }
        result_.distance_m = first ? gap.lower : std::min(result_.distance_m, gap.lower);
        limit_ = std::min(limit_, result_.upper_m);
        if (result_.upper_m == 0.0) return;
      }
    }
  }

  const AabbTree& a_;
  const AabbTree& b_;
  const Pose& b_in_a_;
  BoxTransform to_;
  double shrink_b_;
  std::vector<Entry>& stack_;
  double limit_;  ///< the cutoff, or what the best points known are apart
  double left_out_ = std::numeric_limits<double>::infinity();  ///< smallest bound left out
  DistanceResult result_ = nothing_yet();

  static DistanceResult nothing_yet() {
    DistanceResult result;
    result.upper_m = std::numeric_limits<double>::infinity();
    return result;
  }
};

}  // namespace

DistanceResult distance(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                        DistanceWorkspace& workspace, const DistanceOptions& options) {
  return Search(a, b, b_in_a, workspace, options.cutoff_m).run();
}

}  // namespace crashrank
