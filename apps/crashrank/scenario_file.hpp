#pragma once

#include "tree_arguments.hpp"

#include "crashrank/base/result.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::cli {

// What commands that read a scenario share.

/// The file as messages name it: "standard input" for "-".
std::string shown_name(const std::string& scenario);

/// A file outside its scenario's folder: the library's remedy, with the option for what a caller
/// can do.
Error name_allow(Error error);

/// The number of manoeuvres that a scenario lists or its grid generates.
std::size_t candidate_count(const Scenario& scenario);

/// Reads the models of a scenario in `file`, and adds the masses that model files state. Says what
/// is to be warned of in the meshes, and adds it to `warnings`.
Result<std::vector<Model>> load_models(Scenario& scenario, const std::string& file,
                                       const TreeArguments& trees,
                                       std::vector<std::string>& warnings);

/// Adds --allow, which may be repeated.
void add_allowed_folders(CLI::App& command, std::vector<std::string>& folders);

}  // namespace crashrank::cli
