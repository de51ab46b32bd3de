#include "report/body_front.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t columns = 100;  // along the length, from the rear
using Columns = std::array<double, columns>;

/// Silhouettes of a body whose box is 1 long and 1 high and reaches from -1 to 1 across.
struct Silhouette {
  Columns top{};                      ///< height of the highest point
  std::array<Columns, 2> reach{};     ///< of the outermost point to the right, to the left
  std::array<Columns, 2> reach_at{};  ///< height of that point
  double height_by_length = 0.0;

  void add(const Vector3d& point, std::size_t column) {
    const std::size_t side = point.y() > 0.0 ? 1 : 0;
    top[column] = std::max(top[column], point.z());
    if (std::abs(point.y()) <= reach[side][column]) return;
    reach[side][column] = std::abs(point.y());
    reach_at[side][column] = point.z();
  }

  /// Highest and outermost points of a triangle within a column lie on its edges.
  void add_edge(Vector3d from, Vector3d to) {
    if (from.x() > to.x()) std::swap(from, to);
    const auto column_of = [](double x) {
      return std::min(static_cast<std::size_t>(columns * std::max(x, 0.0)), columns - 1);
    };
    const double length = std::max(to.x() - from.x(), 1e-12);
    for (std::size_t i = column_of(from.x()); i <= column_of(to.x()); ++i) {
      for (const double border : {static_cast<double>(i), static_cast<double>(i + 1)}) {
        const double share = std::clamp((border / columns - from.x()) / length, 0.0, 1.0);
        add(from + share * (to - from), i);
      }
    }
  }
};

Silhouette silhouette_of(const TriangleMesh& mesh, const Vector3d& forward, const Vector3d& up) {
  Eigen::Matrix3d axes;
  axes << forward, up.cross(forward), up;
  const Box box = mesh.bounds();
  const Vector3d half =
      (0.5 * (axes.transpose() * box.extent().cast<double>()).cwiseAbs()).cwiseMax(1e-9);
  const Vector3d middle = box.center().cast<double>();
  Silhouette seen;
  seen.height_by_length = half.z() / half.x();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    std::array<Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d at = mesh.vertices[mesh.triangles[i][k]].cast<double>() - middle;
      corners[k] = (axes.transpose() * at).cwiseQuotient(half);
      corners[k].x() = 0.5 * corners[k].x() + 0.5;
      corners[k].z() = 0.5 * corners[k].z() + 0.5;
    }
    for (std::size_t k = 0; k < 3; ++k) seen.add_edge(corners[k], corners[(k + 1) % 3]);
  }
  return seen;
}

double ranked(Columns values, std::size_t rank) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

int sign_beyond(double value, double least) {
  return std::abs(value) < least ? 0 : value > 0 ? 1 : -1;
}

/// Mirrors are short, stand out on both sides by a tenth of the width and are high.
int front_by_mirrors(const Silhouette& seen) {
  constexpr std::size_t longest = 6;
  constexpr double least_reach = 1.09;
  Columns width{};
  std::transform(seen.reach[0].begin(), seen.reach[0].end(), seen.reach[1].begin(), width.begin(),
                 [](double right, double left) { return std::min(right, left); });
  const double body = ranked(width, columns * 88 / 100);
  const auto wide = [body](double reach) { return reach > 1.03 * body; };
  const auto first =
      static_cast<std::size_t>(std::find_if(width.begin(), width.end(), wide) - width.begin());
  const auto end =
      static_cast<std::size_t>(width.rend() - std::find_if(width.rbegin(), width.rend(), wide));
  const auto widest =
      static_cast<std::size_t>(std::max_element(width.begin(), width.end()) - width.begin());
  if (end <= first || end - first > longest || width[widest] < least_reach * body) return 0;
  if (std::min(seen.reach_at[0][widest], seen.reach_at[1][widest]) < 0.5) return 0;
  return sign_beyond(static_cast<double>(first + end) / (2.0 * columns) - 0.5, 0.05);
}

/// Shares of the length from the rear end and from the front end to where a height is reached.
std::array<double, 2> ends_below(const Columns& top, double height) {
  const auto high = [height](double z) { return z >= height; };
  const auto rear = std::find_if(top.begin(), top.end(), high) - top.begin();
  const auto front = std::find_if(top.rbegin(), top.rend(), high) - top.rbegin();
  return {static_cast<double>(rear) / columns, static_cast<double>(front) / columns};
}

/// The bonnet is longer than the boot, at the height of the waist and at that of the roof, and the
/// glass above it leans: the back of a pickup's cabin, before its bed, is upright.
int front_by_cabin(const Silhouette& seen) {
  constexpr double least_ahead = 0.05;
  constexpr double waist = 0.74;
  constexpr double eaves = 0.94;
  constexpr double least_run_by_rise = 0.5;
  const double roof = ranked(seen.top, columns - 6);  // without an aerial
  const std::array<double, 2> low = ends_below(seen.top, waist * roof);
  const std::array<double, 2> high = ends_below(seen.top, eaves * roof);
  const int front = sign_beyond(low[1] - low[0], least_ahead);
  if (front == 0 || front != sign_beyond(high[1] - high[0], least_ahead)) return 0;
  const std::size_t end = front > 0 ? 1 : 0;
  const double rise = (eaves - waist) * roof * seen.height_by_length;
  return high[end] - low[end] > least_run_by_rise * rise ? front : 0;
}

int front_by_nose(const Silhouette& seen) {
  constexpr std::ptrdiff_t from = 3;
  constexpr std::ptrdiff_t to = 9;
  const double rear = std::accumulate(seen.top.begin() + from, seen.top.begin() + to, 0.0);
  const double front = std::accumulate(seen.top.end() - to, seen.top.end() - from, 0.0);
  return sign_beyond((rear - front) / (to - from), 0.03);
}

}  // namespace

int front_by_shape(const TriangleMesh& mesh, const Vector3d& forward, const Vector3d& up) {
  const Silhouette seen = silhouette_of(mesh, forward, up);
  const int cabin = front_by_cabin(seen);
  const int nose = front_by_nose(seen);
  const int mirrors = front_by_mirrors(seen);
  if (mirrors == 0) return cabin == nose ? cabin : 0;
  return mirrors * (cabin + nose) >= 0 ? mirrors : 0;
}

}  // namespace crashrank::detail
