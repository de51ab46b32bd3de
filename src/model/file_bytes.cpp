#include "model/file_bytes.hpp"

#include "model/model_layout.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>
#include <utility>

namespace crashrank::detail {
namespace {

/// What errno says, by a function that is safe from any thread.
std::string why() { return std::generic_category().message(errno); }

Error file_error(ErrorCode code, const std::string& path, std::string reason,
                 std::string remedy = {}) {
  Error error = make_error(code, std::move(reason), std::move(remedy));
  error.file = path;
  return error;
}

class Descriptor {
public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const noexcept { return number_; }
  /// False where the last of what was written did not arrive.
  bool close() noexcept { return ::close(std::exchange(number_, -1)) == 0; }

private:
  int number_;
};

Result<FileBytes> map(const std::string& path, const Descriptor& file, std::size_t size) {
  struct Mapping {
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    Mapping() = default;
    ~Mapping() {
      if (memory != nullptr) ::munmap(memory, size);
    }
    void* memory = nullptr;
    std::size_t size = 0;
  };
  const auto mapping = std::make_shared<Mapping>();
  void* const memory =
      ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, file.number(), 0);
  if (memory == MAP_FAILED) {
    return file_error(ErrorCode::internal, path, "cannot map: " + why(), "load it as a copy");
  }
  mapping->memory = memory;
  mapping->size = size;
  return FileBytes{{static_cast<const unsigned char*>(memory), size}, mapping};
}

constexpr std::align_val_t aligned{64};
static_assert(section_alignment == 64);

struct Free {
  void operator()(void* memory) const noexcept { ::operator delete(memory, aligned); }
};

Result<FileBytes> copy(const std::string& path, const Descriptor& file, std::size_t size) {
  std::unique_ptr<void, Free> memory(::operator new(size, aligned));
  auto* const bytes = static_cast<unsigned char*>(memory.get());
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = ::read(file.number(), bytes + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return file_error(ErrorCode::internal, path, "cannot read: " + why());
    if (got == 0) break;  // it shrank meanwhile: the size in its header shows that
    have += static_cast<std::size_t>(got);
  }
  return FileBytes{{bytes, have}, std::shared_ptr<const void>(std::move(memory))};
}

/// Writes everything and flushes it to the disk.
bool put(const Descriptor& file, View<const unsigned char> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t wrote = ::write(file.number(), bytes.data() + done, bytes.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return ::fsync(file.number()) == 0;
}

/// Unless something may be overwritten a taken name is an error. Where the file system cannot
/// rename so, a link can: it fails for a taken name, too.
bool give_name(const std::string& draft, const std::string& path, bool overwrite) {
  if (overwrite) return std::rename(draft.c_str(), path.c_str()) == 0;
  if (::renameat2(AT_FDCWD, draft.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) {
    return true;
  }
  return errno != EEXIST && ::link(draft.c_str(), path.c_str()) == 0;
}

/// A file that goes away unless it was given its name.
class Draft {
public:
  explicit Draft(std::string name) : name_(std::move(name)) {}
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() { ::unlink(name_.c_str()); }
  const std::string& name() const noexcept { return name_; }

private:
  std::string name_;
};

}  // namespace

Result<FileBytes> file_bytes(const std::string& path, const LoadModelOptions& options) {
  // Not waiting for the other end of a pipe; a pipe is then refused.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    return file_error(ErrorCode::not_found, path, "cannot open: " + why(), "check the path");
  }
  struct stat facts {};
  if (::fstat(file.number(), &facts) != 0) {
    return file_error(ErrorCode::internal, path, "cannot read its status: " + why());
  }
  if (!S_ISREG(facts.st_mode)) {
    return file_error(ErrorCode::bad_input, path, "is not a file", "name a model file");
  }
  const auto size = static_cast<std::size_t>(facts.st_size);
  if (size > options.max_bytes) {
    return file_error(ErrorCode::limit_exceeded, path,
                      "has " + std::to_string(size) + " bytes, more than the " +
                          std::to_string(options.max_bytes) + " allowed",
                      "allow more");
  }
  if (size == 0) return FileBytes{};
  return options.storage == ModelStorage::mapped ? map(path, file, size) : copy(path, file, size);
}

bool begins_with(const std::string& path, View<const unsigned char> head) noexcept {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat facts {};
  if (file.number() < 0 || ::fstat(file.number(), &facts) != 0 || !S_ISREG(facts.st_mode)) {
    return false;
  }
  std::array<unsigned char, 64> found{};
  const std::size_t size = std::min(head.size(), found.size());
  return ::read(file.number(), found.data(), size) == static_cast<ssize_t>(size) &&
         std::equal(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(size), head.begin());
}

Status write_whole(const std::string& path, View<const unsigned char> bytes, bool overwrite) {
  struct stat facts {};
  // A name given over a pipe or a device takes it from those who use it.
  if (overwrite && ::stat(path.c_str(), &facts) == 0 && !S_ISREG(facts.st_mode)) {
    return file_error(ErrorCode::usage, path, "is no regular file, and stays", "name another file");
  }
  std::string name;
  int number = -1;
  for (int attempt = 0; number < 0 && attempt < 100; ++attempt) {
    name = path + "." + std::to_string(::getpid()) + "." + std::to_string(attempt);
    number = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (number < 0 && errno != EEXIST) break;
  }
  Descriptor file(number);
  if (file.number() < 0) {
    return file_error(ErrorCode::not_found, path, "cannot write: " + why(),
                      "name a file in a folder that can be written to");
  }
  const Draft draft(std::move(name));  // allocates nothing: from here on the file goes with it
  if (!put(file, bytes) || !file.close()) {
    return file_error(ErrorCode::internal, path, "cannot write: " + why(), "make room on the disk");
  }
  if (give_name(draft.name(), path, overwrite)) return Success{};
  if (!overwrite && errno == EEXIST) {
    return file_error(ErrorCode::usage, path, "exists already",
                      "name another file, or ask for it to be replaced");
  }
  return file_error(ErrorCode::internal, path, "cannot give it its name: " + why());
}

}  // namespace crashrank::detail
