// SPDX-License-Identifier: Apache-2.0
// Uses phalanx::station as installed: runs 100 steps of an installed scene on its simulated device. What it
// needs of phalanx::phalanx must come by itself.
#include <cmath>
#include <cstdio>
#include <exception>

#include "phalanx/station/session.h"

int main() try {
  phalanx::SessionSettings settings;
  settings.scene = "grasp_teapot";
  settings.ask_for_realtime = false;
  const phalanx::Clock clock;
  phalanx::Session session(settings, clock);
  const auto geometry = session.info()->geometry;
  while (session.view().snapshot.tick < 100 && clock.now() < 60.0) clock.sleep_until(clock.now() + 0.01);
  session.shut_down();

  const phalanx::StationView last = session.view();
  std::printf("%zu object triangles, %llu steps, %s\n", geometry->object.triangles.size(),
              static_cast<unsigned long long>(last.snapshot.tick),
              phalanx::safety_state_name(last.state).data());
  for (const double torque : last.sent) {
    if (!std::isfinite(torque)) return 1;
  }
  return last.snapshot.tick >= 100 && !geometry->object.triangles.empty() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
