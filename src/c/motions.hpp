#pragma once

#include "c/handles.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::c {

/// Timed poses; `member` names them in errors.
inline Result<std::vector<TimedPose>> to_poses(const crashrank_timed_pose* poses, std::size_t count,
                                               const std::string& member) {
  std::vector<TimedPose> made;
  if (poses == nullptr && count > 0) {
    Error error = make_error(ErrorCode::usage, "is NULL", "it has to be given");
    error.place = member;
    return error;
  }
  if (count > scenario_limits::poses) {
    return make_error(ErrorCode::limit_exceeded, "a motion has at most 10000 poses");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Result<Pose> pose = to_pose(poses[i].pose, member + "[" + std::to_string(i) + "].pose");
    if (!pose) return pose.error();
    made.push_back({poses[i].time_s, *pose});
  }
  return made;
}

/// What crashrank_actor and crashrank_motion say of a motion; `type` is the struct's name.
template <class Given> Result<ActorMotion> to_motion(const Given& given, const std::string& type) {
  const Result<Pose> pose = to_pose(given.pose, type + ".pose");
  if (!pose) return pose.error();
  Result<std::vector<TimedPose>> poses = to_poses(given.poses, given.pose_count, type + ".poses");
  if (!poses) return poses.error();
  ActorMotion motion;
  motion.pose = *pose;
  motion.speed_mps = given.speed_mps;
  motion.acceleration_mps2 = given.acceleration_mps2;
  motion.yaw_rate_radps = given.yaw_rate_radps;
  motion.poses = std::move(*poses);
  return motion;
}

}  // namespace crashrank::c
