// SPDX-License-Identifier: Apache-2.0
// Firmware of a device with two joints for the Phalanx link: two potentiometers, two motor drivers, an emergency stop.
// README.md beside it states how to compile it, and for which boards. setup() and loop() never wait.
#include <Arduino.h>

#include <PhalanxLink.h>

// ---- the device: change these numbers to those of yours ----

const uint8_t kJoints = 2;
const uint8_t kLinkJoint[kJoints] = {4, 6};  // index_mcp_flexion, index_pip_flexion (docs/link.md)
const uint8_t kSensorPin[kJoints] = {A0, A1};
const uint8_t kMotorPin[kJoints] = {5, 6};      // pulse width: torque
const uint8_t kDirectionPin[kJoints] = {4, 7};  // high: flexion
const uint8_t kStopPin = 2;                     // normally closed, to ground; high: pressed, or a broken wire
const uint16_t kRate = 500;                     // of samples and control [Hz]
const uint32_t kPeriod = 1000000UL / kRate;     // [us]
const float kTorqueOfFullWidth = 0.2f;          // of the motor at the joint [Nm]
const float kSensorTurn = 4.712389f;            // of the potentiometers over the whole scale: 270 degrees [rad]

// A core for a converter of more than 10 bits has analogReadResolution(), and reads 10 bits until it is called.
#ifdef __AVR__
const uint8_t kBits = 10;
#else
const uint8_t kBits = 12;
#endif
const int32_t kScale = (1L << kBits) - 1;  // largest count
const int32_t kRail = kScale / 200;        // nearer to an end: an open or shorted potentiometer

phx_controller controller;
phx_receiver receiver;
phx_output output;

/// Frame that is being sent: as many bytes at a time as the port takes.
uint8_t stuffed[PHX_COBS_MAX];
size_t stuffed_size = 0;
size_t stuffed_sent = 0;

/// Answer that waits until the frame before it has been sent.
uint8_t reply[PHX_FRAME_MAX];
size_t reply_size = 0;

/// Extends micros(), which begins again after 71 minutes, to 64 bits. Call it more often than that.
uint64_t time_us() {
  static uint32_t before = 0;
  static uint64_t turns = 0;
  const uint32_t now = (uint32_t)micros();
  if (now < before) turns += 0x100000000ULL;
  before = now;
  return turns + now;
}

/// The first epoch must differ from start to start. This takes it from the noise of an open pin. A counter in
/// flash memory is better.
uint32_t first_epoch() {
  uint32_t noise = (uint32_t)micros();
  for (int i = 0; i < 64; ++i) noise = (uint32_t)(noise * 1664525UL + 1013904223UL + (uint32_t)analogRead(A2));
  return noise;
}

bool port_is_free() { return stuffed_sent == stuffed_size; }

void start_sending(const uint8_t* frame, size_t size) {
  stuffed_size = phx_cobs_encode(frame, size, stuffed, sizeof stuffed);
  stuffed_sent = 0;
}

void go_on_sending() {
  if (port_is_free() && reply_size > 0) {
    start_sending(reply, reply_size);
    reply_size = 0;
  }
  size_t count = stuffed_size - stuffed_sent;
  const size_t room = (size_t)Serial.availableForWrite();
  if (count > room) count = room;
  if (count > 0) stuffed_sent += Serial.write(stuffed + stuffed_sent, count);
}

void receive_frames() {
  while (reply_size == 0 && Serial.available() > 0) {
    const size_t size = phx_receiver_take(&receiver, (uint8_t)Serial.read());
    if (size > 0) phx_controller_receive(&controller, receiver.frame, size, time_us(), reply, &reply_size);
  }
}

/// A motor driver gets direction and pulse width. The current limit belongs to the driver.
void drive(uint8_t i, float torque) {
  float width = 255.0f * torque / kTorqueOfFullWidth;
  digitalWrite(kDirectionPin[i], width >= 0.0f ? HIGH : LOW);
  if (width < 0.0f) width = -width;
  if (width > 255.0f) width = 255.0f;
  analogWrite(kMotorPin[i], (int)width);
}

void tick(uint64_t now) {
  int32_t raw[PHX_CHANNELS] = {0};
  for (uint8_t i = 0; i < kJoints; ++i) raw[i] = analogRead(kSensorPin[i]);
  const bool stopped = digitalRead(kStopPin) == HIGH;
  phx_controller_tick(&controller, now, raw, stopped, false, &output);
  for (uint8_t i = 0; i < kJoints; ++i) drive(i, output.torque[kLinkJoint[i]]);
  // A sample for which the port has no room is left out. The host sees the gap in the numbers.
  if (output.sample_size > 0 && port_is_free() && reply_size == 0) start_sending(output.sample, output.sample_size);
}

void setup() {
  for (uint8_t i = 0; i < kJoints; ++i) {
    pinMode(kMotorPin[i], OUTPUT);
    pinMode(kDirectionPin[i], OUTPUT);
    analogWrite(kMotorPin[i], 0);
  }
  pinMode(kStopPin, INPUT_PULLUP);
#ifndef __AVR__
  analogReadResolution(kBits);
#endif
  Serial.begin(2000000);

  phx_device device = {};
  const char serial[] = "ARDUINO-0001";
  for (size_t i = 0; i + 1 < sizeof serial; ++i) device.serial[i] = serial[i];
  device.rate_hz = kRate;
  device.channel_count = kJoints;
  device.torque_limit = 0.1f;  // [Nm]
  device.torque_rate = 2.0f;   // [Nm/s]
  for (uint8_t i = 0; i < kJoints; ++i) {
    phx_channel& channel = device.channel[i];
    channel.kind = PHX_CHANNEL_ANGLE;
    channel.index = kLinkJoint[i];
    channel.raw_min = kRail;
    channel.raw_max = kScale - kRail;
    channel.gain = kSensorTurn / (float)kScale;
    channel.offset = -0.5f;
  }
  phx_controller_init(&controller, &device, first_epoch());
  phx_receiver_init(&receiver);
}

void loop() {
  static uint64_t next = 0;
  receive_frames();
  go_on_sending();
  const uint64_t now = time_us();
  if (now < next) return;
  // A tick that is much too late is not repeated.
  next = now - next > kPeriod ? now + kPeriod : next + kPeriod;
  tick(now);
}
