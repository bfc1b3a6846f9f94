// SPDX-License-Identifier: Apache-2.0
// The ten stabilisers beside an independent computation of the equations of docs/stabilisers.md: each side
// runs from its own state over the same random motion. Nothing of stabiliser_methods.h is used by the
// reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>

#include "phalanx/core/random.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/force/stabiliser_methods.h"
#include "support/all_stabilisers.h"

namespace phalanx {
namespace {

constexpr std::uint64_t kReferenceSeed = 160606;

/// One step of a contact, as the formulas name it.
struct Motion {
  bool contact = false;    ///< with contact; without it all forces of the law are 0
  double d = 0.0;          ///< depth [m]; a contact may be there at d <= 0
  double F = 0.0;          ///< the law's force after the caps [N]
  double v = 0.0;          ///< of this step [m/s]
  double v_lowpass = 0.0;  ///< the same, low-passed [m/s]
};

/// The table of docs/stabilisers.md, row by row.
class PlainStabiliser {
 public:
  PlainStabiliser(const StabiliserParameters& p, double dF_min, double dF_max, double T)
      : p_(p), dF_min_(dF_min), dF_max_(dF_max), T_(T) {}

  double step(const Motion& m, double F_sent) {
    const double out = m.contact ? pressed(m, F_sent) : left(F_sent);
    if (!m.contact || m.d <= 0.0) d_before_ = 0.0;  // the finger arrives from outside
    if (m.contact && m.d > 0.0) d_before_ = m.d;
    return out;
  }

 private:
  double bounded(double F, double F_sent, double low) const {
    const double wish = F - F_sent;
    if (wish > dF_max_) return F_sent + dF_max_;
    return wish < low ? F_sent + low : F;
  }
  double filtered(double F, double F_sent) const {
    const double keeps = std::exp(-2.0 * std::numbers::pi * p_.lowpass_hz * T_);
    const double out = keeps * F_sent + (1.0 - keeps) * F;
    return F == 0.0 && out < 1e-4 ? 0.0 : out;
  }
  /// k xp = Kc (d - xp) + Bc ((d - d') - (xp - xp')) / T is linear in xp: its root from two of its values.
  double coupled(const Motion& m) {
    if (m.d <= 0.0) return proxy_ = 0.0;
    const double k = m.F / m.d;
    const auto left_over = [&](double xp) {
      return p_.coupling_stiffness * (m.d - xp) +
             p_.coupling_damping * ((m.d - d_before_) - (xp - proxy_)) / T_ - k * xp;
    };
    proxy_ = std::fmax(0.0, m.d * left_over(0.0) / (left_over(0.0) - left_over(m.d)));  // F >= 0
    return k * proxy_;
  }
  double passive(const Motion& m, double F_sent) {
    energy_ += T_ * F_sent * m.v;
    if (m.d <= 0.0) return 0.0;
    if (energy_ >= 0.0 || m.v == 0.0) return m.F;
    const double a = -energy_ / (T_ * m.v * m.v);
    return std::fmax(m.F + std::fmin(a, p_.passivity_damping_max) * m.v, 0.0);
  }
  double energy_bounded(const Motion& m, double F_sent) const {
    if (m.d <= 0.0) return 0.0;
    const double dx = m.d - d_before_;
    if (dx == 0.0) return F_sent;
    const double slope = (m.F - F_sent) / dx;
    const double most = 2.0 * p_.device_damping / T_;
    const double beta = slope < 0.0 ? 0.0 : slope > most ? most : slope;
    return std::fmax(0.0, F_sent + beta * dx);
  }
  double pressed(const Motion& m, double F_sent) {
    switch (p_.method) {
      case Stabiliser::kSmoothing:
        return bounded(m.F, F_sent, dF_min_);
      case Stabiliser::kRiseOnly:
        return std::fmin(m.F, F_sent + dF_max_);
      case Stabiliser::kLowPass:
        return filtered(m.F, F_sent);
      case Stabiliser::kKelvinVoigt:
        return m.d > 0.0 ? std::fmax(0.0, m.F + p_.damping * m.v_lowpass) : 0.0;
      case Stabiliser::kVirtualCoupling:
        return coupled(m);
      case Stabiliser::kPassivity:
        return passive(m, F_sent);
      case Stabiliser::kEnergyBounding:
        return energy_bounded(m, F_sent);
      case Stabiliser::kNone:
      case Stabiliser::kDirection:
      case Stabiliser::kLocalWall:
      case Stabiliser::kOwn:  // has no reference
        break;
    }
    return m.F;
  }
  double left(double F_sent) {
    proxy_ = 0.0;
    energy_ = 0.0;
    if (p_.method == Stabiliser::kSmoothing) return bounded(0.0, F_sent, dF_min_);
    return p_.method == Stabiliser::kLowPass ? filtered(0.0, F_sent) : 0.0;
  }

  StabiliserParameters p_;
  double dF_min_;
  double dF_max_;
  double T_;
  double d_before_ = 0.0;
  double proxy_ = 0.0;
  double energy_ = 0.0;
};

/// A finger that wanders in and out of a wall of 200 to 3000 N/m, and rests now and then.
class RandomPress {
 public:
  RandomPress(Random& random, double T) : random_(random), T_(T), stiffness_(random.between(200.0, 3000.0)) {}

  Motion next() {
    const double before = d_;
    if (random_.between(0.0, 1.0) < 0.1) wants_ = random_.between(-4e-3, 8e-3);
    if (random_.between(0.0, 1.0) > 0.2) d_ += random_.between(0.0, 0.3) * (wants_ - d_);
    const bool was = contact_;
    contact_ = d_ > -0.5e-3;  // a contact that has its offset d0 is there before it is deep
    Motion m{.contact = contact_, .d = d_};
    if (!contact_) {
      v_lowpass_ = 0.0;
      return m;
    }
    m.v = was ? (d_ - before) / T_ : 0.0;
    v_lowpass_ += 0.4 * (m.v - v_lowpass_);
    m.v_lowpass = v_lowpass_;
    m.F = d_ > 0.0 ? stiffness_ * d_ : 0.0;
    return m;
  }

 private:
  Random& random_;
  double T_;
  double stiffness_;
  double wants_ = 0.0;
  double d_ = -1e-3;
  double v_lowpass_ = 0.0;
  bool contact_ = false;
};

StabiliserParameters random_parameters(Stabiliser method, Random& random) {
  return {.method = method,
          .lowpass_hz = random.between(0.5, 30.0),
          .damping = random.between(0.0, 10.0),
          .turn_rate = random.between(0.1, 10.0),
          .coupling_stiffness = random.between(200.0, 5000.0),
          .coupling_damping = random.between(0.0, 8.0),
          .passivity_damping_max = random.between(0.0, 20.0),
          .device_damping = random.between(0.1, 6.0)};
}

TEST(StabiliserReference, EveryMethodIsItsEquationOverRandomMotion) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(kReferenceSeed));
  Random random(kReferenceSeed);
  for (const Stabiliser method : test::kAllStabilisers) {
    int pushed = 0;
    int other_than_the_law = 0;
    for (int sequence = 0; sequence < 60; ++sequence) {
      const double T = sequence % 2 == 0 ? 0.005 : 0.001;
      StabiliserParameters p = random_parameters(method, random);
      p.min_rate = -random.between(2.0, 60.0);
      p.max_rate = random.between(2.0, 60.0);
      PlainStabiliser reference(p, p.min_rate * T, p.max_rate * T, T);
      RandomPress press(random, T);
      StabiliserMemory memory;
      double sent = 0.0;
      double expected = 0.0;
      for (int n = 0; n < 400; ++n) {
        const Motion m = press.next();
        const StabiliserInput input{.force = m.F,
                                    .depth = m.d,
                                    .speed = m.v_lowpass,
                                    .speed_now = m.v,
                                    .sent = sent,
                                    .pressing = m.contact,
                                    .period = T};
        sent = stabilised_force(p, input, memory);
        expected = reference.step(m, expected);
        ASSERT_NEAR(sent, expected, 1e-12 * std::max(1.0, expected))
            << "seed " << kReferenceSeed << ", method " << static_cast<int>(method) << ", sequence "
            << sequence << ", step " << n;
        // The caps of the digit's sum may lower what was sent: F' is that.
        const double share = random.between(0.0, 1.0) < 0.05 ? 0.7 : 1.0;
        sent *= share;
        expected *= share;
        pushed += sent > 0.0 ? 1 : 0;
        other_than_the_law += std::abs(sent - m.F) > 1e-9 ? 1 : 0;
      }
    }
    EXPECT_GT(pushed, 5000) << static_cast<int>(method);
    const bool is_the_law =
        method == Stabiliser::kNone || method == Stabiliser::kDirection || method == Stabiliser::kLocalWall;
    EXPECT_EQ(other_than_the_law > 2000, !is_the_law) << static_cast<int>(method);
  }
}

// From 2 N the law falls to 0.5 N within the contact, and then the finger leaves: rise-only follows in the
// same step both times. Smoothing, with 0.1 N a step both ways, is 1.9 N and 1.8 N there.
TEST(StabiliserReference, RiseOnlyFallsWithTheLawInTheSameStepWithinAContactAndAtItsEnd) {
  StabiliserMemory memory;
  StabiliserInput input{.force = 0.5, .depth = 1e-3, .sent = 2.0, .pressing = true, .period = 0.005};
  EXPECT_EQ(stabilised_force({.method = Stabiliser::kRiseOnly}, input, memory), 0.5);
  EXPECT_NEAR(stabilised_force({.method = Stabiliser::kSmoothing}, input, memory), 1.9, 1e-15);
  input = {.force = 0.0, .depth = 0.0, .sent = 2.0, .pressing = false, .period = 0.005};
  EXPECT_EQ(stabilised_force({.method = Stabiliser::kRiseOnly}, input, memory), 0.0);
  EXPECT_NEAR(stabilised_force({.method = Stabiliser::kSmoothing}, input, memory), 1.9, 1e-15);
}

// Rodrigues' rotation about the common normal, by the smaller of the bound and the angle between.
TEST(StabiliserReference, TheDirectionTurnsAboutTheCommonNormalByTheBound) {
  Random random(kReferenceSeed + 1);
  const auto unit = [&] {
    Vec3 v(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    while (v.norm() < 0.1) v = Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    return Vec3(v / v.norm());
  };
  int bounded = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 from = unit();
    const Vec3 to = unit();
    const double bound = random.between(0.01, 2.0);
    const double apart = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
    if (apart > 3.1 || apart < 0.01) continue;  // where the axis is ill-conditioned
    const Vec3 axis = from.cross(to) / from.cross(to).norm();
    const double angle = std::min(bound, apart);
    const Vec3 expected = std::cos(angle) * from + std::sin(angle) * axis.cross(from);
    ASSERT_LT((turned_direction(from, to, bound) - expected).norm(), 1e-12)
        << "seed " << kReferenceSeed + 1 << ", round " << n;
    bounded += apart > bound ? 1 : 0;
  }
  EXPECT_GT(bounded, 500);
}

// clamp(k (d_ref - g.(q - q_ref)), 0, f_max): the controller's own formula.
TEST(StabiliserReference, ALocalWallIsItsFormulaOverRandomAngles) {
  Random random(kReferenceSeed + 2);
  int at_zero = 0;
  int at_most = 0;
  for (int n = 0; n < 2000; ++n) {
    LocalWall wall{.active = true,
                   .g = {},
                   .d_ref = random.between(-2e-3, 5e-3),
                   .stiffness = random.between(100.0, 3000.0),
                   .force_max = random.between(0.5, 5.0),
                   .host_force = 1.0};
    DigitAngles q{};
    DigitAngles q_ref{};
    double moved = 0.0;
    for (std::size_t i = 0; i < wall.g.size(); ++i) {
      wall.g[i] = random.between(-0.08, 0.08);
      q[i] = random.between(-0.1, 0.1);
      q_ref[i] = random.between(-0.1, 0.1);
      moved += wall.g[i] * q[i] - wall.g[i] * q_ref[i];
    }
    double expected = wall.stiffness * wall.d_ref - wall.stiffness * moved;
    at_zero += expected < 0.0 ? 1 : 0;
    at_most += expected > wall.force_max ? 1 : 0;
    expected = std::fmin(std::fmax(expected, 0.0), wall.force_max);
    ASSERT_NEAR(local_wall_force(wall, q, q_ref), expected, 1e-12 * std::max(1.0, expected))
        << "seed " << kReferenceSeed + 2 << ", round " << n;
    wall.active = false;
    ASSERT_EQ(local_wall_force(wall, q, q_ref), 0.0);
  }
  EXPECT_GT(at_zero, 200);
  EXPECT_GT(at_most, 200);
}

// 2 mm of 500 N/m are 1 N; at an angle that is not a number, none.
TEST(StabiliserReference, ALocalWallPushesNothingAtAnAngleThatIsNotANumber) {
  LocalWall wall{.active = true, .d_ref = 2e-3, .stiffness = 500.0, .force_max = 5.0};
  wall.g[0] = 0.075;
  DigitAngles q{};
  EXPECT_NEAR(local_wall_force(wall, q, {}), 1.0, 1e-12);
  q[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(local_wall_force(wall, q, {}), 0.0);
}

}  // namespace
}  // namespace phalanx
