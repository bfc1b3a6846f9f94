// SPDX-License-Identifier: Apache-2.0
#include "run_device.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "phalanx/device/calibration.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/device/simulated_device.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/station/open_device.h"
#include "phalanx/station/realtime.h"

namespace phalanx {
namespace {

/// A controller that does not slow down with us would be judged by time limits that are too long.
void refuse_slow_motion(const RunOptions& o) {
  const bool ours = o.device.starts_with("udp:127.") || o.device.starts_with("udp:localhost:") ||
                    o.device.starts_with("serial:/dev/pts/");
  if (o.slow_motion == 1.0 || ours) return;
  throw std::invalid_argument(
      fmt::format("--slow-motion {}: {} may be a real device, whose time goes on as ever; leave it out",
                  o.slow_motion, o.device));
}

OpenDevice open_wired(const RunOptions& o, const SafetySettings& safety, const HandParameters& hand,
                      const Clock& clock) {
  refuse_slow_motion(o);
  LinkSettings settings;
  settings.torque_limit = safety.joint_torque;
  settings.torque_rate = safety.torque_rate;
  if (!o.no_realtime)
    settings.on_thread_start = [] {
      static_cast<void>(make_realtime({.priority = 79, .cpu = -1, .lock_memory = true}));
    };
  OpenDevice out;
  out.device = open_device(o.device, clock, settings);
  auto* link = dynamic_cast<LinkDevice*>(out.device.get());
  auto* glove = dynamic_cast<OpenGlovesDevice*>(out.device.get());
  std::optional<Calibration> calibration;
  if (!o.calibration.empty()) calibration = load_calibration(o.calibration);
  if (glove != nullptr) glove->set_hand(hand);
  out.device->open();
  out.channels =
      calibration ? apply_calibration(*calibration, out.device->info()) : out.device->info().channels;
  if (glove != nullptr && calibration) glove->set_calibration(out.channels);
  if (link != nullptr && calibration) {  // a controller is told the gains when its session begins
    link->close();
    link->set_calibration(out.channels);
    link->open();
  }
  if (!calibration)
    fmt::print(stderr,
               "phalanx run: no --calibration: using the device's own numbers; see `phalanx device calibrate "
               "--help`\n");
  return out;
}

}  // namespace

OpenDevice open_station_device(const RunOptions& o, const SceneDescription& scene, const StationModel& made,
                               const Clock& clock) {
  if (o.device != "simulated") return open_wired(o, made.safety, made.model->hand.parameters(), clock);
  if (!o.calibration.empty())
    throw std::invalid_argument("--calibration: the simulated device needs none; leave it out");
  OpenDevice out;
  out.device = make_simulated_device(simulated_settings(scene, *made.model));
  out.device->open();
  out.channels = out.device->info().channels;
  return out;
}

}  // namespace phalanx
