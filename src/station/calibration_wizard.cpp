// SPDX-License-Identifier: Apache-2.0
#include "station/calibration_wizard.h"

#include <stdexcept>
#include <utility>

#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/station/open_device.h"

namespace phalanx {

void CalibrationWizard::begin(const std::string& device, const HandParameters& hand, const Clock& clock) {
  std::unique_ptr<Device> opened = open_device(device, clock);
  if (auto* glove = dynamic_cast<OpenGlovesDevice*>(opened.get())) glove->set_hand(hand);
  opened->open();
  session_ = std::make_unique<CalibrationSession>(*opened, hand);
  device_ = std::move(opened);
  trouble_.clear();
}

void CalibrationWizard::end() noexcept {
  session_.reset();
  if (device_) device_->close();
  device_.reset();
  trouble_.clear();
}

void CalibrationWizard::update(double now) {
  if (!on()) return;
  try {
    session_->update(now);
  } catch (const std::exception& error) {
    trouble_ = error.what();
  }
}

void CalibrationWizard::step(CalibrationSession::Step step, std::size_t pose, double now) {
  refuse_unless_on();
  if (step == CalibrationSession::Step::kMeasure) session_->measure(now);
  if (step == CalibrationSession::Step::kSkip) session_->skip();
  if (step == CalibrationSession::Step::kBack) session_->back();
  if (step == CalibrationSession::Step::kGoTo) session_->go_to(pose);
  trouble_.clear();
}

const Calibration& CalibrationWizard::found() const {
  refuse_unless_on();
  if (!session_->calibration())
    throw std::invalid_argument("the calibration is not finished; measure the poses that are left");
  return *session_->calibration();
}

void CalibrationWizard::refuse_unless_on() const {
  if (!on()) throw std::invalid_argument("no calibration is on; begin one in the device panel");
}

}  // namespace phalanx
