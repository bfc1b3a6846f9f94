// SPDX-License-Identifier: Apache-2.0
// A simulated controller on a wire, in real time, for `phalanx device simulate`.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include "device/controller_faults.h"
#include "device/controller_log.h"
#include "device/faulty_wire.h"
#include "phalanx/device/clock.h"
#include "phalanx/simulation/simulated_controller.h"

namespace phalanx {

/// Counts of a run, at its end.
struct ServedStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;  ///< ticks that were left out because the process did not run in time
  std::uint64_t restarts = 0;
  double seconds = 0.0;  ///< time of the (slowed) clock
};

/// Real-time loop of a simulated controller. Each tick takes the received frames, makes the tick, and sends
/// the replies. A missed tick is not repeated: the controller's clock stays the process's (slowed) clock,
/// while the plant stands still for that time.
class ServedController {
 public:
  /// Makes the loop. All arguments must outlive it.
  /// @param log  may be null
  ServedController(SimulatedController& controller, FaultyWire& wire, ControllerFaultPlan& plan,
                   ControllerLog* log);

  /// Runs until `stop` is not 0, `seconds` have passed, or the transport is lost.
  /// @param stop  set by a signal handler
  ServedStatistics serve(const Clock& clock, const Transport& transport, std::optional<double> seconds,
                         const std::atomic<int>& stop);

  /// @returns an epoch that differs from start to start, so that commands of an earlier session are refused.
  [[nodiscard]] static std::uint32_t new_epoch();

 private:
  void tick(double t) noexcept;
  [[nodiscard]] bool leaves_out(double t) noexcept;
  void take_frames(double t, const PacketFaults& faults) noexcept;
  void note_command(std::span<const std::uint8_t> frame) noexcept;

  SimulatedController& controller_;
  FaultyWire& wire_;
  ControllerFaultPlan& plan_;
  ControllerLog* log_;
  ServedStatistics statistics_;
  int left_out_ = 0;  ///< ticks in a row that a fault has left out
  Peer host_ = 0;
  bool has_host_ = false;
  std::uint64_t newest_command_ = 0;
  std::array<std::uint8_t, PHX_FRAME_MAX> frame_{};
  std::array<std::uint8_t, PHX_FRAME_MAX> reply_{};
};

}  // namespace phalanx
