// SPDX-License-Identifier: Apache-2.0
// The glove's driver against firmware that waits for an answer at every loop.
#include "phalanx/device/opengloves/opengloves_device.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <regex>
#include <string>
#include <thread>
#include <utility>

#include "device/opengloves/glove_firmware.h"
#include "device/opengloves/quick_settings.h"
#include "support/count_allocations.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::GloveFirmware;
using test::quick;
using ::testing::Each;
using ::testing::HasSubstr;

constexpr const char* kOpenGlove = "A0B0C0D0E0F2047G2047P0(AB)2047(BB)2047(CB)2047(DB)2047(EB)2047";
constexpr const char* kFree = "A0B0C0D0E0";

struct Fixture {
  explicit Fixture(const char* line, const OpenGlovesSettings& settings = quick()) : firmware(line) {
    device = make_opengloves_device(firmware.host_descriptor(), clock, settings);
    device->set_hand(test::simple_parameters());
  }
  ~Fixture() { device->close(); }

  // Polls, for there is no end to a test otherwise; false after 10 s.
  static bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 10000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  // The first sample for which `is` holds.
  bool sample_where(const std::function<bool(const DeviceSample&)>& is) {
    return eventually([&] {
      std::array<DeviceSample, 64> inbox;
      const std::size_t count = device->receive(clock.now(), inbox);
      for (std::size_t i = 0; i < count; ++i) {
        sample = inbox[i];
        if (is(sample)) return true;
      }
      return false;
    });
  }
  // Sends the command again and again, as a loop does, until the glove is told so.
  bool told(const DeviceCommand& command, const std::string& answer) {
    return eventually([&] {
      device->send(command);
      return firmware.last_answer() == answer;
    });
  }

  Clock clock;
  GloveFirmware firmware;
  std::unique_ptr<OpenGlovesDevice> device;
  DeviceSample sample;
};

DeviceCommand stopped_index(double q) {
  DeviceCommand command;
  command.tick = 42;
  command.enable = true;
  command.stopped[test::kIndex] = true;
  command.gdp_angle = test::index_angles(q, q, q);
  return command;
}

TEST(OpenGlovesDevice, LearnsItsChannelsFromTheFirstLines) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  const DeviceInfo& info = glove.device->info();
  EXPECT_EQ(info.name, "opengloves");
  ASSERT_EQ(info.channels.size(), 10U);
  EXPECT_EQ(info.channels[0].kind, ChannelKind::kCurl);
  EXPECT_EQ(info.channels[1].kind, ChannelKind::kSplay);
  EXPECT_FALSE(info.renders_torque);
  EXPECT_EQ(info.channels[0].raw_max, 4095) << "the joystick at rest says so, with a hand that is open";
  EXPECT_DOUBLE_EQ(info.channels[0].gain, 1.0 / 4095.0);
}

TEST(OpenGlovesDevice, BearsTheSerialNumberThatItIsGiven) {
  auto settings = quick();
  settings.serial = "L-7";
  Fixture glove(kOpenGlove, settings);
  glove.device->open();
  EXPECT_EQ(glove.device->info().serial, "L-7");
}

// Five lines within the second that it learns for are four periods: 4 Hz.
TEST(OpenGlovesDevice, WaitsForThreeSecondsAndLearnsForOneUnlessItIsToldOtherwise) {
  Fixture silent("", {});
  EXPECT_THAT([&] { silent.device->open(); }, ::testing::ThrowsMessage<DeviceError>(HasSubstr("within 3 s")));
  Fixture glove("", {});
  std::string bytes = "\n";
  for (int i = 0; i < 5; ++i) bytes += "A0B0C0D0E0\n";
  glove.firmware.blurt(bytes);
  glove.device->open();
  EXPECT_NEAR(glove.device->info().rate_hz, 4.0, 1e-9);
}

/// Restores standard input at the end of its scope.
class KeptStandardInput {
 public:
  KeptStandardInput() : kept_(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 100)) {}
  ~KeptStandardInput() {
    if (kept_ < 0) {
      ::close(STDIN_FILENO);
      return;
    }
    ::dup2(kept_, STDIN_FILENO);
    ::close(kept_);
  }
  KeptStandardInput(const KeptStandardInput&) = delete;
  KeptStandardInput& operator=(const KeptStandardInput&) = delete;

 private:
  int kept_;  ///< negative: there is none
};

// In a program without a standard input the port that it opens has the number 0.
TEST(OpenGlovesDevice, TakesTheDescriptorZeroAsWell) {
  const KeptStandardInput kept;
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(nothing, 0);
  if (nothing != STDIN_FILENO) {
    ASSERT_EQ(::dup2(nothing, STDIN_FILENO), STDIN_FILENO);
    ::close(nothing);
  }
  GloveFirmware firmware("");
  const int descriptor = firmware.host_descriptor();
  ASSERT_EQ(::dup2(descriptor, STDIN_FILENO), STDIN_FILENO);
  ::close(descriptor);
  struct stat port = {};
  ASSERT_EQ(::fstat(STDIN_FILENO, &port), 0);
  const Clock clock;
  auto device = make_opengloves_device(STDIN_FILENO, clock, quick());
  firmware.blurt("\nA0B0\n");
  EXPECT_NO_THROW(device->open());
  EXPECT_EQ(device->info().channels.size(), 2U);
  device->close();
  device.reset();
  // A runtime that opens a file on another thread may have taken the number meanwhile; it is not the port.
  struct stat now = {};
  EXPECT_FALSE(::fstat(STDIN_FILENO, &now) == 0 && now.st_rdev == port.st_rdev)
      << "the device owned the descriptor";
}

TEST(OpenGlovesDevice, TakesNarrowNumbersForWhatTheyAre) {
  Fixture glove("A0B1023C0D0E0F511G511");
  glove.device->open();
  ASSERT_EQ(glove.device->info().channels.size(), 5U);
  EXPECT_EQ(glove.device->info().channels[0].raw_max, 1023);
  ASSERT_TRUE(glove.sample_where([](const DeviceSample& s) { return s.raw[1] == 1023; }));
}

// A wide glove whose first lines looked narrow: the number comes through as it is, outside the channel's
// range, where every station calls it a sensor fault.
TEST(OpenGlovesDevice, NeverHidesThatItTookAWideGloveForANarrowOne) {
  Fixture glove("A0B0C0D0E0");
  glove.device->open();
  EXPECT_EQ(glove.device->info().channels[1].raw_max, 1023);
  glove.firmware.say("A0B2000C0D0E0");
  ASSERT_TRUE(glove.sample_where([](const DeviceSample& s) { return s.raw[1] == 2000; }));
  EXPECT_GT(glove.sample.raw[1], glove.device->info().channels[1].raw_max);
}

TEST(OpenGlovesDevice, BelievesTheFullScaleThatItIsGiven) {
  auto settings = quick();
  settings.full_scale = 4095;
  Fixture glove("A0B0C0D0E0", settings);
  glove.device->open();
  EXPECT_EQ(glove.device->info().channels[1].raw_max, 4095);
  settings.full_scale = 1000;
  EXPECT_THROW(Fixture("A0", settings), std::invalid_argument);
}

// The firmware goes on only after a line of the host: that it goes on at all says that each was answered.
TEST(OpenGlovesDevice, AnswersEveryLineWithAllFive) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  const std::size_t newlines = glove.firmware.newlines();
  ASSERT_TRUE(glove.firmware.wait_for_answers(200));  // a millisecond each, at least
  EXPECT_EQ(glove.firmware.newlines(), newlines) << "where lines come every millisecond";
  const auto lines = static_cast<std::size_t>(glove.firmware.lines_sent());
  const std::vector<std::string> answers = glove.firmware.answers();
  const std::regex all_five("A[0-9]+B[0-9]+C[0-9]+D[0-9]+E[0-9]+");
  for (const std::string& answer : answers) EXPECT_TRUE(std::regex_match(answer, all_five)) << answer;
  EXPECT_GE(answers.size() + 1, lines) << "the last one may still be on its way";
}

TEST(OpenGlovesDevice, GivesSamplesInOrderWithRawNumbers) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  glove.firmware.say("A1B2C3D4E5F2047G2047P0(AB)6(BB)7(CB)8(DB)9(EB)10");
  std::uint32_t sequence = 0;
  std::uint64_t time_us = 0;
  ASSERT_TRUE(glove.sample_where([&](const DeviceSample& s) {
    EXPECT_GT(s.sequence, sequence);
    EXPECT_GT(s.time_us, time_us);
    sequence = s.sequence;
    time_us = s.time_us;
    return s.raw[0] == 1;
  }));
  const std::array<std::int32_t, 10> expected = {1, 6, 2, 7, 3, 8, 4, 9, 5, 10};
  for (std::size_t c = 0; c < expected.size(); ++c) EXPECT_EQ(glove.sample.raw[c], expected[c]) << c;
  EXPECT_EQ(glove.sample.raw[10], 0) << "there is no such channel";
  EXPECT_EQ(glove.sample.state, DeviceState::kReady);
  EXPECT_GT(glove.sample.received, 0.1) << "it has learnt for so long";
  EXPECT_NEAR(glove.sample.received, 1e-6 * static_cast<double>(glove.sample.time_us), 1e-3);
}

// By hand: while it learns an empty line and two whole ones are answered, and give no sample. Of the four
// lines that follow one is a part, and one has a number that is too large.
TEST(OpenGlovesDevice, CountsWhatComesAndWhatIsLost) {
  Fixture glove("");
  const LinkStatistics none = glove.device->statistics();
  EXPECT_EQ(none.received + none.corrupt + none.overflowed + none.sent + none.device_corrupt, 0U);
  glove.firmware.blurt("\nA0B0C0D0E0\nA0B0C0D0E0\n");
  glove.device->open();
  glove.firmware.blurt("A1B1C1D1E1\nA2B2C2D2E2\nA3\nA3B3C3D3E5000\n");
  ASSERT_TRUE(glove.eventually([&] { return glove.device->statistics().received >= 3; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(1));  // until the glove's thread sleeps, too
  const LinkStatistics counted = glove.device->statistics();
  EXPECT_EQ(counted.received, 3U);
  EXPECT_EQ(counted.corrupt, 1U);
  EXPECT_EQ(counted.device_corrupt, 1U);
  EXPECT_EQ(counted.sent, 7U);
  EXPECT_EQ(counted.overflowed, 0U);
  std::array<DeviceSample, 1> room;
  ASSERT_EQ(glove.device->receive(0.0, room), 1U);
  EXPECT_EQ(room[0].raw[3], 3);
  EXPECT_EQ(room[0].raw[4], 4095);
  EXPECT_EQ(glove.device->statistics().overflowed, 2U);
}

// The glove sends and does not read: its port is full after a few answers.
TEST(OpenGlovesDevice, CountsOnlyTheAnswersThatThePortTakes) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  const int least = 1;  // the system takes its own least
  ASSERT_EQ(::setsockopt(ends[1], SOL_SOCKET, SO_SNDBUF, &least, sizeof(least)), 0);
  const Clock clock;
  const auto device = make_opengloves_device(ends[1], clock, quick());
  const auto say = [&](int lines) {
    std::string text;
    for (int i = 0; i < lines; ++i) text += "A0B0C0D0E0\n";
    EXPECT_EQ(::write(ends[0], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  };
  say(3);
  device->open();
  say(2000);
  ASSERT_TRUE(Fixture::eventually([&] { return device->statistics().received >= 2000; }));
  const std::uint64_t sent = device->statistics().sent;
  EXPECT_LT(sent, 2000U) << "or the port was never full";
  ASSERT_EQ(::fcntl(ends[0], F_SETFL, O_NONBLOCK), 0);
  std::uint64_t answers = 0;
  EXPECT_TRUE(Fixture::eventually([&] {
    std::array<char, 4096> piece{};
    const ssize_t size = ::read(ends[0], piece.data(), piece.size());
    if (size > 0) answers += static_cast<std::uint64_t>(std::count(piece.begin(), piece.begin() + size, 'E'));
    return answers == sent;
  })) << answers
      << " of " << sent;
  device->close();
  ::close(ends[0]);
}

TEST(OpenGlovesDevice, StopsTheDigitThatIsStoppedAndLetsGoAgain) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  // (0.75 + 0.5) / 2.5 = 0.5 of the curl.
  ASSERT_TRUE(glove.told(stopped_index(0.75), "A0B500C0D0E0"));
  ASSERT_TRUE(glove.eventually([&] {
    glove.device->send(stopped_index(0.75));
    std::array<DeviceSample, 64> inbox;
    const std::size_t count = glove.device->receive(0.0, inbox);
    return count > 0 && inbox[count - 1].acted_tick == 42 && inbox[count - 1].state == DeviceState::kActive;
  }));
  DeviceCommand disabled = stopped_index(0.75);
  disabled.enable = false;
  EXPECT_TRUE(glove.told(disabled, kFree));
}

TEST(OpenGlovesDevice, LetsGoWhenTheLoopFallsSilent) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  ASSERT_TRUE(glove.told(stopped_index(0.75), "A0B500C0D0E0"));
  EXPECT_TRUE(glove.firmware.wait_for_answer(kFree));
}

TEST(OpenGlovesDevice, AGloveThatOnlySensesIsNeverToldToHoldAFinger) {
  Fixture glove(kOpenGlove);
  glove.device->set_force_feedback(false);
  glove.device->open();
  EXPECT_FALSE(glove.device->info().actuated);
  ASSERT_TRUE(glove.sample_where([&](const DeviceSample& sample) {
    glove.device->send(stopped_index(0.75));
    return sample.acted_tick == 42 && sample.state == DeviceState::kActive;
  }));
  EXPECT_THAT(glove.firmware.answers(), Each(kFree));
}

TEST(OpenGlovesDevice, LetsGoWhenItIsClosed) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  ASSERT_TRUE(glove.told(stopped_index(0.75), "A0B500C0D0E0"));
  glove.device->send(stopped_index(0.75));
  glove.device->close();
  EXPECT_TRUE(glove.firmware.wait_for_answer(kFree));
  glove.device->close();
}

TEST(OpenGlovesDevice, KeepsASilentGloveAliveWithNewlines) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  glove.firmware.say("");
  EXPECT_TRUE(glove.firmware.wait_for_newlines(1));
  const double first = glove.clock.now();
  EXPECT_TRUE(glove.firmware.wait_for_newlines(10));
  // Every 100 ms, and up to 11 ms more until it looks again.
  EXPECT_GT(glove.clock.now() - first, 0.98);
  EXPECT_LT(glove.clock.now() - first, 1.3);
  glove.firmware.say(kOpenGlove);
  EXPECT_TRUE(glove.firmware.wait_for_answers(3)) << "and goes on where it speaks again";
  EXPECT_EQ(glove.device->connection_fault(), Fault::kNone);
}

// A line that the glove is half through when the host comes, garbage, half lines, a line without an end: each
// line end is answered, nothing of it becomes a sample.
TEST(OpenGlovesDevice, UsesNothingOfADamagedLineAndAnswersItAllTheSame) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  const auto before = glove.device->statistics();
  glove.firmware.blurt("A4000B40\nB12A1A2\n\x01\xff\x80garbage(((\n" + std::string(5000, 'A') + "9\n\n");
  glove.firmware.blurt("A1B1C1D1E1A2");  // runs together with the next line
  ASSERT_TRUE(glove.eventually([&] { return glove.device->statistics().corrupt >= before.corrupt + 6; }));
  EXPECT_EQ(glove.device->statistics().corrupt, before.corrupt + 6);
  ASSERT_TRUE(glove.firmware.wait_for_answers(20));
  std::array<DeviceSample, 512> inbox;
  const std::size_t count = glove.device->receive(0.0, inbox);
  ASSERT_GT(count, 0U);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 10; ++c) ASSERT_EQ(inbox[i].raw[c], c % 2 == 0 ? 0 : 2047);
}

TEST(OpenGlovesDevice, DoesNotBelieveTheFirstLineWhichMayBeHalfAOne) {
  GloveFirmware firmware("");
  firmware.blurt("47(AB)3000\n");
  Clock clock;
  const auto device = make_opengloves_device(firmware.host_descriptor(), clock, quick());
  firmware.say("A0B0C0D0E0");
  device->open();
  EXPECT_EQ(device->info().channels.size(), 5U) << "no splay";
  device->close();
}

TEST(OpenGlovesDevice, SaysThatTheGloveIsUnplugged) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  glove.firmware.unplug();
  EXPECT_TRUE(glove.eventually([&] { return glove.device->connection_fault() == Fault::kDeviceLost; }));
  glove.device->reset();  // a descriptor cannot be opened again
  glove.device->send(stopped_index(0.5));
  EXPECT_EQ(glove.device->connection_fault(), Fault::kDeviceLost);
}

TEST(OpenGlovesDevice, RefusesAGloveThatSaysNothing) {
  auto settings = quick();
  settings.hello_timeout = 0.2;
  Fixture glove("", settings);
  try {
    glove.device->open();
    ADD_FAILURE() << "opened";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no line that a glove sends"));
    EXPECT_THAT(error.what(), HasSubstr("baud"));
  }
}

TEST(OpenGlovesDevice, RefusesWhatIsNoGlove) {
  auto settings = quick();
  settings.hello_timeout = 0.2;
  Fixture glove("0&0&0&0&0", settings);  // the firmware's other encoding
  EXPECT_THROW(glove.device->open(), DeviceError);
}

TEST(OpenGlovesDevice, TakesOnlyACalibrationOfItsOwnChannels) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  auto channels = glove.device->info().channels;
  channels[0].gain *= 1.1;
  EXPECT_NO_THROW(glove.device->set_calibration(channels));
  channels[0].gain = 0.0;
  EXPECT_THROW(glove.device->set_calibration(channels), std::invalid_argument);
  channels = glove.device->info().channels;
  channels.pop_back();
  EXPECT_THROW(glove.device->set_calibration(channels), std::invalid_argument);
}

// Half the curl is raw (0.5 + 0.5) 2000 = 2000 of 4095, and the stop 1000 (1 - 2000 / 4095) = 511.6.
TEST(OpenGlovesDevice, StopsWhereTheCalibrationSays) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  auto channels = glove.device->info().channels;
  ASSERT_EQ(channels[2].kind, ChannelKind::kCurl);
  ASSERT_EQ(channels[2].index, test::kIndex);
  channels[2].gain = 1.0 / 2000.0;
  channels[2].offset = -0.5;
  glove.device->set_calibration(channels);
  EXPECT_TRUE(glove.told(stopped_index(0.75), "A0B512C0D0E0"));
}

TEST(OpenGlovesDevice, AllocatesNothingInTheLoop) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  glove.firmware.say("");
  ASSERT_TRUE(glove.firmware.wait_for_newlines(2));  // the firmware's own vectors stand still
  const std::size_t before = test::allocations();
  std::array<DeviceSample, 64> inbox;
  for (int i = 0; i < 100; ++i) {
    glove.device->send(stopped_index(0.01 * i));
    static_cast<void>(glove.device->receive(0.0, inbox));
    static_cast<void>(glove.device->statistics());
    static_cast<void>(glove.device->connection_fault());
  }
  EXPECT_EQ(test::allocations(), before);
}

// The device's factor is all or nothing: a glove has no ramp.
TEST(OpenGlovesDevice, SaysAFactorOfOneWhileItActsAndZeroElse) {
  Fixture glove(kOpenGlove);
  glove.device->open();
  ASSERT_TRUE(glove.sample_where([](const DeviceSample&) { return true; }));
  EXPECT_EQ(glove.sample.state, DeviceState::kReady);
  EXPECT_EQ(glove.sample.factor, 0.0);
  ASSERT_TRUE(glove.sample_where([&](const DeviceSample& s) {
    glove.device->send(stopped_index(0.75));
    return s.state == DeviceState::kActive;
  }));
  EXPECT_EQ(glove.sample.factor, 1.0);
  ASSERT_TRUE(glove.sample_where([](const DeviceSample& s) { return s.state == DeviceState::kReady; }))
      << "the loop is silent";
  EXPECT_EQ(glove.sample.factor, 0.0);
}

// Two whole lines in 0.1 s have one period between them: 10 Hz. One line says nothing of a rate: 1 Hz.
TEST(OpenGlovesDevice, LearnsItsRateFromThePeriodsBetweenLines) {
  for (const auto& [lines, rate_hz] : {std::pair{1, 1.0}, std::pair{2, 10.0}, std::pair{5, 40.0}}) {
    Fixture glove("");
    std::string bytes = "\n";
    for (int i = 0; i < lines; ++i) bytes += "A0B0C0D0E0\n";
    glove.firmware.blurt(bytes);
    glove.device->open();
    EXPECT_NEAR(glove.device->info().rate_hz, rate_hz, 1e-9) << lines;
  }
}

// A clock so slow that it stands: lines that come at one time are still one after the other.
TEST(OpenGlovesDevice, GivesNoTwoSamplesTheSameTimeAlsoWhereTheClockStands) {
  const Clock standing(1e9);
  GloveFirmware firmware("A0B0C0D0E0");
  const auto device =
      make_opengloves_device(firmware.host_descriptor(), standing,
                             {.full_scale = 0, .hello_timeout = 1e-6, .learn_for = 1e-10, .serial = ""});
  device->open();
  std::uint64_t time_us = 0;
  std::uint32_t count = 0;
  ASSERT_TRUE(Fixture::eventually([&] {
    std::array<DeviceSample, 64> inbox;
    const std::size_t came = device->receive(0.0, inbox);
    for (std::size_t i = 0; i < came; ++i) {
      EXPECT_GT(inbox[i].time_us, time_us);
      time_us = inbox[i].time_us;
      ++count;
    }
    return count >= 20;
  }));
  device->close();
}

}  // namespace
}  // namespace phalanx
