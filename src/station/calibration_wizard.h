// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"

namespace phalanx {

/// A device whose calibration poses are measured: open, never commanded. For one thread at a time.
class CalibrationWizard {
 public:
  /// Opens the device.
  /// @throws as open_device(), Device::open() and CalibrationSession
  void begin(const std::string& device, const HandParameters& hand, const Clock& clock);
  /// Closes the device. It does nothing if no calibration runs.
  void end() noexcept;
  [[nodiscard]] bool on() const noexcept { return session_ != nullptr; }

  /// Takes in the device's new samples. A failure is reported by trouble(), and the pose stays the current
  /// one: the user can mend the cause, measure again, or abandon.
  /// @throws std::bad_alloc
  void update(double now);
  /// Takes the step kMeasure, kSkip, kBack or kGoTo. A step that fails changes nothing.
  /// @throws std::invalid_argument if no calibration runs; as CalibrationSession
  void step(CalibrationSession::Step step, std::size_t pose, double now);
  /// @returns the result.
  /// @throws std::invalid_argument if the calibration is not finished
  [[nodiscard]] const Calibration& found() const;

  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  [[nodiscard]] CalibrationSession::View view() const { return session_->view(); }
  /// @throws std::invalid_argument if no calibration runs
  void refuse_unless_on() const;

 private:
  std::unique_ptr<Device> device_;
  std::unique_ptr<CalibrationSession> session_;  ///< declared after the device, so that it ends before it
  std::string trouble_;
};

}  // namespace phalanx
