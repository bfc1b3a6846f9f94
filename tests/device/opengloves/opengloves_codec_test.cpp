// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/opengloves/opengloves_codec.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "support/count_allocations.h"

namespace phalanx {
namespace {

std::string answer(const GloveStops& stops) {
  std::array<char, kGloveAnswerSize> out{};
  return {out.data(), format_glove_answer(stops, out)};
}

int numbers_in(const GloveLine& line) {
  int count = 0;
  for (const bool there : line.has) count += there ? 1 : 0;
  return count;
}

TEST(OpenGlovesCodec, ReadsFiveCurls) {
  const GloveLine line = parse_glove_line("A0B512C1023D2047E4095");
  EXPECT_EQ(numbers_in(line), 5);
  const std::array<int, kDigits> expected = {0, 512, 1023, 2047, 4095};
  for (int d = 0; d < kDigits; ++d) {
    EXPECT_TRUE(line.has[glove_curl_key(d)]);
    EXPECT_EQ(line.value[glove_curl_key(d)], expected[static_cast<std::size_t>(d)]);
  }
  EXPECT_TRUE(line.usable());
  EXPECT_EQ(line.clamped, 0);
  EXPECT_EQ(line.largest, 4095);
}

// A whole line of a LucidGloves prototype 5: joystick, trigger, two buttons pressed, then splay.
TEST(OpenGlovesCodec, SkipsJoystickAndButtons) {
  const GloveLine line =
      parse_glove_line("A10B20C30D40E50F2047G2048P0HIJ(AB)100(BB)200(CB)300(DB)400(EB)500\r");
  EXPECT_EQ(numbers_in(line), 10);
  EXPECT_EQ(line.value[glove_curl_key(4)], 50);
  EXPECT_EQ(line.value[glove_splay_key(0)], 100);
  EXPECT_EQ(line.value[glove_splay_key(4)], 500);
  EXPECT_EQ(line.largest, 2048) << "the joystick says how wide the numbers are";
}

// From A to Z, alone or in parentheses; the characters beside these two are no keys.
TEST(OpenGlovesCodec, SkipsALetterThatIsNoKeyWithItsNumber) {
  const GloveLine line = parse_glove_line("A1Z2000(ZZ)3000(AZ)5");
  EXPECT_TRUE(line.usable());
  EXPECT_EQ(numbers_in(line), 1);
  EXPECT_EQ(line.largest, 3000);
  EXPECT_EQ(parse_glove_line("A1@4000[4000").largest, 1);
}

TEST(OpenGlovesCodec, ReadsJointsOneByOne) {
  const GloveLine line = parse_glove_line("B7(BAA)1(BAB)2(BAC)3(BAD)4(EAC)9");
  EXPECT_EQ(line.value[glove_joint_key(1, 0)], 1);
  EXPECT_EQ(line.value[glove_joint_key(1, 1)], 2);
  EXPECT_EQ(line.value[glove_joint_key(1, 2)], 3);
  EXPECT_EQ(line.value[glove_joint_key(4, 2)], 9);
  EXPECT_EQ(line.value[glove_curl_key(1)], 7);
  EXPECT_EQ(numbers_in(line), 5) << "(BAD) is no joint of ours";
}

TEST(OpenGlovesCodec, BoundsAndCountsNumbersOutOfRange) {
  const GloveLine line = parse_glove_line("A-5B4096C99999999999999999999D4095");
  EXPECT_EQ(line.value[glove_curl_key(0)], 0);
  EXPECT_EQ(line.value[glove_curl_key(1)], 4095);
  EXPECT_EQ(line.value[glove_curl_key(2)], 4095);
  EXPECT_EQ(line.clamped, 3);
}

TEST(OpenGlovesCodec, DoesNotUseTwoLinesThatRanTogether) {
  EXPECT_FALSE(parse_glove_line("A10B20C3A11B21C31D41E51").usable());
  EXPECT_FALSE(parse_glove_line("A10(AB").usable());
  EXPECT_FALSE(parse_glove_line("(A12B13").usable());
}

TEST(OpenGlovesCodec, FindsNothingInWhatIsNoLine) {
  for (const char* text : {"", "\r", "hello", "ABCDE", "12345", "F1G2H", "(ZV)7", "()5", "{}~\x80\xff"})
    EXPECT_FALSE(parse_glove_line(text).usable()) << text;
}

TEST(OpenGlovesCodec, AnswersWithAllFive) {
  EXPECT_EQ(answer({0, 1, 500, 999, 1000}), "A0B1C500D999E1000\n");
  EXPECT_EQ(answer({1000, 1000, 1000, 1000, 1000}).size(), kGloveAnswerSize);
  EXPECT_EQ(answer({-1, 1001, -2147483647, 2147483647, 0}), "A0B1000C0D1000E0\n");
}

// What is formatted is read back: the answer has the same letters as a glove's curls.
TEST(OpenGlovesCodec, ReadsItsOwnAnswers) {
  for (int stop = 0; stop <= 1000; stop += 37) {
    const GloveLine line = parse_glove_line(answer({stop, 0, stop / 2, 1000, 1000 - stop}));
    EXPECT_EQ(line.value[glove_curl_key(0)], stop);
    EXPECT_EQ(line.value[glove_curl_key(4)], 1000 - stop);
    EXPECT_TRUE(line.usable());
  }
}

TEST(OpenGlovesCodec, StaysInRangeAndAllocatesNothingWhateverComes) {
  constexpr unsigned kSeed = 20240607;
  std::mt19937 random(kSeed);
  const std::string alphabet = "ABCDEFGH()0123456789-\r\t z\x80";
  for (int round = 0; round < 20000; ++round) {
    std::string text(random() % 80, '\0');
    for (char& c : text)
      c = round % 2 == 0 ? alphabet[random() % alphabet.size()] : static_cast<char>(random());
    const std::size_t before = test::allocations_of_this_thread();
    const GloveLine line = parse_glove_line(text);
    EXPECT_EQ(test::allocations_of_this_thread(), before);
    for (std::size_t key = 0; key < line.value.size(); ++key) {
      ASSERT_GE(line.value[key], 0) << "seed " << kSeed << ": " << text;
      ASSERT_LE(line.value[key], kGloveWide) << "seed " << kSeed << ": " << text;
      ASSERT_TRUE(line.has[key] || line.value[key] == 0) << "seed " << kSeed << ": " << text;
    }
  }
}

}  // namespace
}  // namespace phalanx
