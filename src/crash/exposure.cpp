#include "crash/exposure.hpp"

#include "crash/planar_body.hpp"

namespace crashrank::detail {

void ContactAction::add(const ContactAction& more, double share) {
  dvx_mps += share * more.dvx_mps;
  dvy_mps += share * more.dvy_mps;
  rebound_x_mps += share * more.rebound_x_mps;
  rebound_y_mps += share * more.rebound_y_mps;
  path_mps += share * more.path_mps;
  cancelled_mps += share * more.cancelled_mps;
  crush_j += share * more.crush_j;
  light_mps += share * more.light_mps;
  struck_mps = std::max(struck_mps, share * more.struck_mps);
  edge_m2ps += share * more.edge_m2ps;
  intruded_m3 += share * more.intruded_m3;
  deepest_m += share * more.deepest_m;
}

bool ExposureRecord::add(double begin_s, double end_s, const ExposureCell& state,
                         const ContactAction& action) {
  const auto cell_at = [](double time_s) {
    return static_cast<std::int32_t>(std::floor(time_s / exposure_cell_s));
  };
  const double duration_s = end_s - begin_s;
  std::int32_t cell = cell_at(begin_s);
  if (!cells_.empty()) cell = std::max(cell, cells_.back().index);
  const std::int32_t last = std::max(cell, cell_at(end_s));
  for (; cell <= last; ++cell) {
    const double from_s = std::max(begin_s, cell * exposure_cell_s);
    const double until_s = cell == last ? end_s : (cell + 1) * exposure_cell_s;
    if (!(until_s > from_s)) continue;
    if (cells_.empty() || cells_.back().index != cell) {
      if (cells_.size() == most_cells) return false;
      cells_.push_back(state);
      cells_.back().index = cell;
      cells_.back().action = {};
    }
    cells_.back().action.add(action, (until_s - from_s) / duration_s);
    cells_.back().action.struck_mps = std::max(cells_.back().action.struck_mps, action.struck_mps);
  }
  return true;
}

namespace {

/// Windows with one begin, and the direction of each: forces from the side are at least as harmful
/// as those from ahead, and these as those from behind.
struct WindowSet {
  std::array<ExposureWindow, most_cells_of_window> windows;
  std::size_t count = 0;

  static bool exceeds(const ExposureWindow& w, const ExposureWindow& v) {
    return w.exposure_mps >= v.exposure_mps && w.struck_mps >= v.struck_mps &&
           w.intrusion_m >= v.intrusion_m && w.direction.from_side >= v.direction.from_side &&
           w.direction.from_behind <= v.direction.from_behind;
  }
  void add(const ExposureWindow& added) {
    for (std::size_t k = 0; k < count; ++k) {
      if (exceeds(windows[k], added)) return;
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (!exceeds(added, windows[k])) windows[kept++] = windows[k];
    }
    windows[kept] = added;
    count = kept + 1;
  }
};

}  // namespace

ExposureWindow exposure_window(const ExposedBody& body, const ExposureCell& first, std::int32_t end,
                               const ContactAction& sum) {
  ExposureWindow w;
  const double more = body.restitution - 1.0;
  w.end = end;
  w.change_mps = Eigen::Vector2d(sum.dvx_mps + more * sum.rebound_x_mps,
                                 sum.dvy_mps + more * sum.rebound_y_mps);
  const double change_mps = plane_length(w.change_mps.x(), w.change_mps.y());
  const double crush_mps = std::sqrt(std::max(0.0, sum.crush_j) / body.mass_kg);
  w.exposure_mps = std::max(change_mps, std::min(change_mps + sum.cancelled_mps, crush_mps));
  w.forward =
      Eigen::Vector2d(static_cast<double>(first.forward_x), static_cast<double>(first.forward_y));
  w.road_mps = static_cast<double>(first.road_mps);
  const double path_mps = std::max(sum.path_mps, 1e-12);
  w.edge_m = sum.edge_m2ps / path_mps;
  if (!body.is_vehicle) {
    w.struck_mps = std::max(w.exposure_mps * (1.0 + sum.light_mps / path_mps), sum.struck_mps);
    return w;
  }
  w.intrusion_m = mean_intrusion_m(sum.intruded_m3, sum.deepest_m);
  if (!(w.exposure_mps > 0.0 && change_mps > 0.0)) return w;
  const double directed = change_mps / w.exposure_mps;
  const double along = w.change_mps.dot(w.forward) / change_mps;
  w.direction.from_side = directed * (1.0 - along * along);
  w.direction.from_behind = along > 0.0 ? directed * along * along : 0.0;
  return w;
}

void list_windows(View<const ExposureCell> cells, const ExposedBody& body,
                  std::vector<ExposureWindow>& windows) {
  windows.clear();
  std::size_t to_begin = 0;
  std::size_t to_end = 0;
  std::size_t first = 0;
  std::int32_t last_begin = 0;
  WindowSet set;
  while (to_begin < cells.size()) {
    std::int32_t begin = cells[to_begin].index;
    const bool ends = to_end < cells.size() && cells[to_end].index + 1 - whole_cells < begin;
    if (ends) {
      begin = cells[to_end++].index + 1 - whole_cells;
    } else {
      ++to_begin;
    }
    if (!windows.empty() && begin == last_begin) continue;
    last_begin = begin;
    while (cells[first].index < begin) ++first;
    set.count = 0;
    ContactAction sum;
    for (std::size_t k = first; k < cells.size(); ++k) {
      const double share = share_in_window(cells[k].index - begin);
      if (!(share > 0.0)) break;
      sum.add(cells[k].action, share);
      set.add(exposure_window(body, cells[first], cells[k].index + 1, sum));
    }
    for (std::size_t k = 0; k < set.count; ++k) {
      windows.push_back(set.windows[k]);
      windows.back().begin = begin;
    }
  }
}

void SpacedSum::add(std::int32_t begin, double value) {
  const auto recent = [&](std::size_t k) -> Begin& { return recent_[(first_ + k) % kept]; };
  while (count_ > 0 && recent(0).cell <= begin - 2 * cells_per_window) {
    earlier_ = std::max(earlier_, recent(0).best);
    first_ = (first_ + 1) % kept;
    --count_;
  }
  double best = earlier_ + value;
  for (std::size_t k = 0; k < count_; ++k) {
    const std::int32_t after = begin - recent(k).cell;
    if (after <= cells_per_window) break;
    const double share = static_cast<double>(after - cells_per_window) / cells_per_window;
    best = std::max(best, recent(k).best + share * value);
  }
  recent_[(first_ + count_++) % kept] = {begin, best};
  most_ = std::max(most_, best);
}

}  // namespace crashrank::detail
