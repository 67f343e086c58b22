// What messages make of the texts of files.
#include "engine/core/text.h"

#include <gtest/gtest.h>

namespace qtrace {
namespace {

TEST(Text, CharactersAreThoseOfUtf8) {
  EXPECT_EQ(character_size("a"), 1U);
  EXPECT_EQ(character_size("\u00e9x"), 2U);
  EXPECT_EQ(character_size("\u20acx"), 3U);
  EXPECT_EQ(character_size("\U0001f600x"), 4U);
  EXPECT_EQ(character_size("\U0010ffff"), 4U);
  // Nothing, a tail, cut short, overlong, a surrogate, beyond the last one.
  for (const char* bad : {"", "\x80", "\xc3", "\xe2\x82", "\xf0\x9f\x98", "\xc3\x28", "\xc0\x80",
                          "\xe0\x80\x80", "\xf0\x80\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"}) {
    EXPECT_EQ(character_size(bad), 0U) << ::testing::PrintToString(bad);
  }
}

TEST(Text, IsCutBetweenCharacters) {
  EXPECT_EQ(shortened("abcd", 4), "abcd");
  EXPECT_EQ(shortened("abcde", 4), "abcd...");
  EXPECT_EQ(shortened("\u20ac\u20ac", 5), "\u20ac...");
  EXPECT_EQ(shortened("\u20ac", 2), "...");
}

TEST(Text, IsOneLineOfUtf8) {
  EXPECT_EQ(one_line("a\nb\tc\x7f\x1b[31m"), "a?b?c??[31m");
  EXPECT_EQ(one_line("\xff\u00e9\xe2\x82"), "?\u00e9??");
  EXPECT_EQ(one_line(std::string(3000, 'x')), std::string(1000, 'x') + "...");
}

}  // namespace
}  // namespace qtrace
