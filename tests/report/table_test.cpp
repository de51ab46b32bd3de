#include "crashrank/internal/report/table.hpp"

#include <gtest/gtest.h>

namespace crashrank {
namespace {

TEST(Table, ColumnsAlignByWhatIsSeen) {
  Table table({{"part"}, {"triangles", true}});
  table.add_row({"Tür", "7"});
  table.add_row({"bumper", "1234567890"});
  EXPECT_EQ(table.text(),
            "part     triangles\n"
            "Tür              7\n"
            "bumper  1234567890\n");
}

TEST(Table, HostileCellsAreEscapedAndShortRowsFilled) {
  Table table({{"name"}, {"note"}});
  table.add_row({"\x1b[31m"});
  table.add_row({"a", "b", "one too many"});
  EXPECT_EQ(table.text(),
            "name      note\n"
            "\\x1b[31m\n"
            "a         b\n");
  EXPECT_EQ(table.text(true).substr(0, 4), "\x1b[1m");
}

TEST(Table, WhatIsTooWideIsBrokenThenLeftOutAndCut) {
  Table table({{"name", false, 6}, {"closing m/s", true}, {"parts", false, 4, 3}});
  table.add_row({"Türöffner links", "3.5", "bumper, hood"});
  table.add_row({"wall", "12.0", "door"});
  const std::string whole = table.text();
  EXPECT_EQ(table.text(false, 42), whole);  // it fits
  EXPECT_EQ(table.text(false, 36),
            "               closing\n"
            "name               m/s  parts\n"
            "Türöffner li…      3.5  bumper, hood\n"
            "wall              12.0  door\n");
  EXPECT_EQ(table.text(false, 20),
            "             closing\n"
            "name             m/s\n"
            "Türöffner…       3.5\n"
            "wall            12.0\n");
  // What cannot become narrower stays.
  EXPECT_EQ(table.text(true, 1),
            "\x1b[1m        closing\x1b[0m\n"
            "\x1b[1mname        m/s\x1b[0m\n"
            "Türöf…      3.5\n"
            "wall       12.0\n");
}

}  // namespace
}  // namespace crashrank
