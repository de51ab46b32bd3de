#include "mesh/importer/folder_io.hpp"

#include "mesh/import_protocol.hpp"
#include "mesh/text.hpp"

#include <assimp/IOStream.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <utility>

namespace crashrank::importer {
namespace {

// Reads by position, so that the mesh can be opened any number of times from one descriptor.
class DescriptorStream : public Assimp::IOStream {
public:
  DescriptorStream(int descriptor, bool owned, std::size_t skip, std::size_t size)
      : descriptor_(descriptor), owned_(owned), skip_(skip), size_(size) {}
  DescriptorStream(const DescriptorStream&) = delete;
  DescriptorStream& operator=(const DescriptorStream&) = delete;
  ~DescriptorStream() override {
    if (owned_) ::close(descriptor_);
  }

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t wanted = std::min(count, (size_ - position_) / size) * size;
    std::size_t done = 0;
    while (done < wanted) {
      const ssize_t got = ::pread(descriptor_, static_cast<char*>(buffer) + done, wanted - done,
                                  static_cast<off_t>(skip_ + position_ + done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    position_ += done;
    return done / size;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    // The parsers step back by offsets that wrap around, so the sum is taken modulo 2^64.
    const std::size_t base = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? position_
                                                      : size_;
    const std::size_t target = base + offset;
    if (target > size_) return aiReturn_FAILURE;
    position_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return position_; }
  std::size_t FileSize() const override { return size_; }
  void Flush() override {}

private:
  int descriptor_;
  bool owned_;
  std::size_t skip_;
  std::size_t size_;
  std::size_t position_ = 0;
};

constexpr const char* missing = "is missing";

// Only these formats spread over files: material libraries, by whatever name, and buffers.
bool may_name_files(const std::string& format) {
  return format == "obj" || format == "gltf" || format == "glb";
}

// Exporters write "my%20car.bin" for "my car.bin".
std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string real_path(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                         &std::free);
  return real ? std::string(real.get()) : std::string();
}

std::size_t size_of(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return 0;
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

FolderIo::FolderIo(const std::string& mesh_path, std::string extension, std::size_t skip,
                   std::size_t max_file_bytes)
    : extension_(std::move(extension)), skip_(skip), max_file_bytes_(max_file_bytes) {
  const std::size_t slash = mesh_path.find_last_of('/');
  mesh_name_ = slash == std::string::npos ? mesh_path : mesh_path.substr(slash + 1);
  folder_ = real_path(slash == std::string::npos ? "." : mesh_path.substr(0, slash + 1));
  if (!folder_.empty() && folder_.back() != '/') folder_ += '/';
}

std::string FolderIo::resolve(const std::string& name, std::string& reason) const {
  if (name.empty() || name.find('\0') != std::string::npos) {
    reason = "is no file name";
    return {};
  }
  std::string relative = name;
  std::replace(relative.begin(), relative.end(), '\\', '/');
  if (relative.front() == '/' || folder_.empty()) {
    reason = "is outside the mesh's folder";
    return {};
  }
  std::string real = real_path(folder_ + relative);
  if (real.empty()) real = real_path(folder_ + percent_decoded(relative));
  if (real.empty()) {
    reason = missing;
    return {};
  }
  if (real.compare(0, folder_.size(), folder_) != 0) {
    reason = "is outside the mesh's folder";
    return {};
  }
  return real;
}

int FolderIo::open_inside(const std::string& name, std::string& reason) const {
  if (!may_name_files(extension_)) {
    reason = "is named by a mesh whose format keeps everything in one file";
    return -1;
  }
  const std::string real = resolve(name, reason);
  if (real.empty()) return -1;
  const int descriptor =
      ::open(real.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW);
  if (descriptor < 0) {
    reason = "cannot be opened";
    return -1;
  }
  // Asked of the open file: the path may have been swapped for a link since it was looked at.
  const std::string opened = real_path("/proc/self/fd/" + std::to_string(descriptor));
  const std::size_t size = size_of(descriptor);
  if (opened != real) {
    reason = "is outside the mesh's folder";
  } else if (size == 0) {
    reason = "is empty or not a regular file";
  } else if (size > max_file_bytes_) {
    reason = "is larger than " + std::to_string(max_file_bytes_) + " bytes";
  } else {
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

void FolderIo::note(const std::string& name, const std::string& reason) {
  std::string line = detail::quoted(name, 200) + " " + reason;
  const bool known = std::find(refused_.begin(), refused_.end(), line) != refused_.end();
  if (!known && refused_.size() < detail::max_import_warnings / 2) {
    refused_.push_back(std::move(line));
  }
}

bool FolderIo::read(const std::string& name, std::vector<unsigned char>& bytes,
                    std::string& reason) {
  const int descriptor = open_inside(name, reason);
  if (descriptor < 0) {
    note(name, reason);
    return false;
  }
  const std::size_t size = size_of(descriptor);
  DescriptorStream stream(descriptor, true, 0, size);
  bytes.resize(size);
  bytes.resize(stream.Read(bytes.data(), 1, size));
  return true;
}

bool FolderIo::Exists(const char* file) const {
  std::string reason;
  return mesh_name_ == file || (may_name_files(extension_) && !resolve(file, reason).empty());
}

Assimp::IOStream* FolderIo::Open(const char* file, const char* mode) {
  if (std::string(mode).find_first_of("wa+") != std::string::npos) return nullptr;
  if (mesh_name_ == file) {
    return std::make_unique<DescriptorStream>(STDIN_FILENO, false, skip_,
                                              size_of(STDIN_FILENO) - skip_)
        .release();
  }
  std::string reason;
  const int descriptor = open_inside(file, reason);
  if (descriptor < 0) {
    // An OBJ file names nothing but material libraries, which no answer depends on.
    const bool harmless = extension_ == "obj" && reason == missing;
    if (!harmless) note(file, reason);
    return nullptr;
  }
  return std::make_unique<DescriptorStream>(descriptor, true, 0, size_of(descriptor)).release();
}

void FolderIo::Close(Assimp::IOStream* stream) {
  std::unique_ptr<Assimp::IOStream>(stream).reset();
}

}  // namespace crashrank::importer
