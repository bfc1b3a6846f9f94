// SPDX-License-Identifier: Apache-2.0
#include "serve/plain_text.h"

#include <gtest/gtest.h>

#include <random>

namespace phalanx {
namespace {

const std::string kMark = "\xEF\xBF\xBD";

TEST(PlainText, WhatIsNoUtf8BecomesAMarkForEachByte) {
  EXPECT_EQ(as_utf8("Grüße, 手, 🖐"), "Grüße, 手, 🖐");
  EXPECT_EQ(as_utf8("a\xFFz"), "a" + kMark + "z");
  EXPECT_EQ(as_utf8("\xC0\xAF"), kMark + kMark) << "an overlong '/'";
  EXPECT_EQ(as_utf8("\xE0\x80\xAF"), kMark + kMark + kMark);
  EXPECT_EQ(as_utf8("\xED\xA0\x80"), kMark + kMark + kMark) << "half a surrogate pair";
  EXPECT_EQ(as_utf8("\xF4\x90\x80\x80"), kMark + kMark + kMark + kMark) << "beyond Unicode";
  EXPECT_EQ(as_utf8("\xE6\x89"), kMark + kMark) << "cut in the middle";
  EXPECT_EQ(as_utf8(std::string("\0x", 2)), std::string("\0x", 2));
}

TEST(PlainText, ANameIsOneLineAndDoesNotTurnTheWriting) {
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

/// A decoder of its own: what is left is the same after another pass, whatever the bytes were.
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
