// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/core/random.h"
#include "phalanx/device/motion.h"

namespace phalanx {
namespace {

/// Part of the way from the open to the closed angle that each joint of a digit (flexion, abduction, hinge,
/// hinge) goes at closure 1.
using DigitWeights = std::array<double, kJointsPerDigit>;
constexpr DigitWeights kStill = {0.0, 0.0, 0.0, 0.0};
constexpr DigitWeights kFingerCloses = {1.0, 0.0, 1.0, 0.7};
/// Around an object.
constexpr DigitWeights kThumbWraps = {1.0, 1.0, 0.6, 0.6};
/// Pad to pad with the fingers, the hinges nearly straight.
constexpr DigitWeights kThumbOpposes = {1.0, 1.0, 0.25, 0.2};

struct Grip {
  std::array<DigitWeights, kDigits> weight;
  bool ripple;  ///< the digits move one after another, from the little finger on
};

constexpr Grip kPress = {{kStill, kFingerCloses, kStill, kStill, kStill}, false};
constexpr Grip kPinch = {{kThumbOpposes, kFingerCloses, kStill, kStill, kStill}, false};
constexpr Grip kTripod = {{kThumbOpposes, kFingerCloses, kFingerCloses, kStill, kStill}, false};
constexpr Grip kPower = {{kThumbWraps, kFingerCloses, kFingerCloses, kFingerCloses, kFingerCloses}, false};
constexpr DigitWeights kMoves = {1.0, 1.0, 1.0, 1.0};
constexpr Grip kPosture = {{kMoves, kMoves, kMoves, kMoves, kMoves}, false};
constexpr Grip kWave = {{kStill, kFingerCloses, kFingerCloses, kFingerCloses, kFingerCloses}, true};

const Grip& grip_of(const std::string& name) {
  static constexpr std::array<const Grip*, 6> kGrips = {&kPress, &kPinch, &kTripod,
                                                        &kPower, &kWave,  &kPosture};
  const auto& names = scripted_motion_names();
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) {
    throw std::invalid_argument(fmt::format("motion.name = \"{}\" is not a scripted motion; {}Known: {}",
                                            name, did_you_mean(name, names), fmt::join(names, ", ")));
  }
  return *kGrips[static_cast<std::size_t>(it - names.begin())];
}

/// @returns the part of a ripple's closing (or opening) in which `digit` moves: half of it, the
/// little finger first.
double ripple_fraction(double u, int digit) {
  const double begin = 0.5 * (kDigits - 1 - digit) / (kDigits - 1);
  return (u - begin) / 0.5;
}

/// @returns the closure of a digit (0..1) at time `t` of one cycle.
double closed_at(const ScriptedMotion& script, bool ripple, int digit, double t) {
  const auto progress = [&](double u) { return minimum_jerk(ripple ? ripple_fraction(u, digit) : u); };
  const double closing = progress((t - script.start_s) / script.close_s);
  const double opening = progress((t - script.start_s - script.close_s - script.hold_s) / script.open_s);
  return closing - opening;
}

/// Tremor of three sines a joint, with seeded frequency and phase. Physiological and pathological tremors lie
/// between 5 and 12 Hz.
class Tremor {
 public:
  explicit Tremor(const ScriptedMotion& script) : amplitude_(script.tremor_rad) {
    Random random(script.seed);
    for (auto& joint : waves_) {
      for (Wave& wave : joint) {
        wave.frequency_hz = 5.0 + 7.0 * random.uniform();
        wave.phase = 2.0 * std::numbers::pi * random.uniform();
      }
    }
  }
  [[nodiscard]] double at(int joint, double t) const {
    if (amplitude_ == 0.0) return 0.0;
    double sum = 0.0;
    for (const Wave& wave : waves_[static_cast<std::size_t>(joint)]) {
      sum += std::sin(2.0 * std::numbers::pi * wave.frequency_hz * t + wave.phase);
    }
    return amplitude_ * sum / static_cast<double>(kWaves);
  }

 private:
  static constexpr std::size_t kWaves = 3;
  struct Wave {
    double frequency_hz = 0.0;
    double phase = 0.0;
  };
  double amplitude_;
  std::array<std::array<Wave, kWaves>, kJoints> waves_{};
};

void require(bool ok, const char* key, double value, const char* rule) {
  if (!ok) throw std::invalid_argument(fmt::format("motion.{} = {}: must be {}", key, value, rule));
}

constexpr double kMaxKeys = 2e6;
/// Time within which a tremor rises and fades, so that a motion starts and ends at the open hand [s].
constexpr double kTremorFade = 0.1;

void check(const ScriptedMotion& script, double total) {
  const auto not_negative = [](double x) { return std::isfinite(x) && x >= 0.0; };
  require(not_negative(script.start_s), "start_s", script.start_s, "finite and not negative");
  require(not_negative(script.close_s) && script.close_s > 0.0, "close_s", script.close_s,
          "finite and above 0");
  require(not_negative(script.hold_s), "hold_s", script.hold_s, "finite and not negative");
  require(not_negative(script.open_s) && script.open_s > 0.0, "open_s", script.open_s, "finite and above 0");
  require(script.repeat >= 1, "repeat", script.repeat, "at least 1");
  require(script.closure >= 0.0 && script.closure <= 1.0, "closure", script.closure,
          "between 0 (open) and 1 (closed)");
  for (const double share : script.digit_closure)
    require(not_negative(share), "digit_closure", share, "finite and not negative");
  for (const std::optional<double>& angle : script.posture)
    require(!angle || std::isfinite(*angle), "angle_deg", angle.value_or(0.0) * kRadToDeg, "finite");
  require(not_negative(script.tremor_rad), "tremor_rad", script.tremor_rad, "finite and not negative");
  require(not_negative(script.key_rate_hz) && script.key_rate_hz > 0.0, "key_rate_hz", script.key_rate_hz,
          "finite and above 0");
  require(
      total * script.key_rate_hz <= kMaxKeys, "repeat", script.repeat,
      "small enough that the motion has at most two million keys; shorten the motion or lower its key rate");
}

/// @returns the angle that a joint has at closure 1 [rad].
double closed_angle(const ScriptedMotion& script, const Grip& grip, const HandParameters& hand,
                    std::size_t j) {
  if (&grip == &kPosture) return script.posture[j].value_or(hand.open_angle[j]);
  return hand.closed_angle[j].value_or(hand.max_angle[j]);
}

}  // namespace

const std::vector<std::string>& scripted_motion_names() {
  static const std::vector<std::string> kNames = {"press",       "pinch", "tripod",
                                                  "power_grasp", "wave",  "posture"};
  return kNames;
}

Motion make_motion(const ScriptedMotion& script, const HandParameters& hand) {
  const Grip& grip = grip_of(script.name);
  const double cycle = script.start_s + script.close_s + script.hold_s + script.open_s;
  const double total = cycle * script.repeat;
  check(script, total);
  const Tremor tremor(script);

  Motion motion;
  motion.angle_origin.fill(AngleOrigin::kScripted);
  const auto steps = static_cast<std::size_t>(std::ceil(total * script.key_rate_hz));
  motion.time_s.reserve(steps + 1);
  motion.angle.reserve(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t = k < steps ? static_cast<double>(k) / script.key_rate_hz : total;
    if (!motion.time_s.empty() && t <= motion.time_s.back())
      break;  // total * rate was a whole number but for rounding
    const double t_cycle = k < steps ? t - cycle * std::floor(t / cycle) : cycle;
    const double fade = minimum_jerk(t / kTremorFade) * minimum_jerk((total - t) / kTremorFade);
    JointArray angle = hand.open_angle;
    for (int joint = 0; joint < kJoints; ++joint) {
      const int digit = digit_of_joint(joint);
      const auto j = static_cast<std::size_t>(joint);
      const double weight = grip.weight[static_cast<std::size_t>(digit)][j % kJointsPerDigit];
      if (weight == 0.0) continue;
      const double reach = weight * script.closure * script.digit_closure[static_cast<std::size_t>(digit)] *
                           (closed_angle(script, grip, hand, j) - hand.open_angle[j]);
      angle[j] += reach * closed_at(script, grip.ripple, digit, t_cycle) + fade * tremor.at(joint, t);
      angle[j] = std::clamp(angle[j], hand.min_angle[j], hand.max_angle[j]);
    }
    motion.time_s.push_back(t);
    motion.angle.push_back(angle);
  }
  return motion;
}

}  // namespace phalanx
