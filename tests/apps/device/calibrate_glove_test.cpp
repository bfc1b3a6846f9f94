// SPDX-License-Identifier: Apache-2.0
// `phalanx device calibrate` itself, on a glove of which only the index finger is sensed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "device/opengloves/glove_firmware.h"
#include "phalanx/scene/calibration_file.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using test::GloveFirmware;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// The program, with a pipe to what it reads and one from what it says.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    std::array<int, 2> in{};
    std::array<int, 2> out{};
    if (::pipe(in.data()) != 0 || ::pipe(out.data()) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(out[1], STDERR_FILENO);
      for (const int end : {in[0], in[1], out[0], out[1]}) ::close(end);
      ::setenv("PHALANX_DATA_DIR", PHALANX_SOURCE_DIR, 1);
      std::vector<char*> argv;
      arguments.insert(arguments.begin(), PHALANX_PROGRAM);
      argv.reserve(arguments.size() + 1);
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      ::execv(PHALANX_PROGRAM, argv.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    in_ = in[1];
    out_ = out[0];
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { static_cast<void>(finish()); }

  void type(const std::string& line) const {
    const std::string text = line + "\n";
    ASSERT_EQ(::write(in_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// Reads until the program has said this; false: it ended before.
  bool says(const std::string& words) {
    std::array<char, 512> bytes{};
    while (said.find(words, looked_at_) == std::string::npos) {
      const ssize_t count = ::read(out_, bytes.data(), bytes.size());
      if (count <= 0) return false;
      said.append(bytes.data(), static_cast<std::size_t>(count));
    }
    looked_at_ = said.find(words, looked_at_) + words.size();
    return true;
  }
  int finish() {
    if (child_ <= 0) return -1;
    ::close(in_);
    while (says("\x01")) {
    }
    int status = 0;
    ::waitpid(child_, &status, 0);
    ::close(out_);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string said;

 private:
  pid_t child_ = 0;
  int in_ = -1;
  int out_ = -1;
  std::size_t looked_at_ = 0;
};

// Of a glove that reads 500 at curl 0 and 3500 at curl 1.
std::string line_at(double curl) { return fmt::format("B{}F2047G2047", std::lround(500.0 + 3000.0 * curl)); }

// The adult hand's open index finger: MCP a third of its range, PIP and DIP straight.
constexpr double kOpen = 1.0 / 9.0;

TEST(CalibrateGlove, WritesWhatTheGloveReads) {
  const TemporaryFolder folder;
  GloveFirmware firmware(line_at(kOpen));
  const std::string file = folder / "glove.toml";
  Program program({"device", "calibrate", "opengloves:" + firmware.port(), "--method", "jig", "--out", file});
  const std::vector<std::pair<std::string, double>> poses = {
      {"open hand", kOpen}, {"fist", 1.0}, {"index curl largest", 1.0}, {"index curl smallest", 0.0}};
  for (const auto& [name, curl] : poses) {
    ASSERT_TRUE(program.says("] " + name + ":")) << program.said;
    firmware.say(line_at(curl));
    ASSERT_TRUE(firmware.wait_for_answers(2));
    program.type("");
    ASSERT_TRUE(program.says("measured")) << program.said;
  }
  EXPECT_EQ(program.finish(), 0) << program.said;
  EXPECT_THAT(program.said, HasSubstr("curl of index"));
  const Calibration calibration = load_calibration(file);
  EXPECT_EQ(calibration.device, "opengloves");
  EXPECT_EQ(calibration.serial, firmware.port());
  ASSERT_EQ(calibration.channels.size(), 1U);
  EXPECT_NEAR(calibration.channels[0].channel.gain, 1.0 / 3000.0, 1e-6);
  EXPECT_NEAR(calibration.channels[0].channel.offset, -1.0 / 6.0, 1e-3);
  for (const std::string& answer : firmware.answers())
    ASSERT_EQ(answer, "A0B0C0D0E0") << "nothing is stopped";
}

TEST(CalibrateGlove, WritesNothingWhenItIsEnded) {
  const TemporaryFolder folder;
  GloveFirmware firmware(line_at(kOpen));
  const std::string file = folder / "glove.toml";
  Program program({"device", "calibrate", "opengloves:" + firmware.port(), "--method", "jig", "--out", file});
  ASSERT_TRUE(program.says("] open hand:")) << program.said;
  program.type("q");
  EXPECT_EQ(program.finish(), 1);
  EXPECT_THAT(program.said, HasSubstr("nothing was written"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(CalibrateGlove, ReplacesNoFileUnasked) {
  const TemporaryFolder folder;
  const std::string file = folder / "glove.toml";
  std::ofstream(file) << "mine";
  Program program({"device", "calibrate", "opengloves:/dev/no-such-glove", "--method", "jig", "--out", file});
  EXPECT_EQ(program.finish(), 2);
  EXPECT_THAT(program.said, HasSubstr("--force"));
  EXPECT_EQ(testing::read_file(file), "mine");
}

TEST(CalibrateGlove, SaysThatNoGloveIsThere) {
  const TemporaryFolder folder;
  Program program({"device", "calibrate", "opengloves:/dev/no-such-glove", "--method", "jig", "--out",
                   folder / "glove.toml"});
  EXPECT_EQ(program.finish(), 1);
  EXPECT_THAT(program.said, HasSubstr("/dev/serial/by-id"));
}

}  // namespace
}  // namespace phalanx
