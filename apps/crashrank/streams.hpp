#pragma once

#include "crashrank/base/result.hpp"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace crashrank::cli {

/// "-" means a standard stream.
inline bool is_standard(const std::string& path) { return path == "-"; }

/// A whole text file, or standard input for "-". Refuses more than `limit` bytes.
Result<std::string> read_text(const std::string& path, std::size_t limit);

/// Standard input kept in a file while this lives, for readers that need a file with an extension:
/// "stdin.EXTENSION" alone in a folder of its own.
class StandardInputFile {
public:
  static Result<StandardInputFile> receive(std::size_t limit, const std::string& extension);

  const std::string& path() const { return *path_; }

private:
  struct Remove {
    void operator()(const std::string* path) const;
  };
  std::unique_ptr<const std::string, Remove> path_;
};

/// Whether a file could be written there, before the work for it is begun; an empty name and
/// standard output can. Errors: not_found; usage where it is one of the inputs.
Status can_be_written(const std::string& path, const std::vector<std::string>& inputs);

/// A text file being written, or standard output for "-".
class OutputFile {
public:
  /// Errors: not_found. With `follow_links` unset a symbolic link is refused: who opens a file in a
  /// folder wants it to be in that folder.
  static Result<OutputFile> open(const std::string& path, bool follow_links = true);

  void write(const std::string& text);
  /// Says whether everything arrived; nothing may be written after.
  Status close();

private:
  struct Close {
    void operator()(std::FILE* file) const;
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;  ///< empty for standard output
  int error_ = 0;
};

}  // namespace crashrank::cli
