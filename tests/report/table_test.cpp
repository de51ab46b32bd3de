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

}  // namespace
}  // namespace crashrank
