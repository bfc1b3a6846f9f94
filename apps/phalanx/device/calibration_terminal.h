// SPDX-License-Identifier: Apache-2.0
// The terminal of `device calibrate` and `device range`, and what both do before they measure.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/calibration_dialogue.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Standard input and output. On a terminal, the line of live values is overwritten repeatedly.
class CalibrationTerminal final : public CalibrationConsole {
 public:
  CalibrationTerminal();
  void say(const std::string& line) override;
  std::optional<std::string> answer(const std::function<std::string()>& live) override;

 private:
  std::optional<std::string> take_line();
  void read_more();
  void show(const std::string& values);
  void wipe();

  const bool shows_live_;
  std::string typed_;
  bool ended_ = false;
  std::size_t shown_ = 0;  ///< characters of the live line
};

/// Checks that the file of --out can be written.
/// @throws std::invalid_argument naming the remedy
void check_out(const std::string& out, bool force);

/// Loads the hand of --hand or --profile. @throws std::invalid_argument if both are stated; SceneError
[[nodiscard]] HandParameters hand_of_options(const std::string& hand, const std::string& profile);

/// Opens the device. @throws DeviceError, std::invalid_argument
[[nodiscard]] std::unique_ptr<Device> open_to_measure(const std::string& address, const HandParameters& hand,
                                                      const Clock& clock);

}  // namespace phalanx
