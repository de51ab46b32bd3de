#include "mesh/importer/polygon.hpp"

#include "crashrank/internal/base/predicates.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace crashrank::importer {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Searches of all corners anew: few polygons need any, and one that crosses itself could need one
// for each of its corners.
constexpr int max_searches = 64;

}  // namespace

/// +1 if a, b, c turn as the polygon does, seen along the axis of projection; exact.
int PolygonTriangulator::turn(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c) const {
  std::uint64_t exact_calls = 0;
  return orientation_ * orient2d(a, b, c, axis_, exact_calls);
}

int PolygonTriangulator::turn_at(std::uint32_t corner) const {
  return turn(at(previous_[corner]), at(corner), at(next_[corner]));
}

/// Newell's normal, relative to the first corner: its components are twice the projected areas.
/// Where they cancel, as in a symmetric figure of eight, that of the widest triangle at the first
/// corner and the one farthest from it.
void PolygonTriangulator::choose_projection() {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d before = at(size() - 1) - at(0);
  Eigen::Vector3d farthest = before;
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Eigen::Vector3d here = at(i) - at(0);
    normal += before.cross(here);
    before = here;
    if (here.squaredNorm() > farthest.squaredNorm()) farthest = here;
  }
  constexpr double rounding = 1e-9;
  if (normal.cwiseAbs().maxCoeff() <= rounding * farthest.squaredNorm()) {
    Eigen::Vector3d widest = Eigen::Vector3d::Zero();
    for (std::uint32_t i = 0; i < size(); ++i) {
      const Eigen::Vector3d wide = farthest.cross(at(i) - at(0));
      if (wide.squaredNorm() > widest.squaredNorm()) widest = wide;
    }
    if (widest.norm() > rounding * farthest.squaredNorm()) normal = widest;
  }
  normal.cwiseAbs().maxCoeff(&axis_);
  orientation_ = normal[axis_] < 0.0 ? -1 : 1;
}

bool PolygonTriangulator::triangulate(const std::vector<Eigen::Vector3d>& corners) {
  corners_ = &corners;
  triangles_.clear();
  if (size() == 3) {
    triangles_.push_back({0, 1, 2});
    return true;
  }
  choose_projection();
  if (size() == 4 && triangulate_quadrilateral()) return true;
  previous_.resize(size());
  next_.resize(size());
  turns_.resize(size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    previous_[i] = i == 0 ? size() - 1 : i - 1;
    next_[i] = i + 1 == size() ? 0 : i + 1;
  }
  for (std::uint32_t i = 0; i < size(); ++i) turns_[i] = turn_at(i);
  const bool simple = is_convex() || !crosses_itself();
  return clip_ears() && simple;
}

/// Returns false where the general case decides: several corners are not convex.
bool PolygonTriangulator::triangulate_quadrilateral() {
  std::uint32_t start = 0;
  int not_convex = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (turn(at((i + 3) % 4), at(i), at((i + 1) % 4)) > 0) continue;
    start = i;
    ++not_convex;
  }
  if (not_convex > 1) return false;
  triangles_.push_back({start, (start + 1) % 4, (start + 2) % 4});
  triangles_.push_back({start, (start + 2) % 4, (start + 3) % 4});
  return true;
}

/// Whether all turns are to the left and the outline goes round once: its edges then change
/// between ascending and descending twice.
bool PolygonTriangulator::is_convex() const {
  const auto ascends = [&](std::uint32_t corner) {
    return is_before(at(corner), at(next_[corner]));
  };
  int changes = 0;
  for (std::uint32_t corner = 0; corner < size(); ++corner) {
    if (turns_[corner] <= 0) return false;
    if (ascends(corner) != ascends(previous_[corner])) ++changes;
  }
  return changes == 2;
}

/// Tests the pairs of edges whose boxes overlap, in the order of the boxes' lower ends.
bool PolygonTriangulator::crosses_itself() {
  const int i = (axis_ + 1) % 3;
  const int j = (axis_ + 2) % 3;
  const auto low = [&](std::uint32_t edge, int axis) {
    return std::min(at(edge)[axis], at(next_[edge])[axis]);
  };
  const auto high = [&](std::uint32_t edge, int axis) {
    return std::max(at(edge)[axis], at(next_[edge])[axis]);
  };
  by_position_.resize(size());
  std::iota(by_position_.begin(), by_position_.end(), 0U);
  std::sort(by_position_.begin(), by_position_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return low(a, i) < low(b, i); });
  for (std::size_t first = 0; first < by_position_.size(); ++first) {
    const std::uint32_t a = by_position_[first];
    const double end = high(a, i);
    const double a_low = low(a, j);
    const double a_high = high(a, j);
    for (std::size_t second = first + 1; second < by_position_.size(); ++second) {
      const std::uint32_t b = by_position_[second];
      if (low(b, i) > end) break;
      if (low(b, j) > a_high || high(b, j) < a_low) continue;
      if (edges_cross(a, b)) return true;
    }
  }
  return false;
}

/// Edges are named by their first corner. Edges that touch or overlap do not cross unless the
/// outline passes from one side to the other there.
bool PolygonTriangulator::edges_cross(std::uint32_t first, std::uint32_t second) const {
  if (next_[first] == second || next_[second] == first) return false;
  const Eigen::Vector3d& a = at(first);
  const Eigen::Vector3d& b = at(next_[first]);
  const Eigen::Vector3d& c = at(second);
  const Eigen::Vector3d& d = at(next_[second]);
  const int c_side = turn(a, b, c);
  const int d_side = turn(a, b, d);
  const int a_side = turn(c, d, a);
  const int b_side = turn(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  // Every corner is the first of one edge, so testing the first corners is enough.
  if (c_side == 0 && is_between(a, c, b) && passes_through(second, a, b)) return true;
  if (a_side == 0 && is_between(c, a, d) && passes_through(first, c, d)) return true;
  return !is_before(a, c) && !is_before(c, a) && corners_cross(first, second);
}

/// Order of projected points by their first coordinate, then the second.
bool PolygonTriangulator::is_before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const int i = (axis_ + 1) % 3;
  const int j = (axis_ + 2) % 3;
  return a[i] < b[i] || (a[i] == b[i] && a[j] < b[j]);
}

/// Whether b lies strictly between a and c, all three on one line.
bool PolygonTriangulator::is_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c) const {
  return is_before(a, c) ? is_before(a, b) && is_before(b, c) : is_before(c, b) && is_before(b, a);
}

bool PolygonTriangulator::passes_through(std::uint32_t corner, const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b) const {
  return turn(a, b, at(previous_[corner])) * turn(a, b, at(next_[corner])) < 0;
}

/// Whether the outline at `second` passes through the angle at `first`, which has its position.
bool PolygonTriangulator::corners_cross(std::uint32_t first, std::uint32_t second) const {
  const Eigen::Vector3d& before = at(previous_[first]);
  const Eigen::Vector3d& here = at(first);
  const Eigen::Vector3d& after = at(next_[first]);
  // +1 inside the angle from `after` counter-clockwise to `before`, −1 outside, 0 on its sides.
  const auto side = [&](const Eigen::Vector3d& point) {
    const int left_of_after = turn(here, after, point);
    const int left_of_before = turn(before, here, point);
    return turns_[first] > 0 ? std::min(left_of_after, left_of_before)
                             : std::max(left_of_after, left_of_before);
  };
  return side(at(previous_[second])) * side(at(next_[second])) < 0;
}

/// Whether `corner` keeps the triangle at `ear` from being cut off: it lies inside, or on the
/// boundary with an edge of the outline running into the triangle. On the edge that the cut would
/// make it always counts unless touching is allowed.
bool PolygonTriangulator::blocks(std::uint32_t corner, std::uint32_t ear,
                                 Strictness strictness) const {
  const std::array<const Eigen::Vector3d*, 3> triangle{&at(previous_[ear]), &at(ear),
                                                       &at(next_[ear])};
  const auto side_of = [&](std::size_t side, const Eigen::Vector3d& point) {
    return turn(*triangle[side], *triangle[(side + 1) % 3], point);
  };
  std::array<int, 3> sides{};
  for (std::size_t side = 0; side < 3; ++side) {
    sides[side] = side_of(side, at(corner));
    if (sides[side] < 0) return false;
  }
  if (sides[0] > 0 && sides[1] > 0 && (sides[2] > 0 || strictness == Strictness::no_touch)) {
    return true;
  }
  const auto enters = [&](const Eigen::Vector3d& towards) {
    for (std::size_t side = 0; side < 3; ++side) {
      if (sides[side] == 0 && side_of(side, towards) <= 0) return false;
    }
    return true;
  };
  return enters(at(previous_[corner])) || enters(at(next_[corner]));
}

bool PolygonTriangulator::is_ear(std::uint32_t corner, Strictness strictness) const {
  if (turns_[corner] <= 0) return false;
  const std::uint32_t before = previous_[corner];
  const std::uint32_t after = next_[corner];
  const int i = (axis_ + 1) % 3;
  const double low = std::min({at(before)[i], at(corner)[i], at(after)[i]});
  const double high = std::max({at(before)[i], at(corner)[i], at(after)[i]});
  auto candidate =
      std::lower_bound(by_position_.begin(), by_position_.end(), low,
                       [&](std::uint32_t a, double position) { return at(a)[i] < position; });
  for (; candidate != by_position_.end() && at(*candidate)[i] <= high; ++candidate) {
    const std::uint32_t other = *candidate;
    if (turns_[other] > 0 || other == before || other == after || other == corner) continue;
    if (blocks(other, corner, strictness)) return false;
  }
  return true;
}

/// The first ear from `from` on, round the corners that are left; `none` if there is none.
std::uint32_t PolygonTriangulator::find_ear(std::uint32_t from, Strictness strictness) {
  std::uint32_t corner = from;
  do {
    if (ears_[corner] == Ear::unknown) {
      ears_[corner] = is_ear(corner, strictness) ? Ear::yes : Ear::no;
    }
    if (ears_[corner] == Ear::yes) return corner;
    corner = next_[corner];
  } while (corner != from);
  return none;
}

/// The first corner from `from` on at which the outline is straight or turns back; else `none`.
std::uint32_t PolygonTriangulator::find_flat(std::uint32_t from) const {
  std::uint32_t corner = from;
  do {
    if (turns_[corner] == 0) return corner;
    corner = next_[corner];
  } while (corner != from);
  return none;
}

/// The next ear from `from` on. Where none is found, all are tested again, as degenerate polygons
/// change more than the neighbours of an ear, then with touching allowed.
std::uint32_t PolygonTriangulator::next_ear(std::uint32_t from) {
  std::uint32_t ear = find_ear(from, Strictness::no_touch);
  for (const Strictness strictness : {Strictness::no_touch, Strictness::touch}) {
    if (ear != none || searches_left_ == 0) return ear;
    std::fill(ears_.begin(), ears_.end(), Ear::unknown);
    ear = find_ear(from, strictness);
    std::fill(ears_.begin(), ears_.end(), Ear::unknown);
    --searches_left_;
  }
  return ear;
}

/// Whether the outline turns straight back at a corner, or stands still there. Cutting it off loses
/// nothing, and what is left on it looks like an ear.
bool PolygonTriangulator::is_spike(std::uint32_t corner) const {
  return turns_[corner] == 0 && !is_between(at(previous_[corner]), at(corner), at(next_[corner]));
}

/// A spike that is still there; `none` if there is none.
std::uint32_t PolygonTriangulator::next_spike() {
  while (!spikes_.empty()) {
    const std::uint32_t corner = spikes_.back();
    spikes_.pop_back();
    if (next_[previous_[corner]] == corner && is_spike(corner)) return corner;
  }
  return none;
}

/// False if corners are left of which none is an ear.
bool PolygonTriangulator::clip_ears() {
  const int i = (axis_ + 1) % 3;
  by_position_.clear();
  for (std::uint32_t corner = 0; corner < size(); ++corner) {
    if (turns_[corner] <= 0) by_position_.push_back(corner);
  }
  std::sort(by_position_.begin(), by_position_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return at(a)[i] < at(b)[i]; });
  ears_.assign(size(), Ear::unknown);
  searches_left_ = max_searches;
  bool covered = true;
  std::uint32_t from = 0;
  spikes_.clear();
  for (std::uint32_t corner = size(); corner-- > 0;) {
    if (is_spike(corner)) spikes_.push_back(corner);
  }
  for (std::uint32_t left = size(); left > 3; --left) {
    std::uint32_t ear = next_spike();
    if (ear == none) ear = covered ? next_ear(from) : from;
    if (ear == none) ear = find_flat(from);  // it has no area, so nothing is lost
    if (ear == none) {
      covered = false;
      ear = from;
    }
    const std::uint32_t before = previous_[ear];
    const std::uint32_t after = next_[ear];
    triangles_.push_back({before, ear, after});
    next_[before] = after;
    previous_[after] = before;
    turns_[ear] = 1;  // it no longer blocks
    for (const std::uint32_t neighbour : {before, after}) {
      turns_[neighbour] = turn_at(neighbour);
      ears_[neighbour] = Ear::unknown;
      if (is_spike(neighbour)) spikes_.push_back(neighbour);
    }
    from = after;
  }
  Corners last{from, next_[from], previous_[from]};
  std::sort(last.begin(), last.end());
  triangles_.push_back(last);
  return covered && turns_[from] >= 0;
}

}  // namespace crashrank::importer
