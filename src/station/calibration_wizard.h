// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/range_session.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// A device that is calibrated, or on which a patient's range is measured: open, never commanded. For one thread at a
/// time.
class CalibrationWizard {
 public:
  /// Opens the device for a calibration.
  /// @throws as open_device(), Device::open() and CalibrationSession
  void begin(const std::string& device, const HandParameters& hand, const Clock& clock,
             const CalibrationPlan& plan, std::optional<Calibration> earlier);
  /// Opens the device for the measurement of a patient's range.
  /// @throws as open_device(), Device::open(), apply_calibration() and RangeSession
  void begin_range(const std::string& device, const HandParameters& hand, const Clock& clock,
                   const Calibration& calibration, const std::string& patient);
  /// Closes the device. It does nothing if none is open.
  void end() noexcept;
  [[nodiscard]] bool on() const noexcept { return session_ != nullptr || range_ != nullptr; }
  [[nodiscard]] bool measures_range() const noexcept { return range_ != nullptr; }

  /// Takes in the device's new samples. A failure is reported by trouble(), and the pose stays the current
  /// one: the user can mend the cause, measure again, or abandon.
  /// @throws std::bad_alloc
  void update(double now);
  /// Takes a step between the begin and the end. A step that fails changes nothing.
  /// @throws std::invalid_argument if the wizard is not on, or has no such step; as CalibrationSession and RangeSession
  void step(const WizardStep& step, double now);
  /// @returns the result of a calibration.
  /// @throws std::invalid_argument if it is not finished
  [[nodiscard]] const Calibration& found() const;
  /// @returns the result of a measured range.
  /// @throws std::invalid_argument if it is not finished
  [[nodiscard]] MeasuredRange found_range() const;

  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  [[nodiscard]] CalibrationSession::View view() const { return session_->view(); }
  [[nodiscard]] RangeSession::View range_view() const { return range_->view(); }
  /// @throws std::invalid_argument if the wizard is not on
  void refuse_unless_on() const;

 private:
  void step_calibration(const WizardStep& step, double now);
  void step_range(const WizardStep& step, double now);

  std::unique_ptr<Device> device_;
  std::unique_ptr<CalibrationSession> session_;  ///< declared after the device, so that it ends before it
  std::unique_ptr<RangeSession> range_;          ///< likewise; at most one of the two
  MeasuredRange of_range_;                       ///< calibration and patient of the range
  std::string trouble_;
};

}  // namespace phalanx
