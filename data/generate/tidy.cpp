#include "tidy.hpp"

#include <algorithm>
#include <set>

namespace generate {
namespace {

constexpr double needle = 0.12;
constexpr double flat_cap = 0.05;

class Tidier {
public:
  Tidier(Mesh* mesh, std::vector<int>* label) : mesh_(*mesh), label_(*label) {
    around_.resize(mesh_.vertices.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const int v : mesh_.triangles[t]) around(v).push_back(static_cast<int>(t));
    }
    alive_.assign(mesh_.triangles.size(), true);
  }

  // One pass over all edges; false when nothing was left to do.
  bool collapse(double shortest) {
    bool changed = false;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3 && alive_[t]; ++k) {
        const int a = mesh_.triangles[t][k];
        const int b = mesh_.triangles[t][(k + 1) % 3];
        const double length = (place(a) - place(b)).norm();
        if (length >= shortest) continue;
        const bool hair = length < 0.1 * shortest;
        changed = (merge(a, b, hair) || merge(b, a, hair)) || changed;
      }
    }
    return changed;
  }

  bool turn_edges() {
    bool changed = false;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!alive_[t] || fatness_of(static_cast<int>(t)) >= needle) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (turn(static_cast<int>(t), k)) {
          changed = true;
          break;
        }
      }
    }
    return changed;
  }

  void drop_dead() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!alive_[t]) continue;
      mesh_.triangles[kept] = mesh_.triangles[t];
      label_[kept++] = label_[t];
    }
    mesh_.triangles.resize(kept);
    label_.resize(kept);
  }

private:
  using Corners = std::array<int, 3>;

  std::vector<int>& around(int v) { return around_[static_cast<std::size_t>(v)]; }
  const Vec3& place(int v) const { return mesh_.vertices[static_cast<std::size_t>(v)]; }
  Corners& corners(int t) { return mesh_.triangles[static_cast<std::size_t>(t)]; }
  int label(int t) const { return label_[static_cast<std::size_t>(t)]; }
  double fatness_of(int t) {
    return fatness(place(corners(t)[0]), place(corners(t)[1]), place(corners(t)[2]));
  }
  Vec3 normal(const Corners& c) const {
    return (place(c[1]) - place(c[0])).cross(place(c[2]) - place(c[0]));
  }
  static bool has(const Corners& c, int v) { return c[0] == v || c[1] == v || c[2] == v; }

  std::vector<int> sharing(int a, int b) {
    std::vector<int> result;
    for (const int t : around(a)) {
      if (has(corners(t), b)) result.push_back(t);
    }
    return result;
  }

  std::set<int> neighbours(int v) {
    std::set<int> result;
    for (const int t : around(v)) {
      for (const int w : corners(t)) {
        if (w != v) result.insert(w);
      }
    }
    return result;
  }

  bool on_border(int v) {
    for (const int w : neighbours(v)) {
      if (sharing(v, w).size() == 1) return true;
    }
    return false;
  }

  // Moves b into a where surface, border and seams allow it.
  bool merge(int a, int b, bool hair) {
    const std::vector<int> shared = sharing(a, b);
    if (shared.empty() || shared.size() > 2) return false;
    std::set<int> labels;
    for (const int t : around(b)) labels.insert(label(t));
    const bool border = on_border(b);
    if (border && (shared.size() != 1 || labels.size() > 1)) return false;
    // A seam may move by a hair's breadth.
    if (!hair && labels.size() > 2) return false;
    if (!hair && labels.size() == 2 && label(shared[0]) == label(shared[1])) return false;
    const std::set<int> of_a = neighbours(a);
    const std::set<int> of_b = neighbours(b);
    std::vector<int> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                          std::back_inserter(common));
    if (common.size() != shared.size()) return false;
    for (const int t : around(b)) {
      if (has(corners(t), a)) continue;
      Corners moved = corners(t);
      std::replace(moved.begin(), moved.end(), b, a);
      const Vec3 before = normal(corners(t));
      const Vec3 after = normal(moved);
      const double was = fatness_of(t);
      const double is = fatness(place(moved[0]), place(moved[1]), place(moved[2]));
      if (is < (hair ? 0.02 : std::min(needle, was))) return false;
      if (!hair && was > 0.02 && before.dot(after) < 0.5 * before.norm() * after.norm())
        return false;
    }
    for (const int t : shared) {
      alive_[static_cast<std::size_t>(t)] = false;
      for (const int v : corners(t)) std::erase(around(v), t);
    }
    for (const int t : around(b)) {
      Corners& c = corners(t);
      std::replace(c.begin(), c.end(), b, a);
      around(a).push_back(t);
    }
    around(b).clear();
    return true;
  }

  // Gives the square of two triangles its other diagonal where that makes the thinner one fatter.
  bool turn(int t, std::size_t k) {
    const int a = corners(t)[k];
    const int b = corners(t)[(k + 1) % 3];
    const int c = corners(t)[(k + 2) % 3];
    const std::vector<int> shared = sharing(a, b);
    if (shared.size() != 2) return false;
    const int other = shared[0] == t ? shared[1] : shared[0];
    if (label(t) != label(other)) {
      // A flat cap whose three corners lie on the seam may as well belong to the other side.
      const double height = fatness_of(t);
      const double side = (place(a) - place(b)).squaredNorm();
      const double rest =
          std::max((place(b) - place(c)).squaredNorm(), (place(c) - place(a)).squaredNorm());
      if (height > flat_cap || side < rest) return false;
      label_[static_cast<std::size_t>(t)] = label(other);
    }
    int d = -1;
    for (const int v : corners(other)) {
      if (v != a && v != b) d = v;
    }
    if (d < 0 || d == c || !sharing(c, d).empty()) return false;
    const Corners first = {a, d, c};
    const Corners second = {d, b, c};
    const double was = std::min(fatness_of(t), fatness_of(other));
    const double is =
        std::min(fatness(place(a), place(d), place(c)), fatness(place(d), place(b), place(c)));
    const Vec3 n1 = normal(first);
    const Vec3 n2 = normal(second);
    if (is <= 1.2 * was || n1.dot(n2) < 0.7 * n1.norm() * n2.norm()) return false;
    if (normal(corners(other)).dot(n1) <= 0.0) return false;
    std::erase(around(b), t);
    std::erase(around(a), other);
    corners(t) = first;
    corners(other) = second;
    around(d).push_back(t);
    around(c).push_back(other);
    return true;
  }

  Mesh& mesh_;
  std::vector<int>& label_;
  std::vector<std::vector<int>> around_;
  std::vector<bool> alive_;
};

}  // namespace

double fatness(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest =
      std::max({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()});
  return longest > 0.0 ? (b - a).cross(c - a).norm() / longest : 0.0;
}

void tidy(Mesh* mesh, std::vector<int>* label, double shortest) {
  Tidier tidier(mesh, label);
  for (int round = 0; round < 4; ++round) {
    const bool merged = tidier.collapse(shortest);
    const bool turned = tidier.turn_edges();
    if (!merged && !turned) break;
  }
  tidier.drop_dead();
}

}  // namespace generate
