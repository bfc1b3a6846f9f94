// SPDX-License-Identifier: Apache-2.0
// A glove's port and what is learnt of its lines, without a thread.
#include "device/opengloves/glove_wire.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "device/opengloves/glove_channels.h"
#include "phalanx/device/clock.h"

namespace phalanx {
namespace {

/// A port whose other end is ours.
class PortEnds {
 public:
  PortEnds() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    glove = ends[0];
    EXPECT_EQ(::fcntl(glove, F_SETFL, O_NONBLOCK), 0);
    wire.emplace(ends[1]);
    host_ = ends[1];
  }
  ~PortEnds() { ::close(glove); }
  PortEnds(const PortEnds&) = delete;
  PortEnds& operator=(const PortEnds&) = delete;

  /// Nothing more goes through to the glove until it reads.
  void fill() const {
    const std::array<char, 4096> noise{};
    while (::write(host_, noise.data(), noise.size()) > 0) {
    }
    while (::write(host_, noise.data(), 1) > 0) {
    }
  }
  /// All that the glove can read now, without the noise of fill().
  [[nodiscard]] std::string read_all() const {
    std::string text;
    std::array<char, 4096> piece{};
    for (ssize_t size = 0; (size = ::read(glove, piece.data(), piece.size())) > 0;)
      for (ssize_t i = 0; i < size; ++i)
        if (const char c = piece[static_cast<std::size_t>(i)]; c != '\0') text += c;
    return text;
  }
  void say(const std::string& text) const {
    EXPECT_EQ(::write(glove, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  int glove = -1;
  std::optional<GloveWire> wire;

 private:
  int host_ = -1;
};

// The port is full: the first answer waits, the second is dropped whole. Once there is room the first goes
// out, and nothing of the second.
TEST(GloveWire, WritesAWholeAnswerOrNoneWhereThePortIsFull) {
  PortEnds port;
  port.fill();
  EXPECT_TRUE(port.wire->send("A1B1C1D1E1\n")) << "taken, to be written later";
  EXPECT_FALSE(port.wire->send("A2B2C2D2E2\n")) << "there is room for one";
  EXPECT_EQ(port.read_all(), "");
  EXPECT_TRUE(port.wire->send("A3B3C3D3E3\n"));
  EXPECT_EQ(port.read_all(), "A1B1C1D1E1\nA3B3C3D3E3\n");
  EXPECT_FALSE(port.wire->lost());
}

TEST(GloveWire, WritesWhatIsLeftOfAnAnswerWhileItWaits) {
  PortEnds port;
  port.fill();
  EXPECT_TRUE(port.wire->send("A1B1C1D1E1\n"));
  EXPECT_EQ(port.read_all(), "");
  port.wire->wait(10.0);
  EXPECT_EQ(port.read_all(), "A1B1C1D1E1\n");
}

// The system counts whole milliseconds, and a wait is never too short: of 10 or 10.5 of them it makes 11.
TEST(GloveWire, WaitsForItsTimeUnlessSomethingCanBeRead) {
  PortEnds port;
  const Clock clock;
  port.wire->wait(0.0105);
  EXPECT_NEAR(clock.now(), 0.011, 1e-6);
  port.wire->wait(0.010);
  EXPECT_NEAR(clock.now(), 0.022, 1e-6);
  port.say("A");
  port.wire->wait(10.0);
  EXPECT_NEAR(clock.now(), 0.022, 1e-6);
}

// The glove has closed its sending side but could still read: the waiting answer is not written, and a wait
// lasts its full time.
TEST(GloveWire, WritesNothingMoreOnceItIsLost) {
  PortEnds port;
  port.fill();
  EXPECT_TRUE(port.wire->send("A1B1C1D1E1\n"));
  ::shutdown(port.glove, SHUT_WR);
  EXPECT_EQ(port.wire->next(), GloveWire::Piece::kNone);
  ASSERT_TRUE(port.wire->lost());
  EXPECT_EQ(port.read_all(), "");
  EXPECT_FALSE(port.wire->send("A2B2C2D2E2\n"));
  const Clock clock;
  port.wire->wait(0.0105);
  EXPECT_NEAR(clock.now(), 0.011, 1e-6);
  EXPECT_EQ(port.read_all(), "");
}

// The end of a pipe that can only be written, one that can only be read, and none at all.
TEST(GloveWire, IsLostWhereItCannotBeReadOrWritten) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  GloveWire deaf(ends[1]);
  EXPECT_FALSE(deaf.lost());
  EXPECT_EQ(deaf.next(), GloveWire::Piece::kNone);
  EXPECT_TRUE(deaf.lost());
  GloveWire mute(ends[0]);
  EXPECT_FALSE(mute.send("A0\n"));
  EXPECT_TRUE(mute.lost());
  EXPECT_TRUE(GloveWire(-1).lost());
}

// 512 bytes are a line, 513 are too many; the line after it is whole again.
TEST(GloveWire, GivesLinesOfUpToFiveHundredAndTwelveBytesAndForgetsALongerOne) {
  PortEnds port;
  using Piece = GloveWire::Piece;
  port.say(std::string(512, 'A') + "\n" + std::string(513, 'B') + "\nC1\nD");
  EXPECT_EQ(port.wire->next(), Piece::kLine);
  EXPECT_EQ(port.wire->line(), std::string(512, 'A'));
  EXPECT_EQ(port.wire->next(), Piece::kTooLong);
  EXPECT_EQ(port.wire->next(), Piece::kLine);
  EXPECT_EQ(port.wire->line(), "C1");
  EXPECT_EQ(port.wire->next(), Piece::kNone);
  port.say("2\n\n");
  EXPECT_EQ(port.wire->next(), Piece::kLine);
  EXPECT_EQ(port.wire->line(), "D2");
  EXPECT_EQ(port.wire->next(), Piece::kLine);
  EXPECT_EQ(port.wire->line(), "");
  for (const char* byte : {"E", "7"}) {
    port.say(byte);
    EXPECT_EQ(port.wire->next(), Piece::kNone);
  }
  port.say("\n");
  EXPECT_EQ(port.wire->next(), Piece::kLine);
  EXPECT_EQ(port.wire->line(), "E7") << "byte by byte";
}

TEST(GloveWire, IsLostWhereTheOtherEndIsClosed) {
  PortEnds port;
  port.say("A1\n");
  ::shutdown(port.glove, SHUT_RDWR);
  EXPECT_EQ(port.wire->next(), GloveWire::Piece::kLine) << "what came before is still read";
  EXPECT_EQ(port.wire->next(), GloveWire::Piece::kNone);
  EXPECT_TRUE(port.wire->lost());
  EXPECT_FALSE(port.wire->send("A0\n"));
}

// Every line had A, one of three had B: a later line without A is a part of one, a line without B is whole.
TEST(LearntGlove, DemandsOfALineWhatEveryLineHadAndNoMore) {
  LearntGlove glove;
  EXPECT_TRUE(glove.is_whole(parse_glove_line("")));
  glove.add(parse_glove_line("A1B2"));
  glove.add(parse_glove_line("A1"));
  glove.add(parse_glove_line("A3"));
  EXPECT_TRUE(glove.is_whole(parse_glove_line("A9")));
  EXPECT_TRUE(glove.is_whole(parse_glove_line("A9B9C9")));
  EXPECT_FALSE(glove.is_whole(parse_glove_line("B9")));
  EXPECT_FALSE(glove.is_whole(parse_glove_line("C9")));
}

TEST(LearntGlove, IsWideFromOneThousandAndTwentyFourOn) {
  for (const auto& [line, full_scale] : {std::pair{"A1023", 1023}, std::pair{"A1024", 4095}}) {
    LearntGlove glove;
    glove.add(parse_glove_line(line));
    glove.add(parse_glove_line("A5"));
    EXPECT_EQ(glove.full_scale(), full_scale);
  }
}

// Without a hand a joint goes from straight to a right angle: pi / 2 over 1023 counts.
TEST(GloveChannels, OfAJointWithoutAHandGoFromStraightToARightAngle) {
  LearntGlove glove;
  glove.add(parse_glove_line("(BAA)0(BAB)0(BAC)0(BB)0"));
  const auto channels = glove_channels(glove, kGloveNarrow, std::nullopt);
  ASSERT_EQ(channels.size(), 4U);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(channels[j].channel.gain, std::numbers::pi / 2.0 / 1023.0, 1e-15);
    EXPECT_EQ(channels[j].channel.offset, 0.0);
  }
  EXPECT_NEAR(channels[3].channel.gain, 2.0 / 1023.0, 1e-15);
  EXPECT_EQ(channels[3].channel.offset, -1.0);
}

}  // namespace
}  // namespace phalanx
