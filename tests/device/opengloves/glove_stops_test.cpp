// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_stops.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "device/opengloves/glove_channels.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

// Flexion joints of the simple hand go from -0.5 to 2: curl = (q + 0.5) / 2.5.
const HandParameters& hand() {
  static const HandParameters parameters = test::simple_parameters();
  return parameters;
}

std::vector<DeviceChannel> channels_of(const char* line, int full_scale = kGloveWide) {
  LearntGlove glove;
  glove.add(parse_glove_line(line));
  std::vector<DeviceChannel> channels;
  for (const GloveChannel& c : glove_channels(glove, full_scale, hand())) channels.push_back(c.channel);
  return channels;
}

DeviceCommand stopped_index(double mcp, double pip, double dip) {
  DeviceCommand command;
  command.enable = true;
  command.stopped[test::kIndex] = true;
  command.gdp_angle = test::index_angles(mcp, pip, dip, 0.3);
  return command;
}

TEST(GloveStops, AreOneThousandTimesOneMinusTheShownCurl) {
  const GloveStopper stopper(channels_of("A0B0C0D0E0"), kGloveWide, hand());
  EXPECT_EQ(stopper.stops(stopped_index(-0.5, -0.5, -0.5)), (GloveStops{0, 1000, 0, 0, 0}));
  EXPECT_EQ(stopper.stops(stopped_index(2.0, 2.0, 2.0)), (GloveStops{0, 0, 0, 0, 0}));
  // (0 + 0.5 + 1.5) / 3 + 0.5 over 2.5 = 0.4666..
  EXPECT_EQ(stopper.stops(stopped_index(0.0, 0.5, 1.5)), (GloveStops{0, 533, 0, 0, 0}));
}

TEST(GloveStops, OfAGloveThatSensesEachJointAreThoseOfItsMean) {
  const GloveStopper stopper(channels_of("B0(BAA)0(BAB)0(BAC)0", kGloveNarrow), kGloveNarrow, hand());
  EXPECT_EQ(stopper.stops(stopped_index(0.0, 0.5, 1.5)), (GloveStops{0, 533, 0, 0, 0}));
}

// A glove that reads 1000 for the open hand and 3000 for the fist: curl 0.5 is raw 2000, 0.48840 of 4095.
TEST(GloveStops, StandWhereACalibratedGloveReadsThatCurl) {
  auto channels = channels_of("A0B0C0D0E0");
  channels[test::kIndex].gain = 1.0 / 2000.0;
  channels[test::kIndex].offset = -0.5;
  const GloveStopper stopper(channels, kGloveWide, hand());
  EXPECT_EQ(stopper.stops(stopped_index(0.75, 0.75, 0.75))[test::kIndex], 512);
}

TEST(GloveStops, AreFreeUnlessEnabledAndStopped) {
  const GloveStopper stopper(channels_of("A0B0C0D0E0"), kGloveWide, hand());
  DeviceCommand command = stopped_index(0.0, 0.0, 0.0);
  command.enable = false;
  EXPECT_EQ(stopper.stops(command), GloveStops{});
  command.enable = true;
  command.stopped[test::kIndex] = false;
  EXPECT_EQ(stopper.stops(command), GloveStops{});
}

TEST(GloveStops, AreFreeWithoutAHandAndWithoutASensor) {
  EXPECT_EQ(GloveStopper(channels_of("A0B0"), kGloveWide, std::nullopt).stops(stopped_index(0, 0, 0)),
            GloveStops{});
  EXPECT_EQ(GloveStopper(channels_of("A0C0"), kGloveWide, hand()).stops(stopped_index(0, 0, 0)),
            GloveStops{});
}

TEST(GloveStops, AreFreeWhereAnAngleIsNotANumberAndBoundedElsewhere) {
  const GloveStopper stopper(channels_of("A0B0C0D0E0"), kGloveWide, hand());
  EXPECT_EQ(stopper.stops(stopped_index(std::numeric_limits<double>::quiet_NaN(), 0, 0)), GloveStops{});
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle(-100.0, 100.0);
  for (int i = 0; i < 1000; ++i) {
    const int stop = stopper.stops(stopped_index(angle(random), angle(random), angle(random)))[test::kIndex];
    ASSERT_GE(stop, 0) << "seed " << kSeed;
    ASSERT_LE(stop, 1000) << "seed " << kSeed;
  }
}

TEST(GloveChannels, AreCurlsUnlessAllThreeJointsAreSent) {
  const auto channels = channels_of("A0B0C0(AAA)0(AAB)0(AAC)0(BAA)0(CB)0(DAB)0", kGloveNarrow);
  ASSERT_EQ(channels.size(), 7U);
  for (int j = 0; j < 3; ++j) {
    const DeviceChannel& c = channels[static_cast<std::size_t>(j)];
    EXPECT_EQ(c.kind, ChannelKind::kAngle);
    EXPECT_EQ(c.index, joint_index(0, j == 0 ? 0 : j + 1));
    EXPECT_DOUBLE_EQ(c.offset, -0.5);
    EXPECT_NEAR(c.offset + c.gain * kGloveNarrow, 2.0, 1e-12);
    EXPECT_EQ(c.raw_max, kGloveNarrow);
  }
  EXPECT_EQ(channels[3].kind, ChannelKind::kCurl) << "only one joint of the index is sent: its curl counts";
  EXPECT_EQ(channels[3].index, 1);
  EXPECT_EQ(channels[4].kind, ChannelKind::kCurl);
  EXPECT_EQ(channels[5].kind, ChannelKind::kSplay);
  EXPECT_EQ(channels[5].index, 2);
  EXPECT_DOUBLE_EQ(channels[5].offset, -1.0);
  EXPECT_EQ(channels[6].kind, ChannelKind::kAngle) << "the ring finger has no curl, but a joint";
  EXPECT_EQ(channels[6].index, joint_index(3, 2));
}

}  // namespace
}  // namespace phalanx
