#pragma once

#include "interrupt.hpp"

#include "crashrank/base/result.hpp"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
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
  std::unique_ptr<UnfinishedFile> own_;
  std::unique_ptr<const std::string, Remove> path_;
};

/// A kind of file that is written. A regular file that does not begin so is never replaced: it may
/// be anything, the buffer beside a glTF file, which no list of inputs holds, among it.
struct OutputKind {
  std::string_view name;     ///< such as "an HTML page"
  std::string_view begins;   ///< how each file of it begins
  bool follow_links = true;  ///< unset: symbolic links are refused, it has to be in its folder
};

inline constexpr OutputKind svg_picture{"an SVG picture", "<svg "};
inline constexpr OutputKind png_picture{"a PNG picture", "\x89PNG"};

/// Whether both are, or would be, the same file or folder; links are followed.
bool same_place(const std::string& a, const std::string& b);

/// Whether a file could be written there, before the work for it is begun; an empty name and
/// standard output can, and what lies where a folder comes with `folder_to_make`.
/// Errors: not_found; usage where it is one of the inputs, a folder or a file of another kind.
Status can_be_written(const std::string& path, const OutputKind& kind,
                      const std::vector<std::string>& inputs,
                      const std::string& folder_to_make = {});

/// A file being written, or standard output for "-". An interruption removes it.
class OutputFile {
public:
  /// Errors: not_found; usage for a file of another kind.
  static Result<OutputFile> open(const std::string& path, const OutputKind& kind);

  void write(const std::string& text);
  /// Says whether everything arrived; nothing may be written after.
  Status close();

private:
  struct Close {
    void operator()(std::FILE* file) const;
  };
  std::string path_;
  std::unique_ptr<UnfinishedFile> unfinished_;  ///< for a file that an interruption would cut
  std::unique_ptr<std::FILE, Close> file_;      ///< empty for standard output
  int error_ = 0;
};

}  // namespace crashrank::cli
