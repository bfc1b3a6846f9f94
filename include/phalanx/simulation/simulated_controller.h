// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton behind the link: plant, patient and the controller's side of a session, without
// the wire. A process puts it on UDP or a pseudo-terminal; the station's simulated device holds it directly.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "phalanx/device/device.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/simulation/simulated_device.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {

/// Faults of sensors and motors that a test or a user may switch on; all are off.
struct SimulatedBreakage {
  int stuck_channel = -1;    ///< channel whose raw value stands still
  int open_channel = -1;     ///< channel that reads raw_max + 1000
  int shorted_channel = -1;  ///< channel that reads raw_min - 1000
  int jump_channel = -1;     ///< channel whose reading jumps: an angle by 50 degrees, another by a quarter
                             ///< of its range
  int noise_channel = -1;    ///< channel with normal noise of noise_counts rms
  double noise_counts = 0.0;
  int dead_motor = -1;  ///< motor that exerts no force
  bool estop = false;   ///< the emergency stop is pressed
  bool drive_fault = false;
  bool clock_backwards = false;  ///< the clock decreases from tick to tick, to 0 at least
};

/// Controller whose clock ticks with the plant. The first tick is at one period, so that no sample has the
/// time 0. The patient squeezes over and over (PressCycle), independent of the host: without torque the hand
/// moves through the object. The controller's own limits are the torque that its motors can
/// exert, and kOwnTorqueRate.
class SimulatedController {
 public:
  static constexpr double kOwnTorqueRate = 100.0;  ///< limit of every joint [Nm/s]

  /// @param first_epoch  see phx_controller_init()
  /// @throws std::invalid_argument as SimulatedExoskeleton, PressCycle and simulated_channels(). Set-up only.
  SimulatedController(const SimulatedDeviceSettings& settings, const std::string& serial,
                      std::uint32_t first_epoch);

  /// Takes a frame from the host, as phx_controller_receive() at the controller's time. It acts from the next
  /// tick on. Real-time.
  phx_received receive(std::span<const std::uint8_t> frame, std::array<std::uint8_t, PHX_FRAME_MAX>& reply,
                       std::size_t& reply_size) noexcept;
  /// Makes one tick of 1 / rate_hz: sensors and their faults, controller, motors, plant
  /// with patient. Real-time.
  const phx_output& tick(const SimulatedBreakage& breakage) noexcept;
  /// Advances the clock by `ticks` in which the controller does nothing and the plant stands still: for a
  /// process that was not given its processor.
  void skip(std::uint64_t ticks) noexcept;
  /// Restarts the controller as a power cycle does: session, latch and clock are gone; the plant stays
  /// where it was.
  void restart(std::uint32_t first_epoch) noexcept;

  [[nodiscard]] const phx_controller& controller() const noexcept;
  [[nodiscard]] const phx_output& output() const noexcept;  ///< of the last tick
  [[nodiscard]] const SimulatedExoskeleton& exoskeleton() const noexcept;
  [[nodiscard]] const DeviceInfo& info() const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept;    ///< since the start
  [[nodiscard]] std::uint64_t time_us() const noexcept;  ///< the controller's clock at the last tick
  [[nodiscard]] double period() const noexcept;          ///< [s]

  SimulatedController(SimulatedController&&) noexcept;
  ~SimulatedController();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx
