// SPDX-License-Identifier: Apache-2.0
// The interface that every device implements: an exoskeleton on a wire, a glove, the simulated one, yours.
// docs/device.md walks through one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/device/fault.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

inline constexpr std::size_t kMaxChannels = 32;

/// What a channel measures, and what its index counts (the values of enum phx_channel_kind).
enum class ChannelKind : std::uint8_t {
  kAngle = 0,   ///< joint angle [rad]; joint
  kTorque = 1,  ///< torque on a joint [Nm]; joint
  kForce = 2,   ///< force at a digit's tip [N]; digit
  kMotor = 3,   ///< what a motor has wound up [m]; motor, in the order of their names in the device file
  kCurl = 4,    ///< a whole digit: 0 open .. 1 closed; digit
  kSplay = 5,   ///< abduction of a digit, -1 .. 1 of its range; digit
};

/// One sensor:  value = gain raw + offset.
struct DeviceChannel {
  ChannelKind kind = ChannelKind::kAngle;
  int index = 0;             ///< joint, digit or motor
  std::int32_t raw_min = 0;  ///< below: an open or shorted sensor [counts]
  std::int32_t raw_max = 0;  ///< above: the same [counts]
  double gain = 1.0;         ///< the maker's; a calibration file replaces it
  double offset = 0.0;       ///< likewise
};

/// Who a device is. Known once it is open.
struct DeviceInfo {
  std::string name;                     ///< of the model, for people
  std::string serial;                   ///< of this one; a calibration belongs to it
  double rate_hz = 1000.0;              ///< of its samples
  std::vector<DeviceChannel> channels;  ///< at most kMaxChannels
  bool renders_torque = true;           ///< false: it can at most stop a digit, as force-feedback gloves do
  bool simulated = false;               ///< no motor and no patient is behind it
};

/// Where a device is in its own life. `kReady` and beyond: a host may command it.
enum class DeviceState : std::uint8_t { kConnecting, kReady, kStarting, kActive, kFading, kLatched };

/// One measurement.
struct DeviceSample {
  std::uint32_t sequence = 0;  ///< counts the device's samples
  std::uint64_t time_us = 0;   ///< the device's clock
  double received = 0.0;       ///< the host's clock when it came in [s]
  std::array<std::int32_t, kMaxChannels> raw{};
  DeviceState state = DeviceState::kConnecting;
  Fault fault = Fault::kNone;    ///< what the device is latched for
  int fault_channel = -1;        ///< of kSensorRange
  bool estop = false;            ///< the emergency stop is pressed now
  double factor = 0.0;           ///< the device's own factor on the torque, 0 .. 1
  std::uint64_t acted_tick = 0;  ///< tick of the step that it acts on
};

/// What the host wants of a device at one step.
struct DeviceCommand {
  std::uint64_t tick = 0;            ///< of the step
  std::uint64_t sample_time_us = 0;  ///< the device's clock at the sample that the step used
  bool enable = false;               ///< false: zero torque, no fault
  bool fault = false;      ///< the host is in fault: zero torque within 5 ms, whatever `enable` says
  JointArray torque{};     ///< [Nm] finite and within all of the host's limits
  JointArray hcp_angle{};  ///< measured; also the walls' q_ref [rad]
  JointArray gdp_angle{};  ///< shown: where stopped digits stand [rad]
  std::array<bool, kDigits> stopped{};  ///< a segment of the digit is in contact
  std::array<LocalWall, kSegments> wall{};
  double wall_valid_for = 0.0;  ///< from the sample's time [s]; 0: no walls
};

/// Counters since open(); all only grow.
struct LinkStatistics {
  std::uint64_t received = 0;        ///< samples
  std::uint64_t lost = 0;            ///< sequence numbers that never came
  std::uint64_t outdated = 0;        ///< duplicates, and samples that a newer one had overtaken
  std::uint64_t corrupt = 0;         ///< frames dropped: not a frame, checksum, version
  std::uint64_t refused = 0;         ///< frames of another session
  std::uint64_t overflowed = 0;      ///< samples dropped because the loop did not fetch them in time
  std::uint64_t sent = 0;            ///< commands, repetitions included
  std::uint64_t device_corrupt = 0;  ///< what the controller says that it dropped
  std::uint64_t device_refused = 0;
  std::uint64_t device_outdated = 0;
};

/// A port that does not open, a device that does not answer or belongs to another host: says what was tried
/// and what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One device. open(), close() and info() are for set-up; the others are called from the loop's thread, once
/// a step, and must not allocate, lock, throw or wait. A device that needs to wait for its wire has a thread
/// of its own (device/latest.h and device/sample_queue.h carry values across).
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// Connects, and returns once info() is known. @throws DeviceError. Set-up only.
  virtual void open() = 0;
  /// Zero torque, then lets go of the device. May be called at any time, also twice.
  virtual void close() noexcept = 0;
  [[nodiscard]] virtual const DeviceInfo& info() const = 0;

  /// The samples that came in since the last call, oldest first; none older than one already given.
  /// @param now    the host's clock [s]
  /// @param out    room; what does not fit is dropped, oldest first, and counted as overflowed
  /// @returns how many
  [[nodiscard]] virtual std::size_t receive(double now, std::span<DeviceSample> out) noexcept = 0;
  /// The newest command takes the place of all before it.
  virtual void send(const DeviceCommand& command) noexcept = 0;
  /// Asks the device to clear its latch; its samples say when it has.
  virtual void reset() noexcept = 0;
  /// What is wrong with the connection itself: kNone, kControllerRestarted, kRefused or kDeviceLost. Cleared
  /// by reset() once it is mended.
  [[nodiscard]] virtual Fault connection_fault() const noexcept { return Fault::kNone; }
  [[nodiscard]] virtual LinkStatistics statistics() const noexcept { return {}; }
};

}  // namespace phalanx
