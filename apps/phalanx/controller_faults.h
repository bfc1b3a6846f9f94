// SPDX-License-Identifier: Apache-2.0
// What `phalanx device simulate --fault` can break, and when.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "phalanx/device/simulated_controller.h"

namespace phalanx {

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
};

/// One --fault. Times are the process's own (slowed) clock, which a restart does not set back.
struct ControllerFault {
  ControllerFaultKind kind = ControllerFaultKind::kDrop;
  double value = 0.0;  ///< a probability, seconds, or the number of a channel or motor
  double start = 0.0;  ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s]
  std::string text;                                      ///< as typed
};

/// What happens to packets, in both directions.
struct PacketFaults {
  double drop = 0.0;       ///< probability
  double duplicate = 0.0;  ///< probability
  double reorder = 0.0;    ///< probability: held back behind the next
  double delay = 0.0;      ///< of each [s]
  double jitter = 0.0;     ///< of each, uniform from 0 to this [s]
  double corrupt = 0.0;    ///< probability: one bit flips
  bool noise_bytes = false;
  bool silence = false;
};

/// NAME[=VALUE][@START[+LENGTH]]. @throws std::invalid_argument that names what is possible.
[[nodiscard]] ControllerFault parse_controller_fault(const std::string& text);

/// All names, a line each.
[[nodiscard]] std::string controller_fault_list();

/// The faults of one run. Where two of a kind are in force, the later one on the command line counts.
class ControllerFaultPlan {
 public:
  /// @throws std::invalid_argument naming the fault whose channel or motor the device does not have
  ControllerFaultPlan(std::vector<ControllerFault> faults, std::size_t channels, std::size_t motors);

  [[nodiscard]] PacketFaults packets(double t) const noexcept;
  [[nodiscard]] SimulatedBreakage breakage(double t) const noexcept;
  /// Whether a restart's time has come since the last call.
  [[nodiscard]] bool restarts(double t) noexcept;

 private:
  std::vector<ControllerFault> faults_;
  double asked_ = -1.0;  ///< when restarts() was called last [s]
};

}  // namespace phalanx
