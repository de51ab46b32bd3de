#include "mesh/importer/part_names.hpp"

#include "mesh/text.hpp"

#include <gtest/gtest.h>

#include <set>

namespace crashrank::importer {
namespace {

using Names = std::vector<std::string>;

TEST(PartNames, PreferNodeThenMeshThenMaterialThenFile) {
  EXPECT_EQ(
      name_parts(
          {{"door", "Cube.001", "paint"}, {"", "wheel", "rubber"}, {"", "", "glass"}, {"", "", ""}},
          "car", 256),
      (Names{"door", "wheel", "glass", "car"}));
}

TEST(PartNames, SeeThroughNamesThatParsersMakeUp) {
  for (const char* name : {"", "<STL_BINARY>", "<OFFRoot>", "defaultobject", "RootNode",
                           "$ColladaAutoName$_0", "nodes[3]", "meshes[0]-1", "3DSMesh_4", "17"}) {
    EXPECT_TRUE(is_generic(name)) << name;
  }
  for (const char* name : {"wheel", "<b>bold</b>", "nodes[x]", "Scene", "door<1>", "3DSMesh"}) {
    EXPECT_FALSE(is_generic(name)) << name;
  }
  EXPECT_EQ(name_parts({{"hood_$AssimpFbx$_GeometricScaling", "", ""}}, "car", 256), Names{"hood"});
}

TEST(PartNames, TellTheMeshesOfOneNodeApart) {
  EXPECT_EQ(
      name_parts(
          {{"truck", "geom", "paint"}, {"truck", "geom", "tyres"}, {"truck", "geom", "tyres"}},
          "car", 256),
      (Names{"truck", "truck/tyres", "truck/tyres.2"}));
  EXPECT_EQ(name_parts({{"door", "left", "paint"}, {"door", "right", "paint"}}, "car", 256),
            (Names{"door", "door/right"}));
  EXPECT_EQ(name_parts({{"wheel", "m", "rubber"}, {"wheel", "m", "rubber"}, {"wheel", "", ""}},
                       "car", 256),
            (Names{"wheel", "wheel.2", "wheel.3"}));
  EXPECT_EQ(name_parts({{"wheel", "", ""}, {"wheel.2", "", ""}, {"wheel", "", ""}}, "car", 256),
            (Names{"wheel", "wheel.2", "wheel.3"}));
}

TEST(PartNames, StayUniqueValidAndShort) {
  std::vector<PartLabels> labels;
  for (int i = 0; i < 2000; ++i) {
    labels.push_back({std::string(300, 'a') + "\xff", "m" + std::to_string(i % 7), "\xc3\x28"});
  }
  const Names names = name_parts(labels, "car", 64);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), labels.size());
  for (const std::string& name : names) {
    EXPECT_LE(name.size(), 64U);
    EXPECT_EQ(detail::to_utf8(name, 64), name);
  }
}

TEST(Text, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(detail::printable("a\x1b[31m\n\xc2\x9b\xff\xc3\xa9"),
            "a\\x1b[31m\\x0a\\xc2\\x9b\\xff\xc3\xa9");
  EXPECT_EQ(detail::printable("abcdef", 3), "abc...");
  EXPECT_EQ(detail::to_utf8("\xed\xa0\x80", 100), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(detail::to_utf8("\xf4\x90\x80\x80", 3), "\xef\xbf\xbd");
  EXPECT_EQ(detail::to_utf8("ab\xc3\xa9", 3), "ab");
}

}  // namespace
}  // namespace crashrank::importer
