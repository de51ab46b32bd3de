#include "crash/motion_record.hpp"

namespace crashrank::detail {

Pose moved_pose(const Pose& given, const Eigen::Vector3d& center, const PlanarPlace& start,
                const PlanarPlace& now) {
  Pose pose = given;
  pose.translation.x() += now.x - start.x;
  pose.translation.y() += now.y - start.y;
  pose.translation.z() += ground_rise(given).dot(Eigen::Vector2d(now.x - start.x, now.y - start.y));
  if (now.cosine == start.cosine && now.sine == start.sine) return pose;
  // The origin rotates about the centre of mass by the change of heading since the start.
  pose.translation.x() +=
      (start.cosine - now.cosine) * center.x() - (start.sine - now.sine) * center.y();
  pose.translation.y() +=
      (start.sine - now.sine) * center.x() + (start.cosine - now.cosine) * center.y();
  const double cosine = now.cosine * start.cosine + now.sine * start.sine;
  const double sine = now.sine * start.cosine - now.cosine * start.sine;
  for (int column = 0; column < 3; ++column) {
    const double x = given.rotation(0, column);
    const double y = given.rotation(1, column);
    pose.rotation(0, column) = cosine * x - sine * y;
    pose.rotation(1, column) = sine * x + cosine * y;
  }
  return pose;
}

void MotionRecord::begin(const PlanarBody& first, const PlanarBody& second) {
  last_ = {0.0, place_of(first), place_of(second)};
  entries_[0] = last_;
  count_ = 1;
  steps_ = 0;
  stride_ = 1;
}

void MotionRecord::add(double time_s, const PlanarBody& first, const PlanarBody& second) {
  last_ = {time_s, place_of(first), place_of(second)};
  if (steps_ % stride_ == 0) {
    if (count_ == entries_.size()) {
      // Entries 1, 2, ... hold steps 0, stride, 2·stride, ...: keep the even multiples of the
      // stride.
      count_ = 1;
      for (std::size_t i = 1; i < entries_.size(); i += 2) entries_[count_++] = entries_[i];
      stride_ *= 2;
    }
    if (steps_ % stride_ == 0) entries_[count_++] = last_;
  }
  ++steps_;
}

ContactMotion MotionRecord::motion(const ContactBody& first, const ContactBody& second,
                                   bool swapped) const {
  ContactMotion motion;
  const Entry& start = entries_[0];
  const auto pose_of = [](const ContactBody& given, const PlanarPlace& from,
                          const PlanarPlace& to) {
    return moved_pose(given.pose, given.vehicle->center_m, from, to);
  };
  const auto add_poses = [&](const Entry& entry) {
    ContactPoses& poses = motion.poses[motion.count++];
    poses.time_s = entry.time_s;
    (swapped ? poses.b : poses.a) = pose_of(first, start.first, entry.first);
    (swapped ? poses.a : poses.b) = pose_of(second, start.second, entry.second);
  };
  for (std::size_t i = 0; i < count_; ++i) add_poses(entries_[i]);
  if (last_.time_s > entries_[count_ - 1].time_s) add_poses(last_);
  return motion;
}

}  // namespace crashrank::detail
