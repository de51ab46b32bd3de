#include "command.hpp"
#include "completion.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "options.hpp"

#include "base/nearest_word.hpp"
#include "crashrank/base/version.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace crashrank::cli {
namespace {

constexpr const char* program_epilogue =
    R"(Data goes to standard output, messages to standard error; - names a standard stream.
Exit codes: 0 done, 1 internal failure, 2 usage, 3 bad input, 4 a budget or Ctrl-C ended it
with a partial answer, or the memory.

crashrank help COMMAND prints the options of a command.

Examples:
  crashrank inspect car.obj --json
  crashrank collide car.obj truck.glb --pose 4.2,0.3,0,180,0,0
  crashrank rank scenario.json --damage out)";

/// "; did you mean 'rank'?", or nothing where no known word is near.
std::string meant(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = detail::nearest_word(word, known);
  return nearest.empty() ? std::string() : "; did you mean '" + nearest + "'?";
}

/// Names of a command's options as they are typed: "--json".
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// What the parser says of how often an option or its value is there, in a user's words.
std::string of_counts(const std::string& text) {
  const std::string option = text.substr(0, text.find_first_of(": "));
  const auto says = [&](const char* part) { return text.find(part) != std::string::npos; };
  if (says("disallowed flag override")) return "--" + option + " takes no value";
  if (says("At Most 1")) return option + " is given more than once";
  if (says("1 required")) return option + " needs a value";
  return text;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The first line of what the parser has to say, what was meant, and where to read on. `word` is
/// the first argument or null.
int usage(const CLI::App& app, const CLI::ParseError& problem, const char* word) {
  const CLI::App* named = &app;
  while (!named->get_subcommands().empty()) named = named->get_subcommands().front();
  const std::string help =
      named == &app ? "crashrank --help" : "crashrank " + named->get_name() + " --help";
  std::string text = problem.what();
  text.resize(std::min(text.find('\n'), text.size()));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&problem) != nullptr) text = of_counts(text);
  const std::vector<std::string> strangers = named->remaining();
  if (named == &app && word != nullptr && word[0] == '-') {
    text = "there is no option '" + std::string(word) + "' before a command";
  } else if (named == &app) {
    std::vector<std::string> commands;
    for (const CLI::App* known : app.get_subcommands({})) commands.push_back(known->get_name());
    text =
        word == nullptr ? "no command is given" : "there is no command '" + std::string(word) + "'";
    text += "; choose " + listed(commands);
    if (word != nullptr) text += meant(word, commands);
  }
  if (named == &app && word != nullptr && std::string(word) == "import") {
    return fail(make_error(ErrorCode::usage,
                           "the readers of other formats are in the Python package",
                           "pip install '.[formats]' in the folder of the source, then python -m "
                           "crashrank import FORMAT FILE -o SCENARIO.json"));
  }
  if (named == &app && word != nullptr && std::string(word) == "benchmark") {
    return fail(make_error(ErrorCode::usage, "the benchmark is in the Python package",
                           "pip install . in the folder of the source, then python -m crashrank "
                           "benchmark"));
  }
  if (named != &app && dynamic_cast<const CLI::ExtrasError*>(&problem) != nullptr) {
    text = "not expected:";
    bool numbers = true;
    for (const std::string& stranger : strangers) {
      text += " '" + stranger + "'";
      numbers = numbers && !parse_numbers(stranger).value_or(std::vector<double>()).empty();
    }
    if (numbers) text += "; numbers of one option stand together with commas, such as 1,2,3";
  }
  for (const std::string& unknown : strangers) {
    const std::string option = unknown.substr(0, unknown.find('='));
    if (option.rfind("--", 0) == 0) {
      text += meant(option, option_names(*named));
    } else if (option.size() > 2 && option[0] == '-' && named->get_option_no_throw("-" + option)) {
      text += "; write -" + option;
    }
  }
  return fail(make_error(ErrorCode::usage, text, "see " + help));
}

/// An unset variable of a script must not pass for an option left out.
Status no_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) {
        return make_error(ErrorCode::usage, option->get_name() + ": its value is empty",
                          "leave the option out, or give it a value");
      }
    }
  }
  return Success{};
}

/// `crashrank help COMMAND` means `crashrank COMMAND --help`.
std::vector<const char*> without_help_command(int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (words.size() < 2 || std::string(words[1]) != "help") return words;
  words.erase(words.begin() + 1);
  words.push_back("--help");
  return words;
}

int run(int argc, char** argv) {
  const std::vector<const char*> words = without_help_command(argc, argv);
  CLI::App app("Ranks the crashes a vehicle can still choose, least harmful first.", "crashrank");
  app.set_version_flag("--version", std::string("crashrank ") + library_version());
  app.footer(program_epilogue);
  app.require_subcommand(1);
  Action action;
  add_inspect(app, action);
  add_compile(app, action);
  add_collide(app, action);
  add_rank(app, action);
  add_view(app, action);
  add_new(app, action);
  add_check(app, action);
  add_sweep(app, action);
  add_validate(app, action);
  add_completion(app, action);
  app.formatter(help_formatter());
  for (CLI::App* command : app.get_subcommands({})) {
    command->formatter(help_formatter());
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() == 0) option->disable_flag_override();
    }
  }
  const bool asks_help = argc > 1 && std::string(argv[1]) == "help";
  const auto is_named = [&](const CLI::App* command) { return command->get_name() == words[1]; };
  const std::vector<CLI::App*> commands = app.get_subcommands({});
  if (asks_help && words.size() > 2 && std::none_of(commands.begin(), commands.end(), is_named)) {
    return usage(app, CLI::ExtrasError("help", {words[1]}), words[1]);
  }
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::CallForHelp&) {
    const auto named = app.get_subcommands();
    print(named.empty() ? app.help() : named.front()->help("crashrank"));
    return finish(exit_done);
  } catch (const CLI::CallForVersion&) {
    print(app.version() + "\n");
    return finish(exit_done);
  } catch (const CLI::ParseError& problem) {
    return usage(app, problem, words.size() > 1 ? words[1] : nullptr);
  }
  if (const Status sound = no_empty_values(*app.get_subcommands().front()); !sound) {
    return fail(sound.error());
  }
  return finish(run_interruptible(action));
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that lets a shell complete command lines");
  command->add_option("SHELL", *shell, "bash or zsh")
      ->check(one_of({"bash", "zsh"}))
      ->type_name("bash|zsh")
      ->required();
  command->footer(
      "Installed packages bring both scripts. Without:\n"
      "  bash: eval \"$(crashrank completion bash)\"\n"
      "  zsh:  crashrank completion zsh > _crashrank, in a folder of fpath\n\n"
      "Example:\n  crashrank completion bash > "
      "~/.local/share/bash-completion/completions/crashrank");
  command->callback([shell, &app, &action] {
    action = [shell, &app] {
      print(*shell == "zsh" ? zsh_completion(app) : bash_completion(app));
      return int{exit_done};
    };
  });
}

}  // namespace crashrank::cli

int main(int argc, char** argv) {
  using namespace crashrank;
  try {
    return cli::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return cli::fail(out_of_memory());
  } catch (const std::exception& problem) {
    return cli::fail(make_error(ErrorCode::internal, problem.what()));
  }
}
