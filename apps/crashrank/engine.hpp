#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/model/model.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace crashrank::cli {

/// Which engine answers a command's queries, as its options say. No answer depends on it.
struct EngineArguments {
  std::string kernel = "fast";
  std::string policy = "late-match";
  std::string depth = "auto";
  std::uint32_t workers = 0;  ///< 0: the calling thread does all

  /// Adds --kernel, --workers, --policy and --depth.
  void add_to(CLI::App& command);

  /// Errors: usage for names and numbers that mean nothing.
  Status check() const;
};

/// "auto" is `auto_depth`. Errors: usage for what is no distribution depth.
Result<std::uint32_t> depth_from_text(const std::string& text);

/// What --policy takes.
std::vector<std::string> policy_names();

/// Adds --depth.
CLI::Option* add_depth(CLI::App& command, std::string& depth);

/// One query's answer.
struct Answer {
  CollideResult result;
  double seconds = 0.0;     ///< from the call to all pairs in the buffer
  std::uint64_t jobs = 0;   ///< handed to workers
  std::uint32_t depth = 0;  ///< distribution depth used, 0 where the calling thread did all
};

/// Asks for the pairs of two models with B at a pose; `pairs` is filled in no particular order.
using Engine =
    std::function<Result<Answer>(const Pose& b_in_a, bool any, std::vector<Pair>& pairs)>;

/// The models have to outlive the engine. Errors: usage; internal when threads cannot be started.
Result<Engine> make_engine(const EngineArguments& arguments, const Model& a, const Model& b);

}  // namespace crashrank::cli
