#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace crashrank::cli {

// Scripts that let a shell complete commands, options, their values, files and folders; made from
// the options that `app` has.

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace crashrank::cli
