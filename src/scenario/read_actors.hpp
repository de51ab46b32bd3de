#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "scenario/json_object.hpp"

#include <cstddef>
#include <initializer_list>
#include <vector>

namespace crashrank::detail {

/// Reads the key "pose"; absent: the world's origin.
Pose read_pose(const JsonObject& parent);
/// Reads the key "poses"; empty where it is absent.
std::vector<TimedPose> read_poses(const JsonObject& parent);
/// Reads the required key "model"; the index of the model of that name.
std::size_t read_model_name(const JsonObject& object, const std::vector<ScenarioModel>& models);

/// Reads an object of standard deviations; without errors where the key is absent.
StateUncertainty read_uncertainty(const JsonObject& parent, const char* key);

/// Refuses the keys of version 2 of the format in version 1, as `root` states it.
void require_version_2(const JsonObject& root, const JsonObject& object,
                       std::initializer_list<const char*> keys);

/// Reads "actors" of a scenario whose models are read.
void read_actors(const JsonObject& root, Scenario& scenario);
/// Reads "futures" and "risk" of a scenario whose actors are read. What belongs to version 2 of the
/// format is refused in version 1.
void read_futures(const JsonObject& root, Scenario& scenario);

}  // namespace crashrank::detail
