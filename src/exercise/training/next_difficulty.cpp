// SPDX-License-Identifier: Apache-2.0
// A Bayesian filter of a person's ability over the sessions of a training. docs/exercises.md,
// "Training", has the model.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

// Ability a, width w and gain g of a person, all in units of difficulty:
//   P(success at d) = (1 - kLapse) / (1 + exp(-(a - d) / w))
// Between sessions s and s + 1, a becomes a + g kGainDecay^s + N(0, kDrift^2 + (kDriftOverWidth w)^2).
constexpr double kLapse = 0.03;
constexpr double kDrift = 0.03;
constexpr double kDriftOverWidth = 0.2;
constexpr double kGainDecay = 0.85;
constexpr double kLeastAbility = -1.0;
constexpr double kMostAbility = 2.0;
constexpr std::size_t kAbilities = 151;
constexpr double kAbilityStep = (kMostAbility - kLeastAbility) / static_cast<double>(kAbilities - 1);
constexpr std::array<double, 6> kWidths = {0.03, 0.05, 0.08, 0.13, 0.21, 0.34};
constexpr std::array<double, 3> kGains = {0.0, 0.04, 0.1};
constexpr std::array<double, 3> kGainPrior = {0.4, 0.35, 0.25};
constexpr double kPriorSpread = 0.4;
/// Correlation of trials within a session: a person has good and bad days.
constexpr double kSessionCorrelation = 0.01;

double ability_at(std::size_t i) { return kLeastAbility + static_cast<double>(i) * kAbilityStep; }

double success_at(double ability, double width, double difficulty) {
  return (1.0 - kLapse) / (1.0 + std::exp(-(ability - difficulty) / width));
}

/// Probabilities over ability, width and gain.
class AbilityFilter {
 public:
  AbilityFilter(double start, double target_success) {
    for (std::size_t w = 0; w < kWidths.size(); ++w)
      for (std::size_t g = 0; g < kGains.size(); ++g)
        for (std::size_t i = 0; i < kAbilities; ++i) {
          const double centre = start + kWidths[w] * std::log(target_success / (1.0 - target_success));
          const double z = (ability_at(i) - centre) / kPriorSpread;
          at(w, g, i) = kGainPrior[g] * std::exp(-0.5 * z * z);
        }
    normalise();
  }

  void observe(const TrainingSession& session) {
    const double n = session.counted;
    const double weight = 1.0 / (1.0 + (n - 1.0) * kSessionCorrelation);
    std::vector<double> exponent(probability_.size());
    double largest = -1e300;
    for (std::size_t w = 0; w < kWidths.size(); ++w)
      for (std::size_t g = 0; g < kGains.size(); ++g)
        for (std::size_t i = 0; i < kAbilities; ++i) {
          const double p =
              std::clamp(success_at(ability_at(i), kWidths[w], session.difficulty), 1e-6, 1.0 - 1e-6);
          double& value = exponent[index(w, g, i)];
          value = weight * (session.successes * std::log(p) + (n - session.successes) * std::log(1.0 - p));
          if (at(w, g, i) > 0.0) largest = std::max(largest, value);
        }
    for (std::size_t k = 0; k < probability_.size(); ++k) probability_[k] *= std::exp(exponent[k] - largest);
    normalise();
  }

  /// Moves on to the next session.
  void drift() {
    ++session_;
    std::vector<double> moved(probability_.size(), 0.0);
    for (std::size_t w = 0; w < kWidths.size(); ++w) {
      const std::vector<double> kernel = drift_kernel(kWidths[w]);
      for (std::size_t g = 0; g < kGains.size(); ++g) {
        const double shift = kGains[g] * std::pow(kGainDecay, session_) / kAbilityStep;
        for (std::size_t i = 0; i < kAbilities; ++i)
          spread(at(w, g, i), kernel, shift, i, &moved[index(w, g, 0)]);
      }
    }
    probability_ = std::move(moved);
    normalise();
  }

  /// Returns the expected share of successes at a difficulty; it falls with it.
  [[nodiscard]] double expected(double difficulty) const {
    double sum = 0.0;
    for (std::size_t w = 0; w < kWidths.size(); ++w)
      for (std::size_t g = 0; g < kGains.size(); ++g)
        for (std::size_t i = 0; i < kAbilities; ++i)
          sum += probability_[index(w, g, i)] * success_at(ability_at(i), kWidths[w], difficulty);
    return sum;
  }

 private:
  static std::size_t index(std::size_t w, std::size_t g, std::size_t i) {
    return (w * kGains.size() + g) * kAbilities + i;
  }
  /// Returns weights of the offsets -n .. n of the grid, of a normal drift.
  static std::vector<double> drift_kernel(double width) {
    const double deviation = std::hypot(kDrift, kDriftOverWidth * width) / kAbilityStep;
    const int reach = 1 + static_cast<int>(3.0 * deviation);
    std::vector<double> kernel;
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      kernel.push_back(std::exp(-0.5 * k * k / (deviation * deviation)));
      sum += kernel.back();
    }
    for (double& weight : kernel) weight /= sum;
    return kernel;
  }

  /// Spreads the probability of ability i over its neighbours, `shift` grid steps further. The ends of the
  /// grid keep the rest.
  static void spread(double probability, const std::vector<double>& kernel, double shift, std::size_t i,
                     double* moved) {
    if (probability < 1e-15) return;
    const int whole = static_cast<int>(std::floor(shift));
    const double part = shift - whole;
    const int reach = static_cast<int>(kernel.size()) / 2;
    const auto clamped = [](int j) {
      return static_cast<std::size_t>(std::clamp(j, 0, static_cast<int>(kAbilities) - 1));
    };
    for (int k = -reach; k <= reach; ++k) {
      const double mass = probability * kernel[static_cast<std::size_t>(k + reach)];
      const int to = static_cast<int>(i) + k + whole;
      moved[clamped(to)] += (1.0 - part) * mass;
      moved[clamped(to + 1)] += part * mass;
    }
  }

  double& at(std::size_t w, std::size_t g, std::size_t i) { return probability_[index(w, g, i)]; }
  void normalise() {
    double sum = 0.0;
    for (const double p : probability_) sum += p;
    for (double& p : probability_) p /= sum;
  }

  int session_ = 0;
  std::vector<double> probability_ = std::vector<double>(kWidths.size() * kGains.size() * kAbilities);
};

}  // namespace

double next_difficulty(std::span<const TrainingSession> history, const Difficulty& difficulty) {
  const double target = std::clamp(difficulty.target_success, exercise_ranges::kTargetSuccess.min,
                                   exercise_ranges::kTargetSuccess.max);
  const double start = std::clamp(difficulty.start, 0.0, 1.0);
  bool any = false;
  bool open = false;  // a session was observed, and the ability has not moved on from it
  AbilityFilter filter(start, target);
  for (const TrainingSession& session : history) {
    const bool counts = session.counted > 0 && session.successes >= 0 &&
                        session.successes <= session.counted &&
                        exercise_ranges::kDifficulty.contains(session.difficulty);
    if (!session.continues && std::exchange(open, false)) filter.drift();
    if (!counts) continue;
    any = open = true;
    filter.observe(session);
  }
  if (!any) return start;
  if (open) filter.drift();
  double low = 0.0;
  double high = 1.0;
  if (filter.expected(low) <= target) return low;
  if (filter.expected(high) >= target) return high;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (filter.expected(middle) > target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace phalanx
