// Compiled once with the library's headers and once with those of every planted fault, each time
// under a function name, and for a fault a namespace, of its own.

#include "crashrank/internal/collide/triangle_test.hpp"
#include "oracle/triangle_oracle.hpp"

namespace oracle {

bool CRASHRANK_UNDER_TEST(const Triangle& a, const Triangle& b);

bool CRASHRANK_UNDER_TEST(const Triangle& a, const Triangle& b) {
  crashrank::TriangleD ta;
  crashrank::TriangleD tb;
  for (std::size_t i = 0; i < 3; ++i) {
    ta.corner[i] = {a[i][0], a[i][1], a[i][2]};
    tb.corner[i] = {b[i][0], b[i][1], b[i][2]};
  }
  return crashrank::triangles_intersect(ta, tb);
}

}  // namespace oracle
