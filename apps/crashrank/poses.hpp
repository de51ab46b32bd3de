#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"

#include <string>
#include <vector>

namespace crashrank::cli {

/// "x,y,z,yaw,pitch,roll" in metres and degrees: R = Rz(yaw)·Ry(pitch)·Rx(roll), then the
/// translation. Errors: usage.
Result<Pose> parse_pose_option(const std::string& text);

/// One row-major 4x4 matrix of B in A a line, 16 numbers separated by spaces or commas. Empty lines
/// and lines that begin with # are skipped. "-" is standard input. Errors name the line.
Result<std::vector<Pose>> read_poses(const std::string& path);

}  // namespace crashrank::cli
