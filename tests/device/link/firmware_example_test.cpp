// SPDX-License-Identifier: Apache-2.0
// The firmware of docs/link.md, on a board that is a queue of bytes either way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <fstream>
#include <sstream>

#include "device/link/frame_bytes.h"

namespace {

struct Board {
  std::uint64_t time_us = 0;
  std::deque<std::uint8_t> to_firmware;
  std::deque<std::uint8_t> from_firmware;
  std::array<float, PHX_JOINTS> torque{};
};
Board board;

}  // namespace

extern "C" {
std::uint64_t board_time_us() { return board.time_us; }
int board_read_byte() {
  if (board.to_firmware.empty()) return -1;
  const int byte = board.to_firmware.front();
  board.to_firmware.pop_front();
  return byte;
}
void board_write(const std::uint8_t* bytes, std::size_t size) {
  board.from_firmware.insert(board.from_firmware.end(), bytes, bytes + size);
}
void board_read_sensors(std::int32_t* raw) { raw[0] = raw[1] = 2000; }
bool board_emergency_stop() { return false; }
bool board_drive_fault() { return false; }
void board_set_torque(const float* torque) { std::copy_n(torque, PHX_JOINTS, board.torque.begin()); }
void firmware_start(std::uint32_t boots);
void firmware_tick();
}

namespace phalanx::link_test {
namespace {

class FirmwareExample : public testing::Test {
 protected:
  FirmwareExample() {
    board = {};
    phx_receiver_init(&receiver_);
    firmware_start(3);
  }
  void send(phx_message message) {
    message.header.epoch = epoch_;
    const Bytes frame = encoded(message);
    std::array<std::uint8_t, PHX_COBS_MAX> stuffed{};
    const std::size_t size = phx_cobs_encode(frame.data(), frame.size(), stuffed.data(), stuffed.size());
    board.to_firmware.insert(board.to_firmware.end(), stuffed.begin(),
                             stuffed.begin() + static_cast<std::ptrdiff_t>(size));
  }
  /// One tick. @returns the frames that came back
  std::vector<phx_message> tick() {
    board.time_us += 1000;
    firmware_tick();
    std::vector<phx_message> messages;
    for (; !board.from_firmware.empty(); board.from_firmware.pop_front()) {
      const std::size_t size = phx_receiver_take(&receiver_, board.from_firmware.front());
      if (size == 0) continue;
      EXPECT_EQ(phx_decode(receiver_.frame, size, &messages.emplace_back()), PHX_OK);
    }
    return messages;
  }
  static phx_message message(std::uint8_t type) {
    phx_message message{};
    message.header.type = type;
    return message;
  }
  phx_receiver receiver_{};
  std::uint32_t epoch_ = 0;
};

TEST_F(FirmwareExample, GrantsASessionSendsSamplesAndActsOnCommands) {
  send(message(PHX_HELLO));
  const std::vector<phx_message> first = tick();
  ASSERT_EQ(first.size(), 2U);
  ASSERT_EQ(first[0].header.type, PHX_WELCOME);
  EXPECT_EQ(first[0].header.epoch, (3U << 16) + 1);
  EXPECT_STREQ(first[0].as.welcome.serial, "GLOVE-0001");
  ASSERT_EQ(first[1].header.type, PHX_SAMPLE);
  EXPECT_EQ(first[1].as.sample.raw[1], 2000);
  epoch_ = first[0].header.epoch;
  phx_message configure = message(PHX_CONFIGURE);
  configure.as.configure.torque_limit = 0.4F;
  configure.as.configure.torque_rate = 10.0F;
  send(configure);
  phx_message sample = tick().back();
  EXPECT_EQ(sample.as.sample.flags, PHX_SAMPLE_CONFIGURED);
  for (std::uint64_t step = 1; step <= 1001; ++step) {
    phx_message command = message(PHX_COMMAND);
    command.as.command = {step, sample.as.sample.time_us, PHX_COMMAND_ENABLE, {}};
    command.as.command.torque[5] = 9.0F;
    send(command);
    sample = tick().back();
  }
  EXPECT_EQ(sample.as.sample.state, PHX_STATE_ACTIVE);
  EXPECT_FLOAT_EQ(board.torque[5], 0.4F);
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(board.torque[5], 0.0F);
}

std::string text_of(const char* path) {
  std::ifstream file(std::string(PHALANX_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST_F(FirmwareExample, StandsInTheDocumentationAsItIsTested) {
  const std::string example = text_of("tests/device/link/firmware_example.c");
  ASSERT_FALSE(example.empty());
  EXPECT_THAT(text_of("docs/link.md"), testing::HasSubstr(example.substr(example.find("#include"))));
}

}  // namespace
}  // namespace phalanx::link_test
