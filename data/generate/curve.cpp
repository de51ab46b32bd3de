#include "curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace generate {
namespace {

constexpr double cell_size = 0.03;
constexpr double margin = 0.3;  // of the cells around the outline

}  // namespace

Outline::Outline(const std::vector<Vec2>& control, int per_span) {
  const std::size_t n = control.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& a = control[(i + n - 1) % n];
    const Vec2& b = control[i];
    const Vec2& c = control[(i + 1) % n];
    const Vec2& d = control[(i + 2) % n];
    for (int k = 0; k < per_span; ++k) {
      const double t = static_cast<double>(k) / per_span;
      const double u = 1.0 - t;
      const Vec2 p = (u * u * u * a + (3.0 * t * t * t - 6.0 * t * t + 4.0) * b +
                      (3.0 * u * u * u - 6.0 * u * u + 4.0) * c + t * t * t * d) /
                     6.0;
      if (points_.empty() || (p - points_.back()).norm() > 1e-6) points_.push_back(p);
    }
  }
  Vec2 low = points_.front();
  Vec2 high = points_.front();
  for (const Vec2& p : points_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  origin_ = low - Vec2::Constant(margin);
  columns_ = static_cast<int>((high.x() + margin - origin_.x()) / cell_size) + 1;
  rows_ = static_cast<int>((high.y() + margin - origin_.y()) / cell_size) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  const double reach = cell_size * 0.7072;
  std::vector<double> distance(points_.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Vec2 middle = origin_ + cell_size * Vec2(column + 0.5, row + 0.5);
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t s = 0; s < points_.size(); ++s) {
        distance[s] = std::sqrt(segment_distance_squared(middle, static_cast<int>(s)));
        nearest = std::min(nearest, distance[s]);
      }
      Cell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
      for (std::size_t s = 0; s < points_.size(); ++s) {
        if (distance[s] <= nearest + 2.0 * reach + 1e-9) cell.near.push_back(static_cast<int>(s));
      }
      if (nearest > reach + 1e-9) cell.side = inside(middle) ? -1 : 1;
      const double slack = reach + 1e-9;
      cell.least = cell.side > 0 ? nearest - slack : -nearest - slack;
      cell.most = cell.side < 0 ? slack - nearest : nearest + slack;
    }
  }
}

double Outline::segment_distance_squared(const Vec2& point, int segment) const {
  const Vec2& a = points_[static_cast<std::size_t>(segment)];
  const Vec2& b = points_[(static_cast<std::size_t>(segment) + 1) % points_.size()];
  const Vec2 along = b - a;
  const double t = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - a - t * along).squaredNorm();
}

bool Outline::inside(const Vec2& point) const {
  bool result = false;
  for (std::size_t i = 0, j = points_.size() - 1; i < points_.size(); j = i++) {
    const Vec2& a = points_[i];
    const Vec2& b = points_[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
    if (point.x() < x) result = !result;
  }
  return result;
}

double Outline::exact_distance(const Vec2& point, const std::vector<int>* candidates,
                               int side) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (candidates != nullptr) {
    for (const int s : *candidates) nearest = std::min(nearest, segment_distance_squared(point, s));
  } else {
    for (std::size_t s = 0; s < points_.size(); ++s) {
      nearest = std::min(nearest, segment_distance_squared(point, static_cast<int>(s)));
    }
  }
  const double distance = std::sqrt(nearest);
  if (side == 0) side = inside(point) ? -1 : 1;
  return side * distance;
}

const Outline::Cell* Outline::cell_of(const Vec2& point) const {
  const double column = std::floor((point.x() - origin_.x()) / cell_size);
  const double row = std::floor((point.y() - origin_.y()) / cell_size);
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nullptr;
  return &cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(column)];
}

double Outline::distance(const Vec2& point) const {
  const Cell* cell = cell_of(point);
  if (cell == nullptr) return exact_distance(point, nullptr, 1);
  return exact_distance(point, &cell->near, cell->side);
}

double Outline::distance_within(const Vec2& point, double low, double high) const {
  const Cell* cell = cell_of(point);
  if (cell == nullptr) return high < margin ? margin : exact_distance(point, nullptr, 1);
  if (cell->most < low) return cell->most;
  if (cell->least > high) return cell->least;
  return exact_distance(point, &cell->near, cell->side);
}

Outline polygon(const std::vector<Vec2>& corners) {
  std::vector<Vec2> control;
  for (const Vec2& corner : corners) control.insert(control.end(), 3, corner);
  return Outline(control, 4);
}

Outline rounded_polygon(const std::vector<Vec2>& corners) {
  std::vector<Vec2> control;
  for (const Vec2& corner : corners) control.insert(control.end(), 2, corner);
  return Outline(control, 6);
}

Ramp::Ramp(std::initializer_list<std::pair<double, double>> knots) {
  for (const auto& [x, y] : knots) {
    x_.push_back(x);
    y_.push_back(y);
  }
  const std::size_t n = x_.size();
  slope_.assign(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = (y_[i] - y_[i - 1]) / (x_[i] - x_[i - 1]);
    const double after = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
    if (before * after > 0.0) slope_[i] = 2.0 * before * after / (before + after);
  }
  if (n > 1) {
    slope_[0] = (y_[1] - y_[0]) / (x_[1] - x_[0]);
    slope_[n - 1] = (y_[n - 1] - y_[n - 2]) / (x_[n - 1] - x_[n - 2]);
  }
}

double Ramp::operator()(double x) const {
  if (x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const auto after = std::upper_bound(x_.begin(), x_.end(), x);
  const std::size_t i = static_cast<std::size_t>(after - x_.begin()) - 1;
  const double width = x_[i + 1] - x_[i];
  const double t = (x - x_[i]) / width;
  const double u = 1.0 - t;
  return y_[i] * (1.0 + 2.0 * t) * u * u + y_[i + 1] * (3.0 - 2.0 * t) * t * t +
         width * t * u * (slope_[i] * u - slope_[i + 1] * t);
}

}  // namespace generate
