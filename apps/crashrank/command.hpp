#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace crashrank::cli {

/// What a parsed command line asks for; answers the exit code.
using Action = std::function<int()>;

// Each adds its subcommand, and sets `action` when the command line names it.
void add_inspect(CLI::App& app, Action& action);
void add_compile(CLI::App& app, Action& action);
void add_collide(CLI::App& app, Action& action);
void add_rank(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_new(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_completion(CLI::App& app, Action& action);

}  // namespace crashrank::cli
