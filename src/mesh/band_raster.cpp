#include "mesh/band_raster.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

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
  const Vector3d normal = normal_of(facet);
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
  if (normal.z() == 0.0) return;
  const double slope_x = -normal.x() / normal.z();
  const double slope_y = -normal.y() / normal.z();
  for (std::ptrdiff_t row = raster.row_of(low_y); row <= raster.row_of(high_y); ++row) {
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
    const auto place = [&](double x) { return (x - raster.low_x) / raster.cell_m - 0.5; };
    const auto last = static_cast<std::ptrdiff_t>(std::floor(place(to)));
    for (auto column = static_cast<std::ptrdiff_t>(std::ceil(place(from))); column <= last;
         ++column) {
      const double x = raster.center(column, row).x();
      const double z = first.z() + (slope_x * (x - first.x()) + slope_y * (y - first.y()));
      visit(raster.index(column, row), std::clamp(z, low_z, high_z));
    }
  }
}

/// Calls back for the cells around one, itself included.
template <class Visit> void visit_around(const Raster& raster, std::size_t cell, Visit&& visit) {
  const auto column = static_cast<std::ptrdiff_t>(cell) % raster.columns;
  const auto row = static_cast<std::ptrdiff_t>(cell) / raster.columns;
  for (std::ptrdiff_t j = row - 1; j <= row + 1; ++j) {
    for (std::ptrdiff_t i = column - 1; i <= column + 1; ++i) {
      if (raster.holds(i, j)) visit(raster.index(i, j));
    }
  }
}

/// Gives all cells that are `from` and can be reached from a cell without passing others a label.
void flood(const Raster& raster, std::size_t start, std::int32_t from, std::int32_t label,
           std::vector<std::int32_t>& labels, std::vector<std::size_t>& open) {
  open.assign(1, start);
  labels[start] = label;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    const auto column = static_cast<std::ptrdiff_t>(cell) % raster.columns;
    const auto row = static_cast<std::ptrdiff_t>(cell) / raster.columns;
    const auto enter = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      if (!raster.holds(i, j)) return;
      const std::size_t c = raster.index(i, j);
      if (labels[c] != from) return;
      labels[c] = label;
      open.push_back(c);
    };
    enter(column + 1, row);
    enter(column - 1, row);
    enter(column, row + 1);
    enter(column, row - 1);
  }
}

constexpr std::int32_t unreached = 0;
constexpr std::int32_t surface_label = -1;
constexpr std::int32_t outside_label = 1;

/// Labels above `outside_label` of the spaces that no way leads to, and of those the ones that are
/// wide enough to be free.
std::vector<char> wide_spaces(const Raster& raster, const std::vector<std::int32_t>& labels,
                              std::int32_t count) {
  // Distance to the fattened surface in steps of one cell in any of eight directions, in two
  // passes (Rosenfeld and Pfaltz 1966). The surface was made one cell fatter on each side.
  const auto needed = static_cast<std::uint16_t>(
      std::min(60000.0, std::max(1.0, 0.5 * least_free_width_m / raster.cell_m - 1.0)));
  std::vector<std::uint16_t> distance(raster.size(), needed);
  const auto pass = [&](std::ptrdiff_t from, std::ptrdiff_t step) {
    for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(raster.size()); ++n) {
      const auto cell = static_cast<std::size_t>(from + step * n);
      if (labels[cell] == surface_label) {
        distance[cell] = 0;
        continue;
      }
      visit_around(raster, cell, [&](std::size_t c) {
        distance[cell] = std::min<std::uint16_t>(
            distance[cell], static_cast<std::uint16_t>(distance[c] + 1));
      });
    }
  };
  pass(0, 1);
  pass(static_cast<std::ptrdiff_t>(raster.size()) - 1, -1);
  std::vector<char> wide(static_cast<std::size_t>(count) + 1, 0);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] > outside_label && distance[cell] >= needed) {
      wide[static_cast<std::size_t>(labels[cell])] = 1;
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
      const double x = end[0].x() + (y - end[0].y()) / (end[1].y() - end[0].y()) *
                                        (end[1].x() - end[0].x());
      const auto column = static_cast<std::ptrdiff_t>(
          std::floor((x - raster.low_x) / raster.cell_m - 0.5));
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

/// Marks the cells that have a part of the mesh above a height over them.
std::vector<char> covered_above(const BandSurface& surface, const Raster& raster, double height) {
  std::vector<char> covered(raster.size(), 0);
  const double rim = 2.0 * raster.cell_m;
  for (std::uint32_t i = 0; i < surface.mesh->size(); ++i) {
    const std::array<Vector3d, 3> corner = surface.triangle(i);
    BandFacet facet;
    facet.count = 3;
    std::copy(corner.begin(), corner.end(), facet.corner.begin());
    facet = cut_at(facet, height, 1.0);
    if (facet.count < 3) continue;
    // Only within the raster: bend what lies beyond its rim onto it.
    const Vector2d low = raster.corner(0, 0) + Vector2d::Constant(rim);
    const Vector2d high = raster.corner(raster.columns, raster.rows) - Vector2d::Constant(rim);
    for (std::size_t k = 0; k < facet.count; ++k) {
      facet.corner[k].head<2>() = facet.corner[k].head<2>().cwiseMax(low).cwiseMin(high);
    }
    visit_covered(raster, facet, [&](std::size_t cell, double) { covered[cell] = 1; });
  }
  return covered;
}

/// Of the wide spaces those that are free.
std::vector<char> free_spaces(const BandSurface& surface, const Raster& raster,
                              const std::vector<std::int32_t>& labels, std::int32_t count) {
  std::vector<char> free = wide_spaces(raster, labels, count);
  if (std::none_of(free.begin(), free.end(), [](char wide) { return wide != 0; })) return free;
  // Beside the middle, where no vertex of a drawn body lies.
  constexpr double beside_vertices_m = 1.3e-6;
  const std::vector<std::int32_t> winding = winding_numbers(
      surface, raster, 0.5 * (surface.low_m + surface.high_m) + beside_vertices_m);
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
  bool any_wound = false;
  for (std::size_t space = 0; space < free.size(); ++space) any_wound = any_wound || wound(space);
  if (!any_wound) return free;
  const std::vector<char> covered = covered_above(surface, raster, surface.high_m);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] > outside_label && covered[cell] != 0) {
      sums[static_cast<std::size_t>(labels[cell])].covered += 1.0;
    }
  }
  for (std::size_t space = 0; space < free.size(); ++space) {
    if (wound(space) && sums[space].covered > 0.5 * sums[space].cells) free[space] = 0;
  }
  return free;
}

}  // namespace

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
  Raster raster;
  if (!(low.x() <= high.x())) return raster;
  const Vector2d size = high - low;
  while ((size.x() / cell_m + 10.0) * (size.y() / cell_m + 10.0) > most_cells ||
         length / cell_m + area / (cell_m * cell_m) > most_cells_passed) {
    cell_m *= 1.25;
  }
  raster.cell_m = cell_m;
  raster.low_x = low.x() - 4.37 * cell_m;
  raster.columns = static_cast<std::ptrdiff_t>(size.x() / cell_m) + 10;
  // An odd number: no corner lies in the middle, as near to one side of an even body as to the
  // other.
  raster.rows = (static_cast<std::ptrdiff_t>(size.y() / cell_m) + 10) | 1;
  raster.middle_y = 0.5 * (low.y() + high.y());
  raster.half_rows = 0.5 * static_cast<double>(raster.rows);
  return raster;
}

std::vector<HeightRange> rasterise_heights(const BandSurface& surface, const Raster& raster) {
  std::vector<HeightRange> heights(raster.size());
  surface.for_each_facet([&](const BandFacet& facet) {
    for (std::size_t i = 0; i < facet.count; ++i) {
      const Vector3d& a = facet.corner[i];
      const Vector3d& b = facet.corner[(i + 1) % facet.count];
      const Vector3d& p = is_ordered(a, b) ? a : b;
      const Vector3d& q = is_ordered(a, b) ? b : a;
      visit_cells(raster, p.head<2>(), q.head<2>(), [&](std::size_t cell, double share) {
        heights[cell].grow(static_cast<float>(p.z() + share * (q.z() - p.z())));
      });
    }
    visit_covered(raster, facet, [&](std::size_t cell, double z) {
      heights[cell].grow(static_cast<float>(z));
    });
  });
  return heights;
}

std::vector<Cell> divide_cells(const BandSurface& surface, const Raster& raster,
                               const std::vector<HeightRange>& heights) {
  std::vector<std::int32_t> labels(raster.size(), unreached);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (heights[cell].empty()) continue;
    visit_around(raster, cell, [&](std::size_t c) { labels[c] = surface_label; });
  }
  std::vector<std::size_t> open;
  flood(raster, 0, unreached, outside_label, labels, open);
  std::int32_t last = outside_label;
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (labels[cell] == unreached) flood(raster, cell, unreached, ++last, labels, open);
  }
  const std::vector<char> free = last > outside_label
                                     ? free_spaces(surface, raster, labels, last)
                                     : std::vector<char>(outside_label + 1, 0);
  std::vector<Cell> cells(raster.size(), Cell::solid);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    const std::int32_t label = labels[cell];
    if (label < outside_label) continue;
    if (label > outside_label && free[static_cast<std::size_t>(label)] == 0) continue;
    visit_around(raster, cell, [&](std::size_t c) {
      if (!heights[c].empty() || cells[c] == Cell::outside) return;
      cells[c] = label == outside_label ? Cell::outside : Cell::inside;
    });
  }
  return cells;
}

}  // namespace crashrank::detail
