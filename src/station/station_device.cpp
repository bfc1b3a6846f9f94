// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station_device.h"

#include <optional>

#include "phalanx/device/calibration.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/station/open_device.h"
#include "phalanx/station/realtime.h"

namespace phalanx {

OpenDevice open_wired_device(const WiredDeviceSettings& wired, const SafetySettings& safety,
                             const HandParameters& hand, const Clock& clock) {
  LinkSettings settings;
  settings.torque_limit = safety.joint_torque;
  settings.torque_rate = safety.torque_rate;
  if (wired.ask_for_realtime)
    settings.on_thread_start = [] {
      static_cast<void>(make_realtime({.priority = 79, .cpu = -1, .lock_memory = true}));
    };
  OpenDevice out;
  out.device = open_device(wired.spec, clock, settings);
  auto* link = dynamic_cast<LinkDevice*>(out.device.get());
  auto* glove = dynamic_cast<OpenGlovesDevice*>(out.device.get());
  std::optional<Calibration> calibration;
  if (!wired.calibration.empty()) calibration = load_calibration(wired.calibration);
  if (glove != nullptr) {
    glove->set_hand(hand);
    glove->set_watchdog(wired.watchdog);
    glove->set_force_feedback(wired.force_feedback);
  }
  out.device->open();
  out.channels =
      calibration ? apply_calibration(*calibration, out.device->info()) : out.device->info().channels;
  if (glove != nullptr && calibration) glove->set_calibration(out.channels);
  if (link != nullptr && calibration) {  // a controller gets the gains when its session begins
    link->close();
    link->set_calibration(out.channels);
    link->open();
  }
  return out;
}

}  // namespace phalanx
