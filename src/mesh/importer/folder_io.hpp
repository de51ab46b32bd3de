#pragma once

#include <assimp/IOSystem.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace crashrank::importer {

/// The parser's only way to files: the mesh, already open as standard input, and regular files
/// whose real path lies inside the mesh's folder, for the formats that name any. Everything is
/// read-only.
class FolderIo : public Assimp::IOSystem {
public:
  /// `skip` bytes of the mesh are left out at its start (a byte order mark).
  FolderIo(const std::string& mesh_path, std::string extension, std::size_t skip,
           std::size_t max_file_bytes);

  /// The name under which the parser asks for the mesh.
  const std::string& mesh_name() const { return mesh_name_; }

  /// Files that the mesh names and did not get, as "'NAME' is outside the mesh's folder".
  const std::vector<std::string>& refused() const { return refused_; }

  /// The whole of a file that the mesh names. False with the reason, and noted, if it may not be
  /// read.
  bool read(const std::string& name, std::vector<unsigned char>& bytes, std::string& reason);

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;
  bool CreateDirectory(const std::string& /*path*/) override { return false; }
  bool ChangeDirectory(const std::string& /*path*/) override { return false; }
  bool DeleteFile(const std::string& /*file*/) override { return false; }

private:
  std::string resolve(const std::string& name, std::string& reason) const;
  int open_inside(const std::string& name, std::string& reason) const;
  void note(const std::string& name, const std::string& reason);

  std::string folder_;  // real path, ending in a slash
  std::string mesh_name_;
  std::string extension_;
  std::size_t skip_;
  std::size_t max_file_bytes_;
  std::vector<std::string> refused_;
};

}  // namespace crashrank::importer
