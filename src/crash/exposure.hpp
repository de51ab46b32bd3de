#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/crash/injury.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Contact forces within such a time are one impact, s: event data recorders report the greatest
/// change of velocity within 300 ms (49 CFR 563.8).
inline constexpr double exposure_window_s = 0.3;
/// Time cells of a window. Forces are summed over each cell.
inline constexpr int cells_per_window = 16;
inline constexpr double exposure_cell_s = exposure_window_s / cells_per_window;
/// Cells over which the share of a force in a window fades, about the end of the window.
inline constexpr int cells_of_fading = 6;
/// Cells of a window in which forces count whole, and in which they count at all.
inline constexpr int whole_cells = cells_per_window - cells_of_fading / 2;
inline constexpr int most_cells_of_window = cells_per_window + cells_of_fading / 2;

/// Share with which a force counts in a window that begins `cells` cells before: 1 in the first
/// 0.24 s, falling in a straight line to 0 at 0.36 s, so that the sum of all shares is
/// `cells_per_window` and a second impact does not leave the window of the first at once.
constexpr double share_in_window(std::int32_t cells) {
  return std::clamp((most_cells_of_window - 0.5 - cells) / cells_of_fading, 0.0, 1.0);
}

/// Mass of the vehicle whose full hits the injury curves of people outside cars describe, kg.
inline constexpr double striking_car_kg = 1500.0;

/// What contact forces did to a body in some time. All members but one are sums over its contacts.
struct ContactAction {
  double dvx_mps = 0.0;  ///< change of its velocity, world axes
  double dvy_mps = 0.0;
  double rebound_x_mps = 0.0;  ///< part of it by restitution
  double rebound_y_mps = 0.0;
  double path_mps = 0.0;       ///< sum of the magnitudes of the impulses over its mass
  double cancelled_mps = 0.0;  ///< half of what the impulses cancel of each other, over its mass
  double crush_j = 0.0;        ///< energy that crushed it
  /// `path_mps` weighted by the body's mass over that of the other body, or over
  /// `striking_car_kg` if that is larger.
  double light_mps = 0.0;
  /// Person on foot: exposure by the part that is struck, see `struck_part_mps`, as a hit by a car
  /// gives it to all of the body; the greatest.
  double struck_mps = 0.0;
  double edge_m2ps = 0.0;    ///< `path_mps` weighted by the leading edge of the other body
  double intruded_m3 = 0.0;  ///< volume of its compartment that is crushed
  double deepest_m = 0.0;    ///< increase of its deepest intrusion

  void add(const ContactAction& more, double share);
};

/// The action on a body in one time cell.
struct ExposureCell {
  std::int32_t index = 0;  ///< it begins `index`·`exposure_cell_s` after the begin of the scene
  float forward_x = 1.0F;  ///< forward axis of the body at its first force in the cell
  float forward_y = 0.0F;
  float road_mps = 0.0F;  ///< its speed before that force
  ContactAction action;
};

/// The cells of one body in which a contact force acted on it, in constant memory.
class ExposureRecord {
public:
  static constexpr std::size_t most_cells = 512;  ///< later forces are not recorded

  void prepare() { cells_.reserve(most_cells); }
  void begin() { cells_.clear(); }
  /// Adds the action of a step, spread evenly over its time; times since the begin of the scene,
  /// rising. `state` gives heading and speed at its begin. Returns false if the record is full.
  bool add(double begin_s, double end_s, const ExposureCell& state, const ContactAction& action);
  View<const ExposureCell> cells() const noexcept { return {cells_.data(), cells_.size()}; }

private:
  std::vector<ExposureCell> cells_;
};

/// What a body lives through in a time of about `exposure_window_s`, see `share_in_window`.
struct ExposureWindow {
  std::int32_t begin = 0;     ///< first cell
  std::int32_t end = 0;       ///< cell after the last
  double exposure_mps = 0.0;  ///< see `list_windows`
  /// Speed at which a hit by a car gives that exposure to a person outside cars; of people on foot
  /// at least `ContactAction::struck_mps`.
  double struck_mps = 0.0;
  double edge_m = 0.0;  ///< mean leading edge of what hits the body
  /// Of the change of velocity. The share of the exposure that exceeds it has none.
  ForceDirection direction;
  double intrusion_m = 0.0;  ///< into its compartment, mean over a person's area
  double road_mps = 0.0;     ///< speed of the body before its first force
  Eigen::Vector2d change_mps = Eigen::Vector2d::Zero();  ///< change of its velocity
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();    ///< forward axis at its first force
};

/// Properties of a body that its windows depend on.
struct ExposedBody {
  double mass_kg = 0.0;
  bool is_vehicle = true;    ///< people are inside it
  double restitution = 1.0;  ///< factor on the restitution that was simulated
};

/// Intrusion of a crushed volume that is nowhere deeper than `deepest_m`: the mean over the area of
/// a seated person, m.
inline double mean_intrusion_m(double intruded_m3, double deepest_m) {
  constexpr double person_m2 = 0.45 * 0.65;
  return std::min(intruded_m3 / person_m2, deepest_m);
}

/// The window that ends before cell `end` and in which the sum of all actions, each with its share,
/// is `sum`; `first` is its first cell. Its begin is not set. See `list_windows`.
ExposureWindow exposure_window(const ExposedBody& body, const ExposureCell& first, std::int32_t end,
                               const ContactAction& sum);

/// Lists the windows of a body in the order of their begins. With the change of velocity dV by
/// contact forces within a window, the part C of it that forces of several contacts cancel, the
/// crush energy W and the mass m, the exposure is
///
///   E = max(|dV|, min(|dV| + C, sqrt(W/m)))
///
/// so a body that is squeezed between two others is exposed to the speed that its crush on each
/// side stands for. All are sums in which forces count with `share_in_window`. A window begins with
/// a force and ends with one. Of windows with the same begin those are left out that another
/// exceeds in every quantity that harm depends on, in the sense that the risk of injury cannot be
/// higher. Every window of the first cells of a record remains one when cells are added, or is
/// exceeded. Linear in the number of cells; allocates only beyond the capacity of `windows`.
void list_windows(View<const ExposureCell> cells, const ExposedBody& body,
                  std::vector<ExposureWindow>& windows);

/// Capacity for the windows of any record with up to 8 for every begin.
inline constexpr std::size_t most_windows = 16 * ExposureRecord::most_cells;

/// Sum over separate impacts: the largest sum of `of_window` over windows in the order of time, in
/// which each counts with the share clamp(d/T - 1, 0, 1), where d is the time from the begin of the
/// one before to its own begin and T `exposure_window_s`; the first counts whole. It never falls
/// when windows are added, and is continuous in their times. Linear in the number of windows.
class SpacedSum {
public:
  /// Adds the largest value of the windows that begin in a cell; begins have to rise.
  void add(std::int32_t begin, double value);
  double sum() const noexcept { return most_; }

private:
  static constexpr std::size_t kept = std::size_t{2} * cells_per_window;
  struct Begin {
    std::int32_t cell = 0;
    double best = 0.0;  ///< largest sum that ends with its window
  };
  std::array<Begin, kept> recent_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  double earlier_ = 0.0;  ///< largest sum of begins at least two windows ago
  double most_ = 0.0;
};

/// `SpacedSum` of a value of every window of a list.
template <typename Value>
double spaced_sum(const std::vector<ExposureWindow>& windows, Value&& value) {
  SpacedSum sum;
  for (std::size_t k = 0; k < windows.size();) {
    const std::int32_t begin = windows[k].begin;
    double most = 0.0;
    for (; k < windows.size() && windows[k].begin == begin; ++k) {
      most = std::max(most, value(windows[k]));
    }
    sum.add(begin, most);
  }
  return sum.sum();
}

}  // namespace crashrank::detail
