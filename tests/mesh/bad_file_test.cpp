#include "crashrank/mesh/import.hpp"

#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using test::ScratchDir;

constexpr const char* cube_vertices =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
constexpr const char* cube_faces =
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string cube(const std::string& before = "", const std::string& after = "") {
  return before + cube_vertices + cube_faces + after;
}

std::string without_end(std::string text, std::size_t bytes) {
  text.resize(text.size() - bytes);
  return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// A tetrahedron's corners and two faces, the second as given, on line 8.
std::string off_with_face(const std::string& face) {
  return "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n" + face + "\n";
}

std::string text_stl() { return test::as_stl_text(test::eighths_soup()); }

std::string polygon(std::size_t corners) {
  std::ostringstream out;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
    out << "v " << std::cos(angle) << ' ' << std::sin(angle) << " 0\n";
  }
  out << 'f';
  for (std::size_t i = 1; i <= corners; ++i) out << ' ' << i;
  out << '\n';
  return out.str();
}

// A chain of nodes, each the only child of the one before.
std::string deep_glb(std::size_t depth) {
  std::ostringstream json;
  json << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)";
  for (std::size_t i = 0; i < depth; ++i) {
    json << (i == 0 ? "" : ",") << R"({"children":[)" << i + 1 << "]}";
  }
  json << R"(,{"name":"last"}]})";
  return test::glb(json.str(), "");
}

std::string cyclic_collada() {
  return replaced(test::as_collada(test::eighths_soup()), "<matrix>",
                  "<instance_node url=\"#hull\"/><matrix>");
}

std::string entity_bomb() {
  std::string types = "<!DOCTYPE COLLADA [<!ENTITY a0 \"lol\">";
  for (int i = 1; i < 10; ++i) {
    std::string ten;
    for (int k = 0; k < 10; ++k) ten += "&a" + std::to_string(i - 1) + ";";
    types += "<!ENTITY a" + std::to_string(i) + " \"" + ten + "\">";
  }
  return replaced(test::as_collada(test::eighths_soup()), "<COLLADA", types + "]>\n<COLLADA");
}

// Same text in every run: a linear congruential sequence, no zero byte left out.
std::string noise(std::size_t bytes) {
  std::string text;
  std::uint32_t state = 12345;
  while (text.size() < bytes) {
    state = state * 1664525U + 1013904223U;
    text += static_cast<char>(state >> 24U);
  }
  return text;
}

std::string one_box_glb(const std::string& what, const std::string& by) {
  std::string buffer;
  const std::string json = test::as_gltf({test::eighths_soup()[0]}, "", buffer);
  return test::glb(replaced(json, what, by), buffer);
}

// Index `value` in place of the first one of the only mesh.
std::string glb_with_index(std::uint32_t value) {
  std::string buffer;
  const std::string json = test::as_gltf({test::eighths_soup()[0]}, "", buffer);
  for (std::size_t byte = 0; byte < 4; ++byte) {
    buffer[36 * 12 + byte] = static_cast<char>(value >> (8 * byte) & 0xffU);
  }
  return test::glb(json, buffer);
}

// In place of the line of the cube's seventh vertex. One more vertex stands at the end, so that no
// index is out of range where the seventh is lost.
std::string with_vertex(const std::string& line) {
  return replaced(cube("", "v 9 9 9\n"), "v 1 1 1", line);
}

struct Case {
  std::string name;
  std::string bytes;
  std::string reason = {};    // part of the message, where the file is to be refused
  std::size_t triangles = 0;  // otherwise
  std::string warning = {};   // part of one, where there has to be one
  std::size_t dropped = 0;
};

std::vector<Case> cases() {
  const test::Soup soup = test::eighths_soup();
  const std::string mixed =
      replaced(replaced(cube(), "f 5 6 7 8", "f 8 7 6 5"), "f 2 3 7 6", "f 6 7 3 2");
  return {
      {"empty.obj", "", "empty"},
      {"overflow.obj", replaced(cube(), "v 1 1 1", "v 1e39 1 1"), "not finite"},
      {"nan.obj", replaced(cube(), "v 1 1 1", "v nan 1 1"), "not finite"},
      {"denormal.obj", "v 0 0 0\nv 1e-40 0 0\nv 0 1e-40 0\nf 1 2 3\n", "outside the range"},
      {"huge.obj", "v 0 0 0\nv 3e6 0 0\nv 0 3e6 0\nf 1 2 3\n", "outside the range"},
      {"index.obj", cube("", "f 1 2 99\n"), "vertex '99' is out of range: there are 8"},
      {"indented.obj", replaced(cube(), "f 1 4 3 2", "  f 1 4 3 2"), "", 10,
       "1 of 6 lines of faces were passed over"},
      {"all_indented.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n f 1 2 3\n",
       "no surface is left: 1 of 1 lines of faces were passed over"},
      {"marked.obj", cube("\xef\xbb\xbf", "f 1 2 99\n"), "line 15: vertex '99'"},
      {"far_back.obj", cube("", "f -9223372036854775808 2 3\n"), "out of range"},
      {"word.obj", "v 0 0 0\r\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n", "line 2: 'zero' is no number"},
      {"short.obj", "# c\nv 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "line 2: a vertex has three numbers"},
      {"indented_vertex.obj", with_vertex("  v 1 1 1"), "line 7: the vertex is lost"},
      {"tabbed_vertex.obj", with_vertex("\tv 1 1 1"), "line 7: the vertex is lost"},
      {"capital_vertex.obj", with_vertex("V 1 1 1"), "line 7: the vertex is lost"},
      {"marked_vertex.obj", with_vertex("\xef\xbb\xbfv 1 1 1"), "line 7: the vertex is lost"},
      {"close_vertex.obj", with_vertex("v1 1 1"), "line 7: the vertex is lost"},
      {"five.obj", with_vertex("v 1 1 1 1 1"),
       "line 7: a vertex has 3, 4 or 6 numbers, this line 5"},
      {"point.obj", with_vertex("v 1 1 .5"), "line 7: '.5' has no digit before its point"},
      {"point_in_colour.obj", with_vertex("v 1 1 1 0.5 .5 .5"), "line 7: '.5' has no digit"},
      {"form_feed.obj", with_vertex("v 1 1\f 1"), "line 7: a vertex has three numbers"},
      {"commented_vertex.obj", with_vertex("v 1 1 1 # 7"), "line 7: the numbers after '#'"},
      {"curve.obj", with_vertex("cstype bezier\nv 1 1 1\nend"), "line 8: the vertex is lost"},
      {"joined.obj", with_vertex("# C:\\cars\\\nv 1 1 1"), "line 8: the vertex or face is lost"},
      {"joined_crlf.obj", with_vertex("# C:\\cars\\\r\nv 1 1 1"), "line 8: the vertex or face"},
      {"joined_over.obj", with_vertex("# C:\\cars\\\n\nv 1 1 1"), "line 9: the vertex or face"},
      {"joined_face.obj", replaced(cube(), "f 5 6", "g C:\\cars\\\nf 5 6"), "line 11: the vertex"},
      {"joined_numbers.obj", with_vertex("v 1 1\\\n1"), "line 7: a vertex has three numbers"},
      {"far_index.obj", cube("", "f 1 \\\n 2 99\n"), "line 15: vertex '99' is out of range"},
      {"corner.obj", cube("", "f 1 x 3\n"), "'x' is no corner"},
      {"cube.stl", cube(), "neither a text nor a whole binary STL"},
      {"flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 2 3 4\n", "degenerate"},
      {"winding.obj", mixed, "", 12, "disagree"},
      {"polygon.obj", polygon(20'000), "20000 corners"},
      {"polygon_fits.obj", polygon(2'000), "", 1998},
      {"lines.obj", cube("", "l 1 7\np 3\n"), "", 12},
      {"bom.obj", cube("\xef\xbb\xbf"), "", 12},
      {"utf16.obj", std::string("\xfe\xff\0v\0 ", 6), "UTF-16"},
      {"noise.obj", noise(4096), "binary"},
      {"noise.stl", noise(4096), "STL"},
      {"noise.ply", noise(4096), "ply"},
      {"noise.off", noise(4096), "binary"},
      {"noise.3ds", noise(4096), "3DS"},
      {"noise.fbx", noise(4096), "FBX"},
      {"noise.glb", noise(4096), "glTF"},
      {"noise.gltf", noise(4096), ""},
      {"noise.dae", noise(4096), ""},
      {"noise.ac", noise(4096), "AC3D"},
      {"names.obj", cube("o <script>alert(1)</script>\t\"quoted\",\x1b[31mred\n"), "", 12},
      {"twice.obj",
       replaced(cube("o wheel\n"), "v -1 -1 -1", "v -1 -1 -1") +
           "o wheel\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 9 10 11\n",
       "", 13},
      {"cut.stl", test::as_stl_binary(soup).substr(0, 84 + 50 * 7 + 20),
       "promises 36 triangles, 1884 bytes in all, and it has 454"},
      {"head.stl", test::as_stl_binary(soup).substr(0, 83),
       "a binary one begins with 84 bytes, and it has 83"},
      {"none.stl", std::string(80, ' ') + std::string(4, '\0'), "STL"},
      {"cut.ply", without_end(test::as_ply_text(soup), 30),
       "it ends after 34 of the 36 faces that its header promises"},
      {"cut_binary.ply", without_end(test::as_ply_binary(soup), 5),
       "it ends after 35 of the 36 faces that its header promises"},
      {"cut_vertices.ply", without_end(test::as_ply_binary(soup), 13 * 36 + 1),
       "it ends after 107 of the 108 vertices that its header promises"},
      {"camera.ply",
       replaced(test::as_ply_text(soup), "element vertex",
                "element camera 0\nproperty int q\nelement lens 1\nproperty int q\nelement vertex"),
       "element 'lens' stands before the vertices"},
      {"strips.ply",
       replaced(test::as_ply_text(soup), "element face",
                "element strip 1\nproperty list uchar int q\nelement face"),
       "element 'strip' has lists before the faces"},
      {"empty_element.ply",
       replaced(test::as_ply_text(soup), "element face",
                "element nothing 4000000000\nelement face"),
       "element 'nothing' has no properties"},
      {"corners.ply", replaced(test::as_ply_text(soup), "\n3 0 1 2", "\n3.0 0 1 2"),
       "'face' 0 has '3.0' where the length of a list stands"},
      {"cut_face.obj", cube() + "f 1 2", "the file ends within a face: it was cut"},
      {"promises.ply",
       replaced(test::as_ply_text(soup), "element vertex 108", "element vertex 4000000000"), ""},
      {"points.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n0 0 0\n1 1 1\n",
       "no triangles"},
      {"promises.off", replaced(test::as_off(soup), "108 36", "353535235358 36"),
       "ends after 144 of the 353535235358 vertices"},
      {"index.off", off_with_face("3 0 1 4"), "line 8: face 1 names vertex '4', but there are 4"},
      {"negative.off", off_with_face("3 0 1 -1"), "line 8: face 1 names vertex '-1'"},
      {"corners.off", off_with_face("4 0 1 2"), "line 8: face 1 has 3 of its 4 corners"},
      {"cut.off", off_with_face(""), "ends after 1 of the 2 faces"},
      {"comments.off", off_with_face("\n3 0 1 3 255 0 0 # red"), "", 2},
      {"comment_among.off", off_with_face("# one\n3 0 1 3"), "", 1,
       "1 of 2 lines of faces were passed over"},
      {"decagon.off", off_with_face("10 0 1 3 0 1 3 0 1 3 2"), "", 1, "more than nine corners"},
      {"one_line.off", replaced(off_with_face("3 0 1 3"), "OFF\n", "OFF "), "", 2},
      {"in_facet.stl", text_stl().substr(0, text_stl().rfind("endloop")), "", 36,
       "ends within facet 36"},
      {"no_end.stl", text_stl().substr(0, text_stl().rfind("endsolid")), "", 36,
       "ends without endsolid"},
      {"in_vertex.stl", text_stl().substr(0, text_stl().rfind("vertex") + 3),
       "ends within facet 36"},
      {"accessor.glb", one_box_glb("\"count\":36", "\"count\":9999"), "out of range"},
      {"index.glb", glb_with_index(60'000), "", 11, "1 face", 1},
      {"cycle.glb",
       one_box_glb("\"nodes\":[{\"name\":\"hull\",",
                   "\"nodes\":[{\"name\":\"hull\",\"children\":[0],"),
       "recursive"},
      {"deep.glb", deep_glb(200'000), ""},
      {"cycle.dae", cyclic_collada(), ""},
      {"points.glb", one_box_glb("\"indices\":1", "\"indices\":1,\"mode\":0"), "no triangles"},
      {"missing.gltf",
       replaced(test::as_gltf(soup), "data:application/octet-stream;base64,",
                "missing.bin\",\"x\":\""),
       "'missing.bin' is missing"},
      {"negative.dae", test::as_collada(soup, "-1"), "<unit>"},
      {"zero.dae", test::as_collada(soup, "0"), "<unit>"},
      {"comma.dae", test::as_collada(soup, "0,5"), "", 36},
      {"entities.dae", entity_bomb(), "entities"},
      {"skew.dae",
       replaced(
           test::as_collada(soup), "</matrix>",
           "</matrix><extra><technique profile=\"x\"><skew/><skew >45</skew></technique></extra>"),
       "the transform <skew> is not supported"},
      {"zero.fbx", test::as_fbx(soup, 0.0), ""},
      {"negative.fbx", test::as_fbx(soup, -100.0), "UnitScaleFactor"},
      {"no_extension", cube(), "extension"},
      {"cube.x3d", cube(), "'x3d' is not a supported"},
      {"cube.obj.zip", cube(), "'zip' is not a supported"},
      {"zip.dae", std::string("PK\x03\x04") + noise(100), "archive"},
      {"zip_at_end.dae", test::as_collada(soup) + "<!-- PK\x05\x06" + std::string(18, '\0'),
       "archive"},
      {"gzip.obj", "\x1f\x8b\x08" + noise(100), "archive"},
      {"hello.ply", "hello", "ply"},
  };
}

TEST(BadFile, EachEndsAsItShouldInBoundedTime) {
  const ScratchDir dir;
  for (const Case& bad : cases()) {
    SCOPED_TRACE(bad.name);
    const std::string path = dir.write(bad.name, bad.bytes);
    const Result<ImportedMesh> imported = import_mesh(path);
    if (bad.triangles == 0) {
      ASSERT_FALSE(imported.ok());
      const Error& error = imported.error();
      EXPECT_TRUE(error.code == ErrorCode::bad_input || error.code == ErrorCode::limit_exceeded)
          << error.message();
      EXPECT_EQ(error.file, path);
      EXPECT_NE(error.message().find(bad.reason), std::string::npos) << error.message();
      EXPECT_FALSE(error.reason.empty());
      for (const char c : error.message()) {
        EXPECT_GE(static_cast<unsigned char>(c), 0x20) << error.message();
      }
      continue;
    }
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->mesh.size(), bad.triangles);
    EXPECT_EQ(imported->dropped_triangles, bad.dropped);
    std::string warnings;
    for (const std::string& warning : imported->warnings) warnings += warning + "\n";
    EXPECT_NE(warnings.find(bad.warning), std::string::npos) << warnings;
  }
}

TEST(BadFile, ADeepTreeOfNodesThatTheParserSurvivesIsFlattenedWithoutRecursion) {
  // Collada nests nodes in its text; 2,000 levels are within the parser's own reach.
  std::string nested = test::as_collada({test::eighths_soup()[0]});
  std::string open;
  std::string close;
  for (int i = 0; i < 2'000; ++i) {
    open += "<node>";
    close += "</node>";
  }
  nested = replaced(nested, "<node id", open + "<node id");
  nested = replaced(nested, "</visual_scene>", close + "</visual_scene>");
  const ScratchDir dir;
  const Result<ImportedMesh> imported = import_mesh(dir.write("nested.dae", nested));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.size(), 12U);
}

TEST(BadFile, NamesComeBackAsTheyAre) {
  const ScratchDir dir;
  const Result<ImportedMesh> imported =
      import_mesh(dir.write("a.obj", cube("o <script>alert(1)</script>\n")));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.parts[0].name, "<script>alert(1)</script>");
}

TEST(BadFile, NamesThatAreNotUtf8AreMended) {
  const ScratchDir dir;
  const Result<ImportedMesh> imported = import_mesh(dir.write("a.obj", cube("o d\xf6r\n")));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.parts[0].name, "d\xef\xbf\xbdr");
}

TEST(BadFile, TheByteOrderMarkCostsNoVertex) {
  const ScratchDir dir;
  const Result<ImportedMesh> plain = import_mesh(dir.write("plain.obj", cube()));
  const Result<ImportedMesh> marked = import_mesh(dir.write("marked.obj", cube("\xef\xbb\xbf")));
  ASSERT_TRUE(plain.ok() && marked.ok());
  EXPECT_EQ(plain->mesh.triangles, marked->mesh.triangles);
  EXPECT_EQ(plain->mesh.vertices, marked->mesh.vertices);
}

// However the line of a vertex is written: the cube, or no mesh.
TEST(BadFile, LinesOfVerticesThatTheParserReadsLoadAsTheCube) {
  const ScratchDir dir;
  const Result<ImportedMesh> plain = import_mesh(dir.write("plain.obj", cube()));
  ASSERT_TRUE(plain.ok());
  const std::vector<std::string> lines{"v\t1 1\t1",
                                       "v  1 1 1 ",
                                       "v +1 1.0 1e0",
                                       "v 1 1 1 1",
                                       "v 1 1 1 0 0.5 1",
                                       "v 1 1 1\r",
                                       "v 1 1 1 # the seventh",
                                       "v 1 1 \\\n1",
                                       "v 1 1 \\\r\n 1",
                                       "v \\\n1 1 1",
                                       "v 1 1 1 .5 .5 .5",
                                       "\fv 1 1 1",
                                       "# C:\\a\nv 1 1 1",
                                       "# a \\\n# b\nv 1 1 1",
                                       "# a\\\r\n\r\nv 1 1 1",
                                       "# a\\ \nv 1 1 1",
                                       "vt 0.5 0.5\nv 1 1 1",
                                       "  vn 0 0 1\nv 1 1 1",
                                       "cstype bezier\nend\nv 1 1 1"};
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    const Result<ImportedMesh> imported = import_mesh(dir.write("a.obj", with_vertex(line)));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->mesh.triangles, plain->mesh.triangles);
    EXPECT_EQ(imported->mesh.vertices, plain->mesh.vertices);
  }
}

TEST(BadFile, LinesAreTheSameWhereverAReadOfTheFileEnds) {
  const ScratchDir dir;
  for (std::size_t spare = (1U << 20U) - 8; spare < (1U << 20U) + 8; ++spare) {
    SCOPED_TRACE(spare);
    // The comment's line ends, or its backslash stands, where the first mebibyte does.
    const std::string comment = "#" + std::string(spare - 2, 'c');
    const Result<ImportedMesh> good = import_mesh(dir.write("a.obj", cube(comment + "\r\n")));
    ASSERT_TRUE(good.ok()) << good.error().message();
    EXPECT_EQ(good->mesh.size(), 12U);
    const Result<ImportedMesh> bad = import_mesh(dir.write("b.obj", cube(comment + "\\\r\n")));
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().place, "line 2") << bad.error().message();
  }
}

TEST(BadFile, LimitsAreKept) {
  const ScratchDir dir;
  const std::string path = dir.write("a.stl", test::as_stl_binary(test::ragged_soup(3, 1000)));
  const auto code_with = [&](const std::function<void(ImportLimits&)>& tighten) {
    ImportOptions options;
    tighten(options.limits);
    const Result<ImportedMesh> imported = import_mesh(path, options);
    return imported.ok()                                        ? "loaded"
           : imported.error().code == ErrorCode::limit_exceeded ? "limit exceeded"
                                                                : "another error";
  };
  EXPECT_STREQ(code_with([](ImportLimits&) {}), "loaded");
  EXPECT_STREQ(code_with([](ImportLimits& l) { l.file_bytes = 1000; }), "limit exceeded");
  EXPECT_STREQ(code_with([](ImportLimits& l) { l.triangles = 999; }), "limit exceeded");
  EXPECT_STREQ(code_with([](ImportLimits& l) { l.vertices = 999; }), "limit exceeded");
  EXPECT_STREQ(code_with([](ImportLimits& l) { l.parts = 0; }), "limit exceeded");
}

// The folder of files, beside the project or the one that CRASHRANK_BAD_MESHES names, with a
// MANIFEST.tsv of columns file, what is wrong, what a loader should do
// (beginning with REJECT or LOAD, "or REJECT" where both are right).
TEST(BadFile, TheFilesOfCrashrankBadMeshesEndAsTheirManifestSays) {
  const char* named = std::getenv("CRASHRANK_BAD_MESHES");
  const std::string folder = named != nullptr ? named : CRASHRANK_BAD_MESHES;
  std::ifstream manifest(folder + "/MANIFEST.tsv");
  if (!manifest && named == nullptr) GTEST_SKIP() << "no folder " << folder;
  ASSERT_TRUE(manifest) << "no MANIFEST.tsv in " << folder;
  std::string line;
  std::getline(manifest, line);
  std::size_t count = 0;
  while (std::getline(manifest, line)) {
    std::istringstream columns(line);
    std::string file;
    std::string wrong;
    std::string expected;
    std::getline(columns, file, '\t');
    std::getline(columns, wrong, '\t');
    std::getline(columns, expected, '\t');
    SCOPED_TRACE(file + ": " + expected);
    const auto start = std::chrono::steady_clock::now();
    const Result<ImportedMesh> imported = import_mesh(folder + "/" + file);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const bool load = expected.compare(0, 4, "LOAD") == 0;
    const bool either = expected.find("REJECT") != std::string::npos && load;
    const bool either_warn = expected.find("or WARN") != std::string::npos;
    const std::string told = imported.ok() ? "loaded" : imported.error().message();
    if (!either && !either_warn) {
      EXPECT_EQ(imported.ok(), load) << told;
    }
    std::cout << file << ": " << took.count() << " s, " << told << '\n';
    ++count;
  }
  EXPECT_GT(count, 0U);
  rusage used{};
  ASSERT_EQ(::getrusage(RUSAGE_CHILDREN, &used), 0);
  std::cout << count << " files; the largest importer process used " << used.ru_maxrss / 1024
            << " MiB\n";
  EXPECT_LT(used.ru_maxrss, 1L << 20);
}

}  // namespace
}  // namespace crashrank
