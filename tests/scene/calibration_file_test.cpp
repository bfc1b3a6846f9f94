// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/calibration_file.h"

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <random>

#include "record/temporary_folder.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

Calibration example() {
  Calibration c;
  c.device = "a \"glove\" \\ with\na name";
  c.serial = "0007 \xc3\xa4";
  c.date = "2026-05-04T09:30:00Z";
  c.phalanx = "0.1.0";
  c.channels.push_back({.channel = {.kind = ChannelKind::kAngle,
                                    .index = joint_index(1, 2),
                                    .gain = -1.0 / 3.0 * 1e-3,
                                    .offset = 2.0 / 7.0},
                        .residual = 0.012345678901234567,
                        .poses = {{.pose = "open hand", .value = 0.0, .raw = 3021.5, .residual = -0.01},
                                  {.pose = "fist", .value = 1.7453292519943295, .raw = 12.25}},
                        .method = CalibrationMethod::kGoniometer,
                        .date = "2026-05-03T10:00:00Z"});
  c.channels.push_back(
      {.channel = {.kind = ChannelKind::kCurl, .index = 0, .gain = 1e-300, .offset = -1e-5}});
  c.channels.push_back({.channel = {.kind = ChannelKind::kSplay, .index = 4, .gain = 2.0, .offset = -1.0}});
  return c;
}

const std::string kHead =
    "format = 2\ndevice = \"glove\"\nserial = \"1\"\ndate = \"2026-05-04T09:30:00Z\"\nphalanx = \"0.1.0\"\n";
const std::string kAngle = "[[channel]]\nkind = \"angle\"\njoint = \"index_pip_flexion\"\n";
const std::string kNumbers = "gain = 0.001\noffset = 0\nresidual_rad = 0\nmethod = \"jig\"\nposes = []\n";

void expect_bad_calibration(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_calibration(text, "bad.toml")); }, words);
}

void expect_same(const Calibration& a, const Calibration& b) {
  EXPECT_EQ(a.device, b.device);
  EXPECT_EQ(a.serial, b.serial);
  EXPECT_EQ(a.date, b.date);
  EXPECT_EQ(a.phalanx, b.phalanx);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const CalibratedChannel& x = a.channels[i];
    const CalibratedChannel& y = b.channels[i];
    EXPECT_EQ(x.channel.kind, y.channel.kind);
    EXPECT_EQ(x.channel.index, y.channel.index);
    EXPECT_EQ(x.channel.gain, y.channel.gain);
    EXPECT_EQ(x.channel.offset, y.channel.offset);
    EXPECT_EQ(x.residual, y.residual);
    EXPECT_EQ(x.method, y.method);
    EXPECT_EQ(x.date, y.date);
    ASSERT_EQ(x.poses.size(), y.poses.size());
    for (std::size_t p = 0; p < x.poses.size(); ++p) {
      EXPECT_EQ(x.poses[p].pose, y.poses[p].pose);
      EXPECT_EQ(x.poses[p].raw, y.poses[p].raw);
      EXPECT_EQ(x.poses[p].value, y.poses[p].value);
      EXPECT_EQ(x.poses[p].residual, y.poses[p].residual);
    }
  }
}

TEST(CalibrationFile, ReadsBackToTheSameBits) {
  expect_same(parse_calibration(calibration_text(example()), "round trip"), example());
}

TEST(CalibrationFile, ReadsBackWhateverTheNumbersAre) {
  constexpr unsigned kSeed = 99;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> number(-99.0, 99.0);
  for (int round = 0; round < 200; ++round) {
    Calibration c = example();
    for (CalibratedChannel& channel : c.channels) {
      channel.channel.gain = number(random);
      channel.channel.offset = 1e4 * number(random);
      channel.residual = std::abs(number(random)) / 10.0;
      for (PoseReading& pose : channel.poses) pose.raw = 1e7 * number(random);
    }
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    expect_same(parse_calibration(calibration_text(c), "round trip"), c);
  }
}

TEST(CalibrationFile, IsReadFromAFile) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "mine.toml") << calibration_text(example());
  expect_same(load_calibration(folder / "mine.toml"), example());
  expect_scene_error([&] { static_cast<void>(load_calibration(folder / "none.toml")); }, {"none.toml"});
}

TEST(CalibrationFile, HoldsOnlyWhatPosesCanCalibrate) {
  Calibration c = example();
  c.channels[0].channel.kind = ChannelKind::kMotor;
  EXPECT_THROW(static_cast<void>(calibration_text(c)), std::invalid_argument);
  for (const auto& [kind, index] : {std::pair{ChannelKind::kCurl, 5},
                                    {ChannelKind::kSplay, -1},
                                    {ChannelKind::kAngle, kJoints},
                                    {ChannelKind::kAngle, -1}}) {
    c.channels[0].channel = {.kind = kind, .index = index};
    EXPECT_THROW(static_cast<void>(calibration_text(c)), std::invalid_argument) << index;
  }
  c.channels[0].channel = {.kind = ChannelKind::kAngle, .index = kJoints - 1};
  EXPECT_NO_THROW(static_cast<void>(calibration_text(c)));
}

TEST(CalibrationFile, OfAnotherFormatIsRefused) {
  expect_bad_calibration("format = 1\n", {"bad.toml:1", "format = 1", "reads format 2"});
  expect_bad_calibration("format = \"1\"\n", {"format", "is a string"});
  expect_bad_calibration("format = nan\n", {"format", "must be"});
  expect_bad_calibration("", {"format", "is missing"});
}

TEST(CalibrationFile, WithAHeadThatIsNone) {
  expect_bad_calibration("format = 2\ndevice = 3\n", {"device = 3", "write a string"});
  // The characters next to the digits are '/' and ':'.
  for (const char* date : {"yesterday", "2026-05-04", "2026-05-04 09:30:00Z", "2026-05-04T09:30:00+02:00",
                           "2026-05-/4T09:30:00Z", "2026-05-:4T09:30:00Z"}) {
    expect_bad_calibration(
        "format = 2\ndevice = \"d\"\nserial = \"s\"\ndate = \"" + std::string(date) + "\"\nphalanx = \"1\"\n",
        {"bad.toml:4", "date", "2026-05-04T09:30:00Z"});
  }
  expect_bad_calibration("format = 2\ndevice = \"d\"\nserial = \"s\"\n", {"date", "is missing"});
}

TEST(CalibrationFile, WithoutAChannelOrWithTooMany) {
  expect_bad_calibration(kHead, {"channel", "is missing"});
  expect_bad_calibration(kHead + "channel = []\n", {"channel", "0 channels"});
  expect_bad_calibration(kHead + "channel = 5\n", {"channel", "array of tables"});
}

TEST(CalibrationFile, WithAChannelTwice) {
  expect_bad_calibration(kHead + kAngle + kNumbers + kAngle + kNumbers,
                         {"angle of index_pip_flexion", "twice"});
}

// Two of one kind, and two of one digit, are four channels.
TEST(CalibrationFile, TellsChannelsByKindAndPlace) {
  const std::string curl = "[[channel]]\nkind = \"curl\"\ndigit = \"thumb\"\n" + kNumbers;
  const std::string text = kHead + kAngle + kNumbers +
                           "[[channel]]\nkind = \"angle\"\njoint = \"index_mcp_flexion\"\n" + kNumbers +
                           "[[channel]]\nkind = \"splay\"\ndigit = \"thumb\"\n" + kNumbers + curl;
  EXPECT_EQ(parse_calibration(text, "good.toml").channels.size(), 4U);
  expect_bad_calibration(text + curl, {"bad.toml", "twice"});
}

TEST(CalibrationFile, WithANameThatNobodyKnows) {
  expect_bad_calibration(kHead + "[[channel]]\nkind = \"angel\"\n", {"kind = 'angel'", "\"angle\""});
  expect_bad_calibration(kHead + "[[channel]]\nkind = \"angle\"\njoint = \"index_pip\"\n",
                         {"bad.toml:8", "\"index_pip_flexion\""});
  expect_bad_calibration(kHead + "[[channel]]\nkind = \"curl\"\ndigit = \"pinky\"\n", {"digit = 'pinky'"});
  expect_bad_calibration(kHead + "[[channel]]\nkind = \"curl\"\njoint = \"index_pip_flexion\"\n",
                         {"digit", "is missing"});
  expect_bad_calibration(kHead + kAngle + "gain = 1\noffset = 0\nresidual_rad = 0\nmethod = \"jigg\"\n",
                         {"method = 'jigg'", "\"jig\""});
  expect_bad_calibration(kHead + kAngle + kNumbers + "date = \"today\"\n", {"date", "2026-05-04T09:30:00Z"});
  expect_bad_calibration(kHead + kAngle + kNumbers + "gian = 1\n", {"gian = 1", "gain"});
}

TEST(CalibrationFile, WithABadNumber) {
  const std::string rest = "offset = 0\nresidual_rad = 0\nmethod = \"jig\"\nposes = []\n";
  for (const char* bad : {"nan", "inf", "-inf", "1e9", "true", "\"1\"", "0"})
    expect_bad_calibration(kHead + kAngle + "gain = " + bad + "\n" + rest, {"bad.toml:9", "gain"});
  expect_bad_calibration(kHead + kAngle + "gain = 1\noffset = nan\n", {"offset = nan"});
  expect_bad_calibration(kHead + kAngle + "gain = 1\noffset = 0\nresidual_rad = -1\n", {"residual_rad = -1"});
  expect_bad_calibration(
      kHead + kAngle +
          "gain = 1\noffset = 0\nresidual_rad = 0\nmethod = \"jig\"\nposes = [{ name = \"a\", raw = 1e99, "
          "value = 0 }]\n",
      {"raw"});
  expect_bad_calibration(
      kHead + kAngle + "gain = 1\noffset = 0\nresidual_rad = 0\nmethod = \"jig\"\nposes = [1]\n",
      {"poses", "write a table"});
}

// Each number at its largest and smallest, and just beyond.
TEST(CalibrationFile, TakesEachNumberUpToItsBoundAndNoFurther) {
  struct Bound {
    const char* name;
    const char* good;
    const char* bad;
  };
  const auto text_with = [](const std::string& name, const std::string& number) {
    const auto of = [&](const char* key, const char* usual) {
      return key == name ? number : std::string(usual);
    };
    return kHead + kAngle + "gain = " + of("gain", "1") + "\noffset = " + of("offset", "0") +
           "\nresidual_rad = " + of("residual_rad", "0") +
           "\nmethod = \"stops\"\nposes = [{ name = \"a\", raw = " + of("raw", "0") +
           ", value = " + of("value", "0") + ", residual_rad = 0 }]\n";
  };
  for (const Bound& bound : {Bound{"gain", "100", "100.001"},
                             {"gain", "-100", "-100.001"},
                             {"offset", "1e6", "1000001"},
                             {"offset", "-1e6", "-1000001"},
                             {"residual_rad", "10", "10.001"},
                             {"residual_rad", "0", "-0.001"},
                             {"raw", "2147483647", "2147483648"},
                             {"raw", "-2147483648", "-2147483649"},
                             {"value", "100", "100.001"},
                             {"value", "-100", "-100.001"}}) {
    EXPECT_NO_THROW(static_cast<void>(parse_calibration(text_with(bound.name, bound.good), "good.toml")))
        << bound.name << " = " << bound.good;
    expect_bad_calibration(text_with(bound.name, bound.bad), {"bad.toml", bound.name});
  }
}

// Any single byte of a good file changed: it is read, or refused with a message; nothing else.
TEST(CalibrationFile, WithADamagedByteIsReadOrRefused) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  const std::string good = calibration_text(example());
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    text[random() % text.size()] = static_cast<char>(random());
    try {
      const Calibration c = parse_calibration(text, "damaged.toml");
      for (const CalibratedChannel& channel : c.channels) EXPECT_TRUE(std::isfinite(channel.channel.gain));
    } catch (const SceneError& error) {
      EXPECT_STRNE(error.what(), "") << "seed " << kSeed;
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000) << "seed " << kSeed;
}

// Opening a named pipe would wait until another program writes to it.
TEST(CalibrationFile, ThatIsNoRegularFileIsRefusedWithoutAWait) {
  const testing::TemporaryFolder folder;
  const std::string pipe = folder / "pipe.toml";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& file : {pipe, std::string("/dev/zero")})
    expect_scene_error([&] { static_cast<void>(load_calibration(file)); },
                       {"calibration file: ", file, "is not a regular file", "copy its contents"});
}

}  // namespace
}  // namespace phalanx
