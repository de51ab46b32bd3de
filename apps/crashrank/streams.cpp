#include "streams.hpp"

#include "console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != nullptr && file != stdin) std::fclose(file);
  }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Error file_error(ErrorCode code, const std::string& path, std::string reason,
                 std::string remedy = {}) {
  Error error = make_error(code, std::move(reason), std::move(remedy));
  error.file = is_standard(path) ? "standard input" : path;
  return error;
}

/// Hands the file to `take` in pieces of at most 64 KiB.
template <class Take> Status read_pieces(const std::string& path, std::size_t limit, Take take) {
  std::error_code ignored;
  if (!is_standard(path) && fs::is_directory(path, ignored)) {
    return file_error(ErrorCode::bad_input, path, "is a folder, not a file");
  }
  const File file(is_standard(path) ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) {
    return file_error(ErrorCode::not_found, path, std::string("cannot open: ") + strerror(errno),
                      "check the path");
  }
  std::string piece(std::size_t{1} << 16U, '\0');
  std::size_t total = 0;
  while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), file.get())) {
    total += got;
    if (total > limit) {
      return file_error(ErrorCode::limit_exceeded, path,
                        "is larger than " + std::to_string(limit) + " bytes");
    }
    if (!take(piece.data(), got)) {
      return file_error(ErrorCode::internal, path, "cannot keep it in a temporary file",
                        "make room in the folder that TMPDIR names");
    }
  }
  if (std::ferror(file.get()) != 0) {
    return file_error(ErrorCode::bad_input, path, std::string("cannot read: ") + strerror(errno));
  }
  return Success{};
}

bool begins_with(const std::string& path, std::string_view beginning) {
  std::string head(beginning.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == beginning;
}

/// Refuses what is there where it must not be replaced; devices and pipes only take the bytes.
Status can_be_replaced(const std::string& path, const OutputKind& kind) {
  std::error_code ignored;
  if (!kind.follow_links && fs::is_symlink(path, ignored)) {
    return file_error(ErrorCode::not_found, path, "cannot write: it is a symbolic link",
                      "remove it first, or name another folder");
  }
  if (fs::is_directory(path, ignored)) {
    return file_error(ErrorCode::usage, path, "is a folder", "name a file in it");
  }
  if (fs::is_regular_file(path, ignored) && !fs::is_empty(path, ignored) &&
      !begins_with(path, kind.begins)) {
    return file_error(
        ErrorCode::usage, path,
        "is kept, as it does not begin like " + std::string(kind.name) + " that crashrank writes",
        "remove it first, or name another file");
  }
  return Success{};
}

/// The path without links, "..", or a slash at its end; the file need not be there.
fs::path plain(const std::string& path) {
  std::error_code ignored;
  const fs::path found = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  return found.has_filename() ? found : found.parent_path();
}

/// Whether making a folder makes this one, too.
bool comes_with(const std::string& folder, const std::string& made) {
  const fs::path relative = plain(made).lexically_relative(plain(folder));
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

Result<std::string> read_text(const std::string& path, std::size_t limit) {
  std::string text;
  const Status status = read_pieces(path, limit, [&](const char* data, std::size_t size) {
    text.append(data, size);
    return true;
  });
  if (!status) return status.error();
  return text;
}

void StandardInputFile::Remove::operator()(const std::string* path) const {
  std::error_code ignored;
  fs::remove_all(fs::path(*path).parent_path(), ignored);
  delete path;
}

Result<StandardInputFile> StandardInputFile::receive(std::size_t limit,
                                                     const std::string& extension) {
  std::error_code failure;
  const fs::path folder = fs::temp_directory_path(failure);
  std::string own = (folder / "crashrank-XXXXXX").string();
  if (failure || mkdtemp(own.data()) == nullptr) {
    return file_error(ErrorCode::internal, "-", "cannot keep it in a temporary file",
                      "let TMPDIR name a folder that can be written to");
  }
  StandardInputFile received;
  received.own_ = std::make_unique<UnfinishedFile>(own);
  received.path_.reset(new std::string((fs::path(own) / ("stdin." + extension)).string()));
  const File file(std::fopen(received.path().c_str(), "wbx"));
  if (!file) {
    return file_error(ErrorCode::internal, "-", "cannot keep it in a temporary file",
                      "let TMPDIR name a folder that can be written to");
  }
  const Status status = read_pieces("-", limit, [&](const char* data, std::size_t size) {
    return std::fwrite(data, 1, size, file.get()) == size;
  });
  if (!status) return status.error();
  if (std::fflush(file.get()) != 0) {
    return file_error(ErrorCode::internal, "-", "cannot keep it in a temporary file",
                      "make room in the folder that TMPDIR names");
  }
  return received;
}

void OutputFile::Close::operator()(std::FILE* file) const { std::fclose(file); }

bool same_place(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (a.empty() || b.empty()) return false;
  return fs::equivalent(a, b, ignored) || plain(a) == plain(b);
}

Status can_be_written(const std::string& path, const OutputKind& kind,
                      const std::vector<std::string>& inputs, const std::string& folder_to_make) {
  if (path.empty() || is_standard(path)) return Success{};
  for (const std::string& input : inputs) {
    // On Linux a redirected file can be told by its descriptor's name.
    if (same_place(is_standard(input) ? "/dev/stdin" : input, path)) {
      return file_error(ErrorCode::usage, path, "would be written over what is read",
                        "name another file");
    }
  }
  if (Status free = can_be_replaced(path, kind); !free) return free;
  const bool there = access(path.c_str(), F_OK) == 0;
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  if (there ? access(path.c_str(), W_OK) == 0 : access(folder.c_str(), W_OK | X_OK) == 0) {
    return Success{};
  }
  const int reason = errno;
  if (!there && !folder_to_make.empty() && comes_with(folder, folder_to_make)) return Success{};
  return file_error(ErrorCode::not_found, path, std::string("cannot write: ") + strerror(reason),
                    "name a file in a folder that can be written to");
}

Result<OutputFile> OutputFile::open(const std::string& path, const OutputKind& kind) {
  OutputFile out;
  out.path_ = path;
  if (is_standard(path)) return out;
  if (const Status free = can_be_replaced(path, kind); !free) return free.error();
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored) || !fs::exists(path, ignored)) {
    out.unfinished_ = std::make_unique<UnfinishedFile>(plain(path).string());
  }
  const int links = kind.follow_links ? 0 : O_NOFOLLOW;
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | links, 0666);
  if (descriptor >= 0) out.file_.reset(fdopen(descriptor, "wb"));
  if (!out.file_) {
    return file_error(ErrorCode::not_found, path, std::string("cannot write: ") + strerror(errno),
                      "name a file in a folder that can be written to");
  }
  return out;
}

void OutputFile::write(const std::string& text) {
  if (!file_) return print(text);
  if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
    error_ = errno;
  }
}

Status OutputFile::close() {
  if (!file_) return Success{};  // `finish` speaks for standard output
  if (std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  unfinished_.reset();
  if (error_ == 0) return Success{};
  return file_error(ErrorCode::internal, path_, std::string("cannot write: ") + strerror(error_));
}

}  // namespace crashrank::cli
