#include "mesh/band_raster.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double most_cells = 4e6;
/// What all facets together may pass and cover, in cells: bounds time and memory on meshes of many
/// large triangles.
constexpr double most_cells_passed = 10e6;

/// Keeps the part of a polygon on one side of a height: above for sign 1, below for -1.
BandFacet cut_at(const BandFacet& facet, double height, double sign) {
  BandFacet kept;
  for (std::size_t i = 0; i < facet.count; ++i) {
    const Vector3d& p = facet.corner[i];
    const Vector3d& q = facet.corner[(i + 1) % facet.count];
    const double over_p = sign * (p.z() - height);
    const double over_q = sign * (q.z() - height);
    if (over_p >= 0.0) kept.corner[kept.count++] = p;
    if ((over_p > 0.0 && over_q < 0.0) || (over_p < 0.0 && over_q > 0.0)) {
      // From the lower end, whichever way the edge runs: neighbours meet at the same point.
      const Vector3d& low = p.z() < q.z() ? p : q;
      const Vector3d& high = p.z() < q.z() ? q : p;
      const double t = (height - low.z()) / (high.z() - low.z());
      const Vector2d at = low.head<2>() + t * (high.head<2>() - low.head<2>());
      kept.corner[kept.count++] = Vector3d(at.x(), at.y(), height);
    }
  }
  return kept;
}

/// Twice the vector area of a facet.
Vector3d normal_of(const BandFacet& facet) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < facet.count; ++i) {
    normal += (facet.corner[i] - facet.corner[0]).cross(facet.corner[i + 1] - facet.corner[0]);
  }
  return normal;
}

/// The ends of an edge in an order that neither its direction nor a mirror image changes.
bool is_ordered(const Vector3d& p, const Vector3d& q) {
  return p.x() != q.x() ? p.x() < q.x() : p.z() < q.z();
}

/// Calls back for the cells whose middles a facet covers, with its height there.
template <class Visit>
void visit_covered(const Raster& raster, const BandFacet& facet, Visit&& visit) {
  const Vector3d& first = facet.corner[0];
  double low_y = first.y();
  double high_y = first.y();
  double low_z = first.z();
  double high_z = first.z();
  for (std::size_t i = 1; i < facet.count; ++i) {
    low_y = std::min(low_y, facet.corner[i].y());
    high_y = std::max(high_y, facet.corner[i].y());
    low_z = std::min(low_z, facet.corner[i].z());
    high_z = std::max(high_z, facet.corner[i].z());
  }
  // The rows whose middles it spans.
  std::ptrdiff_t row = raster.row_of(low_y);
  std::ptrdiff_t last_row = raster.row_of(high_y);
  if (raster.center(0, row).y() < low_y) ++row;
  if (raster.center(0, last_row).y() > high_y) --last_row;
  if (row > last_row) return;
  const Vector3d normal = normal_of(facet);
  if (normal.z() == 0.0) return;
  const double slope_x = -normal.x() / normal.z();
  const double slope_y = -normal.y() / normal.z();
  for (; row <= last_row; ++row) {
    const double y = raster.center(0, row).y();
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (std::size_t i = 0; i < facet.count; ++i) {
      const Vector3d& a = facet.corner[i];
      const Vector3d& b = facet.corner[(i + 1) % facet.count];
      const Vector3d& p = is_ordered(a, b) ? a : b;
      const Vector3d& q = is_ordered(a, b) ? b : a;
      if ((p.y() < y) == (q.y() < y) && p.y() != y && q.y() != y) continue;
      if (p.y() == q.y()) continue;
      const double x = p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
      from = std::min(from, x);
      to = std::max(to, x);
    }
    if (!(from <= to)) continue;
    const auto place = [&](double x) { return (x - raster.low_x) * raster.cells_per_m - 0.5; };
    const auto last = static_cast<std::ptrdiff_t>(std::floor(place(to)));
    for (auto column = static_cast<std::ptrdiff_t>(std::ceil(place(from))); column <= last;
         ++column) {
      const double x = raster.center(column, row).x();
      const double z = first.z() + (slope_x * (x - first.x()) + slope_y * (y - first.y()));
      visit(raster.index(column, row), std::clamp(z, low_z, high_z));
    }
  }
}

/// Calls back for the cells around one, itself included; not for cells of the rim.
template <class Visit> void visit_around(const Raster& raster, std::size_t cell, Visit&& visit) {
  const auto columns = static_cast<std::size_t>(raster.columns);
  for (const std::size_t row : {cell - columns, cell, cell + columns}) {
    visit(row - 1);
    visit(row);
    visit(row + 1);
  }
}

constexpr std::int32_t unreached = 0;
constexpr std::int32_t surface_label = -1;
constexpr std::int32_t outside_label = 1;

/// Gives a label to all unreached cells that can be reached from a cell without passing others. The
/// outermost cells of the raster are reached already.
void flood(const Raster& raster, std::size_t start, std::int32_t label,
           std::vector<std::int32_t>& labels, std::vector<std::size_t>& open) {
  const auto columns = static_cast<std::size_t>(raster.columns);
  open.assign(1, start);
  labels[start] = label;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    for (const std::size_t next : {cell + 1, cell - 1, cell + columns, cell - columns}) {
      if (labels[next] != unreached) continue;
      labels[next] = label;
      open.push_back(next);
    }
  }
}

/// By label above `outside_label`: whether the space that no way leads to holds a square of
/// `least_free_width_m`.
std::vector<char> wide_spaces(const Raster& raster, const std::vector<std::int32_t>& labels,
                              std::int32_t count) {
  // The surface was made one cell fatter on each side.
  const auto needed = static_cast<std::int32_t>(
      std::min(1e6, std::max(1.0, least_free_width_m / raster.cell_m - 2.0)));
  std::vector<char> wide(static_cast<std::size_t>(count) + 1, 0);
  // Side of the largest free square that ends in each cell of a row and of the one before.
  const auto columns = static_cast<std::size_t>(raster.columns);
  std::vector<std::int32_t> side(columns, 0);
  std::vector<std::int32_t> before(columns, 0);
  for (std::size_t row = 0; row < labels.size(); row += columns) {
    std::swap(side, before);
    for (std::size_t i = 1; i < columns; ++i) {
      const std::int32_t label = labels[row + i];
      side[i] =
          label > outside_label ? 1 + std::min(before[i - 1], std::min(before[i], side[i - 1])) : 0;
      if (side[i] >= needed) wide[static_cast<std::size_t>(label)] = 1;
    }
  }
  return wide;
}

/// How often the section of the surface at a height goes round the middle of each cell: crossings
/// of the way to the right, those upwards less those downwards.
std::vector<std::int32_t> winding_numbers(const BandSurface& surface, const Raster& raster,
                                          double height) {
  std::vector<std::int32_t> winding(raster.size(), 0);
  surface.for_each_facet([&](const BandFacet& facet) {
    std::array<Vector2d, 2> end;
    std::size_t count = 0;
    for (std::size_t i = 0; i < facet.count && count < 2; ++i) {
      const Vector3d& p = facet.corner[i];
      const Vector3d& q = facet.corner[(i + 1) % facet.count];
      if ((p.z() < height) == (q.z() < height)) continue;
      const double t = (height - p.z()) / (q.z() - p.z());
      end[count++] = p.head<2>() + t * (q.head<2>() - p.head<2>());
    }
    if (count < 2) return;
    // The outward side of the surface lies to the right of the section.
    const Vector3d normal = normal_of(facet);
    const Vector2d along = end[1] - end[0];
    if (along.dot(Vector2d(-normal.y(), normal.x())) < 0.0) std::swap(end[0], end[1]);
    const double low = std::min(end[0].y(), end[1].y());
    const double high = std::max(end[0].y(), end[1].y());
    for (std::ptrdiff_t row = raster.row_of(low); row <= raster.row_of(high); ++row) {
      const double y = raster.center(0, row).y();
      if ((end[0].y() < y) == (end[1].y() < y)) continue;
      const double x =
          end[0].x() + (y - end[0].y()) / (end[1].y() - end[0].y()) * (end[1].x() - end[0].x());
      const auto column =
          static_cast<std::ptrdiff_t>(std::floor((x - raster.low_x) * raster.cells_per_m - 0.5));
      if (raster.holds(column, row)) {
        winding[raster.index(column, row)] += end[0].y() < y ? 1 : -1;
      }
    }
  });
  for (std::ptrdiff_t row = 0; row < raster.rows; ++row) {
    for (std::ptrdiff_t column = raster.columns - 2; column >= 0; --column) {
      winding[raster.index(column, row)] += winding[raster.index(column + 1, row)];
    }
  }
  return winding;
}

/// Of the wide spaces those that are free.
std::vector<char> free_spaces(const BandSurface& surface, const Raster& raster,
                              const std::vector<std::int32_t>& labels, std::int32_t count,
                              std::optional<SkyMap>& sky) {
  std::vector<char> free = wide_spaces(raster, labels, count);
  if (std::none_of(free.begin(), free.end(), [](char wide) { return wide != 0; })) return free;
  // Beside the middle, where no vertex of a drawn body lies.
  constexpr double beside_vertices_m = 1.3e-6;
  const std::vector<std::int32_t> winding =
      winding_numbers(surface, raster, 0.5 * (surface.low_m + surface.high_m) + beside_vertices_m);
  struct Sums {
    double cells = 0.0;
    double wound = 0.0;
    double covered = 0.0;
  };
  std::vector<Sums> sums(free.size());
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] <= outside_label) continue;
    Sums& s = sums[static_cast<std::size_t>(labels[cell])];
    s.cells += 1.0;
    s.wound += winding[cell] != 0 ? 1.0 : 0.0;
  }
  const auto wound = [&](std::size_t space) {
    return free[space] != 0 && sums[space].wound > 0.5 * sums[space].cells;
  };
  const auto columns = static_cast<std::size_t>(raster.columns);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] <= outside_label) continue;
    const auto space = static_cast<std::size_t>(labels[cell]);
    if (!wound(space)) continue;
    if (!sky) sky.emplace(surface);
    const Vector2d place = raster.center(static_cast<std::ptrdiff_t>(cell % columns),
                                         static_cast<std::ptrdiff_t>(cell / columns));
    // A roof at the edge of the band covers.
    if (sky->covers(place, surface.high_m - 1e-3)) sums[space].covered += 1.0;
  }
  for (std::size_t space = 0; space < free.size(); ++space) {
    if (wound(space) && sums[space].covered > 0.5 * sums[space].cells) free[space] = 0;
  }
  return free;
}

Raster make_raster(const Vector2d& low, const Vector2d& high, double cell_m) {
  const Vector2d size = high - low;
  Raster raster;
  raster.cell_m = cell_m;
  raster.cells_per_m = 1.0 / cell_m;
  raster.low_x = low.x() - 4.37 * cell_m;
  raster.columns = static_cast<std::ptrdiff_t>(size.x() / cell_m) + 10;
  // An odd number: no corner lies in the middle, as near to one side of an even body as to the
  // other.
  raster.rows = (static_cast<std::ptrdiff_t>(size.y() / cell_m) + 10) | 1;
  raster.middle_y = 0.5 * (low.y() + high.y());
  raster.half_rows = 0.5 * static_cast<double>(raster.rows);
  return raster;
}

}  // namespace

SkyMap::SkyMap(const BandSurface& surface) {
  constexpr double finest_m = 0.1;
  constexpr double cells_along = 400.0;
  const Vector2d low = surface.bounds.min.head<2>().cast<double>();
  const Vector2d high = surface.bounds.max.head<2>().cast<double>();
  raster_ = make_raster(low, high, std::max(finest_m, (high - low).maxCoeff() / cells_along));
  heights_.resize(raster_.size());
  for (std::uint32_t i = 0; i < surface.mesh->size(); ++i) {
    const std::array<Vector3d, 3> corner = surface.triangle(i);
    BandFacet facet;
    facet.count = 3;
    std::copy(corner.begin(), corner.end(), facet.corner.begin());
    for (const Vector3d& p : corner) {
      const std::size_t cell = raster_.index(raster_.column_of(p.x()), raster_.row_of(p.y()));
      heights_[cell].grow(static_cast<float>(p.z()));
    }
    visit_covered(raster_, facet,
                  [&](std::size_t cell, double z) { heights_[cell].grow(static_cast<float>(z)); });
  }
}

bool SkyMap::covers(const Vector2d& place, double height_m) const {
  const std::ptrdiff_t column = raster_.column_of(place.x());
  const std::ptrdiff_t row = raster_.row_of(place.y());
  return raster_.holds(column, row) &&
         static_cast<double>(heights_[raster_.index(column, row)].high_m) > height_m;
}

BandFacet clip_to_band(const std::array<Vector3d, 3>& triangle, double low, double high) {
  BandFacet facet;
  const auto [least, greatest] = std::minmax({triangle[0].z(), triangle[1].z(), triangle[2].z()});
  // What only touches the band has no height in it.
  if (least >= high || greatest <= low) return facet;
  facet.count = 3;
  std::copy(triangle.begin(), triangle.end(), facet.corner.begin());
  if (least < low) facet = cut_at(facet, low, 1.0);
  if (greatest > high) facet = cut_at(facet, high, -1.0);
  return facet;
}

std::array<Vector3d, 3> BandSurface::triangle(std::uint32_t index) const {
  std::array<Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = mesh->vertices[mesh->triangles[index][k]].cast<double>();
    corners[k].z() -= ground_m;
  }
  return corners;
}

Raster raster_over(const BandSurface& surface, double cell_m) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = -low;
  double length = 0.0;
  double area = 0.0;
  surface.for_each_facet([&](const BandFacet& facet) {
    for (std::size_t i = 0; i < facet.count; ++i) {
      const Vector2d p = facet.corner[i].head<2>();
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      length += (facet.corner[(i + 1) % facet.count].head<2>() - p).norm();
    }
    area += 0.5 * std::abs(normal_of(facet).z());
  });
  if (!(low.x() <= high.x())) return {};
  const Vector2d size = high - low;
  while ((size.x() / cell_m + 10.0) * (size.y() / cell_m + 10.0) > most_cells ||
         length / cell_m + area / (cell_m * cell_m) > most_cells_passed) {
    cell_m *= 1.25;
  }
  return make_raster(low, high, cell_m);
}

std::vector<HeightRange> rasterise_heights(const BandSurface& surface, const Raster& raster) {
  std::vector<HeightRange> heights(raster.size());
  surface.for_each_facet([&](const BandFacet& facet) {
    for (std::size_t i = 0; i < facet.count; ++i) {
      const Vector3d& a = facet.corner[i];
      const Vector3d& b = facet.corner[(i + 1) % facet.count];
      const Vector3d& p = is_ordered(a, b) ? a : b;
      const Vector3d& q = is_ordered(a, b) ? b : a;
      visit_cells(raster, p.head<2>(), q.head<2>(),
                  [&](std::size_t cell, double entered, double left) {
                    heights[cell].grow(static_cast<float>(p.z() + entered * (q.z() - p.z())));
                    heights[cell].grow(static_cast<float>(p.z() + left * (q.z() - p.z())));
                  });
    }
    visit_covered(raster, facet,
                  [&](std::size_t cell, double z) { heights[cell].grow(static_cast<float>(z)); });
  });
  return heights;
}

std::vector<Cell> divide_cells(const BandSurface& surface, const Raster& raster,
                               const std::vector<HeightRange>& heights,
                               std::optional<SkyMap>& sky) {
  std::vector<std::int32_t> labels(raster.size(), unreached);
  const auto columns = static_cast<std::size_t>(raster.columns);
  for (std::size_t i = 0; i < columns; ++i) {
    labels[i] = labels[labels.size() - 1 - i] = outside_label;
  }
  for (std::size_t row = 0; row < labels.size(); row += columns) {
    labels[row] = labels[row + columns - 1] = outside_label;
  }
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (heights[cell].empty()) continue;
    visit_around(raster, cell, [&](std::size_t c) { labels[c] = surface_label; });
  }
  std::vector<std::size_t> open;
  flood(raster, columns + 1, outside_label, labels, open);
  std::int32_t last = outside_label;
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] == unreached) flood(raster, cell, ++last, labels, open);
  }
  std::vector<char> free(outside_label + 1, 0);
  if (last > outside_label) free = free_spaces(surface, raster, labels, last, sky);
  const auto kind_of = [&](std::int32_t label) {
    if (label == outside_label) return Cell::outside;
    return label > outside_label && free[static_cast<std::size_t>(label)] != 0 ? Cell::inside
                                                                               : Cell::solid;
  };
  std::vector<Cell> cells(raster.size(), Cell::solid);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] != surface_label) {
      cells[cell] = kind_of(labels[cell]);
    } else if (heights[cell].empty()) {
      Cell kind = Cell::solid;
      visit_around(raster, cell, [&](std::size_t c) {
        const Cell beside = labels[c] == surface_label ? Cell::solid : kind_of(labels[c]);
        if (kind != Cell::outside && beside != Cell::solid) kind = beside;
      });
      cells[cell] = kind;
    }
  }
  return cells;
}

}  // namespace crashrank::detail
