#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/tree/build.hpp"

#include <CLI/CLI.hpp>

#include <string>

namespace crashrank::cli {

/// How a command's trees are to be built, as its options say. No answer depends on it.
struct TreeArguments {
  std::string split = "min-relative-segment";
  std::string frame = "world";

  /// Adds --split and --frame.
  void add_to(CLI::App& command);

  /// Whether an option asks for anything but the default.
  bool given() const;

  /// Errors: usage for a name that is not known.
  Result<BuildOptions> build_options() const;
};

}  // namespace crashrank::cli
