#include "crash/pulse_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// No pulse is told of bodies that come together faster.
constexpr double most_closing_mps = 150.0;

/// How far A's surface may come within the pulse, ahead and, since what is behind falls back as
/// fast as what is ahead comes near, what lies further behind than that is out of its way. Where B
/// begins says nothing about it: a long wall that is struck along its flank begins far behind A.
double reach_m(const PulseBody& a, const PulseBody& b, double length_m,
               const PulseOptions& options) {
  const Vector3d closing = a.rigid.velocity.linear_mps - b.rigid.velocity.linear_mps;
  const double speed = std::min(closing.head<2>().norm(), most_closing_mps);
  return std::max(length_m, speed * options.longest_s);
}

}  // namespace

void AwakeFacets::reserve(std::size_t count) {
  facet.reserve(count);
  for (std::vector<double>* field : {&x, &y, &normal_x, &normal_y, &front_m, &at_x, &at_y, &in_a_x,
                                     &in_a_y, &clear_m, &advance_mps}) {
    field->reserve(count);
  }
}

void AwakeFacets::resize(std::size_t count) {
  facet.resize(count);
  for (std::vector<double>* field : {&x, &y, &normal_x, &normal_y, &front_m, &at_x, &at_y, &in_a_x,
                                     &in_a_y, &clear_m, &advance_mps}) {
    field->resize(count);
  }
}

void AwakeFacets::keep(std::size_t from, std::size_t to) {
  facet[to] = facet[from];
  for (std::vector<double>* field : {&x, &y, &normal_x, &normal_y, &front_m, &in_a_x, &in_a_y}) {
    (*field)[to] = (*field)[from];
  }
}

void PulseMemory::prepare(double longest_m, double highest_m, std::uint32_t deepest,
                          const PulseOptions& options) {
  constexpr double most_cells = 1024.0;  // across and up, see `grid_over`
  const double across = std::min(std::ceil((longest_m + 1.0) / options.cell_w_m) + 4.0, most_cells);
  const double rows = std::min(std::ceil(highest_m / options.cell_h_m) + 1.0, most_cells);
  const double cells = across * rows;
  // From one column to the next a line of facets may go over A's length and its reach on both
  // sides; pieces are as long as a cell.
  const double stretch =
      longest_m + 2.0 * std::max(longest_m, most_closing_mps * options.longest_s);
  const double pieces =
      std::min(2.0 * cells * (stretch / options.cell_w_m + 3.0), static_cast<double>(most_facets));
  const auto cell_count = static_cast<std::size_t>(cells);
  const auto facet_count = static_cast<std::size_t>(pieces);
  for (DepthMap* map : {&map_a, &map_b}) {
    map->least_m.reserve(cell_count);
    map->greatest_m.reserve(cell_count);
  }
  look.stack.reserve(std::size_t{deepest} + 64);
  look.waiting.reserve(std::size_t{deepest} + 64);
  facets.reserve(facet_count);
  laws.reserve(facet_count);
  row_front_m.reserve(static_cast<std::size_t>(rows) + 1);
  crushed_m.reserve(cell_count);
  wakes_m.reserve(facet_count);
  awake.reserve(facet_count);
}

bool can_press(const PulseBody& a, const PulseBody& b, const Vector3d& along) {
  return along.head<2>().norm() > 0.0 && (a.rigid.movable() || b.rigid.movable()) &&
         !(a.strength.rigid && b.strength.rigid);
}

void look(const PulseBody& a, const PulseBody& b, const ViewFrame& frame,
          const PulseOptions& options, PulseMemory& memory) {
  memory.facets.clear();
  memory.looked_at = 1;
  memory.look.stopped = false;
  Vector3d low_a;
  Vector3d high_a;
  Vector3d low_b;
  Vector3d high_b;
  view_bounds(a, frame, low_a, high_a, memory.look);
  view_bounds(b, frame, low_b, high_b, memory.look);
  const double low = std::max(low_a.z(), low_b.z());
  const double high = std::min(high_a.z(), high_b.z());
  if (!(low < high)) return;
  constexpr double aside = 0.5;  // how far B may come in from the side
  const double rim = options.cell_w_m;
  const double left = std::max(low_b.y() - rim, low_a.y() - aside);
  const double right = std::min(high_b.y() + rim, high_a.y() + aside);
  if (!(left < right)) return;
  const ViewGrid grid_a =
      grid_over({low_a.y(), low}, {high_a.y(), high}, options.cell_w_m, options.cell_h_m);
  ViewGrid grid_b = grid_over({left, low}, {right, high}, options.cell_w_m, options.cell_h_m);
  // Rows have to be the same.
  grid_b.rows = grid_a.rows;
  grid_b.cell_h_m = grid_a.cell_h_m;
  depth_map(a, frame, grid_a, memory.map_a, memory.look);
  depth_map(b, frame, grid_b, memory.map_b, memory.look);
  if (memory.look.stopped) return;
  const double reach = reach_m(a, b, high_a.x() - low_a.x(), options);
  facets_of(memory.map_b, low_a.x() - reach, high_a.x() + reach, memory.facets);

  memory.row_front_m.assign(grid_a.rows, -std::numeric_limits<double>::infinity());
  for (std::size_t row = 0; row < grid_a.rows; ++row) {
    for (std::size_t column = 0; column < grid_a.columns; ++column) {
      const std::size_t cell = grid_a.index(column, row);
      memory.row_front_m[row] = std::max(memory.row_front_m[row], memory.map_a.greatest_m[cell]);
    }
  }
  memory.looked_at += 2 * grid_a.size() + memory.facets.size();
  const Material material(b, frame);
  memory.laws.resize(memory.facets.size());
  if (material.rigid()) {
    FacetLaw rigid;
    rigid.core.rigid = rigid.aside.rigid = true;
    std::fill(memory.laws.begin(), memory.laws.end(), rigid);
    return;
  }
  const CrushCore& core = material.strength().core;
  for (std::size_t i = 0; i < memory.facets.size(); ++i) {
    const Facet& facet = memory.facets[i];
    const double height = grid_a.h_of(facet.row);
    memory.laws[i].core = material.law_of_share(core.inside, height, -facet.normal);
    memory.laws[i].aside = material.law_of_share(core.outside, height, -facet.normal);
  }
}

}  // namespace crashrank::detail
