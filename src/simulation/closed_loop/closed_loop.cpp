// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/closed_loop.h"

#include <memory>

namespace phalanx {
namespace {

/// Tolerance for comparing the two clocks [s]. A step of the host that falls on a tick of the controller uses
/// that tick's sample, for any rounding of the two sums of periods.
constexpr double kClock = 1e-9;

}  // namespace

void run_closed_loop(
    const HapticModel& model, const HapticParameters& parameters, SimulatedExoskeleton& device,
    const Intention& intention, double seconds, double host_phase,
    const std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>& observer,
    const Gate& gate) {
  const auto state = std::make_unique<HapticState>(model, parameters);
  const double compute_delay = device.exoskeleton().controller.compute_delay;
  const double host_period = parameters.period();
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
      step(model, parameters, device.sample(), *state);
      if (gate) {
        Snapshot leaving = state->snapshot();
        gate(t, device, leaving);
        device.send(leaving, t + compute_delay);
      } else {
        device.send(state->snapshot(), t + compute_delay);
      }
      observer(t, state->snapshot(), device);
    }
    move.to = intention.angle(next);
    if (intention.push) move.push = intention.push(now);
    device.end_tick(move);
    move.from = move.to;
  }
}

}  // namespace phalanx
