#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace crashrank::importer {

/// A line of an OBJ file. The text is good until the next one is read.
struct ObjLine {
  std::string_view text;
  std::size_t number = 0;
  bool whole = true;        ///< unset: so long that only its head and its end are here
  bool ends_in_lf = false;  ///< with or without a carriage return before it
  bool ends_in_crlf = false;
};

/// The lines of an OBJ file as its parser splits them: also at a lone carriage return, a form feed
/// and a zero. Without a byte order mark. Reads the descriptor by position, a window at a time.
class ObjLines {
public:
  explicit ObjLines(int descriptor) : descriptor_(descriptor) {}

  /// False at the end.
  bool next(ObjLine& line);

private:
  bool refill();

  int descriptor_;
  std::size_t offset_ = 0;  ///< in the file, of what is not in the buffer yet
  bool last_ = false;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< in the buffer, of the next line
  std::size_t number_ = 1;
  bool whole_ = true;  ///< of the line that begins there
};

/// What the parser takes for one line: lines that end in a backslash are joined with the next.
struct ObjStatement {
  std::string_view text;  ///< without those backslashes; good until the next one is read
  std::size_t number = 0;
  bool whole = true;         ///< unset: too long, and cut
  std::size_t swallows = 0;  ///< line of a vertex or face that was joined to another; 0: none
};

class ObjStatements {
public:
  explicit ObjStatements(int descriptor) : lines_(descriptor) {}

  /// False at the end.
  bool next(ObjStatement& statement);

private:
  ObjLines lines_;
  std::string joined_;
};

/// Whether a reader of the line takes it for a vertex ('v') or a face ('f'), whatever stands before
/// the letter and however it is written.
bool means(std::string_view line, char letter);

}  // namespace crashrank::importer
