#include "scenario/text_file.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace crashrank::detail {

Result<std::string> read_text_file(const std::string& file, std::size_t most_bytes,
                                   const std::string& wanted) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    return Error{ErrorCode::not_found, file, {}, "there is no such file", "check the path"};
  }
  if (error) {
    return Error{ErrorCode::not_found,
                 file,
                 {},
                 "cannot be reached: " + error.message(),
                 "check the permissions of the folders above it"};
  }
  if (!fs::is_regular_file(status)) {
    return Error{ErrorCode::not_found, file, {}, "is not a file", wanted};
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return Error{ErrorCode::not_found, file, {}, "cannot be read", "check its permissions"};
  }
  // One byte more than is allowed detects a file that is too large, even one that grows meanwhile.
  std::string text;
  std::string block(std::size_t{64} << 10, '\0');
  while (in && text.size() <= most_bytes) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
  }
  return text;
}

}  // namespace crashrank::detail
