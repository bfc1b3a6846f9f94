// SPDX-License-Identifier: Apache-2.0
// own_device [SECONDS [SLOWDOWN]]: a station with a driver of your own (my_device.cpp), without real-time
// scheduling. The station has the loop, the safety gate and the faults. Everything runs SLOWDOWN times slower.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <utility>

#include "my_device.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/station.h"
#include "phalanx/station/station_model.h"

using namespace phalanx;

int main(int argc, char** argv) try {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5.0;
  const Clock clock(argc > 2 ? std::atof(argv[2]) : 1.0);
  const StationModel made = make_station_model(load_scene("press_teapot"), "");

  const auto device = make_my_device();
  device->open();
  // Joints that the device does not measure stay at the open hand. With a calibration file, use
  // apply_calibration(load_calibration("mine.toml"), device->info()) in place of its own channels.
  ChannelMap map(device->info().channels, {}, made.model->hand.parameters());

  StationOptions options;
  options.ask_for_realtime = false;
  options.safety = made.safety;
  Station station(made.model, made.parameters, *device, std::move(map), options, clock);
  const double begin = clock.now();
  station.start();

  const auto knuckle = static_cast<std::size_t>(joint_index(1, 0));
  double largest_angle = 0.0;
  for (double t = 0.1; t <= seconds; t += 0.1) {
    clock.sleep_until(begin + t);
    const StationView view = station.view();
    std::printf("%5.1f s  tick %6llu  %-8s  index knuckle %6.3f rad, torque %8.4f Nm\n", view.time,
                static_cast<unsigned long long>(view.snapshot.tick), safety_state_name(view.state).data(),
                view.snapshot.hcp_angle[knuckle], view.sent[knuckle]);
    largest_angle = std::max(largest_angle, view.snapshot.hcp_angle[knuckle]);
  }
  const StationView last = station.view();
  station.shut_down();
  if (last.fault.fault == Fault::kNone) return last.snapshot.tick > 0 && largest_angle > 0.1 ? 0 : 1;
  std::printf("fault: %s\n", fault_name(last.fault.fault).data());
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "own_device: %s\n", error.what());
  return 1;
}
