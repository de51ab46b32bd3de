#include "report/page_track.hpp"

#include "crashrank/scenario/candidate.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

/// Leaves out samples that lie within the tolerances of a line between those that stay. Greedy;
/// a stretch has at most 64 samples, so that it is linear in their number.
template <std::size_t values>
std::vector<Sample<values>> straightened(const std::vector<Sample<values>>& all,
                                         const std::array<double, values>& tolerance) {
  constexpr std::size_t longest = 64;
  std::vector<Sample<values>> kept;
  const auto is_straight = [&](std::size_t first, std::size_t last) {
    const double whole_s = all[last].time_s - all[first].time_s;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = whole_s > 0.0 ? (all[i].time_s - all[first].time_s) / whole_s : 0.0;
      for (std::size_t k = 0; k < values; ++k) {
        const double line = all[first].at[k] + share * (all[last].at[k] - all[first].at[k]);
        if (std::abs(line - all[i].at[k]) > tolerance[k]) return false;
      }
    }
    return true;
  };
  for (std::size_t first = 0; first < all.size();) {
    kept.push_back(all[first]);
    std::size_t next = first + 1;
    while (next + 1 < all.size() && next + 1 - first <= longest && is_straight(first, next + 1)) {
      ++next;
    }
    first = next;
  }
  return kept;
}

long long rounded(double value, double steps) { return std::llround(value * steps); }

/// Adds full turns, so that no heading is more than half a turn from the one before.
Track without_jumps(Track track) {
  constexpr double full_turn = 6.283185307179586;
  for (std::size_t i = 1; i < track.size(); ++i) {
    double& heading = track[i].at[3];
    heading += full_turn * std::round((track[i - 1].at[3] - heading) / full_turn);
  }
  return track;
}

double heading_rad(const Pose& pose) {
  return std::atan2(pose.rotation(1, 0), pose.rotation(0, 0));
}

/// When the bodies of a simulation stand for good, s; 0 without any.
double rest_time_s(const std::vector<BodyMotion>& motions) {
  constexpr double slow_mps = 0.05;
  double rest_s = 0.0;
  for (const BodyMotion& motion : motions) {
    for (std::size_t i = motion.t_s.size(); i-- > 0;) {
      if (std::hypot(motion.vx_mps[i], motion.vy_mps[i]) < slow_mps &&
          std::abs(motion.yaw_rate_radps[i]) < slow_mps) {
        continue;
      }
      rest_s = std::max(rest_s, motion.t_s[i]);
      break;
    }
  }
  return rest_s;
}

}  // namespace

Track track_of(const Motion& motion, double until_s) {
  constexpr double step_s = 0.05;
  Track track;
  const int steps = std::max(1, static_cast<int>(std::ceil(until_s / step_s)));
  for (int i = 0; i <= steps; ++i) {
    const double time_s = until_s * i / steps;
    const Pose pose = motion.pose_at(time_s);
    const Eigen::Vector3d& at = pose.translation;
    track.push_back({time_s, {at.x(), at.y(), at.z(), heading_rad(pose)}});
  }
  return without_jumps(std::move(track));
}

Track track_of(const BodyMotion& simulated, const Motion& plan) {
  Track track;
  if (simulated.t_s.empty()) return track;
  const Pose start = plan.pose_at(simulated.t_s.front());
  const Eigen::Vector2d center(simulated.x_m.front(), simulated.y_m.front());
  const Eigen::Vector2d from_center =
      Eigen::Rotation2Dd(-simulated.yaw_rad.front()) * (start.translation.head<2>() - center);
  for (std::size_t i = 0; i < simulated.t_s.size(); ++i) {
    const Eigen::Vector2d origin = Eigen::Vector2d(simulated.x_m[i], simulated.y_m[i]) +
                                   Eigen::Rotation2Dd(simulated.yaw_rad[i]) * from_center;
    track.push_back(
        {simulated.t_s[i], {origin.x(), origin.y(), start.translation.z(), simulated.yaw_rad[i]}});
  }
  return without_jumps(std::move(track));
}

Track track_of(const Motion& plan, const BodyMotion* simulated, double end_s) {
  if (simulated == nullptr || simulated->t_s.empty()) return track_of(plan, end_s);
  Track track = track_of(plan, simulated->t_s.front());
  for (const Sample<4>& sample : track_of(*simulated, plan)) {
    if (sample.time_s > end_s) break;
    while (!track.empty() && track.back().time_s >= sample.time_s) track.pop_back();
    track.push_back(sample);
  }
  return without_jumps(std::move(track));
}

Track thinned(const Track& track, const std::array<double, 4>& tolerance) {
  Track kept = straightened<4>(track, tolerance);
  const bool stays = std::all_of(kept.begin(), kept.end(), [&](const Sample<4>& sample) {
    return sample.at == kept.front().at;
  });
  if (stays && !kept.empty()) kept.resize(1);
  return kept;
}

Json track_json(const Track& track) {
  Json t = Json::array();
  std::array<Json, 4> columns{Json::array(), Json::array(), Json::array(), Json::array()};
  bool is_level = true;
  for (const Sample<4>& sample : thinned(track, {0.01, 0.01, 0.01, 0.004})) {
    t.push_back(rounded(sample.time_s, 1e3));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      columns[k].push_back(rounded(sample.at[k], k == 3 ? 1e4 : 1e3));
    }
    is_level = is_level && columns[2].back() == 0;
  }
  Json json{{"t", std::move(t)},
            {"x", std::move(columns[0])},
            {"y", std::move(columns[1])},
            {"a", std::move(columns[3])}};
  if (!is_level) json["z"] = std::move(columns[2]);
  return json;
}

Json exposure_json(const BodyMotion& simulated) {
  constexpr double window_s = 0.3;
  constexpr double step_s = 0.02;
  std::vector<Sample<1>> samples;
  std::size_t before = 0;
  for (std::size_t i = 0; i < simulated.t_s.size(); ++i) {
    const double now_s = simulated.t_s[i];
    if (!samples.empty() && now_s < samples.back().time_s + step_s) continue;
    while (simulated.t_s[before] < now_s - window_s) ++before;
    samples.push_back({now_s,
                       {std::hypot(simulated.vx_mps[i] - simulated.vx_mps[before],
                                   simulated.vy_mps[i] - simulated.vy_mps[before])}});
  }
  Json t = Json::array();
  Json v = Json::array();
  for (const Sample<1>& sample : straightened<1>(samples, {0.1})) {
    t.push_back(rounded(sample.time_s, 1e3));
    v.push_back(rounded(sample.at[0], 1e3));
  }
  return {{"t", std::move(t)}, {"v", std::move(v)}};
}

Motion motion_of(const ActorMotion& stated) {
  Result<Motion> motion = make_motion(stated, {});
  return motion ? std::move(*motion) : Motion::at_rest(stated.pose);
}

Eigen::Matrix3d tilt_of(const Pose& pose) {
  return Eigen::AngleAxisd(-heading_rad(pose), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
         pose.rotation;
}

double played_end_s(const Scenario& scenario, const CandidateResult& ranked) {
  constexpr double still_s = 0.5;
  if (!ranked.motion.empty()) return rest_time_s(ranked.motion) + still_s;
  return ranked.contacts.empty() ? scenario.horizon_s
                                 : ranked.contacts.front().time_of_impact_s + still_s;
}

}  // namespace crashrank::detail
