// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace phalanx {

std::uint64_t tick_count(double seconds, double rate_hz) {
  if (!(std::isfinite(rate_hz) && rate_hz > 0.0)) {
    throw std::invalid_argument(fmt::format("rate {} Hz: must be above 0", rate_hz));
  }
  if (!(std::isfinite(seconds) && seconds >= 0.0)) {
    throw std::invalid_argument(fmt::format("{} seconds: must be 0 or more", seconds));
  }
  const double ticks = std::max(1.0, std::round(seconds * rate_hz));
  if (ticks > 1e9) {
    throw std::invalid_argument(fmt::format(
        "{} s at {} Hz are more than 1e9 ticks; ask for a shorter time or a lower rate", seconds, rate_hz));
  }
  return static_cast<std::uint64_t>(ticks);
}

StepTimes simulate(const HapticModel& model, const HapticParameters& parameters, const Motion& motion,
                   std::uint64_t ticks, const SimulationObservers& observers) {
  using Clock = std::chrono::steady_clock;
  const auto state = std::make_unique<HapticState>(model, parameters);
  std::vector<double> step_us(ticks);
  const std::uint64_t progress_every = std::max<std::uint64_t>(1, ticks / 100);
  for (std::uint64_t i = 0; i < ticks; ++i) {
    const double t = static_cast<double>(i) / parameters.rate_hz;
    const Sample sample{.time_s = t, .angle = motion.at(t), .angle_origin = motion.angle_origin};
    const auto start = Clock::now();
    step(model, parameters, sample, *state);
    const auto end = Clock::now();
    step_us[i] = std::chrono::duration<double, std::micro>(end - start).count();
    if (observers.tick) observers.tick(state->snapshot());
    if (observers.progress && ((i + 1) % progress_every == 0 || i + 1 == ticks))
      observers.progress(i + 1, ticks);
  }
  return step_times(std::move(step_us));
}

SimulatedMotion simulate_motion(const HapticModel& model, const HapticParameters& parameters,
                                const Motion& motion, std::uint64_t ticks) {
  SimulatedMotion all;
  all.time_s.reserve(ticks);
  all.status.reserve(ticks);
  for (auto* angles : {&all.hcp_angle, &all.gdp_angle, &all.torque}) angles->reserve(ticks);
  for (auto* segments : {&all.depth, &all.force_raw, &all.force}) segments->reserve(ticks);
  const auto add = [&](const Snapshot& snapshot) {
    all.time_s.push_back(snapshot.time_s);
    all.status.push_back(snapshot.status);
    all.hcp_angle.push_back(snapshot.hcp_angle);
    all.gdp_angle.push_back(snapshot.gdp_angle);
    all.torque.push_back(snapshot.torque);
    SegmentArray& depth = all.depth.emplace_back();
    SegmentArray& force_raw = all.force_raw.emplace_back();
    SegmentArray& force = all.force.emplace_back();
    for (std::size_t s = 0; s < snapshot.segment.size(); ++s) {
      depth[s] = snapshot.segment[s].depth;
      force_raw[s] = snapshot.segment[s].force_raw;
      force[s] = snapshot.segment[s].force;
    }
  };
  simulate(model, parameters, motion, ticks, {.tick = add, .progress = {}});
  return all;
}

}  // namespace phalanx
