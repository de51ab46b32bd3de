#include "crashrank/internal/report/escape.hpp"

#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <string>

namespace crashrank {
namespace {

TEST(Escape, TerminalTextCannotMoveTheCursor) {
  EXPECT_EQ(escape_terminal("left front door"), "left front door");
  EXPECT_EQ(escape_terminal("\x1b[2Jgone"), "\\x1b[2Jgone");
  EXPECT_EQ(escape_terminal("a\nb\tc\x7f"), "a\\x0ab\\x09c\\x7f");
  EXPECT_EQ(escape_terminal(std::string("nul\0", 4)), "nul\\x00");
  EXPECT_EQ(escape_terminal("\xc2\x9b"
                            "31m"),
            "\\u{009b}31m");  // C1 control sequence
  EXPECT_EQ(escape_terminal("\xe2\x80\xae"
                            "txt"),
            "\\u{202e}txt");  // right-to-left override
  EXPECT_EQ(escape_terminal("Stoßstange 前"), "Stoßstange 前");
}

TEST(Escape, WhatIsNotUtf8IsShownAsBytes) {
  EXPECT_EQ(escape_terminal("\xff"), "\\xff");
  EXPECT_EQ(escape_terminal("\xc3"), "\\xc3");                             // cut short
  EXPECT_EQ(escape_terminal("\xc0\xaf"), "\\xc0\\xaf");                    // overlong '/'
  EXPECT_EQ(escape_terminal("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(escape_terminal("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // past U+10FFFF
}

TEST(Escape, XmlTextStaysText) {
  EXPECT_EQ(escape_xml("<script a=\"b\">'&"), "&lt;script a=&quot;b&quot;&gt;&#39;&amp;");
  EXPECT_EQ(escape_xml("a\x1b\xff"), "a\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(escape_xml("tür"), "tür");
  EXPECT_EQ(escape_xml("saloon \xe2\x80\xae"
                       "9.0"),
            "saloon \\u{202e}9.0");
  EXPECT_EQ(escape_xml("\xd8\x9c\xe2\x81\xa6x\xe2\x81\xa9"), "\\u{061c}\\u{2066}x\\u{2069}");
}

TEST(Escape, FileNamesStayInTheirFolder) {
  EXPECT_EQ(escape_file_name("../../etc/passwd"), "_._.._etc_passwd");
  EXPECT_EQ(escape_file_name(".."), "_.");
  EXPECT_EQ(escape_file_name("."), "_");
  EXPECT_EQ(escape_file_name(""), "_");
  EXPECT_EQ(escape_file_name("a b\\c:d\n"), "a_b_c_d_");
  EXPECT_EQ(escape_file_name(std::string(500, 'x')).size(), 80U);
}

TEST(Escape, NoBytesWhateverGetThrough) {
  constexpr unsigned seed = 20160601;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const std::regex file_name("[A-Za-z0-9_-][A-Za-z0-9._-]{0,79}");
  for (int round = 0; round < 2000; ++round) {
    std::string text(random() % 40, ' ');
    for (char& c : text) c = static_cast<char>(random() & 0xffU);
    for (const char c : escape_terminal(text)) {
      EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 || c == 0x7f);
    }
    EXPECT_EQ(escape_xml(text).find_first_of("<>\"'\x1b"), std::string::npos);
    EXPECT_TRUE(std::regex_match(escape_file_name(text), file_name));
  }
}

TEST(Escape, WidthCountsCodePoints) {
  EXPECT_EQ(display_width("tür"), 3U);
  EXPECT_EQ(display_width(""), 0U);
}

}  // namespace
}  // namespace crashrank
