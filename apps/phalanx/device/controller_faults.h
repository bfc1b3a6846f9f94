// SPDX-License-Identifier: Apache-2.0
// Faults that `phalanx device simulate --fault` can inject, and their times.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "phalanx/simulation/simulated_controller.h"

namespace phalanx {

/// Kind of an injected fault; controller_fault_list() explains each.
enum class ControllerFaultKind {
  kDrop,
  kDuplicate,
  kReorder,
  kDelay,
  kJitter,
  kCorrupt,
  kNoiseBytes,
  kSilence,
  kRestart,
  kStuck,
  kOpen,
  kShort,
  kJump,
  kNoise,
  kDeadMotor,
  kEmergencyStop,
  kDrive,
  kClockBackwards,
  kSlow,
  kSlowClock,
};

/// One --fault. Its times are those of the process's (slowed) clock, which a restart does not reset.
struct ControllerFault {
  ControllerFaultKind kind = ControllerFaultKind::kDrop;
  double value = 0.0;  ///< a probability, a time [s], a factor, or the number of a channel or motor
  double start = 0.0;  ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s]
  std::string text;                                      ///< as typed
};

/// Faults of packets, in both directions.
struct PacketFaults {
  double drop = 0.0;       ///< probability
  double duplicate = 0.0;  ///< probability
  double reorder = 0.0;    ///< probability: sent after the next packet
  double delay = 0.0;      ///< delay of each packet [s]
  double jitter = 0.0;     ///< additional delay of each packet, uniform from 0 to this [s]
  double corrupt = 0.0;    ///< probability: one bit flips
  bool noise_bytes = false;
  bool silence = false;
};

/// Slowness of the controller: only every n-th tick is made.
struct ControllerSlowness {
  int every = 1;       ///< n
  bool clock = false;  ///< its clock counts only the ticks that are made
};

/// Parses NAME[=VALUE][@START[+LENGTH]].
/// @throws std::invalid_argument that names the possible forms.
[[nodiscard]] ControllerFault parse_controller_fault(const std::string& text);

/// @returns all names, a line each.
[[nodiscard]] std::string controller_fault_list();

/// The faults of one run. If two of a kind are in force, the later one on the command line counts.
class ControllerFaultPlan {
 public:
  /// Checks the faults.
  /// @throws std::invalid_argument naming the fault whose channel or motor the device does not have
  ControllerFaultPlan(std::vector<ControllerFault> faults, std::size_t channels, std::size_t motors);

  [[nodiscard]] PacketFaults packets(double t) const noexcept;
  [[nodiscard]] SimulatedBreakage breakage(double t) const noexcept;
  [[nodiscard]] ControllerSlowness slowness(double t) const noexcept;
  /// @returns true if the time of a restart has come since the last call.
  [[nodiscard]] bool restarts(double t) noexcept;

 private:
  std::vector<ControllerFault> faults_;
  double asked_ = -1.0;  ///< time of the last call of restarts() [s]
};

}  // namespace phalanx
