// SPDX-License-Identifier: Apache-2.0
#include "station/calibration_wizard.h"

#include <stdexcept>
#include <utility>

#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/station/open_device.h"

namespace phalanx {
namespace {

constexpr double kMeasureFor = 1.0;  ///< duration of a pose's measurement [s]

std::unique_ptr<Device> opened(const std::string& address, const HandParameters& hand, const Clock& clock) {
  std::unique_ptr<Device> device = open_device(address, clock);
  if (auto* glove = dynamic_cast<OpenGlovesDevice*>(device.get())) glove->set_hand(hand);
  device->open();
  return device;
}

}  // namespace

void CalibrationWizard::begin(const std::string& device, const HandParameters& hand, const Clock& clock,
                              const CalibrationPlan& plan, std::optional<Calibration> earlier) {
  std::unique_ptr<Device> open = opened(device, hand, clock);
  session_ = std::make_unique<CalibrationSession>(*open, hand, kMeasureFor, CalibrationLimits{}, plan,
                                                  std::move(earlier));
  device_ = std::move(open);
  trouble_.clear();
}

void CalibrationWizard::begin_range(const std::string& device, const HandParameters& hand, const Clock& clock,
                                    const Calibration& calibration, const std::string& patient) {
  std::unique_ptr<Device> open = opened(device, hand, clock);
  range_ = std::make_unique<RangeSession>(*open, apply_calibration(calibration, open->info()), hand);
  device_ = std::move(open);
  of_range_ = {.calibration = calibration.date, .patient = patient};
  trouble_.clear();
}

void CalibrationWizard::end() noexcept {
  session_.reset();
  range_.reset();
  if (device_) device_->close();
  device_.reset();
  trouble_.clear();
}

void CalibrationWizard::update(double now) {
  if (!on()) return;
  try {
    if (range_) range_->update(now);
    if (session_) session_->update(now);
  } catch (const std::exception& error) {
    trouble_ = error.what();
  }
}

void CalibrationWizard::step(const WizardStep& step, double now) {
  refuse_unless_on();
  if (range_)
    step_range(step, now);
  else
    step_calibration(step, now);
  trouble_.clear();
}

void CalibrationWizard::step_calibration(const WizardStep& step, double now) {
  using Kind = WizardStep::Kind;
  if (step.kind == Kind::kMeasure) return session_->measure(now);
  if (step.kind == Kind::kSkip) return session_->skip();
  if (step.kind == Kind::kBack) return session_->back();
  if (step.kind == Kind::kGoTo) return session_->go_to(step.pose);
  if (step.kind == Kind::kEnter) return session_->enter(step.pose, step.joint, step.angle);
  throw std::invalid_argument("a device is calibrated now; this step belongs to a patient's range");
}

void CalibrationWizard::step_range(const WizardStep& step, double now) {
  using Kind = WizardStep::Kind;
  if (step.kind == Kind::kMeasure) return range_->measure(now);
  if (step.kind == Kind::kAccept) return range_->accept();
  if (step.kind == Kind::kSkip) return range_->skip();
  if (step.kind == Kind::kBack) return range_->back();
  if (step.kind == Kind::kGoTo) return range_->go_to(step.pose);
  throw std::invalid_argument("a patient's range is measured now; this step belongs to a calibration");
}

const Calibration& CalibrationWizard::found() const {
  refuse_unless_on();
  if (!session_ || !session_->calibration())
    throw std::invalid_argument("the calibration is not finished; measure the poses that are left");
  return *session_->calibration();
}

MeasuredRange CalibrationWizard::found_range() const {
  refuse_unless_on();
  std::optional<MeasuredRange> range = range_ ? range_->range() : std::nullopt;
  if (!range)
    throw std::invalid_argument("no digit's range was accepted; measure one, or end without a file");
  range->calibration = of_range_.calibration;
  range->patient = of_range_.patient;
  return *range;
}

void CalibrationWizard::refuse_unless_on() const {
  if (!on()) throw std::invalid_argument("no calibration is on; begin one in the device panel");
}

}  // namespace phalanx
