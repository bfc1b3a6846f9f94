// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton behind the link: plant, patient and the controller's side of a session, without
// the wire. A process puts it on UDP or a pseudo-terminal, the station's simulated device holds it directly.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "phalanx/device/device.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/device/simulated_device.h"
#include "phalanx/device/simulated_exoskeleton.h"

namespace phalanx {

/// What a test or a curious user may break in the sensors and motors; all off.
struct SimulatedBreakage {
  int stuck_channel = -1;    ///< its raw value stands still
  int open_channel = -1;     ///< reads raw_max + 1000
  int shorted_channel = -1;  ///< reads raw_min - 1000
  int jump_channel = -1;     ///< an angle reads 50 degrees more, another a quarter of its range
  int noise_channel = -1;    ///< gets normal noise of noise_counts rms
  double noise_counts = 0.0;
  int dead_motor = -1;  ///< does nothing whatever it is told
  bool estop = false;   ///< the emergency stop is pressed
  bool drive_fault = false;
  bool clock_backwards = false;  ///< its clock decreases from tick to tick, to 0 at least
};

/// One tick of the controller's clock is one of the plant. The first tick is at one period, so that no sample
/// has the time 0. The patient squeezes over and over (PressCycle) whatever the host does: without torque he
/// moves through the object. Its own limits are the torque that its motors can do and kOwnTorqueRate.
class SimulatedController {
 public:
  static constexpr double kOwnTorqueRate = 100.0;  ///< of every joint [Nm/s]

  /// @param first_epoch  see phx_controller_init()
  /// @throws std::invalid_argument as SimulatedExoskeleton, PressCycle and simulated_channels(). Set-up only.
  SimulatedController(const SimulatedDeviceSettings& settings, const std::string& serial,
                      std::uint32_t first_epoch);

  /// A frame from the host. As phx_controller_receive() at the controller's time; acts from the next tick on.
  /// Real-time.
  phx_received receive(std::span<const std::uint8_t> frame, std::array<std::uint8_t, PHX_FRAME_MAX>& reply,
                       std::size_t& reply_size) noexcept;
  /// One tick of 1 / rate_hz: sensors, what is broken in them, controller, motors, plant with patient.
  /// Real-time.
  const phx_output& tick(const SimulatedBreakage& breakage) noexcept;
  /// The clock goes on by so many ticks in which the controller did nothing, the plant stands still: for a
  /// process that was not given its processor.
  void skip(std::uint64_t ticks) noexcept;
  /// As after a power cycle: session, latch and clock are gone, the plant is where it was.
  void restart(std::uint32_t first_epoch) noexcept;

  [[nodiscard]] const phx_controller& controller() const noexcept;
  [[nodiscard]] const phx_output& output() const noexcept;  ///< of the last tick
  [[nodiscard]] const SimulatedExoskeleton& exoskeleton() const noexcept;
  [[nodiscard]] const DeviceInfo& info() const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept;    ///< since the beginning
  [[nodiscard]] std::uint64_t time_us() const noexcept;  ///< the controller's clock at the last tick
  [[nodiscard]] double period() const noexcept;          ///< [s]

  SimulatedController(SimulatedController&&) noexcept;
  ~SimulatedController();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx
