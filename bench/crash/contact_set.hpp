#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bench {

/// A model of data/models with what a scenario states of it.
struct CrashModel {
  std::string name;
  std::string kind;      ///< as scenarios name it
  double mass_kg = 0.0;  ///< read for kinds that move alone
  bool moves = false;
  crashrank::Model model;
};

/// The models of data/models as shipped, in the order of the catalogue.
crashrank::Result<std::vector<CrashModel>> shipped_crash_models();

/// Two bodies at first contact. World axes.
struct ContactCase {
  std::size_t a = 0;  ///< index of the ego's model
  std::size_t b = 0;
  crashrank::Pose pose_a;
  crashrank::Pose pose_b;
  crashrank::Velocity velocity_a;  ///< of its origin
  crashrank::Velocity velocity_b;
  double closing_mps = 0.0;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
};

/// Random contacts: hatch, saloon, lorry and motorcycle in turn against any model, closing at 4 to
/// 40 m/s, any headings, any offset at which the boxes meet; first contact of the meshes by
/// `time_of_impact`. The same contacts on every machine.
std::vector<ContactCase> draw_contacts(const std::vector<CrashModel>& models, std::size_t count,
                                       std::uint64_t seed);

/// Writes contacts as text, one a line, so that another version simulates the same ones.
bool save_contacts(const std::string& path, const std::vector<ContactCase>& cases);
/// Errors: bad_input for what `save_contacts` did not write.
crashrank::Result<std::vector<ContactCase>> load_contacts(const std::string& path,
                                                          std::size_t models);

}  // namespace bench
