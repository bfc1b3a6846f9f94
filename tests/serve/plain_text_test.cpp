// SPDX-License-Identifier: Apache-2.0
#include "record/plain_text.h"

#include <gtest/gtest.h>

#include <random>

namespace phalanx {
namespace {

const std::string kMark = "\xEF\xBF\xBD";

TEST(PlainText, EachByteOfInvalidUtf8BecomesAMark) {
  EXPECT_EQ(as_utf8("Grüße, 手, 🖐"), "Grüße, 手, 🖐");
  EXPECT_EQ(as_utf8("a\xFFz"), "a" + kMark + "z");
  EXPECT_EQ(as_utf8("\xC0\xAF"), kMark + kMark) << "an overlong '/'";
  EXPECT_EQ(as_utf8("\xE0\x80\xAF"), kMark + kMark + kMark);
  EXPECT_EQ(as_utf8("\xED\xA0\x80"), kMark + kMark + kMark) << "half a surrogate pair";
  EXPECT_EQ(as_utf8("\xF4\x90\x80\x80"), kMark + kMark + kMark + kMark) << "beyond Unicode";
  EXPECT_EQ(as_utf8("\xE6\x89"), kMark + kMark) << "cut in the middle";
  EXPECT_EQ(as_utf8(std::string("\0x", 2)), std::string("\0x", 2));
}

// The first and the last character of each length, those beside the surrogates, and their neighbours outside.
TEST(PlainText, CharactersOfEachLengthAreAcceptedFromTheFirstToTheLast) {
  for (const char* whole : {"\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                            "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(as_utf8(whole), whole);
  for (const std::string broken :
       {"\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xBF\xBF", "\xF0\x8F\xBF\xBF", "\xF5\x80\x80\x80"}) {
    std::string marks;
    for (std::size_t i = 0; i < broken.size(); ++i) marks += kMark;
    EXPECT_EQ(as_utf8(broken), marks);
  }
}

// Each range of characters that are left out, with its neighbours, which stay.
TEST(PlainText, ANameKeepsTheNeighboursOfTheCharactersThatItLeavesOut) {
  for (const char* kept :
       {" ", "~", "\u00A0", "\u061B", "\u061D", "\u200D", "\u2010", "\u2027", "\u202F", "\u2065", "\u206A"})
    EXPECT_EQ(one_line(kept), kept);
  for (const char* gone : {"\x1F", "\x7F", "\u0080", "\u009F", "\u061C", "\u200E", "\u200F", "\u2028",
                           "\u2029", "\u202A", "\u202E", "\u2066", "\u2069"})
    EXPECT_EQ(one_line(gone), "");
}

TEST(PlainText, ANameIsOneLineAndDoesNotChangeTheDirectionOfWriting) {
  EXPECT_EQ(one_line("An\nna\r\t\x7F\x1b[31m"), "Anna[31m");
  EXPECT_EQ(one_line("\u202Eanna\u202C \u2066x\u2069\u200F"), "anna x");
  EXPECT_EQ(one_line("a\u2028b\u0085c"), "abc");
  EXPECT_EQ(one_line("Jürgen 手"), "Jürgen 手");
}

TEST(PlainText, IsCutAtAWholeCharacter) {
  EXPECT_EQ(shortened("short", 5), "short");
  EXPECT_EQ(shortened("longer", 5), "lo...");
  EXPECT_EQ(shortened("üüüü", 6), "ü...");
  EXPECT_EQ(shortened("手手手", 5), "...");
}

TEST(PlainText, NamesFilesBelowAFolderFromThereOn) {
  EXPECT_EQ(without_folder("/opt/x/scenes/a.toml:3: no; see /opt/x/scenes/b.toml, /opt/xy/c", "/opt/x"),
            "scenes/a.toml:3: no; see scenes/b.toml, /opt/xy/c");
  EXPECT_EQ(without_folder("/opt/y/../x/a and /opt/x/b", "/opt/y/../x"), "a and b");
  EXPECT_EQ(without_folder("/opt/x/", "/opt/x"), "");
}

// Whatever the bytes are, a second pass changes nothing.
TEST(PlainText, OfAnyBytesAnotherPassChangesNothing) {
  constexpr unsigned kSeed = 20260504;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 12, ' ');
    for (char& c : bytes) c = static_cast<char>(random());
    const std::string once = as_utf8(bytes);
    EXPECT_EQ(as_utf8(once), once);
    EXPECT_EQ(one_line(one_line(bytes)), one_line(bytes));
    EXPECT_EQ(as_utf8(shortened(once, 6)), shortened(once, 6));
    EXPECT_LE(shortened(once, 6).size(), 6U);
  }
}

}  // namespace
}  // namespace phalanx
