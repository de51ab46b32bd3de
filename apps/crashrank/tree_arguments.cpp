#include "tree_arguments.hpp"
#include "crashrank/tree/build.hpp"

#include "options.hpp"

#include <array>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

constexpr std::array<std::pair<const char*, SplitRule>, 4> rules{
    {{"min-relative-segment", SplitRule::min_relative_segment},
     {"paper", SplitRule::paper},
     {"sah", SplitRule::sah},
     {"median", SplitRule::median}}};

constexpr std::array<std::pair<const char*, BoxFrame>, 2> frames{
    {{"world", BoxFrame::world}, {"gaussian", BoxFrame::gaussian}}};

template <class Table> auto find(const Table& table, const std::string& name) {
  std::optional<decltype(table[0].second)> found;
  for (const auto& [known, value] : table) {
    if (name == known) found.emplace(value);
  }
  return found;
}

template <class Table> std::vector<std::string> names(const Table& table) {
  std::vector<std::string> all;
  all.reserve(std::size(table));
  for (const auto& [known, value] : table) all.emplace_back(known);
  return all;
}

}  // namespace

void TreeArguments::add_to(CLI::App& command) {
  const std::string group = "Trees";
  add_choice(command, "--split", split, "How triangles are split", names(rules))->group(group);
  add_choice(
      command, "--frame", frame,
      "Axes of the boxes: the body's (world) or those of its vertices' covariance (gaussian)",
      names(frames))
      ->group(group);
}

bool TreeArguments::given() const {
  const TreeArguments none;
  return split != none.split || frame != none.frame;
}

Result<BuildOptions> TreeArguments::build_options() const {
  const auto rule = find(rules, split);
  if (!rule) {
    return make_error(ErrorCode::usage, "--split " + split + ": is no split rule",
                      "give min-relative-segment, paper, sah or median");
  }
  const auto box_frame = find(frames, frame);
  if (!box_frame) {
    return make_error(ErrorCode::usage, "--frame " + frame + ": is no frame",
                      "give world or gaussian");
  }
  BuildOptions options;
  options.rule = *rule;
  options.frame = *box_frame;
  return options;
}

}  // namespace crashrank::cli
