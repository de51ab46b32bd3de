#pragma once

#include "crashrank/base/result.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crashrank::cli {

// What commands that read a scenario share.

/// The file as messages name it: "standard input" for "-".
std::string shown_name(const std::string& scenario);

/// A file outside its scenario's folder: the library's remedy, with the option for what a caller
/// can do.
Error name_allow(Error error);

/// Adds --allow, which may be repeated.
void add_allowed_folders(CLI::App& command, std::vector<std::string>& folders);

}  // namespace crashrank::cli
