// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"

namespace phalanx {

/// A device while poses are measured: open, never commanded. One thread at a time.
class CalibrationWizard {
 public:
  /// Opens the device. @throws as open_device(), Device::open() and CalibrationSession
  void begin(const std::string& device, const HandParameters& hand, const Clock& clock);
  /// Closes the device. Nothing if no calibration is on.
  void end() noexcept;
  [[nodiscard]] bool on() const noexcept { return session_ != nullptr; }

  /// Takes in what the device has sampled. What goes wrong is trouble(), and the pose stays asked for:
  /// whoever calibrates mends it, measures again, or abandons.
  void go_on(double now) noexcept;
  /// kMeasure, kSkip, kBack or kGoTo. @throws std::invalid_argument if no calibration is on; as
  /// CalibrationSession
  void step(CalibrationSession::Step step, std::size_t pose, double now);
  /// @throws std::invalid_argument if it is not finished
  [[nodiscard]] const Calibration& found() const;

  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  [[nodiscard]] CalibrationSession::View view() const { return session_->view(); }
  /// @throws std::invalid_argument
  void refuse_unless_on() const;

 private:
  std::unique_ptr<Device> device_;
  std::unique_ptr<CalibrationSession> session_;  ///< declared after the device, so that it ends before it
  std::string trouble_;
};

}  // namespace phalanx
