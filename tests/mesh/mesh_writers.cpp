#include "mesh/mesh_writers.hpp"

#include <cstdint>
#include <cstring>
#include <random>
#include <sstream>

namespace crashrank::test {
namespace {

template <class T> void put(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

std::string text(const Eigen::Vector3f& v) {
  std::ostringstream out;
  out.precision(9);
  out << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

template <class Visit> void each_corner(const Soup& soup, Visit visit) {
  for (const SoupPart& part : soup) {
    for (const SoupTriangle& triangle : part.triangles) {
      for (const Eigen::Vector3f& corner : triangle) visit(corner);
    }
  }
}

// 3ds: u16 id, u32 length with these six bytes, content.
std::string chunk(std::uint16_t id, const std::string& content) {
  std::string bytes;
  put(bytes, id);
  put(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto byte = static_cast<unsigned char>(i + k < bytes.size() ? bytes[i + k] : '\0');
      word = (word << 8U) | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : digits[(word >> (18U - 6U * k)) & 63U];
    }
  }
  return out;
}

std::string vertices_and_faces(const Soup& soup) {
  std::ostringstream out;
  each_corner(soup, [&](const Eigen::Vector3f& corner) { out << text(corner) << '\n'; });
  for (std::size_t t = 0; t < triangle_count(soup); ++t) {
    out << "3 " << 3 * t << ' ' << 3 * t + 1 << ' ' << 3 * t + 2 << '\n';
  }
  return out.str();
}

std::string ply_header(const Soup& soup, const char* format) {
  std::ostringstream out;
  out << "ply\nformat " << format << " 1.0\nelement vertex " << 3 * triangle_count(soup)
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << triangle_count(soup) << "\nproperty list uchar int vertex_indices\nend_header\n";
  return out.str();
}

// One node, mesh and primitive a part; positions by accessor, indices 0, 1, 2, ... by another.
std::string gltf_json(const Soup& soup, const std::string& uri, std::string& buffer) {
  std::ostringstream nodes;
  std::ostringstream meshes;
  std::ostringstream accessors;
  std::ostringstream views;
  std::ostringstream roots;
  for (std::size_t p = 0; p < soup.size(); ++p) {
    const char* comma = p == 0 ? "" : ",";
    const std::size_t corners = 3 * soup[p].triangles.size();
    const std::size_t positions = buffer.size();
    Eigen::Vector3f low = soup[p].triangles[0][0];
    Eigen::Vector3f high = low;
    each_corner({soup[p]}, [&](const Eigen::Vector3f& corner) {
      for (int axis = 0; axis < 3; ++axis) put(buffer, corner[axis]);
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    });
    const std::size_t indices = buffer.size();
    for (std::uint32_t i = 0; i < corners; ++i) put(buffer, i);
    roots << comma << p;
    nodes << comma << R"({"name":")" << soup[p].name << R"(","mesh":)" << p << '}';
    meshes << comma << R"({"name":"shape","primitives":[{"attributes":{"POSITION":)" << 2 * p
           << R"(},"indices":)" << 2 * p + 1 << "}]}";
    const auto list = [](const Eigen::Vector3f& v) {
      std::ostringstream out;
      out.precision(9);
      out << '[' << v.x() << ',' << v.y() << ',' << v.z() << ']';
      return out.str();
    };
    accessors << comma << R"({"bufferView":)" << 2 * p << R"(,"componentType":5126,"count":)"
              << corners << R"(,"type":"VEC3","min":)" << list(low) << R"(,"max":)" << list(high)
              << R"(},{"bufferView":)" << 2 * p + 1 << R"(,"componentType":5125,"count":)"
              << corners << R"(,"type":"SCALAR"})";
    views << comma << R"({"buffer":0,"byteOffset":)" << positions << R"(,"byteLength":)"
          << indices - positions << R"(},{"buffer":0,"byteOffset":)" << indices
          << R"(,"byteLength":)" << buffer.size() - indices << '}';
  }
  std::ostringstream out;
  out << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" << roots.str()
      << R"(]}],"nodes":[)" << nodes.str() << R"(],"meshes":[)" << meshes.str()
      << R"(],"accessors":[)" << accessors.str() << R"(],"bufferViews":[)" << views.str()
      << R"(],"buffers":[{)";
  if (!uri.empty()) out << R"("uri":")" << uri << R"(",)";
  out << R"("byteLength":)" << buffer.size() << "}]}";
  return out.str();
}

}  // namespace

std::size_t triangle_count(const Soup& soup) {
  std::size_t count = 0;
  for (const SoupPart& part : soup) count += part.triangles.size();
  return count;
}

Soup eighths_soup() {
  Soup soup;
  const auto add_box = [&](const char* name, const Eigen::Vector3f& low,
                           const Eigen::Vector3f& size) {
    const auto corner = [&](unsigned bits) {
      const Eigen::Vector3f pick(static_cast<float>(bits & 1U), static_cast<float>(bits >> 1U & 1U),
                                 static_cast<float>(bits >> 2U & 1U));
      return Eigen::Vector3f(low + pick.cwiseProduct(size));
    };
    constexpr std::array<std::array<unsigned, 4>, 6> sides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    SoupPart part{name, {}};
    for (const auto& s : sides) {
      part.triangles.push_back({corner(s[0]), corner(s[1]), corner(s[2])});
      part.triangles.push_back({corner(s[0]), corner(s[2]), corner(s[3])});
    }
    soup.push_back(part);
  };
  add_box("hull", {-1.125F, -0.875F, 0.25F}, {4.5F, 1.75F, 1.25F});
  add_box("door_left", {0.5F, 0.875F, 0.5F}, {1.0F, 0.125F, 0.75F});
  add_box("roof", {-0.25F, -0.625F, 1.5F}, {1.5F, 1.25F, 0.125F});
  return soup;
}

Soup ragged_soup(unsigned seed, std::size_t triangles) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&] {
    return static_cast<float>(static_cast<double>(random() >> 11U) * 0x1p-53 * 8.0 - 4.0);
  };
  const auto point = [&] {
    const float x = coordinate();
    const float y = coordinate();
    return Eigen::Vector3f(x, y, coordinate());
  };
  SoupPart part{"ragged", {}};
  while (part.triangles.size() < triangles) {
    SoupTriangle triangle{point(), point(), point()};
    const std::uint64_t kind = random() % 10;
    if (kind == 0) triangle[2] = triangle[0];
    if (kind == 1) triangle[1] = triangle[2] = triangle[0];
    if (kind == 2 && !part.triangles.empty()) triangle = part.triangles.back();
    part.triangles.push_back(triangle);
  }
  return {part};
}

std::string as_obj(const Soup& soup) {
  std::ostringstream out;
  std::size_t next = 1;
  for (const SoupPart& part : soup) {
    out << "o " << part.name << '\n';
    each_corner({part}, [&](const Eigen::Vector3f& c) { out << "v " << text(c) << '\n'; });
    for (std::size_t t = 0; t < part.triangles.size(); ++t, next += 3) {
      out << "f " << next << ' ' << next + 1 << ' ' << next + 2 << '\n';
    }
  }
  return out.str();
}

std::string as_stl_text(const Soup& soup) {
  std::ostringstream out;
  out << "solid mesh\n";
  for (const SoupPart& part : soup) {
    for (const SoupTriangle& t : part.triangles) {
      out << " facet normal 0 0 0\n  outer loop\n";
      for (const Eigen::Vector3f& corner : t) out << "   vertex " << text(corner) << '\n';
      out << "  endloop\n endfacet\n";
    }
  }
  out << "endsolid mesh\n";
  return out.str();
}

std::string as_stl_binary(const Soup& soup) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(triangle_count(soup)));
  std::size_t corners = 0;
  each_corner(soup, [&](const Eigen::Vector3f& corner) {
    if (corners++ % 3 == 0) bytes.append(12, '\0');
    for (int axis = 0; axis < 3; ++axis) put(bytes, corner[axis]);
    if (corners % 3 == 0) bytes.append(2, '\0');
  });
  return bytes;
}

std::string as_ply_text(const Soup& soup) {
  return ply_header(soup, "ascii") + vertices_and_faces(soup);
}

std::string as_ply_binary(const Soup& soup) {
  std::string bytes = ply_header(soup, "binary_little_endian");
  each_corner(soup, [&](const Eigen::Vector3f& corner) {
    for (int axis = 0; axis < 3; ++axis) put(bytes, corner[axis]);
  });
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(3 * triangle_count(soup)); ++i) {
    if (i % 3 == 0) bytes += '\3';
    put(bytes, i);
  }
  return bytes;
}

std::string as_off(const Soup& soup) {
  std::ostringstream out;
  out << "OFF\n" << 3 * triangle_count(soup) << ' ' << triangle_count(soup) << " 0\n";
  return out.str() + vertices_and_faces(soup);
}

std::string glb(std::string json, std::string buffer) {
  while (json.size() % 4 != 0) json += ' ';
  while (buffer.size() % 4 != 0) buffer += '\0';
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes.append("JSON").append(json);
  put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes.append("BIN\0", 4);
  return bytes + buffer;
}

std::string as_glb(const Soup& soup) {
  std::string buffer;
  const std::string json = gltf_json(soup, "", buffer);
  return glb(json, buffer);
}

std::string as_gltf(const Soup& soup, const std::string& uri, std::string& buffer) {
  buffer.clear();
  return gltf_json(soup, uri, buffer);
}

std::string as_gltf(const Soup& soup) {
  std::string buffer;
  gltf_json(soup, "", buffer);
  std::string again;
  return gltf_json(soup, base64(buffer).insert(0, "data:application/octet-stream;base64,"), again);
}

std::string as_collada(const Soup& soup, const std::string& unit, const std::string& up_axis,
                       const std::string& matrix) {
  std::ostringstream geometries;
  std::ostringstream nodes;
  for (std::size_t p = 0; p < soup.size(); ++p) {
    const std::string id = "g" + std::to_string(p);
    const std::size_t corners = 3 * soup[p].triangles.size();
    geometries << "<geometry id=\"" << id << "\"><mesh><source id=\"" << id
               << "p\"><float_array id=\"" << id << "a\" count=\"" << 3 * corners << "\">";
    each_corner({soup[p]}, [&](const Eigen::Vector3f& c) { geometries << text(c) << ' '; });
    geometries << "</float_array><technique_common><accessor source=\"#" << id << "a\" count=\""
               << corners << "\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
               << "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
               << "</accessor></technique_common></source><vertices id=\"" << id
               << "v\"><input semantic=\"POSITION\" source=\"#" << id << "p\"/></vertices>"
               << "<triangles count=\"" << corners / 3 << "\"><input semantic=\"VERTEX\" source=\"#"
               << id << "v\" offset=\"0\"/><p>";
    for (std::size_t i = 0; i < corners; ++i) geometries << i << ' ';
    geometries << "</p></triangles></mesh></geometry>\n";
    nodes << "<node id=\"" << soup[p].name << "\"><matrix>" << matrix
          << "</matrix><instance_geometry url=\"#" << id << "\"/></node>\n";
  }
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter=")" +
         unit + "\"/><up_axis>" + up_axis + "</up_axis></asset>\n<library_geometries>" +
         geometries.str() +
         "</library_geometries>\n<library_visual_scenes><visual_scene id=\"s\">" + nodes.str() +
         "</visual_scene></library_visual_scenes>\n"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
}

std::string as_fbx(const Soup& soup, double unit) {
  std::ostringstream objects;
  std::ostringstream connections;
  for (std::size_t p = 0; p < soup.size(); ++p) {
    const std::size_t geometry = 1000 + p;
    const std::size_t model = 2000 + p;
    const std::size_t corners = 3 * soup[p].triangles.size();
    objects << "  Geometry: " << geometry << ", \"Geometry::" << soup[p].name
            << "\", \"Mesh\" {\n    Vertices: *" << 3 * corners << " {\n      a: ";
    std::string separator;
    each_corner({soup[p]}, [&](const Eigen::Vector3f& c) {
      objects << separator << c.x() << ',' << c.y() << ',' << c.z();
      separator = ",";
    });
    objects << "\n    }\n    PolygonVertexIndex: *" << corners << " {\n      a: ";
    for (std::size_t i = 0; i < corners; ++i) {
      const auto index = static_cast<long>(i);
      objects << (i == 0 ? "" : ",") << (i % 3 == 2 ? -index - 1 : index);
    }
    objects << "\n    }\n    GeometryVersion: 124\n  }\n  Model: " << model
            << ", \"Model::" << soup[p].name << "\", \"Mesh\" {\n    Version: 232\n  }\n";
    connections << "  C: \"OO\"," << model << ",0\n  C: \"OO\"," << geometry << ',' << model
                << '\n';
  }
  std::ostringstream out;
  out << "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n  FBXHeaderVersion: 1003\n"
      << "  FBXVersion: 7300\n}\nGlobalSettings:  {\n  Version: 1000\n  Properties70:  {\n"
      << "    P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," << unit << "\n  }\n}\n"
      << "Objects:  {\n"
      << objects.str() << "}\nConnections:  {\n"
      << connections.str() << "}\n";
  return out.str();
}

std::string as_3ds(const Soup& soup) {
  std::string objects;
  std::string nodes;
  for (const SoupPart& part : soup) {
    std::string vertices;
    put(vertices, static_cast<std::uint16_t>(3 * part.triangles.size()));
    each_corner({part}, [&](const Eigen::Vector3f& corner) {
      for (int axis = 0; axis < 3; ++axis) put(vertices, corner[axis]);
    });
    std::string faces;
    put(faces, static_cast<std::uint16_t>(part.triangles.size()));
    for (std::uint16_t t = 0; t < part.triangles.size(); ++t) {
      for (std::uint16_t c = 0; c < 3; ++c) put(faces, static_cast<std::uint16_t>(3 * t + c));
      put(faces, std::uint16_t{7});
    }
    std::string name = part.name;
    name += '\0';
    // The keyframer's node, whose parent 0xffff is the root: it alone carries names through.
    std::string node = name;
    put(node, std::uint32_t{0});
    put(node, std::uint16_t{0xffff});
    nodes += chunk(0xb002, chunk(0xb010, node));
    objects += chunk(0x4000, name + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces)));
  }
  return chunk(0x4d4d, chunk(0x3d3d, objects) + chunk(0xb000, nodes));
}

std::string as_ac3d(const Soup& soup) {
  std::ostringstream out;
  out << "AC3Db\nMATERIAL \"paint\" rgb 1 1 1  amb 0.2 0.2 0.2  emis 0 0 0  spec 0.5 0.5 0.5  "
         "shi 10  trans 0\nOBJECT world\nkids "
      << soup.size() << '\n';
  for (const SoupPart& part : soup) {
    out << "OBJECT poly\nname \"" << part.name << "\"\nnumvert " << 3 * part.triangles.size()
        << '\n';
    each_corner({part}, [&](const Eigen::Vector3f& corner) { out << text(corner) << '\n'; });
    out << "numsurf " << part.triangles.size() << '\n';
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      out << "SURF 0x20\nmat 0\nrefs 3\n";
      for (std::size_t c = 0; c < 3; ++c) out << 3 * t + c << " 0 0\n";
    }
    out << "kids 0\n";
  }
  return out.str();
}

}  // namespace crashrank::test
