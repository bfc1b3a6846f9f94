// SPDX-License-Identifier: Apache-2.0
// Bytes that nobody should have sent: dropped and counted, and the torque goes on.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "faults/fault_suite.h"
#include "faults/reactions.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx::testing {
namespace {

constexpr unsigned kSeed = 20261121;

Bytes random_bytes(std::mt19937& random, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Bit by bit, as IEEE 802.3 states it; the library has a table.
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// The frame as another version of the link would have sent it.
Bytes with_version(Bytes frame, std::uint8_t version) {
  if (frame.size() < PHX_HEADER_SIZE + PHX_CRC_SIZE) return frame;
  frame[2] = version;
  const std::uint32_t crc = crc32(std::span(frame).first(frame.size() - PHX_CRC_SIZE));
  for (std::size_t i = 0; i < PHX_CRC_SIZE; ++i)
    frame[frame.size() - PHX_CRC_SIZE + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  return frame;
}

Bytes with_a_flipped_bit(Bytes frame, std::mt19937& random) {
  const std::size_t bit = random() % (8 * frame.size());
  frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ (1U << (bit % 8)));
  return frame;
}

/// What a frame can suffer, ten of each.
std::vector<Bytes> spoilt(const Bytes& frame, std::mt19937& random) {
  std::vector<Bytes> out;
  for (int i = 0; i < 10; ++i) {
    out.push_back(random_bytes(random, 1 + random() % 200));
    out.push_back(random_bytes(random, PHX_FRAME_MAX + 1 + random() % 400));
    out.push_back(with_a_flipped_bit(frame, random));
    out.push_back(with_version(frame, 2));
    out.push_back(Bytes(frame.begin(), frame.end() - 1 - static_cast<std::ptrdiff_t>(random() % 20)));
    Bytes longer = frame;
    longer.resize(PHX_FRAME_MAX + 200, 0x55);
    out.push_back(longer);
  }
  return out;
}

void send_spoilt_frames(TwoProcesses& both) {
  std::mt19937 random(kSeed);
  Outcome& outcome = both.outcome();
  if (both.middle().last_command().empty() || both.middle().last_sample().empty()) return;
  for (int round = 0; round < 20; ++round) {
    const std::vector<Bytes> commands = spoilt(both.middle().last_command(), random);
    const std::vector<Bytes> samples = spoilt(both.middle().last_sample(), random);
    for (const Bytes& bytes : commands) both.middle().to_controller(bytes);
    for (const Bytes& bytes : samples) both.middle().to_host(bytes);
    outcome.sent_to_controller += commands.size();
    outcome.sent_to_host += samples.size();
    const std::vector<Bytes> more(5, random_bytes(random, 100));
    send_from_a_stranger(both.controller_port(), more);
    outcome.sent_to_controller += more.size();
    both.pass(0.05);
  }
}

/// "frames dropped: A no frame of the wire, B corrupt, ...": A + B.
std::uint64_t dropped_by_controller(const Outcome& outcome) {
  const std::string& text = outcome.controller_output;
  const std::size_t at = text.find("frames dropped: ");
  unsigned long wire = 0;
  unsigned long corrupt = 0;
  if (at == std::string::npos ||
      std::sscanf(text.c_str() + at, "frames dropped: %lu no frame of the wire, %lu corrupt", &wire,
                  &corrupt) != 2)
    return 0;
  return wire + corrupt;
}

std::uint64_t corrupt_at_host(const Outcome& outcome) {
  return nlohmann::json::parse(outcome.summary).at("link").at("corrupt").get<std::uint64_t>();
}

std::int64_t oldest_step(const Outcome& outcome) {
  std::int64_t oldest = 0;
  for (const ControllerRow& row : outcome.logs.controller)
    if (row.state == "active") oldest = std::max(oldest, row.age_us);
  return oldest;
}

const Registered kSocket("SpoiltFramesOnTheSocketAreCounted", "",
                         {.middle = true, .events = {{1.8, send_spoilt_frames}}, .seconds = 4.2});
TEST(Faults, SpoiltFramesOnTheSocketAreCounted) {
  const Outcome& o = outcome("SpoiltFramesOnTheSocketAreCounted");
  expect_runs_on(o);
  EXPECT_EQ(dropped_by_controller(o), o.sent_to_controller) << o.controller_output;
  EXPECT_EQ(corrupt_at_host(o), o.sent_to_host);
  print_row(
      "socket: corrupt bytes, other version, too long, too short, random bytes",
      "dropped and counted; nothing else",
      fmt::format(
          "{} frames to the controller, {} counted; {} to the host, {} counted as corrupt; torque goes on, "
          "oldest step {:.0f} ms (seed {})",
          o.sent_to_controller, dropped_by_controller(o), o.sent_to_host, corrupt_at_host(o),
          1e-3 * static_cast<double>(oldest_step(o)), kSeed));
}

void write_noise_to_the_line(TwoProcesses& both) {
  std::mt19937 random(kSeed);
  std::string path = both.address().substr(std::string("serial:").size());
  const int line = ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (line < 0) {
    both.outcome().notes.push_back("cannot open " + path);
    return;
  }
  for (int round = 0; round < 40; ++round) {
    const Bytes bytes = random_bytes(random, 1 + random() % (round % 4 == 0 ? 2000U : 100U));
    const ssize_t written = ::write(line, bytes.data(), bytes.size());
    if (written > 0) ++both.outcome().sent_to_controller;
    both.pass(0.02);
  }
  ::close(line);
}

const Registered kSerial("RandomBytesOnTheSerialLineAreCounted", "",
                         {.controller = {"--fault", "corrupt=0.05@1.8+1.5"},
                          .pty = true,
                          .events = {{1.8, write_noise_to_the_line}},
                          .seconds = 4.2});
TEST(Faults, RandomBytesOnTheSerialLineAreCounted) {
  const Outcome& o = outcome("RandomBytesOnTheSerialLineAreCounted");
  ASSERT_TRUE(o.notes.empty()) << o.notes.front();
  expect_runs_on(o);
  EXPECT_GE(dropped_by_controller(o), 40U);
  EXPECT_GT(corrupt_at_host(o), 10U);
  print_row("serial: bursts of random bytes, 5 % of frames with a flipped bit",
            "dropped and counted; nothing else",
            fmt::format("{} bursts; {} frames dropped by the controller, {} by the host; torque goes on, "
                        "oldest step {:.0f} "
                        "ms (seed {})",
                        o.sent_to_controller, dropped_by_controller(o), corrupt_at_host(o),
                        1e-3 * static_cast<double>(oldest_step(o)), kSeed));
}

/// The newest command with a tick from the future, so that it would be acted on, and one wrong number.
Bytes wrong_number(const Bytes& command, float number) {
  phx_message message{};
  if (phx_decode(command.data(), command.size(), &message) != PHX_OK) return {};
  message.as.command.tick += 100000;
  message.as.command.torque[7] = number;
  Bytes out(PHX_FRAME_MAX);
  out.resize(phx_encode(&message, out.data(), out.size()));
  return out;
}

void send_wrong_numbers(TwoProcesses& both) {
  for (int round = 0; round < 50; ++round) {
    for (const float number :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      const Bytes frame = wrong_number(both.middle().last_command(), number);
      if (frame.empty()) continue;
      both.middle().to_controller(frame);
      ++both.outcome().sent_to_controller;
    }
    both.pass(0.01);
  }
}

const Registered kNan("ACommandThatIsNoNumberIsDropped", "",
                      {.middle = true, .events = {{2.2, send_wrong_numbers}}, .seconds = 4.2});
TEST(Faults, ACommandThatIsNoNumberIsDropped) {
  const Outcome& o = outcome("ACommandThatIsNoNumberIsDropped");
  expect_runs_on(o);
  EXPECT_EQ(o.sent_to_controller, 100U);
  EXPECT_EQ(dropped_by_controller(o), o.sent_to_controller) << o.controller_output;
  for (const ControllerRow& row : o.logs.controller) ASSERT_LT(row.acted_tick, 100000U);
  print_row("NaN and infinity in a command, in the host's own voice",
            "dropped; the command stays finite and within limits",
            fmt::format("{} frames, {} counted, none acted on; torque goes on", o.sent_to_controller,
                        dropped_by_controller(o)));
}

}  // namespace
}  // namespace phalanx::testing
