#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace crashrank::test {

/// Numbers as bytes, one after the other.
template <class T> std::string bytes_of(const std::vector<T>& numbers) {
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// Component types of glTF.
template <class T> constexpr int component_type() {
  if (std::is_same_v<T, std::int8_t>) return 5120;
  if (std::is_same_v<T, std::uint8_t>) return 5121;
  if (std::is_same_v<T, std::int16_t>) return 5122;
  if (std::is_same_v<T, std::uint16_t>) return 5123;
  if (std::is_same_v<T, std::uint32_t>) return 5125;
  return 5126;
}

/// Writes a glTF file piece by piece, by hand: each call adds an element and returns its number.
class GltfWriter {
public:
  /// `more` are further members, each with a comma before it.
  int view(const std::string& bytes, const std::string& more = "");
  int raw_view(const std::string& json);
  int raw_accessor(const std::string& json);
  template <class T>
  int accessor(const std::vector<T>& numbers, const std::string& type, const std::string& more = "",
               const std::string& view_more = "") {
    const std::size_t components = type == "SCALAR" ? 1
                                   : type == "VEC4" ? 4
                                   : type == "MAT4" ? 16
                                                    : 3;
    return raw_accessor("\"bufferView\":" + std::to_string(view(bytes_of(numbers), view_more)) +
                        ",\"componentType\":" + std::to_string(component_type<T>()) +
                        ",\"count\":" + std::to_string(numbers.size() / components) +
                        ",\"type\":\"" + type + "\"" + more);
  }
  /// A mesh of one primitive; `primitive` are its members.
  int mesh(const std::string& primitive, const std::string& more = "");
  int node(const std::string& json);
  /// Members of the file itself, as "\"scene\":1".
  void add(const std::string& members) { more_ += "," + members; }
  /// Without this, one scene names every node that was added as a root.
  void scenes(const std::string& json) { scenes_ = json; }
  void root(int node) { roots_.push_back(node); }
  void extra_buffer(const std::string& json) { extra_buffers_ += "," + json; }

  std::string json(const std::string& uri = "") const;
  std::string glb() const;
  const std::string& buffer() const { return buffer_; }

private:
  std::string buffer_;
  std::string extra_buffers_;
  std::vector<std::string> views_;
  std::vector<std::string> accessors_;
  std::vector<std::string> meshes_;
  std::vector<std::string> nodes_;
  std::vector<int> roots_;
  std::string scenes_;
  std::string more_;
};

/// A box of 4 x 2 x 1 m from (-1, -1, 0): 8 corners and 12 triangles, outside out.
std::vector<Eigen::Vector3d> box_corners();
std::vector<std::uint16_t> box_indices();
std::vector<float> box_positions();

/// "attributes" and "indices" of the box in float.
std::string box_primitive(GltfWriter& writer);

/// The box quantised to normalised 16 bits, in a node that scales it back.
std::string quantised_box();
/// The box with one corner raised to 2 m by a sparse accessor.
std::string sparse_box();
/// The box, compressed by the libraries that define the two extensions.
std::string meshopt_box();
std::string draco_box();
/// A primitive of a flat grid of columns x rows vertices, compressed by Draco.
std::string draco_grid(int columns, int rows);

}  // namespace crashrank::test
