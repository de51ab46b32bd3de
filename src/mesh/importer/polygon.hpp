#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::importer {

/// Triangulates planar polygons by ear clipping. The polygon is projected along the axis of its
/// largest area component, and every decision about the projection is exact (`orient2d`), so a
/// polygon that does not cross itself is covered exactly: concave ones, ones with corners on a
/// straight edge, and ones whose holes are joined to the outline by edges that run there and back.
///
/// Order of the triangles: ears from corner 0 on, each as (previous, ear, next) among the corners
/// that are left, and the last three corners ascending. A convex polygon of five corners or more is
/// so a fan around its last corner; a quadrilateral is a fan around its corner that is not convex,
/// else around corner 0. Always n − 2 triangles. Time O(n log n) for convex polygons, else O(n·r)
/// for r corners that are not convex. Buffers are kept between calls; not for concurrent use.
class PolygonTriangulator {
public:
  using Corners = std::array<std::uint32_t, 3>;

  /// Triangulates the polygon of three corners or more. Coordinates must be finite. Returns false
  /// if its edges cross, seen along the axis of projection: then no triangulation covers it, and
  /// `triangles` are a guess.
  bool triangulate(const std::vector<Eigen::Vector3d>& corners);

  /// Numbers of corners of the last polygon, in its orientation.
  const std::vector<Corners>& triangles() const { return triangles_; }

private:
  enum class Ear : std::uint8_t { unknown, yes, no };
  enum class Strictness : std::uint8_t { no_touch, touch };

  const Eigen::Vector3d& at(std::uint32_t corner) const { return (*corners_)[corner]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(corners_->size()); }
  int turn(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) const;
  int turn_at(std::uint32_t corner) const;

  void choose_projection();
  bool triangulate_quadrilateral();
  bool is_convex() const;
  bool crosses_itself();
  bool edges_cross(std::uint32_t first, std::uint32_t second) const;
  bool is_before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  bool is_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c) const;
  bool passes_through(std::uint32_t corner, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b) const;
  bool corners_cross(std::uint32_t first, std::uint32_t second) const;
  bool clip_ears();
  bool is_ear(std::uint32_t corner, Strictness strictness) const;
  bool blocks(std::uint32_t corner, std::uint32_t ear, Strictness strictness) const;
  std::uint32_t find_ear(std::uint32_t from, Strictness strictness);
  std::uint32_t next_ear(std::uint32_t from);
  bool is_spike(std::uint32_t corner) const;
  std::uint32_t next_spike();
  std::uint32_t find_flat(std::uint32_t from) const;

  const std::vector<Eigen::Vector3d>* corners_ = nullptr;
  int axis_ = 2;         // of projection
  int orientation_ = 1;  // +1 if the projection is counter-clockwise
  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> previous_;
  std::vector<std::uint32_t> next_;
  std::vector<int> turns_;  // at each corner among those left
  std::vector<Ear> ears_;
  std::vector<std::uint32_t> spikes_;
  int searches_left_ = 0;
  std::vector<std::uint32_t> by_position_;  // corners that are not convex, or edges, sorted
};

}  // namespace crashrank::importer
