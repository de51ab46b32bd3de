#pragma once

#include "rank/contact_severity.hpp"
#include "rank/scene.hpp"

#include <vector>

namespace crashrank::detail {

/// The ego from a contact on: through the crash, then as it leaves it, slowed evenly to standstill.
class Aftermath {
public:
  /// Begun with a contact: `ego` at it, `start_s` its time, and what the crash made of the ego. One
  /// object serves any number, one after another.
  void begin(const Scene& scene, const Candidate& candidate, double start_s,
             const EgoAtContact& ego, const EgoAfterContact& after);
  /// Room for all that begin in a scene.
  void prepare(const Scene& scene);

  /// Rests at the contact's pose before it.
  const Motion& motion() const { return motion_; }
  /// Nothing is followed past this time.
  double until_s() const { return until_s_; }
  /// The ego at a time in [start, until].
  EgoAtContact at(double time_s) const;

private:
  /// Of the centre of mass, once the crash is over, at a time since then.
  Velocity slowed(double since_s) const;
  Pose pose(double since_s) const;

  double start_s_ = 0.0;
  double until_s_ = 0.0;
  EgoAtContact ego_;
  EgoAfterContact after_;
  Eigen::Vector3d center_in_body_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d center_m_ = Eigen::Vector3d::Zero();  ///< when the crash is over
  Eigen::Matrix3d turned_ = Eigen::Matrix3d::Identity();
  double deceleration_mps2_ = 0.0;
  double spin_deceleration_radps2_ = 0.0;
  Motion motion_;
  std::vector<TimedPose> poses_;
};

}  // namespace crashrank::detail
