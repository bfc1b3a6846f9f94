// SPDX-License-Identifier: Apache-2.0
// examples/arduino on a board in memory, and `phalanx device conform` against it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include <Arduino.h>

#include "device/conform/conform_report.h"

void setup();
void loop();
extern phx_controller controller;
ArduinoSerial Serial;

namespace {

/// Pins and port of the board. Its core has a buffer of 64 bytes to send, as those of small boards.
struct ArduinoBoard {
  double now = 0.0;  ///< [s]
  std::deque<std::uint8_t> to_sketch;
  std::deque<std::uint8_t> from_sketch;
  std::size_t in_buffer = 0;  ///< of the core, to send
  std::array<int, 32> width{};
  std::array<std::uint8_t, 32> mode{};
  bool stop_open = false;  ///< contact of the emergency stop, normally closed, or its wire
  int bits = 10;           ///< of the converter, until the sketch asks for more
  double sensor = 0.49;    ///< of the potentiometers, as a part of the supply
};
ArduinoBoard arduino;

constexpr std::size_t kCoreBuffer = 64;

}  // namespace

unsigned long micros() { return static_cast<std::uint32_t>(std::llround(4.2e9 + 1e6 * arduino.now)); }
int analogRead(std::uint8_t pin) {
  return pin == A2 ? 7 : static_cast<int>(arduino.sensor * ((1 << arduino.bits) - 1));
}
void analogReadResolution(int bits) { arduino.bits = bits; }
void analogWrite(std::uint8_t pin, int value) { arduino.width[pin] = value; }
// An open pin is high only with a pull-up; without one it reads anything, here low.
int digitalRead(std::uint8_t pin) {
  return arduino.stop_open && arduino.mode[pin] == INPUT_PULLUP ? HIGH : LOW;
}
void digitalWrite(std::uint8_t, std::uint8_t) {}
void pinMode(std::uint8_t pin, std::uint8_t mode) { arduino.mode[pin] = mode; }
void ArduinoSerial::begin(unsigned long) {}
int ArduinoSerial::available() { return static_cast<int>(arduino.to_sketch.size()); }
int ArduinoSerial::read() {
  if (arduino.to_sketch.empty()) return -1;
  const int byte = arduino.to_sketch.front();
  arduino.to_sketch.pop_front();
  return byte;
}
int ArduinoSerial::availableForWrite() { return static_cast<int>(kCoreBuffer - arduino.in_buffer); }
std::size_t ArduinoSerial::write(const std::uint8_t* bytes, std::size_t size) {
  EXPECT_LE(size, kCoreBuffer - arduino.in_buffer) << "the sketch would wait";
  arduino.from_sketch.insert(arduino.from_sketch.end(), bytes, bytes + size);
  arduino.in_buffer += size;
  return size;
}

namespace phalanx {
namespace {

using ::testing::UnorderedElementsAreArray;

/// Serial line to the sketch. loop() is called each 50 us; the line carries 2 Mbaud, 10 bytes in that time.
class SketchPort final : public ConformPort {
 public:
  SketchPort() { phx_receiver_init(&receiver_); }
  [[nodiscard]] double now() const override { return arduino.now; }
  [[nodiscard]] bool serial() const override { return true; }
  [[nodiscard]] double bytes_per_second() const override { return 2e5; }
  void send(std::span<const std::uint8_t> frame, ConformSender) override {
    std::vector<std::uint8_t> stuffed(frame.size() + frame.size() / 254 + 2);
    stuffed.resize(phx_cobs_encode(frame.data(), frame.size(), stuffed.data(), stuffed.size()));
    send_bytes(stuffed);
  }
  void send_bytes(std::span<const std::uint8_t> bytes) override {
    on_line_.insert(on_line_.end(), bytes.begin(), bytes.end());
  }
  std::size_t receive(double until, std::span<std::uint8_t> out, ConformSender& to) override {
    to = ConformSender::kHost;
    while (true) {
      while (!arduino.from_sketch.empty() && carried_ > 0) {
        --carried_;
        --arduino.in_buffer;
        const std::size_t size = phx_receiver_take(&receiver_, arduino.from_sketch.front());
        arduino.from_sketch.pop_front();
        if (size == 0) continue;
        std::copy_n(receiver_.frame, size, out.begin());
        return size;
      }
      if (arduino.now + kLoop > until) {
        arduino.now = std::max(arduino.now, until);
        return 0;
      }
      arduino.now += kLoop;
      carried_ = kBytesPerLoop;
      for (int i = 0; i < kBytesPerLoop && !on_line_.empty(); ++i) {
        arduino.to_sketch.push_back(on_line_.front());
        on_line_.pop_front();
      }
      loop();
    }
  }

 private:
  static constexpr double kLoop = 50e-6;  // [s]
  static constexpr int kBytesPerLoop = 10;
  phx_receiver receiver_{};
  std::deque<std::uint8_t> on_line_;
  int carried_ = 0;
};

// Its clock begins just before micros() wraps around.
TEST(ArduinoExample, ConformsToTheLink) {
  arduino = {};
  setup();
  SketchPort port;
  const ConformReport report = run_conformance(port, {});
  std::vector<std::string> failed;
  for (const ConformResult& result : report.results)
    if (result.finding.outcome == ConformOutcome::kFail) failed.emplace_back(result.row->id);
  EXPECT_THAT(failed, UnorderedElementsAreArray(std::vector<std::string>{})) << conform_markdown(report);
  EXPECT_EQ(report.device, "serial number ARDUINO-0001, 500 Hz, 2 channels");
  EXPECT_EQ(arduino.width[5], 0) << "no torque at the end";
}

void run_sketch(SketchPort& port, double seconds) {
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
  ConformSender to = ConformSender::kHost;
  for (const double end = arduino.now + seconds; arduino.now < end;) port.receive(end, frame, to);
}

void open_session(SketchPort& port) {
  phx_message hello{};
  hello.header.type = PHX_HELLO;
  hello.header.sequence = 1;
  hello.as.hello.host_id = 5;
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
  port.send(std::span(frame).first(phx_encode(&hello, frame.data(), frame.size())), ConformSender::kHost);
}

// An open or shorted potentiometer reads an end of the converter's scale.
TEST(ArduinoExample, ASensorAtARailIsAFault) {
  for (const double rail : {0.0, 1.0}) {
    arduino = {};
    setup();
    SketchPort port;
    open_session(port);
    EXPECT_EQ(arduino.bits, 12) << "a core reads 10 bits until it is told otherwise";
    arduino.sensor = 0.98;
    run_sketch(port, 0.05);
    EXPECT_TRUE(controller.session);
    EXPECT_EQ(controller.fault, PHX_FAULT_NONE);
    arduino.sensor = rail;
    run_sketch(port, 0.05);
    EXPECT_EQ(controller.fault, PHX_FAULT_SENSOR_RANGE);
    EXPECT_EQ(controller.fault_channel, 0);
    EXPECT_EQ(arduino.width[5], 0);
  }
}

// The pull-up makes the pin high as soon as the contact or its wire is open.
TEST(ArduinoExample, AnOpenEmergencyStopIsAFault) {
  arduino = {};
  setup();
  SketchPort port;
  open_session(port);
  run_sketch(port, 0.05);
  EXPECT_TRUE(controller.session);
  EXPECT_EQ(controller.fault, PHX_FAULT_NONE);
  arduino.stop_open = true;
  run_sketch(port, 0.05);
  EXPECT_EQ(controller.fault, PHX_FAULT_EMERGENCY_STOP);
}

}  // namespace
}  // namespace phalanx
