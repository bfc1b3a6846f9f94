// SPDX-License-Identifier: Apache-2.0
#include "grasp_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "peer_motion.h"

namespace phalanx::bench {
namespace {

constexpr double kLightDepth = 0.5e-3;  ///< where a squeeze begins to let go [m]
/// How far a squeeze goes back, as a share of the way between kLightDepth and kPressDepth: 2 mm past the
/// contact.
constexpr double kRelease = 1.5;
constexpr int kSearchSteps = 600;  ///< from open to closed, while looking for the depth
constexpr int kSwayTicks = 2000;
constexpr double kSway = 0.05;    ///< amplitude of a joint [rad]
constexpr double kWrapped = 0.7;  ///< of the way from the open angle to the greatest, at the end of a wrap
constexpr int kSqueezeTicks = 4000;
constexpr int kSqueezePeriods = 2;

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return low + (high - low) * (static_cast<double>(z >> 11U) * 0x1.0p-53);
  }

 private:
  std::uint64_t state_;
};

/// From rest to rest with the least jerk, u in [0, 1].
double minimum_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

/// How far each digit is closed, 0 to 1.
using Closure = std::array<double, kDigits>;

/// One grasp without its end: where it starts, where it would lead, and when each digit moves.
struct Posture {
  JointArray open;
  JointArray closed;
  std::array<int, kDigits> begin;  ///< tick
  std::array<int, kDigits> ticks;  ///< how many the digit moves for

  [[nodiscard]] JointArray at_closure(const Closure& closure) const {
    JointArray angle;
    for (int j = 0; j < kJoints; ++j) {
      angle[idx(j)] = open[idx(j)] + closure[idx(digit_of_joint(j))] * (closed[idx(j)] - open[idx(j)]);
    }
    return angle;
  }
};

Posture draw_posture(const HandParameters& hand, std::uint64_t seed) {
  Random random(seed);
  Posture posture{};
  for (int d = 0; d < kDigits; ++d) {
    // Flexion, abduction, hinge, hinge: shares of the way from the open angle to the end of the range.
    const std::array<double, kJointsPerDigit> weight =
        d == 0
            ? std::array{1.0, random.between(0.7, 1.0), random.between(0.3, 0.8), random.between(0.3, 0.8)}
            : std::array{1.0, random.between(-0.3, 0.3), random.between(0.6, 1.0), random.between(0.4, 0.9)};
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(d, i));
      const double way = hand.max_angle[j] - hand.open_angle[j];
      const auto in_range = [&](double angle) {
        return std::clamp(angle, hand.min_angle[j], hand.max_angle[j]);
      };
      posture.open[j] = in_range(hand.open_angle[j] + random.between(-0.04, 0.04));
      posture.closed[j] = in_range(hand.open_angle[j] + weight[idx(i)] * way);
    }
    posture.begin[idx(d)] = static_cast<int>(random.between(10.0, 80.0));
    posture.ticks[idx(d)] = static_cast<int>(random.between(200.0, 300.0));
  }
  return posture;
}

/// Slow waves of the joints, so that what presses slides.
class Sway {
 public:
  explicit Sway(std::uint64_t seed) {
    Random random(~seed);
    for (std::size_t j = 0; j < kJoints; ++j) {
      hertz_[j] = random.between(0.3, 1.2);
      phase_[j] = random.between(0.0, 2.0 * std::numbers::pi);
    }
  }
  /// Adds kSwayTicks ticks about the motion's end to it; `share` of the amplitude for each digit.
  void append_to(const HandParameters& hand, const Closure& share, BenchMotion& motion) const {
    const JointArray from = motion.angle.back();
    for (int tick = 0; tick < kSwayTicks; ++tick) {
      const double swell = std::min(1.0, tick / 200.0);
      JointArray angle = from;
      for (int joint = 0; joint < kJoints; ++joint) {
        const std::size_t j = idx(joint);
        const double wave = std::sin(2.0 * std::numbers::pi * hertz_[j] * tick * 1e-3 + phase_[j]);
        angle[j] = std::clamp(from[j] + share[idx(digit_of_joint(joint))] * swell * kSway * wave,
                              hand.min_angle[j], hand.max_angle[j]);
      }
      motion.angle.push_back(angle);
    }
  }

 private:
  std::array<double, kJoints> hertz_{};
  std::array<double, kJoints> phase_{};
};

/// Where each digit's deepest segment is this deep.
struct Depths {
  Closure light;
  Closure pressed;
};

double deepest(const Snapshot& snapshot, int digit) {
  double depth = 0.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    depth = std::max(depth, snapshot.segment[idx(segment_index(digit, k))].depth);
  return depth;
}

/// Closes the hand step by step and notes, by linear interpolation, where each digit has gone deep enough.
Depths find_depths(const HapticModel& model, const HapticParameters& parameters, const Posture& posture) {
  HapticState state(model, parameters);
  Depths found;
  found.light.fill(1.0);
  found.pressed.fill(1.0);
  std::array<double, kDigits> before{};
  for (int n = 0; n <= kSearchSteps; ++n) {
    Closure closure;
    for (int d = 0; d < kDigits; ++d)
      closure[idx(d)] = std::min(found.pressed[idx(d)], static_cast<double>(n) / kSearchSteps);
    // A step a second: no speed is too high, and nothing that smooths the force matters to the depth.
    static_cast<void>(step(model, parameters, {static_cast<double>(n), posture.at_closure(closure)}, state));
    for (int d = 0; d < kDigits; ++d) {
      const double depth = deepest(state.snapshot(), d);
      const auto crossing = [&](double wanted) {
        return (n - (depth - wanted) / (depth - before[idx(d)])) / kSearchSteps;
      };
      if (before[idx(d)] < kLightDepth && depth >= kLightDepth)
        found.light[idx(d)] = std::min(found.light[idx(d)], crossing(kLightDepth));
      if (before[idx(d)] < kPressDepth && depth >= kPressDepth)
        found.pressed[idx(d)] = std::min(found.pressed[idx(d)], crossing(kPressDepth));
      before[idx(d)] = depth;
    }
  }
  return found;
}

std::vector<JointArray> grasp_angles(const Posture& posture, const Closure& pressed) {
  std::vector<JointArray> angle;
  for (int tick = 0; tick < kGraspTicks; ++tick) {
    Closure closure;
    for (int d = 0; d < kDigits; ++d) {
      const double u = static_cast<double>(tick - posture.begin[idx(d)]) / posture.ticks[idx(d)];
      closure[idx(d)] = pressed[idx(d)] * minimum_jerk(u);
    }
    angle.push_back(posture.at_closure(closure));
  }
  return angle;
}

}  // namespace

BenchMotion make_grasp(const HapticModel& model, const HapticParameters& parameters, std::uint64_t seed) {
  const Posture posture = draw_posture(model.hand.parameters(), seed);
  const Depths depths = find_depths(model, parameters, posture);
  return {"grasp " + std::to_string(seed), grasp_angles(posture, depths.pressed)};
}

BenchMotion make_restless(const HapticModel& model, const HapticParameters& parameters, std::uint64_t seed) {
  constexpr int kTicks = 1500;
  constexpr double kAmplitude = 0.05;  // of each of three waves a joint [rad]
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const HandParameters& hand = model.hand.parameters();
  const BenchMotion grasp = make_grasp(model, parameters, seed);
  struct Wave {
    double frequency_hz;
    double phase;
  };
  Random random(~seed);
  std::array<std::array<Wave, 3>, kJoints> waves{};
  for (auto& joint : waves) {
    for (Wave& wave : joint) wave = {random.between(2.0, 12.0), random.between(0.0, kTurn)};
  }
  BenchMotion motion{"restless " + std::to_string(seed), {}};
  for (int tick = 0; tick < kTicks; ++tick) {
    const double closed = 0.5 - 0.5 * std::cos(kTurn * tick / kTicks);
    const double swell = std::min(1.0, tick / 200.0);
    JointArray angle;
    for (std::size_t j = 0; j < kJoints; ++j) {
      double tremor = 0.0;
      for (const Wave& wave : waves[j])
        tremor += std::sin(kTurn * wave.frequency_hz * tick * 1e-3 + wave.phase);
      const double open = grasp.angle.front()[j];
      angle[j] = std::clamp(open + closed * (grasp.angle.back()[j] - open) + swell * kAmplitude * tremor,
                            hand.min_angle[j], hand.max_angle[j]);
    }
    motion.angle.push_back(angle);
  }
  return motion;
}

BenchMotion make_slide(const HapticModel& model, const HapticParameters& parameters, std::uint64_t seed,
                       int digit) {
  const Posture posture = draw_posture(model.hand.parameters(), seed);
  Closure pressed = find_depths(model, parameters, posture).pressed;
  Closure share;
  share.fill(1.0);
  for (int d = 0; d < kDigits; ++d) {
    if (digit == kAllDigits || d == digit) continue;
    pressed[idx(d)] = share[idx(d)] = 0.0;
  }
  const std::string who = digit == kAllDigits ? "all" : std::to_string(digit);
  BenchMotion motion{"slide " + who + ", " + std::to_string(seed), grasp_angles(posture, pressed)};
  Sway(seed).append_to(model.hand.parameters(), share, motion);
  return motion;
}

BenchMotion make_wrap(const HapticModel& model, std::uint64_t seed) {
  const HandParameters& hand = model.hand.parameters();
  Posture posture = draw_posture(hand, seed);
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::size_t j = idx(joint);
    if (joint % kJointsPerDigit != kAbductionJoint)
      posture.closed[j] = posture.open[j] + kWrapped * (hand.max_angle[j] - posture.open[j]);
  }
  Closure all;
  all.fill(1.0);
  BenchMotion motion{"wrap " + std::to_string(seed), grasp_angles(posture, all)};
  Sway(seed).append_to(hand, all, motion);
  return motion;
}

BenchMotion make_squeeze(const HapticModel& model, const HapticParameters& parameters, std::uint64_t seed) {
  const Posture posture = draw_posture(model.hand.parameters(), seed);
  const Depths depths = find_depths(model, parameters, posture);
  BenchMotion motion{"squeeze " + std::to_string(seed), grasp_angles(posture, depths.pressed)};
  constexpr int kPeriod = kSqueezeTicks / kSqueezePeriods;
  for (int tick = 0; tick < kSqueezeTicks; ++tick) {
    Closure closure;
    for (int d = 0; d < kDigits; ++d) {
      // The digits follow one another by a fifth of a period: out for the first half of it, in for the
      // second.
      const int since = tick - d * kPeriod / kDigits;
      const double u = since < 0 ? 0.0 : static_cast<double>(since % kPeriod) / kPeriod;
      const double out = kRelease * (u < 0.5 ? minimum_jerk(2.0 * u) : minimum_jerk(2.0 - 2.0 * u));
      closure[idx(d)] = depths.pressed[idx(d)] + out * (depths.light[idx(d)] - depths.pressed[idx(d)]);
    }
    motion.angle.push_back(posture.at_closure(closure));
  }
  return motion;
}

}  // namespace phalanx::bench
