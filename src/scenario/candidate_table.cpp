#include "scenario/candidate_table.hpp"

#include "base/utf8.hpp"
#include "scenario/json_object.hpp"
#include "scenario/key_ranges.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string_view>
#include <utility>

namespace crashrank::detail {
namespace {

namespace limits = scenario_limits;

enum Column : std::size_t { name_column, time, x, y, yaw, z, pitch, roll, column_count };
constexpr std::size_t required_columns = z;
constexpr std::array<const char*, column_count> column_names{
    "candidate", "t_s", "x_m", "y_m", "yaw_deg", "z_m", "pitch_deg", "roll_deg"};
constexpr std::array<NumberRange, column_count> column_ranges{{{},
                                                               ranges::pose_time,
                                                               ranges::position,
                                                               ranges::position,
                                                               ranges::angle,
                                                               ranges::position,
                                                               ranges::angle,
                                                               ranges::angle}};
constexpr std::size_t absent = column_count;

/// Where a text is read, one field after the other.
class Fields {
public:
  explicit Fields(std::string_view text) : rest_(text) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (rest_.substr(0, byte_order_mark.size()) == byte_order_mark) {
      rest_.remove_prefix(byte_order_mark.size());
    }
  }

  std::size_t line() const { return line_; }
  bool at_end() const { return rest_.empty(); }
  bool line_ended() const { return line_ended_; }

  /// The next field of the line, without its quotes; false where a quote is not closed or followed
  /// by more.
  bool next(std::string& field) {
    field.clear();
    if (line_ended_) ++line_;
    line_ended_ = false;
    if (take('"')) {
      if (!take_quoted(field)) return false;
      take('\r');
    } else {
      const std::size_t end = std::min(rest_.find_first_of(",\n"), rest_.size());
      std::string_view plain = rest_.substr(0, end);
      rest_.remove_prefix(end);
      if (!plain.empty() && plain.back() == '\r') plain.remove_suffix(1);
      while (!plain.empty() && plain.front() == ' ') plain.remove_prefix(1);
      while (!plain.empty() && plain.back() == ' ') plain.remove_suffix(1);
      field = plain;
    }
    if (take(',')) return true;
    line_ended_ = true;
    return rest_.empty() || take('\n');
  }

private:
  bool take(char wanted) {
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// What stands before the closing quote.
  bool take_quoted(std::string& field) {
    for (std::size_t at = 0; at < rest_.size() && rest_[at] != '\n'; ++at) {
      if (rest_[at] != '"') {
        field += rest_[at];
      } else if (at + 1 < rest_.size() && rest_[at + 1] == '"') {
        field += rest_[at++];
      } else {
        rest_.remove_prefix(at + 1);
        return true;
      }
    }
    return false;
  }

  std::string_view rest_;
  std::size_t line_ = 1;
  bool line_ended_ = false;
};

class TableReader {
public:
  TableReader(const std::string& text, std::vector<ListedCandidate>& listed)
      : fields_(text), listed_(listed) {
    for (const ListedCandidate& candidate : listed) names_.insert(candidate.name);
  }

  Status read() {
    read_header();
    while (refusals_.ok() && !fields_.at_end()) read_row();
    if (refusals_.ok() && !any_) refuse(name_column, "holds no pose", "give one pose a line");
    return refusals_.status();
  }

private:
  void refuse(std::size_t column, const std::string& reason, const std::string& remedy,
              ErrorCode code = ErrorCode::bad_input) {
    refuse_at(refusals_, place_of(column), reason, remedy, code);
  }

  std::string place_of(std::size_t column) const {
    const std::string line = "line " + std::to_string(fields_.line());
    return column == absent ? line : line + ", " + column_names[column];
  }

  void read_header() {
    std::array<bool, column_count> seen{};
    do {
      if (!next_field()) return;
      const auto found = std::find(column_names.begin(), column_names.end(), field_);
      const auto column = static_cast<std::size_t>(found - column_names.begin());
      if (column == absent || seen[column]) {
        std::string known;
        for (const char* const each : column_names) {
          known += (known.empty() ? "" : ", ") + std::string(each);
        }
        refuse(absent,
               "'" + field_ + "' is " +
                   (column == absent ? "no column of a table of candidates" : "named twice"),
               "the first line names columns, with commas between, out of " + known);
        return;
      }
      seen[column] = true;
      order_.push_back(column);
    } while (!fields_.line_ended());
    for (std::size_t column = 0; column < required_columns; ++column) {
      if (!seen[column]) refuse(column, "is missing", "add the column");
    }
  }

  void read_row() {
    std::array<double, column_count> values{};
    std::string name;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (!next_field()) return;
      // What follows the last line is no row.
      if (i == 0 && field_.empty() && fields_.line_ended()) return;
      const std::size_t column = order_[i];
      if (column == name_column) {
        name = field_;
      } else {
        values[column] = number(column);
      }
      if (!refusals_.ok()) return;
      if (fields_.line_ended() != (i + 1 == order_.size())) {
        refuse(absent,
               std::string("has ") + (fields_.line_ended() ? "fewer" : "more") +
                   " fields than the first line",
               "give " + std::to_string(order_.size()) + " fields a line");
        return;
      }
    }
    add(name, values);
  }

  bool next_field() {
    if (fields_.next(field_)) return true;
    refuse(absent, "a quoted field does not end", "end it with a quote, and double those inside");
    return false;
  }

  double number(std::size_t column) {
    double value = 0.0;
    const char* const end = field_.data() + field_.size();
    const auto [stop, fault] = std::from_chars(field_.data(), end, value);
    if (fault != std::errc() || stop != end) {
      refuse(column, "'" + field_ + "' is not a number", give_one_in(column_ranges[column]));
    } else if (!column_ranges[column].holds(value)) {
      refuse(column, out_of_range(value), give_one_in(column_ranges[column]));
    }
    return value;
  }

  void add(const std::string& name, const std::array<double, column_count>& values) {
    if (!any_ || listed_.back().name != name) begin(name);
    if (!refusals_.ok()) return;
    any_ = true;
    std::vector<TimedPose>& poses = listed_.back().poses;
    if (poses.empty() ? values[time] != 0.0 : values[time] <= poses.back().time_s) {
      refuse(time, poses.empty() ? "the first pose is not at time 0" : "does not rise",
             "start at 0 and let times rise from pose to pose");
    }
    if (poses.size() == limits::poses) {
      refuse(absent, "has more than " + std::to_string(limits::poses) + " poses", "leave some out",
             ErrorCode::limit_exceeded);
    }
    using ranges::rad_per_deg;
    poses.push_back({values[time],
                     pose_from_angles({values[x], values[y], values[z]}, rad_per_deg * values[yaw],
                                      rad_per_deg * values[pitch], rad_per_deg * values[roll])});
  }

  void begin(const std::string& name) {
    if (!is_utf8(name)) refuse(name_column, "is not UTF-8", "write the table in UTF-8");
    check_name(name, place_of(name_column), limits::name_characters, refusals_);
    if (!names_.insert(name).second) {
      refuse(name_column, "'" + name + "' was there before",
             "put the poses of a candidate one after the other, and give each its own name");
    }
    if (listed_.size() == limits::listed_candidates) {
      refuse(name_column,
             "is one more than " + std::to_string(limits::listed_candidates) + " candidates",
             "rank them in parts", ErrorCode::limit_exceeded);
    }
    listed_.emplace_back();
    listed_.back().name = name;
  }

  Fields fields_;
  std::vector<ListedCandidate>& listed_;
  std::set<std::string> names_;
  std::vector<std::size_t> order_;  ///< by place in a line
  std::string field_;
  Refusals refusals_;
  bool any_ = false;
};

}  // namespace

Status add_candidate_table(const std::string& text, const std::string& file,
                           std::vector<ListedCandidate>& listed) {
  if (text.size() > limits::table_bytes) {
    return error_in_file(file, {ErrorCode::limit_exceeded,
                                {},
                                {},
                                "is larger than 64 MiB",
                                "rank its candidates in parts"});
  }
  const Status read = TableReader(text, listed).read();
  if (!read.ok()) return error_in_file(file, read.error());
  return Success{};
}

}  // namespace crashrank::detail
