#include "command.hpp"
#include "console.hpp"

#include "crashrank/base/library_version.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <string>

namespace crashrank::cli {
namespace {

constexpr const char* epilogue =
    R"(Data goes to standard output, messages to standard error; - names a standard stream.
Exit codes: 0 done, 1 internal failure, 2 usage, 3 bad input, 4 a budget ended it with a
partial answer.

Examples:
  crashrank inspect car.obj --json
  crashrank collide car.obj truck.glb --pose 4.2,0.3,0,180,0,0
  crashrank rank scenario.json --damage out)";

/// The first line of what the parser has to say, and where to read on. `word` is the first argument
/// or null.
int usage(const CLI::App& app, const CLI::ParseError& problem, const char* word) {
  const CLI::App* named = &app;
  while (!named->get_subcommands().empty()) named = named->get_subcommands().front();
  const std::string help =
      named == &app ? "crashrank --help" : "crashrank " + named->get_name() + " --help";
  std::string text = problem.what();
  text.resize(std::min(text.find('\n'), text.size()));
  if (named == &app && word != nullptr && word[0] != '-') {
    text = "there is no command '" + std::string(word) + "'; choose";
    for (const CLI::App* known : app.get_subcommands({})) text += " " + known->get_name() + ",";
    text.pop_back();
  }
  return fail(make_error(ErrorCode::usage, text, "see " + help));
}

int run(int argc, char** argv) {
  CLI::App app("Ranks the crashes a vehicle can still choose, least harmful first.", "crashrank");
  app.set_version_flag("--version", std::string("crashrank ") + library_version());
  app.footer(epilogue);
  app.require_subcommand(1);
  Action action;
  add_inspect(app, action);
  add_collide(app, action);
  add_rank(app, action);
  add_sweep(app, action);
  add_validate(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto named = app.get_subcommands();
    print(named.empty() ? app.help()
                        : named.front()->help("crashrank " + named.front()->get_name()));
    return finish(exit_done);
  } catch (const CLI::CallForVersion&) {
    print(app.version() + "\n");
    return finish(exit_done);
  } catch (const CLI::ParseError& problem) {
    return usage(app, problem, argc > 1 ? argv[1] : nullptr);
  }
  return finish(action());
}

}  // namespace
}  // namespace crashrank::cli

int main(int argc, char** argv) {
  using namespace crashrank;
  try {
    return cli::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return cli::fail(make_error(ErrorCode::out_of_budget, "out of memory"));
  } catch (const std::exception& problem) {
    return cli::fail(make_error(ErrorCode::internal, problem.what()));
  }
}
