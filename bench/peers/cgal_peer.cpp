#include "peer.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <iterator>

namespace peers {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

/// A's triangles in an AABB_tree; every triangle of B is carried and asked by itself, which is what
/// the package offers for all pairs. Exact predicates.
class Cgal final : public Peer {
public:
  std::string name() const override { return "CGAL AABB_tree"; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    mesh_b_ = &b;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const crashrank::Triangle t = a.triangle(i);
      triangles_.emplace_back(point(t.corner[0].cast<double>()), point(t.corner[1].cast<double>()),
                              point(t.corner[2].cast<double>()));
    }
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
  }
  std::size_t all(const Pose& b_in_a) override {
    pairs_.clear();
    std::vector<Triangles::const_iterator> hits;
    for (std::size_t j = 0; j < mesh_b_->size(); ++j) {
      const Kernel::Triangle_3 t = placed(b_in_a, j);
      if (!CGAL::do_overlap(t.bbox(), tree_.bbox())) continue;
      hits.clear();
      tree_.all_intersected_primitives(t, std::back_inserter(hits));
      for (const auto& hit : hits) {
        pairs_.push_back({static_cast<std::int32_t>(std::distance(triangles_.cbegin(), hit)),
                          static_cast<std::int32_t>(j)});
      }
    }
    return pairs_.size();
  }
  bool any(const Pose& b_in_a) override {
    for (std::size_t j = 0; j < mesh_b_->size(); ++j) {
      const Kernel::Triangle_3 t = placed(b_in_a, j);
      if (CGAL::do_overlap(t.bbox(), tree_.bbox()) && tree_.do_intersect(t)) return true;
    }
    return false;
  }
  void pairs(std::vector<Pair>& out) const override { out = pairs_; }

private:
  static Kernel::Point_3 point(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
  Kernel::Triangle_3 placed(const Pose& b_in_a, std::size_t j) const {
    const crashrank::Triangle t = mesh_b_->triangle(j);
    return {point(carry(b_in_a, t.corner[0])), point(carry(b_in_a, t.corner[1])),
            point(carry(b_in_a, t.corner[2]))};
  }

  const TriangleMesh* mesh_b_ = nullptr;
  Triangles triangles_;
  Tree tree_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<Peer> make_cgal() { return std::make_unique<Cgal>(); }

}  // namespace peers
