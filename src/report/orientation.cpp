#include "report/orientation.hpp"

#include "report/body_front.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// The words of a name in lower case: "Wheel_Front-Left2" has wheel, front and left.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  bool inside = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool letter = std::isalpha(c) != 0;
    const bool begins =
        i > 0 && std::isupper(c) != 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if (letter && (!inside || begins)) words.emplace_back();
    if (letter) words.back() += static_cast<char>(std::tolower(c));
    inside = letter;
  }
  return words;
}

template <std::size_t count>
bool any_of(const std::vector<std::string>& words,
            const std::array<std::string_view, count>& sought) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(sought.begin(), sought.end(), word) != sought.end();
  });
}

bool names_wheel(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 6> wheels{"wheel", "wheels", "tyre",
                                                   "tyres", "tire",   "tires"};
  constexpr std::array<std::string_view, 6> others{"steering", "housing", "house",
                                                   "arch",     "spare",   "well"};
  return any_of(words, wheels) && !any_of(words, others);
}

/// 1 for parts at the front, -1 for parts at the rear, 0 for others.
int end_of(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 14> front{
      "front",      "hood",       "bonnet", "headlamp", "headlamps", "headlight", "headlights",
      "windshield", "windscreen", "grille", "grill",    "radiator",  "fl",        "fr"};
  constexpr std::array<std::string_view, 13> rear{
      "rear",       "back",     "trunk",   "boot", "tail", "taillight", "taillamp",
      "taillights", "tailgate", "exhaust", "rl",   "rr",   "bl"};
  const bool at_front = any_of(words, front);
  return at_front == any_of(words, rear) ? 0 : (at_front ? 1 : -1);
}

/// Middle of the surface of parts.
struct Middle {
  Vector3d sum = Vector3d::Zero();
  double area_m2 = 0.0;

  void add(const TriangleMesh& mesh, const Part& part) {
    for (std::uint32_t i = 0; i < part.triangle_count; ++i) {
      const auto& t = mesh.triangles[part.first_triangle + i];
      const Vector3d a = mesh.vertices[t[0]].cast<double>();
      const Vector3d b = mesh.vertices[t[1]].cast<double>();
      const Vector3d c = mesh.vertices[t[2]].cast<double>();
      const double area = 0.5 * (b - a).cross(c - a).norm();
      sum += area / 3.0 * (a + b + c);
      area_m2 += area;
    }
  }
  bool known() const { return area_m2 > 0.0; }
  Vector3d at() const { return sum / area_m2; }
};

Box bounds_of(const TriangleMesh& mesh, const Part& part) {
  Box box;
  for (std::uint32_t i = 0; i < part.triangle_count; ++i) {
    for (const std::uint32_t v : mesh.triangles[part.first_triangle + i]) {
      box.grow(mesh.vertices[v]);
    }
  }
  return box;
}

struct NamedParts {
  Middle wheels;
  Middle front;
  Middle rear;
  std::vector<Box> wheel_boxes;
};

NamedParts named_parts(const TriangleMesh& mesh) {
  NamedParts named;
  for (const Part& part : mesh.parts) {
    const std::vector<std::string> words = words_of(part.name);
    if (names_wheel(words)) {
      named.wheels.add(mesh, part);
      named.wheel_boxes.push_back(bounds_of(mesh, part));
    }
    if (const int end = end_of(words); end != 0) {
      (end > 0 ? named.front : named.rear).add(mesh, part);
    }
  }
  return named;
}

/// The axis along which a vector is longest as shares of the extents, as a unit vector; zero where
/// it is shorter than `least`. `not_along`: an axis that is left out.
Vector3d main_axis(const Vector3d& v, const Vector3d& extent, double least,
                   const Vector3d& not_along) {
  const Vector3d share = v.array() / extent.array().max(1e-9) * (1.0 - not_along.array().abs());
  int axis = 0;
  Vector3d unit = Vector3d::Zero();
  if (share.cwiseAbs().maxCoeff(&axis) > least) unit[axis] = share[axis] < 0.0 ? -1.0 : 1.0;
  return unit;
}

/// The axis of the height of a body without named parts. Its left and right are alike, its upper
/// and lower half are not: the middle of its surface lies off the middle of its height. Where that
/// does not decide, by proportions: cars are wider than high; lorries, buses and trams, beyond the
/// width of any car, mostly higher than wide. `z` where nothing contradicts it.
int height_axis(const TriangleMesh& mesh, const Vector3d& extent_m) {
  constexpr double least_ratio = 1.2;
  constexpr double widest_car_m = 2.5;
  constexpr double shortest_m = 3.0;  // below it two-wheelers are higher than wide
  constexpr double least_shift = 0.03;
  int length = 0;
  extent_m.maxCoeff(&length);
  const bool upright =
      length == 2 && extent_m[2] > least_ratio * std::max(extent_m[0], extent_m[1]);
  const int a = upright ? 0 : (length == 0 ? 1 : 0);
  const int b = upright ? 1 : 2;
  if (!upright && (extent_m[length] < shortest_m || extent_m[2] < 1.05 * extent_m[a])) return 2;
  Middle all;
  all.add(mesh, {"", 0, static_cast<std::uint32_t>(mesh.size())});
  Vector3d shift = Vector3d::Zero();
  if (all.known()) {
    shift = (all.at() - mesh.bounds().center().cast<double>()).cwiseAbs();
    shift = shift.array() / mesh.bounds().extent().cast<double>().array().max(1e-9);
  }
  // As wide one way as the other and even all round: a tree.
  const double widest_m = std::max(extent_m[a], extent_m[b]);
  if (upright && std::min(extent_m[a], extent_m[b]) > 0.95 * widest_m &&
      std::max(shift[a], shift[b]) < 0.01) {
    return 2;
  }
  for (const auto& [height, width] : {std::pair{a, b}, std::pair{b, a}}) {
    if (shift[height] > least_shift && shift[height] > 3.0 * shift[width]) return height;
  }
  const bool car = widest_m < widest_car_m;
  return (extent_m[a] < extent_m[b]) == car ? a : b;
}

/// The end of the height at which the body is narrower: its roof.
double roof_side(const TriangleMesh& mesh, int height, int width) {
  const Box box = mesh.bounds();
  const Vector3d middle = box.center().cast<double>();
  const Vector3d extent = box.extent().cast<double>();
  std::array<double, 2> reach{};  // of the lowest and the highest quarter
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d at = vertex.cast<double>() - middle;
    if (std::abs(at[height]) < 0.25 * extent[height]) continue;
    double& most = reach[at[height] > 0.0 ? 1 : 0];
    most = std::max(most, std::abs(at[width]));
  }
  return reach[1] <= reach[0] ? 1.0 : -1.0;
}

/// The file's axis that became a body axis.
Axis file_axis(const ImportTransform& transform, const Vector3d& unit) {
  const Vector3d forward = direction(transform.forward);
  const Vector3d up = direction(transform.up);
  const Vector3d file = unit.x() * forward + unit.y() * up.cross(forward) + unit.z() * up;
  int axis = 0;
  file.cwiseAbs().maxCoeff(&axis);
  return static_cast<Axis>(2 * axis + (file[axis] < 0.0 ? 1 : 0));
}

/// A body axis that the file's axis became.
Vector3d body_axis(const ImportTransform& transform, Axis axis) {
  const Vector3d forward = direction(transform.forward);
  const Vector3d up = direction(transform.up);
  const Vector3d file = direction(axis);
  return {file.dot(forward), file.dot(up.cross(forward)), file.dot(up)};
}

/// Factor that makes a vehicle of what is none: from millimetres, centimetres, inches or feet.
std::optional<double> unit_factor(const Vector3d& extent) {
  constexpr std::array<double, 5> units{1.0, 0.001, 0.01, 0.0254, 0.3048};
  if (has_vehicle_size(extent)) return 1.0;
  // Most vehicles are no smaller; some two-wheelers and microcars are.
  for (const Vector3d& least_m : {Vector3d(1.15, 1.55, 2.4), Vector3d(0.5, 1.0, 1.5)}) {
    for (const double factor : units) {
      Vector3d sides_m = factor * extent;
      std::sort(sides_m.data(), sides_m.data() + 3);
      if (has_vehicle_size(sides_m) && (sides_m.array() >= least_m.array()).all()) return factor;
    }
  }
  return std::nullopt;
}

/// Factor for the models of games, in no unit: a car's length, to one digit.
double game_factor(const Vector3d& extent) {
  constexpr double car_m = 4.5;
  const double factor = car_m / std::max(extent.maxCoeff(), 1e-9);
  if (!std::isfinite(factor)) return 1.0;
  const double digit = std::pow(10.0, std::floor(std::log10(factor)));
  return std::round(factor / digit) * digit;
}

// Passenger cars from kei cars to large saloons, mirrors included, and their tyres.
constexpr std::array<double, 2> car_length_m{3.4, 5.2};
constexpr std::array<double, 2> car_width_m{1.5, 2.1};
constexpr std::array<double, 2> car_wheel_m{0.55, 0.8};

/// Sets the scales at which a body of two tracks that is shorter than all cars would be one, where
/// there are any. `unscaled` is its box before the guess of its unit, in axes `forward` and `up`.
void guess_car_scale(const NamedParts& named, const Vector3d& middle, const Vector3d& unscaled,
                     const Vector3d& forward, const Vector3d& up, double applied_scale,
                     MeshReading& reading) {
  constexpr double shortest_m = 3.0;
  constexpr double least_off_middle = 0.2;  // of the width
  const Vector3d across = up.cross(forward);
  const auto along = [](const Vector3d& size, const Vector3d& axis) {
    return std::abs(size.dot(axis));
  };
  reading.length_m = reading.scale / applied_scale * along(unscaled, forward);
  const double width = along(unscaled, across);
  double diameter = 0.0;
  bool two_tracks = false;
  for (const Box& box : named.wheel_boxes) {
    diameter = std::max(diameter, along(box.extent().cast<double>(), up));
    two_tracks |= along(box.center().cast<double>() - middle, across) > least_off_middle * width;
  }
  if (!two_tracks || reading.length_m >= shortest_m) return;
  double least = 0.0;
  double most = 1e9;
  for (const auto& [size, usual_m] :
       {std::pair{along(unscaled, forward), car_length_m}, std::pair{width, car_width_m},
        std::pair{diameter, car_wheel_m}}) {
    least = std::max(least, usual_m[0] / size);
    most = std::min(most, usual_m[1] / size);
  }
  if (least > most) return;
  reading.least_car_scale = applied_scale * least;
  reading.most_car_scale = applied_scale * most;
}

}  // namespace

bool MeshReading::has_axes_of(const ImportTransform& transform) const {
  if (up != transform.up) return false;
  return front_known ? forward == transform.forward
                     : direction(forward).cwiseAbs() == direction(transform.forward).cwiseAbs();
}

bool MeshReading::has_scale_of(const ImportTransform& transform) const {
  return std::abs(scale - transform.scale) <= 1e-9 * scale;
}

std::string MeshReading::options() const {
  return fmt::format("--scale {:g} --up {} --forward {}", scale, axis_name(up), axis_name(forward));
}

std::string MeshReading::size_doubt() const {
  if (most_car_scale == 0.0) return {};
  return fmt::format(
      "as a car it is small, {:.2f} m long; most are {:g} to {:g} m: --scale {:.2g} to {:.2g} "
      "would "
      "make its length, width and wheels a car's; in a scenario scale, and origin_m and "
      "wheelbase_m as many times as large",
      length_m, car_length_m[0], car_length_m[1], least_car_scale, most_car_scale);
}

MeshReading guess_reading(const TriangleMesh& mesh, const ImportTransform& transform,
                          bool is_gltf) {
  const Vector3d unscaled = mesh.bounds().extent().cast<double>();
  const NamedParts named = named_parts(mesh);
  MeshReading reading;
  const std::optional<double> unit = unit_factor(unscaled);
  const double factor = unit.value_or(named.wheels.known() ? game_factor(unscaled) : 1.0);
  reading.scale = transform.scale * factor;
  const Vector3d extent_m = factor * unscaled;
  const Vector3d middle = mesh.bounds().center().cast<double>();
  const auto along = [&](const Middle& from, const Middle& to) -> Vector3d {
    return (to.known() ? to.at() : middle) - (from.known() ? from.at() : middle);
  };
  constexpr double least_share = 0.12;
  const Vector3d none = Vector3d::Zero();
  Vector3d forward = none;
  Vector3d up = none;
  // One end alone may be the trunk of a tree.
  if (named.wheels.known() || (named.front.known() && named.rear.known())) {
    forward = main_axis(along(named.rear, named.front), unscaled, least_share, none);
    // Between lamps and sills, say, the height differs as well: a vehicle is longer than high.
    int axis = 0;
    forward.cwiseAbs().maxCoeff(&axis);
    if (extent_m[axis] < 0.5 * extent_m.maxCoeff()) forward = none;
  }
  if (named.wheels.known()) {
    up = main_axis(middle - named.wheels.at(), unscaled, least_share, forward);
  }
  reading.front_known = forward != none;
  reading.shown_by = up != none || forward != none ? "its parts" : "its size";
  // What parts do not show, the format says unless proportions contradict it.
  const Vector3d format_up = body_axis(transform, Axis::plus_y);
  const Vector3d format_forward = body_axis(transform, Axis::plus_z);
  const auto extent_along = [&](const Vector3d& axis) { return axis.cwiseAbs().dot(extent_m); };
  const bool as_format = is_gltf && extent_along(format_forward) > 0.8 * extent_m.maxCoeff();
  int height = 2;
  if (up == none && as_format && (forward == none || forward.dot(format_up) == 0.0)) {
    up = format_up;
    if (forward == none) reading.shown_by = "the format";
  } else if (up == none) {
    height = height_axis(mesh, extent_m);
    if (forward != none && std::abs(forward[height]) > 0.0) height = (height + 1) % 3;
    up[height] = 1.0;
    if (height != 2) {
      int length = 0;
      extent_m.maxCoeff(&length);
      up[height] = roof_side(mesh, height, length == height ? 2 : 3 - length - height);
    }
  }
  if (forward == none && as_format && format_forward.dot(up) == 0.0) {
    forward = format_forward;
    reading.front_known = true;
  } else if (forward == none) {
    constexpr double least_ratio = 1.2;
    const Vector3d level_m = extent_m.array() * (1.0 - up.array().abs());
    int length = 0;
    if (level_m.maxCoeff(&length) <= least_ratio * level_m.x()) length = 0;
    forward[length] = 1.0;
    if (const int front = front_by_shape(mesh, forward, up); front != 0) {
      forward *= front;
      reading.front_known = true;
      reading.shown_by = named.wheels.known() ? "its parts and shape" : "its shape";
    }
  }
  // Wheelchairs and trolleys have wheels as well, but no car is higher than long.
  if (!unit && extent_along(up) > extent_along(forward)) reading.scale = transform.scale;
  guess_car_scale(named, middle, unscaled, forward, up, transform.scale, reading);
  reading.up = file_axis(transform, up);
  reading.forward = file_axis(transform, forward);
  return reading;
}

bool is_gltf_file(const std::string& path) {
  const auto ends_with = [&](std::string_view end) {
    return path.size() >= end.size() &&
           std::equal(end.begin(), end.end(), path.end() - static_cast<std::ptrdiff_t>(end.size()),
                      [](char a, char b) {
                        return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
                      });
  };
  return ends_with(".gltf") || ends_with(".glb");
}

bool has_wheels(const TriangleMesh& mesh) {
  return std::any_of(mesh.parts.begin(), mesh.parts.end(),
                     [](const Part& part) { return names_wheel(words_of(part.name)); });
}

bool has_vehicle_size(const Vector3d& extent_m) {
  const double length = extent_m.maxCoeff();
  const double least = extent_m.minCoeff();
  const double between = extent_m.sum() - length - least;
  return length >= 1.5 && length <= 60.0 && least >= 0.5 && between >= 1.0 && between <= 4.5;
}

}  // namespace crashrank::detail
