// SPDX-License-Identifier: Apache-2.0
// A device of two joints with a motor each, as a safety test needs it: samples by hand, no plant.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"
#include "station/safety.h"

namespace phalanx::test {

inline constexpr int kMcp = 4;          ///< index_mcp_flexion
inline constexpr int kPip = 6;          ///< index_pip_flexion
inline constexpr double kCount = 1e-4;  ///< [rad]

/// Channels 0, 1: the angles of kMcp and kPip. 2, 3: their motors, 1 um a count. 4: the torque on kMcp, 0.1
/// mNm.
inline std::vector<DeviceChannel> two_joint_channels() {
  return {{.kind = ChannelKind::kAngle,
           .index = kMcp,
           .raw_min = -20000,
           .raw_max = 20000,
           .gain = kCount,
           .offset = 0.0},
          {.kind = ChannelKind::kAngle,
           .index = kPip,
           .raw_min = -20000,
           .raw_max = 20000,
           .gain = kCount,
           .offset = 0.0},
          {.kind = ChannelKind::kMotor,
           .index = 0,
           .raw_min = -100000,
           .raw_max = 100000,
           .gain = 1e-6,
           .offset = 0.0},
          {.kind = ChannelKind::kMotor,
           .index = 1,
           .raw_min = -100000,
           .raw_max = 100000,
           .gain = 1e-6,
           .offset = 0.0},
          {.kind = ChannelKind::kTorque,
           .index = kMcp,
           .raw_min = -100000,
           .raw_max = 100000,
           .gain = 1e-4,
           .offset = 0.0},
          {.kind = ChannelKind::kForce,
           .index = 1,
           .raw_min = -100000,
           .raw_max = 100000,
           .gain = 1e-3,
           .offset = 0.0}};
}

inline HandParameters ranged_hand() {
  HandParameters hand;
  hand.min_angle.fill(-0.3);
  hand.max_angle.fill(1.5);
  return hand;
}

/// Motor 0 winds 10 mm a radian of kMcp, motor 1 of kPip; neither has slack.
inline std::vector<MotorWitness> two_witnesses() {
  std::vector<MotorWitness> out(2);
  out[0].channel = 2;
  out[0].arm[kMcp] = 0.01;
  out[1].channel = 3;
  out[1].arm[kPip] = 0.01;
  return out;
}

/// A sample every `interval_us`; set what differs.
class FakeSamples {
 public:
  FakeSamples() { at(0.5, 0.5); }

  /// Angles of both joints [rad], the motors with them.
  void at(double mcp, double pip) {
    sample.raw[0] = static_cast<std::int32_t>(std::lround(mcp / kCount));
    sample.raw[1] = static_cast<std::int32_t>(std::lround(pip / kCount));
    sample.raw[2] = static_cast<std::int32_t>(std::lround(mcp * 0.01 / 1e-6));
    sample.raw[3] = static_cast<std::int32_t>(std::lround(pip * 0.01 / 1e-6));
  }
  const DeviceSample& next(double now) {
    ++sample.sequence;
    sample.time_us += interval_us;
    sample.received = now;
    return sample;
  }

  DeviceSample sample{.state = DeviceState::kReady, .factor = 1.0};
  std::uint64_t interval_us = 1000;  ///< by the device's clock
};

/// Safety under test with its samples, one a step.
struct Bench {
  explicit Bench(SafetySettings the_settings = {}, double the_period = 1e-3)
      : Bench(the_settings, the_period, info(1.0 / the_period)) {}
  Bench(SafetySettings the_settings, double the_period, const DeviceInfo& device)
      : settings(the_settings),
        period(the_period),
        map(two_joint_channels(), {}, ranged_hand()),
        safety(settings, map, device, ranged_hand(), two_witnesses(), period) {
    samples.interval_us = static_cast<std::uint64_t>(std::llround(1e6 * period));
  }

  static DeviceInfo info(double rate_hz = 1000.0) {
    DeviceInfo out;
    out.rate_hz = rate_hz;
    return out;
  }

  /// One step; with no sample if `silent`.
  const DeviceCommand& step(bool silent = false, Fault connection = Fault::kNone, bool late = false) {
    now += period;
    ++snapshot.tick;
    DeviceState& state = samples.sample.state;
    if (state == DeviceState::kReady || state == DeviceState::kActive)
      state = command.enable && obeys ? DeviceState::kActive : DeviceState::kReady;
    snapshot.hcp_angle[kMcp] = kCount * samples.sample.raw[0];
    snapshot.hcp_angle[kPip] = kCount * samples.sample.raw[1];
    if (torque_follows)
      samples.sample.raw[4] = static_cast<std::int32_t>(std::lround(command.torque[kMcp] / 1e-4));
    if (silent) {
      safety.observe({}, connection, late, now);
    } else {
      const DeviceSample sample = samples.next(now);
      safety.observe(std::span(&sample, 1), connection, late, now);
    }
    safety.command(snapshot, samples.sample, now, command);
    return command;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// Steps until the start ramp is over, with this torque on kMcp.
  void run_with(double torque) {
    snapshot.torque[kMcp] = torque;
    steps(static_cast<int>(1.3 / period));
  }

  SafetySettings settings;
  double period;
  ChannelMap map;
  Safety safety;
  FakeSamples samples;
  Snapshot snapshot;
  DeviceCommand command;
  double now = 0.0;
  bool obeys = true;           ///< the device acts on what it is sent
  bool torque_follows = true;  ///< the torque sensor reads what was commanded
};

}  // namespace phalanx::test
