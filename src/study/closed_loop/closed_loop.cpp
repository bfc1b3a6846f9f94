// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/closed_loop/closed_loop.h"

#include <memory>

namespace phalanx {
namespace {

/// A step of the host that falls on a tick of the controller uses that tick's sample, however the two sums of
/// periods are rounded [s].
constexpr double kClock = 1e-9;

}  // namespace

void run_closed_loop(
    const HapticModel& model, SimulatedExoskeleton& device, const Intention& intention, double seconds,
    double host_phase,
    const std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>& observer) {
  const auto state = std::make_unique<HapticState>(model);
  const double compute_delay = device.exoskeleton().controller.compute_delay;
  const double host_period = 1.0 / model.rate_hz;
  std::uint64_t host_tick = 0;
  IntendedMove move{.from = intention.angle(0.0), .to = {}, .push = {}};
  for (;;) {
    device.begin_tick();
    const double now = device.time_s();
    if (now >= seconds) return;
    const double next = now + device.period();
    for (;; ++host_tick) {
      const double t = (static_cast<double>(host_tick) + host_phase) * host_period;
      if (t >= next - kClock) break;
      step(model, device.sample(), *state);
      device.send(state->snapshot(), t + compute_delay);
      observer(t, state->snapshot(), device);
    }
    move.to = intention.angle(next);
    if (intention.push) move.push = intention.push(now);
    device.end_tick(move);
    move.from = move.to;
  }
}

}  // namespace phalanx
