#pragma once

#include "mesh.hpp"

#include <functional>
#include <string>
#include <vector>

namespace generate {

/// A model that can be made, with what a crash calculation needs to know beside its shape.
struct Entry {
  std::string name;
  std::string title;
  std::string kind;           ///< as scenarios name it
  std::size_t triangles = 0;  ///< of the file that is checked in
  double start_edge = 0.0;    ///< m, a first guess of the edge length that gives them
  std::function<Model(double edge)> build;
  double wheelbase_m = 0.0;  ///< 0: none
  double mass_kg = 0.0;      ///< as it stands on the road, occupants included
  double izz_kgm2 = 0.0;     ///< about the vertical through the centre of mass
  Vec3 center_of_mass_m = Vec3::Zero();
  std::string origin;  ///< where the model's origin is
  std::string facts;   ///< where size and mass come from
};

const std::vector<Entry>& catalogue();

/// The model with `triangles` triangles as nearly as its grids allow (within 3 % from 8,000 on).
Model build_sized(const Entry& entry, std::size_t triangles);

/// The comment at the head of the OBJ file.
std::string about(const Entry& entry);

/// What `models.json` says of one model: a JSON object, dimensions measured on the mesh.
std::string to_json(const Entry& entry, const Model& model);

/// The model's row of the table in `README.md`.
std::string to_row(const Entry& entry, const Model& model);

}  // namespace generate
