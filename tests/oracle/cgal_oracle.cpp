#include "oracle/triangle_oracle.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <type_traits>
#include <variant>

namespace oracle {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Shape = std::variant<Kernel::Point_3, Kernel::Segment_3, Kernel::Triangle_3>;

Shape shape(const Triangle& t) {
  std::array<Kernel::Point_3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = Kernel::Point_3(t[i][0], t[i][1], t[i][2]);
  if (!CGAL::collinear(p[0], p[1], p[2])) return Kernel::Triangle_3(p[0], p[1], p[2]);
  // Along a line the lexicographic order is the order of the points.
  const auto [low, high] = std::minmax_element(
      p.begin(), p.end(), [](const Kernel::Point_3& q, const Kernel::Point_3& r) {
        return CGAL::compare_xyz(q, r) == CGAL::SMALLER;
      });
  if (*low == *high) return *low;
  return Kernel::Segment_3(*low, *high);
}

}  // namespace

bool cgal_intersects(const Triangle& a, const Triangle& b) {
  return std::visit(
      [](const auto& s, const auto& t) {
        if constexpr (std::is_same_v<decltype(s), const Kernel::Point_3&> &&
                      std::is_same_v<decltype(t), const Kernel::Point_3&>) {
          return s == t;
        } else {
          return CGAL::do_intersect(s, t);
        }
      },
      shape(a), shape(b));
}

}  // namespace oracle
