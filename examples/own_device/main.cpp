// SPDX-License-Identifier: Apache-2.0
// own_device [SECONDS [SLOWDOWN]]: a session of the station with a driver of your own, without real-time
// scheduling. Everything runs SLOWDOWN times slower.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <utility>

#include "my_device.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/station.h"
#include "phalanx/station/station_model.h"

namespace {

int run(double seconds, double slowdown) {
  const phalanx::Clock clock(slowdown);
  const phalanx::StationModel made = phalanx::make_station_model(phalanx::load_scene("press_teapot"), "");

  const auto device = make_my_device();
  device->open();
  // Joints that the device does not measure stay at the open hand. With a calibration file:
  // apply_calibration(load_calibration("mine.toml"), device->info()) in place of the device's own channels.
  phalanx::ChannelMap map(device->info().channels, {}, made.model->hand.parameters());

  phalanx::StationOptions options;
  options.ask_for_realtime = false;
  options.safety = made.safety;
  phalanx::Station station(made.model, made.parameters, *device, std::move(map), options, clock);
  const double begin = clock.now();
  station.start();

  double largest_angle = 0.0;
  for (double t = 0.1; t <= seconds; t += 0.1) {
    clock.sleep_until(begin + t);
    const phalanx::StationView view = station.view();
    const double angle = view.snapshot.hcp_angle[phalanx::joint_index(1, 0)];
    const double torque = view.sent[phalanx::joint_index(1, 0)];
    std::printf("%5.1f s  tick %6llu  %-8s  index knuckle %6.3f rad, torque %8.4f Nm\n", view.time,
                static_cast<unsigned long long>(view.snapshot.tick),
                phalanx::safety_state_name(view.state).data(), angle, torque);
    if (angle > largest_angle) largest_angle = angle;
  }
  const phalanx::StationView last = station.view();
  station.shut_down();
  if (last.fault.fault != phalanx::Fault::kNone) {
    std::printf("fault: %s\n", phalanx::fault_name(last.fault.fault).data());
    return 1;
  }
  return last.snapshot.tick > 0 && largest_angle > 0.1 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  return run(argc > 1 ? std::atof(argv[1]) : 5.0, argc > 2 ? std::atof(argv[2]) : 1.0);
} catch (const std::exception& error) {
  std::fprintf(stderr, "own_device: %s\n", error.what());
  return 1;
}
