#include "crashrank/crash/depth_map.hpp"

#include "crash/look.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace crashrank {
namespace {

using Eigen::Vector3d;

constexpr double endless = std::numeric_limits<double>::infinity();

/// Cells whose middle lies in [low, high], as a range of indices clipped to the grid.
struct Span {
  std::size_t first = 0;
  std::size_t end = 0;

  bool empty() const { return first >= end; }
};

Span cells_between(double low, double high, double start, double cell, std::size_t count) {
  // A little wider than it is, so that a middle on a shared edge is seen by one side at least.
  constexpr double slack = 1e-9;
  const double first = std::ceil((low - start) / cell - 0.5 - slack);
  const double last = std::floor((high - start) / cell - 0.5 + slack);
  const double end = static_cast<double>(count);
  if (!(first <= last) || !(last >= 0.0) || !(first < end)) return {};
  return {static_cast<std::size_t>(std::max(first, 0.0)),
          static_cast<std::size_t>(std::min(last + 1.0, end))};
}

/// Cells of a grid that boxes may cover, found at less cost than those of triangles: a little too
/// many rather than one too few.
class CoveredCells {
public:
  explicit CoveredCells(const ViewGrid& grid)
      : grid_(grid),
        per_w_(1.0 / grid.cell_w_m),
        per_h_(1.0 / grid.cell_h_m),
        columns_(static_cast<double>(grid.columns)),
        rows_(static_cast<double>(grid.rows)) {}

  Span columns(double low, double high) const {
    return span((low - grid_.low_w_m) * per_w_, (high - grid_.low_w_m) * per_w_, columns_);
  }
  Span rows(double low, double high) const {
    return span((low - grid_.low_h_m) * per_h_, (high - grid_.low_h_m) * per_h_, rows_);
  }

private:
  /// Middles lie at i + 1/2.
  static Span span(double low, double high, double count) {
    constexpr double slack = 1e-6;
    const double from = std::max(low - 0.5 - slack, 0.0);
    const double to = std::min(high - 0.5 + slack, count - 1.0);
    if (!(to >= 0.0) || !(from <= to)) return {};
    auto first = static_cast<std::size_t>(from);
    if (static_cast<double>(first) < from) ++first;
    const std::size_t end = static_cast<std::size_t>(to) + 1;
    return first < end ? Span{first, end} : Span{};
  }

  const ViewGrid& grid_;
  double per_w_;
  double per_h_;
  double columns_;
  double rows_;
};

void draw(const Vector3d& a, const Vector3d& b, const Vector3d& c, const CoveredCells& cells,
          DepthMap& map) {
  const ViewGrid& grid = map.grid;
  const Vector3d low = a.cwiseMin(b).cwiseMin(c);
  const Vector3d high = a.cwiseMax(b).cwiseMax(c);
  // Most triangles lie between the middles of cells, which is seen without a division.
  if (cells.columns(low.y(), high.y()).empty() || cells.rows(low.z(), high.z()).empty()) return;
  const Span columns = cells_between(low.y(), high.y(), grid.low_w_m, grid.cell_w_m, grid.columns);
  if (columns.empty()) return;
  const Span rows = cells_between(low.z(), high.z(), grid.low_h_m, grid.cell_h_m, grid.rows);
  if (rows.empty()) return;
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double twice_area = ab.y() * ac.z() - ab.z() * ac.y();
  if (twice_area == 0.0) return;
  constexpr double rim = 1e-9;
  for (std::size_t row = rows.first; row < rows.end; ++row) {
    const double dh = grid.h_of(row) - a.z();
    for (std::size_t column = columns.first; column < columns.end; ++column) {
      const double dw = grid.w_of(column) - a.y();
      const double s = (dw * ac.z() - dh * ac.y()) / twice_area;
      const double t = (ab.y() * dh - ab.z() * dw) / twice_area;
      if (s < -rim || t < -rim || s + t > 1.0 + rim) continue;
      // Clamped to the triangle: a sliver seen nearly edge-on must not throw its plane far out.
      const double u = std::clamp(a.x() + s * ab.x() + t * ac.x(), low.x(), high.x());
      const std::size_t cell = grid.index(column, row);
      map.least_m[cell] = std::min(map.least_m[cell], u);
      map.greatest_m[cell] = std::max(map.greatest_m[cell], u);
    }
  }
}

}  // namespace

ViewFrame view_along(const Vector3d& along, const Vector3d& origin_m) {
  ViewFrame frame;
  const Vector3d u = Vector3d(along.x(), along.y(), 0.0).normalized();
  frame.axes.row(0) = u;
  frame.axes.row(1) = Vector3d(-u.y(), u.x(), 0.0);
  frame.axes.row(2) = Vector3d::UnitZ();
  frame.origin_m = Vector3d(origin_m.x(), origin_m.y(), 0.0);
  return frame;
}

ViewGrid grid_over(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_w_m,
                   double cell_h_m) {
  ViewGrid grid;
  grid.low_w_m = low.x();
  grid.low_h_m = low.y();
  const double width = std::max(high.x() - low.x(), 0.0);
  const double height = std::max(high.y() - low.y(), 0.0);
  const double cells = std::max(width / cell_w_m, 1.0) * std::max(height / cell_h_m, 1.0);
  const double coarser = std::max(1.0, std::sqrt(cells / (0.25 * max_view_cells)));
  const auto count = [coarser](double length, double cell) {
    const double wanted = std::ceil(length / (cell * coarser));
    return static_cast<std::size_t>(std::clamp(wanted, 1.0, 1024.0));
  };
  grid.columns = count(width, cell_w_m);
  grid.rows = count(height, cell_h_m);
  grid.cell_w_m = width > 0.0 ? width / static_cast<double>(grid.columns) : cell_w_m;
  grid.cell_h_m = height > 0.0 ? height / static_cast<double>(grid.rows) : cell_h_m;
  return grid;
}

void view_bounds(const TriangleMesh& mesh, const Pose& body_in_world, const ViewFrame& frame,
                 Vector3d& low, Vector3d& high) {
  low = Vector3d::Constant(endless);
  high = -low;
  const detail::ViewOfBody view(body_in_world, frame);
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) {
      const Vector3d p = view(mesh.vertices[vertex]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
}

DepthMap depth_map(const TriangleMesh& mesh, const Pose& body_in_world, const ViewFrame& frame,
                   const ViewGrid& grid) {
  DepthMap map;
  map.grid = grid;
  map.least_m.assign(grid.size(), endless);
  map.greatest_m.assign(grid.size(), -endless);
  const detail::ViewOfBody view(body_in_world, frame);
  std::vector<Vector3d> seen;
  seen.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) seen.emplace_back(view(vertex));
  const CoveredCells cells(map.grid);
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    draw(seen[t[0]], seen[t[1]], seen[t[2]], cells, map);
  }
  return map;
}

namespace detail {
namespace {

/// Boxes of a tree as they are seen, a little larger than they are: what rounding may take off a
/// vertex is far less.
class SeenBoxes {
public:
  SeenBoxes(const AabbTree& tree, const ViewOfBody& view)
      : turn_(tree.axes_are_world ? view.turn : Eigen::Matrix3d(view.turn * tree.axes)),
        spread_(turn_.cwiseAbs()),
        shift_(view.shift) {
    const Box& root = tree.nodes[0].box;
    const Vector3d far =
        root.min.cast<double>().cwiseAbs().cwiseMax(root.max.cast<double>().cwiseAbs());
    margin_ = 1e-9 * (far.sum() + shift_.cwiseAbs().sum() + 1.0);
    if (!tree.axes_are_world) margin_ += 1e-6 * far.sum();
  }

  void see(const Box& box, Vector3d& low, Vector3d& high) const {
    const Vector3d from = box.min.cast<double>();
    const Vector3d to = box.max.cast<double>();
    const Vector3d middle = rotate(turn_, 0.5 * (from + to)) + shift_;
    const Vector3d half = rotate(spread_, 0.5 * (to - from));
    low = (middle - half).array() - margin_;
    high = (middle + half).array() + margin_;
  }

private:
  Eigen::Matrix3d turn_;
  Eigen::Matrix3d spread_;
  Vector3d shift_;
  double margin_ = 0.0;
};

/// Whether a box could still show anywhere: some middle of a cell lies before it, where what has
/// been seen so far does not reach past it on both sides.
bool may_show(const DepthMap& map, const CoveredCells& cells, const Vector3d& low,
              const Vector3d& high) {
  const Span columns = cells.columns(low.y(), high.y());
  if (columns.empty()) return false;
  const Span rows = cells.rows(low.z(), high.z());
  for (std::size_t row = rows.first; row < rows.end; ++row) {
    for (std::size_t column = columns.first; column < columns.end; ++column) {
      const std::size_t cell = map.grid.index(column, row);
      if (map.least_m[cell] > low.x() || map.greatest_m[cell] < high.x()) return true;
    }
  }
  return false;
}

}  // namespace

void view_bounds(const AabbTree& tree, const ViewOfBody& view, Vector3d& low, Vector3d& high,
                 LookMemory& memory) {
  low = Vector3d::Constant(endless);
  high = -low;
  if (tree.empty()) return;
  const SeenBoxes boxes(tree, view);
  Vector3d from;
  Vector3d to;
  const auto include = [&](const Node& leaf) {
    for (std::uint32_t slot = leaf.first; slot < leaf.first + leaf.count; ++slot) {
      for (const Eigen::Vector3f& corner : tree.triangles[slot].corner) {
        const Vector3d p = view(corner);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
  };
  // Straight down to what is likely to be outermost each way, so that little is left to look at.
  for (int way = 0; way < 6; ++way) {
    const int axis = way / 2;
    const auto outer = [&](std::uint32_t index) {
      boxes.see(tree.nodes[index].box, from, to);
      return way % 2 == 0 ? to[axis] : -from[axis];
    };
    const Node* node = &tree.nodes[0];
    while (!node->is_leaf()) {
      const bool left = outer(node->first) >= outer(node->first + 1);
      node = &tree.nodes[left ? node->first : node->first + 1];
    }
    include(*node);
  }
  std::vector<std::uint32_t>& stack = memory.stack;
  stack.assign(1, 0);
  while (!stack.empty() && memory.goes_on()) {
    const Node& node = tree.nodes[stack.back()];
    stack.pop_back();
    boxes.see(node.box, from, to);
    if ((from.array() >= low.array()).all() && (to.array() <= high.array()).all()) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.first + 1);
      stack.push_back(node.first);
      continue;
    }
    include(node);
  }
}

void depth_map(const AabbTree& tree, const ViewOfBody& view, DepthMap& map, LookMemory& memory) {
  map.least_m.assign(map.grid.size(), endless);
  map.greatest_m.assign(map.grid.size(), -endless);
  if (tree.empty()) return;
  const SeenBoxes boxes(tree, view);
  std::vector<SeenNode>& waiting = memory.waiting;
  waiting.resize(1);
  waiting.front().node = 0;
  boxes.see(tree.nodes[0].box, waiting.front().low, waiting.front().high);
  const double middle = 0.5 * (waiting.front().low.x() + waiting.front().high.x());
  const CoveredCells cells(map.grid);
  const auto outer = [middle](const SeenNode& seen) {
    return std::max(seen.high.x() - middle, middle - seen.low.x());
  };
  while (!waiting.empty() && memory.goes_on()) {
    const SeenNode seen = waiting.back();
    const Node& node = tree.nodes[seen.node];
    waiting.pop_back();
    if (!may_show(map, cells, seen.low, seen.high)) continue;
    if (!node.is_leaf()) {
      SeenNode left;
      SeenNode right;
      left.node = node.first;
      right.node = node.first + 1;
      boxes.see(tree.nodes[left.node].box, left.low, left.high);
      boxes.see(tree.nodes[right.node].box, right.low, right.high);
      // What is further out hides more.
      const bool right_first = outer(right) > outer(left);
      waiting.push_back(right_first ? left : right);
      waiting.push_back(right_first ? right : left);
      continue;
    }
    for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
      const auto& [a, b, c] = tree.triangles[slot].corner;
      draw(view(a), view(b), view(c), cells, map);
    }
  }
}

void triangles_where(const AabbTree& tree, const ViewOfBody& view,
                     bool (*wanted)(const void* context, const Vector3d& low, const Vector3d& high),
                     const void* context, std::vector<std::uint32_t>& triangles,
                     LookMemory& memory) {
  triangles.clear();
  if (tree.empty()) return;
  const SeenBoxes boxes(tree, view);
  Vector3d from;
  Vector3d to;
  std::vector<std::uint32_t>& stack = memory.stack;
  stack.assign(1, 0);
  while (!stack.empty()) {
    const Node& node = tree.nodes[stack.back()];
    stack.pop_back();
    boxes.see(node.box, from, to);
    if (!wanted(context, from, to)) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.first + 1);
      stack.push_back(node.first);
      continue;
    }
    for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
      triangles.push_back(tree.order[slot]);
    }
  }
  std::sort(triangles.begin(), triangles.end());
}

void view_bounds(const PulseBody& body, const ViewFrame& frame, Vector3d& low, Vector3d& high,
                 LookMemory& memory) {
  if (body.tree != nullptr) {
    view_bounds(*body.tree, ViewOfBody(body.pose, frame), low, high, memory);
  } else {
    crashrank::view_bounds(*body.mesh, body.pose, frame, low, high);
  }
}

void depth_map(const PulseBody& body, const ViewFrame& frame, const ViewGrid& grid, DepthMap& map,
               LookMemory& memory) {
  if (body.tree != nullptr) {
    map.grid = grid;
    depth_map(*body.tree, ViewOfBody(body.pose, frame), map, memory);
  } else {
    map = crashrank::depth_map(*body.mesh, body.pose, frame, grid);
  }
}

}  // namespace detail
}  // namespace crashrank
