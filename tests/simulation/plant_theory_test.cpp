// SPDX-License-Identifier: Apache-2.0
// The plant under a sampled wall, against what theory says of it.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "plant_cases.h"

namespace phalanx {
namespace {

using test::at;
using test::bare_joint;
using test::kMcp;
using test::no_input;
using test::no_patient;

/// A mass on viscous friction that feels a wall through a sampler and a hold:
/// push = -(K x + B dx/T) of `delay` periods ago, dx the change over one period.
struct SampledWall {
  double mass, damping, period;
  int delay = 0;
  double virtual_damping = 0.0;
  double patient_stiffness = 0.0;
  double patient_damping = 0.0;
};

/// State: position, speed, and the positions sampled before, newest first. Exact between samples:
///   x+ = x + (1-e)/beta v + (T - (1-e)/beta) F/b,   v+ = e v + (1-e) F/b,   beta = b/m, e = exp(-beta T).
double spectral_radius(const SampledWall& wall, double stiffness) {
  const double beta = wall.damping / wall.mass;
  const double e = std::exp(-beta * wall.period);
  const double glide = (1.0 - e) / beta;
  const double x_per_force = (wall.period - glide) / wall.damping;
  const double v_per_force = (1.0 - e) / wall.damping;
  const Eigen::Index old = wall.delay + 1;  // one more for the difference
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 + old, 2 + old);
  A(0, 0) = 1.0;
  A(0, 1) = glide;
  A(1, 1) = e;
  A(2, 0) = 1.0;
  for (Eigen::Index i = 1; i < old; ++i) A(2 + i, 1 + i) = 1.0;
  const auto column = [](Eigen::Index age) { return age == 0 ? 0 : 1 + age; };
  const double b = wall.virtual_damping / wall.period;
  const auto feed = [&](Eigen::Index age, double force) {
    A(0, column(age)) += x_per_force * force;
    A(1, column(age)) += v_per_force * force;
  };
  feed(wall.delay, -(stiffness + b));
  feed(wall.delay + 1, b);
  // Gelfand's formula, |A^k|^(1/k) for k = 2^40: Eigen's eigenvalues() take the compiler 3 s.
  constexpr int kSquarings = 40;
  double log_scale = 0.0;  // A^(2^i) = exp(log_scale) times what is in A
  for (int i = 0; i < kSquarings; ++i) {
    const double norm = A.norm();
    A = (A / norm).lazyProduct(A / norm).eval();
    log_scale = 2.0 * (log_scale + std::log(norm));
  }
  return std::exp((log_scale + std::log(A.norm())) / std::exp2(kSquarings));
}

/// Whether the swing grows, of the plant itself, released 1 mrad away from the wall's rest.
bool swings_up(const SampledWall& wall, double stiffness) {
  const Exoskeleton exo = bare_joint(wall.mass, wall.damping);
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = wall.patient_stiffness;
  patient.damping[at(kMcp)] = wall.patient_damping;
  JointArray start{};
  start[at(kMcp)] = 1e-3;
  Plant plant(exo, patient, start, 1e-4);
  PlantInput input = no_input(exo);
  std::deque<double> before(at(wall.delay + 2), 1e-3);  // newest first
  constexpr int kPeriods = 3000;
  double early = 0.0;
  double late = 0.0;
  for (int k = 0; k < kPeriods; ++k) {
    const double x = plant.angle()[at(kMcp)];
    before.push_front(x);
    before.pop_back();
    const double sampled = before[at(wall.delay)];
    const double change = sampled - before[at(wall.delay + 1)];
    input.push[at(kMcp)] = -(stiffness * sampled + wall.virtual_damping * change / wall.period);
    plant.advance(input, wall.period);
    if (k >= kPeriods / 3 && k < 2 * kPeriods / 3) early = std::max(early, std::abs(x));
    if (k >= 2 * kPeriods / 3) late = std::max(late, std::abs(x));
    if (std::abs(x) > 1.0) return true;
    if (std::max(std::abs(x), wall.period * std::abs(plant.speed()[at(kMcp)])) < 1e-9) return false;
  }
  return late > early;
}

/// The least stiffness at which `unstable` holds, to 0.1 %.
double limit(const std::function<bool(double)>& unstable, double first) {
  double high = first;
  while (!unstable(high)) high *= 1.5;
  double low = high / 1.5;
  while (unstable(low)) low /= 1.5;
  while (high > low * 1.001) {
    const double middle = std::sqrt(low * high);
    (unstable(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

double plant_limit(const SampledWall& wall, double first) {
  return limit([&](double k) { return swings_up(wall, k); }, first);
}

TEST(PlantTheory, ASampledSpringTurnsUnstableWhereTheDiscreteEigenvaluesSay) {
  const std::vector<SampledWall> walls = {{.mass = 0.24, .damping = 1.6, .period = 5e-3},
                                          {.mass = 1.0, .damping = 20.0, .period = 1e-3},
                                          {.mass = 0.05, .damping = 5.0, .period = 2e-3},
                                          {.mass = 0.1, .damping = 40.0, .period = 1e-2},
                                          {.mass = 0.24, .damping = 1.6, .period = 5e-3, .delay = 1},
                                          {.mass = 0.05, .damping = 5.0, .period = 2e-3, .delay = 3},
                                          {.mass = 0.1, .damping = 20.0, .period = 1e-2, .delay = 2}};
  for (const SampledWall& wall : walls) {
    SCOPED_TRACE(testing::Message() << "m " << wall.mass << " b " << wall.damping << " T " << wall.period
                                    << " delay " << wall.delay);
    const double theory = limit([&](double k) { return spectral_radius(wall, k) > 1.0; }, 1.0);
    EXPECT_NEAR(plant_limit(wall, theory) / theory, 1.0, 0.01);
  }
}

// Colgate & Schenkel 1997: with K < 2 (b - |B|) / T the wall is passive, b the device's own friction. It is
// then stable, without a hand or in any passive one. The condition is sufficient; nothing is said beyond it.
TEST(PlantTheory, NoWallWithinThePassivityBoundSwingsUpInAnyPassiveHand) {
  for (const double mass : {0.02, 0.24, 2.0}) {
    for (const double period : {1e-3, 5e-3}) {
      for (const double virtual_damping : {0.0, 0.4, -0.4}) {
        for (const double stiffness : {0.0, 20.0, 700.0}) {
          const SampledWall wall{.mass = mass,
                                 .damping = 1.6,
                                 .period = period,
                                 .virtual_damping = virtual_damping,
                                 .patient_stiffness = stiffness,
                                 .patient_damping = 0.004 * stiffness};
          const double bound = 2.0 * (wall.damping - std::abs(virtual_damping)) / period;
          EXPECT_FALSE(swings_up(wall, 0.98 * bound))
              << "m " << mass << " T " << period << " B " << virtual_damping << " hand " << stiffness;
        }
      }
    }
  }
}

// Gil and others 2009: K < (b + B) / tau, tau = T/2 + delay, where (b + B) tau / m is small. From
// m s^2 + b s + K exp(-s tau) = 0 at s = i w:  K = (b / tau) (w tau / sin(w tau))  with  (w tau)^2 near
// b tau / m, so that the limit is above the rule by about b tau / (6 m).
TEST(PlantTheory, TheDelaysLinearRuleHoldsWhereDampingTimesDelayIsSmall) {
  const std::vector<SampledWall> walls = {
      {.mass = 0.24, .damping = 1.6, .period = 5e-3},
      {.mass = 0.24, .damping = 1.6, .period = 1e-3, .delay = 5},
      {.mass = 0.24, .damping = 1.6, .period = 5e-3, .delay = 1},
      {.mass = 0.5, .damping = 1.0, .period = 2e-3, .delay = 3},
      {.mass = 0.5, .damping = 1.0, .period = 2e-3, .delay = 3, .virtual_damping = 0.5}};
  for (const SampledWall& wall : walls) {
    const double tau = wall.period * (0.5 + wall.delay);
    const double damping = wall.damping + wall.virtual_damping;
    const double small = damping * tau / wall.mass;
    ASSERT_LT(small, 0.06);
    const double ratio = plant_limit(wall, damping / tau) * tau / damping;
    EXPECT_NEAR(ratio, 1.0, small / 3.0 + 0.002) << "delay " << wall.delay;
    if (wall.virtual_damping == 0.0) {
      EXPECT_GT(ratio, 1.0 - 0.001) << "delay " << wall.delay;
    }
  }
}

/// Swing over the last second, in quanta, of a wall that sees positions rounded to `quantum`.
double swing_in_quanta(double stiffness, double damping, double friction, double quantum) {
  constexpr double kPeriod = 1e-3;
  Exoskeleton exo = bare_joint(0.1, damping);
  exo.joints[0].friction.coulomb = friction;
  JointArray start{};
  start[at(kMcp)] = 20.4 * quantum;
  Plant plant(exo, no_patient(), start);
  PlantInput input = no_input(exo);
  double low = 1e9;
  double high = -1e9;
  for (int k = 0; k < 8000; ++k) {
    const double x = plant.angle()[at(kMcp)];
    if (k >= 7000) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
    input.push[at(kMcp)] = -stiffness * quantum * std::round(x / quantum);
    plant.advance(input, kPeriod);
  }
  return (high - low) / quantum;
}

// Abbott & Okamura 2005: no limit cycle while  K <= min(2 b / T, 2 Fc / quantum).  b = 1, T = 1 ms: 2000;
// quantum 1e-4: Fc = 0.02 gives 400, Fc = 0.09 gives 1800.
TEST(PlantTheory, FrictionThatCoversTheQuantumLeavesNoLimitCycle) {
  for (const double stiffness : {50.0, 200.0, 390.0})
    EXPECT_LE(swing_in_quanta(stiffness, 1.0, 0.02, 1e-4), 1.0) << stiffness;
  for (const double stiffness : {500.0, 1750.0})
    EXPECT_LE(swing_in_quanta(stiffness, 1.0, 0.09, 1e-4), 1.0) << stiffness;
}

// The same wall with too little friction or none, so that the test above can fail.
TEST(PlantTheory, AQuantisedWallSwingsWithoutThatFriction) {
  EXPECT_GT(swing_in_quanta(1900.0, 1.0, 0.0, 1e-4), 1.0);
  EXPECT_GT(swing_in_quanta(1900.0, 1.0, 0.002, 1e-4), 1.0);
}

}  // namespace
}  // namespace phalanx
