// SPDX-License-Identifier: Apache-2.0
// Seeded tables of observed steps and tasks: a hand that moves and presses, seen by sensors with noise.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "exercise/scores/observed_steps.h"
#include "phalanx/core/random.h"
#include "phalanx/exercise/force_scores.h"
#include "phalanx/exercise/motion_scores.h"
#include "phalanx/exercise/smoothness.h"

namespace phalanx::test {

/// A sum of three sines with seeded frequencies and phases.
class Wander {
 public:
  Wander(Random& random, double size) {
    for (auto& part : parts_)
      part = {size * random.between(0.2, 1.0), random.between(0.3, 9.0), random.between(0.0, 6.3)};
  }
  [[nodiscard]] double at(double time) const {
    double sum = 0.0;
    for (const auto& [size, rate, phase] : parts_) sum += size * std::sin(rate * time + phase);
    return sum;
  }

 private:
  struct Part {
    double size = 0.0;
    double rate = 0.0;
    double phase = 0.0;
  };
  std::array<Part, 3> parts_{};
};

/// Generates 3 to 9 s at uneven times. Joints and pads wander, digits press now and then. By the seed some
/// have sensors of force, joints that are not measured, dropouts, slips, or torques that are off.
inline std::vector<Observation> generated_steps(std::uint64_t seed) {
  Random random(seed);
  const double end = random.between(3.0, 9.0);
  const double interval =
      seed % 25 == 24 ? 0.001 : random.between(0.01, 0.04);  // two tables of a station's rate
  std::vector<Wander> angle;
  std::vector<Wander> force;
  std::vector<Wander> pad;
  for (int i = 0; i < kJoints; ++i) angle.emplace_back(random, random.between(0.02, 0.8));
  for (int i = 0; i < kDigits; ++i) force.emplace_back(random, random.between(0.5, 4.0));
  for (int i = 0; i < 3 * kDigits; ++i) pad.emplace_back(random, 0.03);
  const bool sensors = seed % 3 == 0;
  std::vector<Observation> steps;
  for (double time = random.between(0.0, 5.0), begin = time; time < begin + end;
       time += interval * random.between(0.4, 1.6)) {
    Observation step = running_step(time);
    step.tick = steps.size();
    // Two of five tables are of a device with half the rate: each second step repeats the angles of
    // the one before.
    const bool repeats = seed % 5 < 2 && steps.size() % 2 == 1;
    if (repeats) step.sample_time = steps.back().sample_time;
    const auto noisy = [&](double value, double noise) { return value + noise * random.normal(); };
    for (std::size_t j = 0; j < kJoints; ++j)
      step.angle[j] = repeats ? steps.back().angle[j] : noisy(angle[j].at(time), 0.003);
    for (std::size_t d = 0; d < kDigits; ++d) {
      step.force[d] = std::max(0.0, noisy(force[d].at(time), 0.02));
      if (time < begin + 0.3) step.force[d] = 0.0;
      if (sensors) step.measured_force[d] = noisy(0.6 * step.force[d], 0.01);
      step.touching[d] = step.force[d] > 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        step.pad[d][static_cast<Eigen::Index>(axis)] = noisy(pad[3 * d + axis].at(time), 1e-4);
      if (step.touching[d]) step.sent_stiffness[d] = random.between(300.0, 600.0);
    }
    steps.push_back(step);
  }
  const auto some = [&] {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(steps.size()));
  };
  if (seed % 5 == 1)
    for (Observation& step : steps)
      for (int joint = joint_index(2, 0); joint < kJoints; ++joint)
        step.angle_origin[idx(joint)] = AngleOrigin::kCompleted;
  if (seed % 5 == 2) steps[some()].slips[1] = true;
  if (seed % 7 == 3) steps[some()].fault = ObservationFault::kNoSample;
  if (seed % 11 == 4) steps[some()].torque_on = false;
  if (seed % 6 == 3) steps[some()].measured_force[2] = kNaN;
  return steps;
}

/// One call of a function of scores, and the same task as scores.py reads it (JSON).
struct ScoredTask {
  std::string json;
  std::function<std::vector<Score>(const std::vector<Observation>&)> scores;
};

/// Returns tasks of all measures with seeded parameters. The tracking task's target is for `steps`.
[[nodiscard]] std::vector<ScoredTask> generated_tasks(std::uint64_t seed,
                                                      const std::vector<Observation>& steps);

}  // namespace phalanx::test
