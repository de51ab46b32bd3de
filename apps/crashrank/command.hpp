#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace crashrank::cli {

/// What a parsed command line asks for; answers the exit code.
using Action = std::function<int()>;

/// Checks an option that counts something: digits alone, below 10^18. A 0 before others would make
/// it octal.
inline CLI::Validator whole_number() {
  return {[](const std::string& text) {
            const bool digits = !text.empty() &&
                                text.find_first_not_of("0123456789") == std::string::npos &&
                                (text.size() == 1 || text[0] != '0');
            return digits && text.size() <= 18
                       ? std::string()
                       : "'" + text + "' is no count: give a whole number from 0 to 10^18 - 1";
          },
          "", "whole number"};
}

// Each adds its subcommand, and sets `action` when the command line names it.
void add_inspect(CLI::App& app, Action& action);
void add_compile(CLI::App& app, Action& action);
void add_collide(CLI::App& app, Action& action);
void add_rank(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);

}  // namespace crashrank::cli
