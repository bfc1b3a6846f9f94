// SPDX-License-Identifier: Apache-2.0
// The interface that every device implements: an exoskeleton on a wire, a glove, a simulated device, or your
// own. docs/device.md walks through an example.
//
// A Device gives samples of raw counts and takes commands of joint torques. channel_map.h turns raw counts
// into joint angles; calibration.h fits its gains and offsets. link/ is the host's side of the link to a
// controller, with its reference in C. opengloves/ holds the gloves.
// motion.h holds recorded and scripted motions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/device/fault.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Largest number of channels of a device.
inline constexpr std::size_t kMaxChannels = 32;

/// Quantity that a channel measures, and the meaning of its index (as enum phx_channel_kind).
enum class ChannelKind : std::uint8_t {
  kAngle = 0,   ///< joint angle [rad]; index: joint
  kTorque = 1,  ///< torque on a joint [Nm]; index: joint
  kForce = 2,   ///< force at a digit's tip [N]; index: digit
  kMotor = 3,   ///< wound length of a motor [m]; index: motor, by name in the device file
  kCurl = 4,    ///< a whole digit: 0 open .. 1 closed; index: digit
  kSplay = 5,   ///< abduction of a digit, -1 .. 1 of its range; index: digit
};

/// One sensor: value = gain raw + offset.
struct DeviceChannel {
  ChannelKind kind = ChannelKind::kAngle;
  int index = 0;             ///< joint, digit or motor
  std::int32_t raw_min = 0;  ///< a smaller value is an open or shorted sensor [counts]
  std::int32_t raw_max = 0;  ///< a larger value is an open or shorted sensor [counts]
  double gain = 1.0;         ///< the maker's value; a calibration file replaces it
  double offset = 0.0;       ///< the maker's value, likewise
};

/// Identity and abilities of a device. Known once it is open.
struct DeviceInfo {
  std::string name;                     ///< name of the model, for people
  std::string serial;                   ///< serial number; a calibration belongs to it
  double rate_hz = 1000.0;              ///< rate of its samples [Hz]
  std::vector<DeviceChannel> channels;  ///< at most kMaxChannels
  bool renders_torque = true;           ///< false: it can at most stop a digit, as force-feedback gloves do
  bool actuated = true;                 ///< false: it has no actuator, and cannot hold a digit
  bool simulated = false;               ///< no motor and no patient are connected
  /// Its time goes on without the host, as behind a link. False: a simulated device's time advances with the
  /// host's steps; of a device that is not simulated it means nothing.
  bool own_clock = false;
  /// Watchdog time-out [s] > 0. At most so long after the host's last message, the device by itself removes
  /// all torque, or lets go of all digits. None: it keeps the last command, also for a host that is frozen or
  /// killed. If such a device is actuated, it is refused for a patient's session (check_watchdog()).
  std::optional<double> watchdog = {};
};

/// State of the device itself. From kReady on, a host may command it.
enum class DeviceState : std::uint8_t { kConnecting, kReady, kStarting, kActive, kFading, kLatched };

/// One measurement.
struct DeviceSample {
  std::uint32_t sequence = 0;  ///< number of the sample, counted by the device
  std::uint64_t time_us = 0;   ///< the device's clock [us]
  double received = 0.0;       ///< the host's clock at arrival [s]
  std::array<std::int32_t, kMaxChannels> raw{};
  DeviceState state = DeviceState::kConnecting;
  Fault fault = Fault::kNone;    ///< fault that the device is latched for
  int fault_channel = -1;        ///< channel of kSensorRange
  bool estop = false;            ///< the emergency stop is pressed now
  double factor = 0.0;           ///< the device's own factor on the torque, 0 .. 1
  std::uint64_t acted_tick = 0;  ///< tick of the step that it acts on
};

/// Command of one step to a device.
struct DeviceCommand {
  std::uint64_t tick = 0;               ///< number of the step
  std::uint64_t sample_time_us = 0;     ///< the device's clock at the sample that the step used [us]
  bool enable = false;                  ///< false: zero torque, no fault
  bool fault = false;                   ///< the host is in fault: zero torque within 5 ms, also if enabled
  JointArray torque{};                  ///< finite and within all of the host's limits [Nm]
  JointArray hcp_angle{};               ///< measured; also the walls' q_ref [rad]
  JointArray gdp_angle{};               ///< displayed pose: where stopped digits stand [rad]
  std::array<bool, kDigits> stopped{};  ///< a segment of the digit is in contact
  std::array<LocalWall, kSegments> wall{};
  double wall_valid_for = 0.0;  ///< since the sample's time [s]; 0: no walls
};

/// Counters since open(); they never decrease.
struct LinkStatistics {
  std::uint64_t received = 0;        ///< samples
  std::uint64_t lost = 0;            ///< sequence numbers that did not arrive
  std::uint64_t outdated = 0;        ///< duplicates, and samples that a newer one had overtaken
  std::uint64_t corrupt = 0;         ///< frames dropped: not a frame, checksum, version
  std::uint64_t refused = 0;         ///< frames of another session
  std::uint64_t overflowed = 0;      ///< samples dropped because the loop did not fetch them in time
  std::uint64_t sent = 0;            ///< commands, repetitions included
  std::uint64_t device_corrupt = 0;  ///< frames that the controller dropped, by its own count
  std::uint64_t device_refused = 0;
  std::uint64_t device_outdated = 0;
};

/// Error of a port that does not open, or of a device that does not answer or belongs to another host. what()
/// names the attempt and the remedy.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One device. open(), close() and info() are for set-up. The loop's thread calls the other functions once a
/// step; they must not allocate, lock, throw or wait. A device that has to wait for its wire has a thread of
/// its own (core/latest.h and device/sample_queue.h carry values across).
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// Connects, and returns once info() is known. @throws DeviceError. Set-up only.
  virtual void open() = 0;
  /// Commands zero torque, then releases the device. It may be called at any time, also twice.
  virtual void close() noexcept = 0;
  /// @returns identity and abilities, known after open() and constant until close().
  [[nodiscard]] virtual const DeviceInfo& info() const = 0;

  /// Fetches the samples since the last call, oldest first; none is older than an earlier one.
  /// @param now    the host's clock [s]
  /// @param out    if it is too small, the oldest samples are dropped and counted as overflowed
  /// @returns the number of samples
  [[nodiscard]] virtual std::size_t receive(double now, std::span<DeviceSample> out) noexcept = 0;
  /// Sends a command; it replaces all earlier ones.
  virtual void send(const DeviceCommand& command) noexcept = 0;
  /// Asks the device to clear its latch; its samples show when it has.
  virtual void reset() noexcept = 0;
  /// @returns the fault of the connection itself: kNone, kControllerRestarted, kRefused or kDeviceLost. After
  /// the cause is gone, reset() clears it.
  [[nodiscard]] virtual Fault connection_fault() const noexcept { return Fault::kNone; }
  /// @returns the counters of the link since open(); zeros for a device without one. Real-time.
  [[nodiscard]] virtual LinkStatistics statistics() const noexcept { return {}; }
};

}  // namespace phalanx
