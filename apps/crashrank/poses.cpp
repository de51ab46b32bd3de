#include "poses.hpp"

#include "numbers.hpp"
#include "streams.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

namespace crashrank::cli {

Result<Pose> parse_pose_option(const std::string& text) {
  const std::optional<std::vector<double>> numbers = parse_numbers(text);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (numbers && !std::all_of(numbers->begin(), numbers->end(), finite)) {
    return make_error(ErrorCode::usage,
                      "--pose " + text + ": holds a number that is not finite or beyond a double",
                      "give metres and degrees");
  }
  if (!numbers || numbers->size() != 6) {
    return make_error(ErrorCode::usage,
                      "--pose " + text + ": needs six numbers, x,y,z,yaw_deg,pitch_deg,roll_deg",
                      "write them with commas between, such as 4.2,0,0,180,0,0");
  }
  const std::vector<double>& n = *numbers;
  constexpr double radians = 3.14159265358979323846 / 180.0;
  return pose_from_angles({n[0], n[1], n[2]}, n[3] * radians, n[4] * radians, n[5] * radians);
}

Result<std::vector<Pose>> read_poses(const std::string& path) {
  constexpr std::size_t largest_file = std::size_t{64} << 20U;  // 200,000 poses of 16 numbers
  Result<std::string> text = read_text(path, largest_file);
  if (!text) return text.error();
  const std::string file = is_standard(path) ? "standard input" : path;
  std::vector<Pose> poses;
  std::string_view rest = *text;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos || line[begin] == '#') continue;
    const std::optional<std::vector<double>> numbers = parse_numbers(line);
    Result<Pose> pose = numbers
                            ? pose_from_matrix(*numbers)
                            : make_error(ErrorCode::bad_input, "has something that is no number",
                                         "write 16 numbers, a row-major 4x4 matrix");
    if (!pose) {
      Error error = pose.error();
      error.file = file;
      error.place = "line " + std::to_string(line_number);
      return error;
    }
    poses.push_back(*pose);
  }
  if (poses.empty()) {
    return Error{
        ErrorCode::bad_input, file, {}, "holds no pose", "write one row-major 4x4 matrix a line"};
  }
  return poses;
}

}  // namespace crashrank::cli
