#include "completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace crashrank::cli {
namespace {

/// What can be typed for an option's value.
struct Values {
  enum class Kind { none, text, words, files, folders } kind = Kind::none;
  std::string words;  ///< separated by blanks
};

Values values_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  std::string type = option.get_type_name();
  type.resize(std::min(type.find(':'), type.size()));
  if (type == "FILE") return {Values::Kind::files, {}};
  if (type == "FOLDER") return {Values::Kind::folders, {}};
  if (type.find('|') == std::string::npos) return {Values::Kind::text, {}};
  std::replace(type.begin(), type.end(), '|', ' ');
  return {Values::Kind::words, type};
}

std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) { return app.get_subcommands({}); }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return joined(names);
}

std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  std::vector<const CLI::Option*> named;
  for (const CLI::Option* option : command.get_options()) {
    if (!spellings(*option).empty()) named.push_back(option);
  }
  return named;
}

std::string bash_values(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\"); return",
                         values.words);
    case Values::Kind::files:
      return "mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return";
    case Values::Kind::folders:
      return "mapfile -t COMPREPLY < <(compgen -d -- \"$word\"); return";
    case Values::Kind::text:
    case Values::Kind::none:
      break;
  }
  return "return";
}

/// The beginning of a description, for a list of options, in single quotes of a zsh specification.
std::string zsh_words(std::string_view description) {
  description = description.substr(0, description.find_first_of(";:[(\n"));
  while (!description.empty() && description.back() == ' ') description.remove_suffix(1);
  std::string words;
  for (const char c : description) {
    if (c == '\'') {
      words += R"('\'')";
    } else {
      words += c;
    }
  }
  return words;
}

std::string zsh_values(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return ":value:(" + values.words + ")";
    case Values::Kind::files:
      return ":file:_files";
    case Values::Kind::folders:
      return ":folder:_files -/";
    case Values::Kind::text:
      return ":value: ";
    case Values::Kind::none:
      break;
  }
  return {};
}

/// The values of a command's first argument, where they are known words.
std::string argument_words(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const Values values = values_of(*option);
    return values.kind == Values::Kind::words ? values.words : std::string();
  }
  return {};
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::string commands = command_names(app);
  std::string values;
  std::string options;
  std::string arguments = fmt::format("    help) words='{}' ;;\n", commands);
  for (const CLI::App* command : commands_of(app)) {
    std::vector<std::string> names;
    for (const CLI::Option* option : named_options(*command)) {
      const std::vector<std::string> spelt = spellings(*option);
      names.insert(names.end(), spelt.begin(), spelt.end());
      const Values found = values_of(*option);
      if (found.kind == Values::Kind::none) continue;
      for (const std::string& name : spelt) {
        values +=
            fmt::format("    '{} {}') {} ;;\n", command->get_name(), name, bash_values(found));
      }
    }
    options += fmt::format("      {}) words='{}' ;;\n", command->get_name(), joined(names));
    const std::string words = argument_words(*command);
    if (!words.empty()) {
      arguments += fmt::format("    {}) words='{}' ;;\n", command->get_name(), words);
    }
  }
  return fmt::format(
      R"(# Completion of crashrank for bash, as `crashrank completion bash` prints it.
_crashrank() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{} help --help --version' -- "$word")
    return
  fi
  case "$command $before" in
{}  esac
  if [[ $word == -* ]]; then
    case "$command" in
{}    esac
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    return
  fi
  case "$command" in
{}    *) mapfile -t COMPREPLY < <(compgen -f -- "$word"); return ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}}
complete -o filenames -F _crashrank crashrank
)",
      commands, values, options, arguments);
}

std::string zsh_completion(const CLI::App& app) {
  std::string list;
  std::string cases;
  for (const CLI::App* command : commands_of(app)) {
    list +=
        fmt::format("    '{}:{}'\n", command->get_name(), zsh_words(command->get_description()));
    cases += fmt::format("    {})\n      _arguments", command->get_name());
    for (const CLI::Option* option : named_options(*command)) {
      for (const std::string& name : spellings(*option)) {
        cases += fmt::format(" \\\n        '{}[{}]{}'", name, zsh_words(option->get_description()),
                             zsh_values(values_of(*option)));
      }
    }
    const std::string words = argument_words(*command);
    cases += words.empty() ? " \\\n        '*:file:_files'\n      ;;\n"
                           : fmt::format(" \\\n        '1:value:({})'\n      ;;\n", words);
  }
  return fmt::format(R"(#compdef crashrank
# Completion of crashrank for zsh, as `crashrank completion zsh` prints it.
_crashrank() {{
  local -a commands
  commands=(
{}    'help:Print the help of a command'
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
    help) _describe command commands ;;
{}  esac
}}
_crashrank "$@"
)",
                     list, cases);
}

}  // namespace crashrank::cli
