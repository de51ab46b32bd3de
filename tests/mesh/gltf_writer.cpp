#include "mesh/gltf_writer.hpp"

#include "mesh/mesh_writers.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cmath>
#include <utility>

namespace crashrank::test {
namespace {

std::string joined(const std::vector<std::string>& elements) {
  std::string text;
  for (const std::string& element : elements) text.append(text.empty() ? "" : ",").append(element);
  return text;
}

int number_of(const std::vector<std::string>& elements) {
  return static_cast<int>(elements.size()) - 1;
}

std::string array(const char* key, const std::string& elements) {
  return elements.empty() ? "" : std::string(",\"").append(key).append("\":[") + elements + "]";
}

}  // namespace

int GltfWriter::view(const std::string& bytes, const std::string& more) {
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  const std::size_t begin = buffer_.size();
  buffer_ += bytes;
  return raw_view("\"buffer\":0,\"byteOffset\":" + std::to_string(begin) +
                  ",\"byteLength\":" + std::to_string(bytes.size()) + more);
}

int GltfWriter::raw_view(const std::string& json) {
  views_.push_back("{" + json + "}");
  return number_of(views_);
}

int GltfWriter::raw_accessor(const std::string& json) {
  accessors_.push_back("{" + json + "}");
  return number_of(accessors_);
}

int GltfWriter::mesh(const std::string& primitive, const std::string& more) {
  meshes_.push_back("{\"primitives\":[{" + primitive + "}]" + more + "}");
  return number_of(meshes_);
}

int GltfWriter::node(const std::string& json) {
  nodes_.push_back("{" + json + "}");
  return number_of(nodes_);
}

std::string GltfWriter::json(const std::string& uri) const {
  std::string roots;
  for (std::size_t i = 0; i < (roots_.empty() ? nodes_.size() : roots_.size()); ++i) {
    roots.append(roots.empty() ? "" : ",");
    roots += std::to_string(roots_.empty() ? static_cast<int>(i) : roots_[i]);
  }
  std::string buffers;
  if (!buffer_.empty()) {
    buffers = "{\"byteLength\":" + std::to_string(buffer_.size()) +
              (uri.empty() ? "" : ",\"uri\":\"" + uri + "\"") + "}" + extra_buffers_;
  }
  std::string text = R"({"asset":{"version":"2.0"})";
  text += array("scenes", scenes_.empty() ? "{\"nodes\":[" + roots + "]}" : scenes_);
  text += array("nodes", joined(nodes_)) + array("meshes", joined(meshes_));
  text += array("accessors", joined(accessors_)) + array("bufferViews", joined(views_));
  return text + array("buffers", buffers) + more_ + "}";
}

std::string GltfWriter::glb() const { return test::glb(json(), buffer_); }

std::vector<Eigen::Vector3d> box_corners() {
  std::vector<Eigen::Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back(i % 2 == 0 ? -1.0 : 3.0, i / 2 % 2 == 0 ? -1.0 : 1.0,
                         i / 4 == 0 ? 0.0 : 1.0);
  }
  return corners;
}

std::vector<std::uint16_t> box_indices() {
  return {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
          2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
}

std::vector<float> box_positions() {
  std::vector<float> positions;
  for (const Eigen::Vector3d& corner : box_corners()) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(corner[axis]));
  }
  return positions;
}

std::string box_primitive(GltfWriter& writer) {
  const int positions = writer.accessor(box_positions(), "VEC3");
  return "\"attributes\":{\"POSITION\":" + std::to_string(positions) +
         "},\"indices\":" + std::to_string(writer.accessor(box_indices(), "SCALAR"));
}

std::string quantised_box() {
  GltfWriter writer;
  std::vector<std::int16_t> positions;
  for (const Eigen::Vector3d& corner : box_corners()) {
    // From (1, 0, 0), in units of 2 m.
    for (const double value : {corner.x() - 1.0, corner.y(), corner.z()}) {
      positions.push_back(static_cast<std::int16_t>(std::lround(value / 2.0 * 32767.0)));
    }
    positions.push_back(0);
  }
  const int view = writer.view(bytes_of(positions), ",\"byteStride\":8");
  const int accessor =
      writer.raw_accessor("\"bufferView\":" + std::to_string(view) +
                          R"(,"componentType":5122,"normalized":true,"count":8,"type":"VEC3")");
  const int mesh =
      writer.mesh("\"attributes\":{\"POSITION\":" + std::to_string(accessor) +
                  "},\"indices\":" + std::to_string(writer.accessor(box_indices(), "SCALAR")));
  writer.node("\"mesh\":" + std::to_string(mesh) + R"(,"scale":[2,2,2],"translation":[1,0,0])");
  writer.add(R"("extensionsUsed":["KHR_mesh_quantization"])");
  writer.add(R"("extensionsRequired":["KHR_mesh_quantization"])");
  return writer.glb();
}

std::string sparse_box() {
  GltfWriter writer;
  const int base = writer.view(bytes_of(box_positions()));
  const int indices = writer.view(bytes_of(std::vector<std::uint8_t>{7}));
  const int values = writer.view(bytes_of(std::vector<float>{3.0F, 1.0F, 2.0F}));
  const int accessor = writer.raw_accessor(
      "\"bufferView\":" + std::to_string(base) +
      R"(,"componentType":5126,"count":8,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":)" +
      std::to_string(indices) + R"(,"componentType":5121},"values":{"bufferView":)" +
      std::to_string(values) + "}}");
  const int mesh =
      writer.mesh("\"attributes\":{\"POSITION\":" + std::to_string(accessor) +
                  "},\"indices\":" + std::to_string(writer.accessor(box_indices(), "SCALAR")));
  writer.node("\"mesh\":" + std::to_string(mesh));
  return writer.glb();
}

std::string meshopt_box() {
  GltfWriter writer;
  const std::vector<float> positions = box_positions();
  const std::vector<std::uint16_t> indices = box_indices();
  std::vector<unsigned char> vertex_bytes(meshopt_encodeVertexBufferBound(8, 12));
  vertex_bytes.resize(meshopt_encodeVertexBuffer(vertex_bytes.data(), vertex_bytes.size(),
                                                 positions.data(), 8, 12));
  const std::vector<unsigned> wide(indices.begin(), indices.end());
  std::vector<unsigned char> index_bytes(meshopt_encodeIndexBufferBound(36, 8));
  index_bytes.resize(
      meshopt_encodeIndexBuffer(index_bytes.data(), index_bytes.size(), wide.data(), 36));
  writer.view(bytes_of(vertex_bytes));
  writer.view(bytes_of(index_bytes));
  // Views of a buffer that is not there, as optimisers write them.
  const auto compressed = [&](std::size_t offset, std::size_t begin, std::size_t size,
                              std::size_t stride, std::size_t count, const std::string& mode) {
    return writer.raw_view("\"buffer\":1,\"byteOffset\":" + std::to_string(offset) +
                           ",\"byteLength\":" + std::to_string(stride * count) +
                           R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
                           std::to_string(begin) + ",\"byteLength\":" + std::to_string(size) +
                           ",\"byteStride\":" + std::to_string(stride) +
                           ",\"count\":" + std::to_string(count) + ",\"mode\":\"" + mode + "\"}}");
  };
  const std::size_t second = (vertex_bytes.size() + 3) / 4 * 4;
  const int vertices = compressed(0, 0, vertex_bytes.size(), 12, 8, "ATTRIBUTES");
  const int triangles = compressed(96, second, index_bytes.size(), 2, 36, "TRIANGLES");
  writer.extra_buffer(
      R"({"byteLength":168,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})");
  writer.raw_accessor("\"bufferView\":" + std::to_string(vertices) +
                      R"(,"componentType":5126,"count":8,"type":"VEC3")");
  writer.raw_accessor("\"bufferView\":" + std::to_string(triangles) +
                      R"(,"componentType":5123,"count":36,"type":"SCALAR")");
  writer.mesh(R"("attributes":{"POSITION":0},"indices":1)");
  writer.node("\"mesh\":0");
  writer.add(R"("extensionsUsed":["EXT_meshopt_compression"])");
  writer.add(R"("extensionsRequired":["EXT_meshopt_compression"])");
  return writer.glb();
}

namespace {

std::string draco_file(const std::vector<float>& positions, const std::vector<unsigned>& indices) {
  draco::Mesh mesh;
  const auto points = static_cast<std::uint32_t>(positions.size() / 3);
  mesh.set_num_points(points);
  draco::GeometryAttribute shape;
  shape.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  draco::PointAttribute* const attribute = mesh.attribute(mesh.AddAttribute(shape, true, points));
  for (std::uint32_t i = 0; i < points; ++i) {
    attribute->SetAttributeValue(draco::AttributeValueIndex(i), &positions[3 * i]);
  }
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]),
                  draco::PointIndex(indices[i + 2])});
  }
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 20);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) return {};
  GltfWriter writer;
  writer.view(std::string(buffer.data(), buffer.size()));
  writer.raw_accessor("\"componentType\":5126,\"type\":\"VEC3\",\"count\":" +
                      std::to_string(points));
  writer.raw_accessor("\"componentType\":5125,\"type\":\"SCALAR\",\"count\":" +
                      std::to_string(indices.size()));
  writer.mesh(
      "\"attributes\":{\"POSITION\":0},\"indices\":1,\"extensions\":{"
      "\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{\"POSITION\":" +
      std::to_string(attribute->unique_id()) + "}}}");
  writer.node("\"mesh\":0");
  writer.add(R"("extensionsUsed":["KHR_draco_mesh_compression"])");
  writer.add(R"("extensionsRequired":["KHR_draco_mesh_compression"])");
  return writer.glb();
}

}  // namespace

std::string draco_box() {
  const std::vector<std::uint16_t> indices = box_indices();
  return draco_file(box_positions(), std::vector<unsigned>(indices.begin(), indices.end()));
}

std::string draco_grid(int columns, int rows) {
  std::vector<float> positions;
  std::vector<unsigned> indices;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      positions.insert(positions.end(),
                       {static_cast<float>(column) / 64.0F, static_cast<float>(row) / 64.0F, 0.0F});
      if (row == 0 || column == 0) continue;
      const auto here = static_cast<unsigned>(row * columns + column);
      const auto below = here - static_cast<unsigned>(columns);
      indices.insert(indices.end(), {below - 1, below, here, below - 1, here, here - 1});
    }
  }
  return draco_file(positions, indices);
}

}  // namespace crashrank::test
