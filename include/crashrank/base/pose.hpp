#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/version.hpp"
#include "crashrank/base/view.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace crashrank {

/// Rigid motion: x_world = rotation · x_body + translation. Metres. Frames follow ISO 8855 and
/// REP-103: x forward, y left, z up, right-handed.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< body axes in the world, by column
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< the body's origin in the world, m
};

/// Transforms a float32 vertex in the operation order that every exact answer refers to: ((r00·x +
/// r01·y) + r02·z) + tx, each operation rounded to double, never fused.
inline Eigen::Vector3d carry(const Pose& pose, const Eigen::Vector3f& vertex) {
  const double x = vertex.x();
  const double y = vertex.y();
  const double z = vertex.z();
  const Eigen::Matrix3d& r = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  return {((r(0, 0) * x + r(0, 1) * y) + r(0, 2) * z) + t.x(),
          ((r(1, 0) * x + r(1, 1) * y) + r(1, 2) * z) + t.y(),
          ((r(2, 0) * x + r(2, 1) * y) + r(2, 2) * z) + t.z()};
}

/// The pose that applies `inner` first, then `outer`.
inline Pose compose(const Pose& outer, const Pose& inner);

/// The pose that undoes this one: world to body.
inline Pose inverse(const Pose& pose);

/// Pose of body B in the frame of body A, from both poses in the world.
inline Pose relative(const Pose& a_in_world, const Pose& b_in_world);

/// R = Rz(yaw)·Ry(pitch)·Rx(roll), then the translation. Metres and radians. Uses sine and cosine
/// of libm: bits may differ between machines, those of matrices do not.
inline Pose pose_from_angles(const Eigen::Vector3d& translation, double yaw, double pitch,
                             double roll) {
  const double cy = std::cos(yaw);
  const double sy = std::sin(yaw);
  const double cp = std::cos(pitch);
  const double sp = std::sin(pitch);
  const double cr = std::cos(roll);
  const double sr = std::sin(roll);
  Pose pose;
  pose.rotation << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,               //
      -sp, cp * sr, cp * cr;
  pose.translation = translation;
  return pose;
}

/// Largest deviation of a pose from a rigid motion: |RᵀR − 1| entrywise, or infinity when an entry
/// is not finite or the rotation mirrors.
inline double rigidity_error(const Pose& pose) {
  if (!pose.rotation.allFinite() || !pose.translation.allFinite()) return INFINITY;
  const Eigen::Matrix3d& r = pose.rotation;
  const double determinant = r.row(0).dot(r.row(1).cross(r.row(2)));
  if (!(determinant > 0.0)) return INFINITY;
  return (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

/// Poses that deviate more from a rigid motion are refused as bad input.
inline constexpr double max_rigidity_error = 1e-6;

/// Reads a row-major 4x4 matrix. Errors: bad_input for numbers that are not finite, a last row
/// other than 0 0 0 1, mirrored axes, and a deviation from a rigid motion above
/// `max_rigidity_error`. The entries keep their bits.
inline Result<Pose> pose_from_matrix(View<const double> row_major) {
  if (row_major.size() != 16) {
    return make_error(ErrorCode::bad_input, "a pose needs 16 numbers, a row-major 4x4 matrix");
  }
  Pose pose;
  const double* row = row_major.data();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.rotation(i, j) = row[j];
    pose.translation[i] = row[3];
    row += 4;
  }
  constexpr double last_row[4] = {0.0, 0.0, 0.0, 1.0};
  for (std::size_t j = 0; j < 4; ++j) {
    if (!(std::abs(row_major[12 + j] - last_row[j]) <= max_rigidity_error)) {
      return make_error(ErrorCode::bad_input, "the last row of a pose has to be 0 0 0 1",
                        "write the matrix row-major, translation in the last column");
    }
  }
  if (!(rigidity_error(pose) <= max_rigidity_error)) {
    return make_error(ErrorCode::bad_input,
                      "the matrix is not a rigid motion (off by more than 1e-6, mirrored, or not "
                      "finite)",
                      "orthonormalise the rotation; scale belongs to the model");
  }
  return pose;
}

}  // namespace crashrank

#include "crashrank/internal/base/pose-inl.hpp"
