// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/discrimination.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "exercise/distributions.h"
#include "phalanx/core/index.h"
#include "phalanx/core/number_range.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

// The observer that the staircase assumes. docs/exercises.md, "Feel and find", has what happens for others.
constexpr double kLapses = 0.05;  ///< share of answers that are guesses

// Prior of ln theta: constant for Weber fractions of 5 to 80 %, beyond them the sides of
// a normal distribution.
constexpr double kPriorLow = 0.05;
constexpr double kPriorHigh = 0.8;
constexpr double kPriorSide = 0.6;  ///< standard deviation of the sides [ln]

// Grid of ln theta.
constexpr int kCells = 120;
constexpr double kLeastTheta = 0.01;
constexpr double kMostTheta = 2.5;

/// Next difference over the estimated theta: near the most informative one (1.3), and less sensitive to
/// a wrong slope.
constexpr double kPlacement = 1.15;
/// Of the posterior beside the interval: calibrated with 100,000 simulated observers, of whom the interval
/// then covers 95 %.
constexpr double kTail = 0.028;
constexpr double kLeastRoom = 0.7;       ///< largest difference that the stable zone must allow [ln]
constexpr double kLeastEnd = 0.8e-3;     ///< of an end position [m]
constexpr double kLeastWeber = 0.02;     ///< of what is reported
constexpr double kMostWeber = 2.0;       ///< of what is reported
constexpr double kFewestCounted = 0.75;  ///< share of the wanted trials
constexpr double kGuessing = 0.05;       ///< significance of the test against guesses
constexpr std::uint8_t kSecondSofter = 1;
constexpr std::uint8_t kSecondDeeper = 2;
constexpr int kConditions = 4;

double log_theta(int cell) noexcept {
  const double low = std::log(kLeastTheta);
  return low + (std::log(kMostTheta) - low) * (cell + 0.5) / kCells;
}

/// Returns the Weber fraction of a value of ln theta.
double weber_of(double log_theta) noexcept { return std::expm1(std::exp(log_theta)); }

std::vector<double> prior() {
  const double low = std::log(std::log1p(kPriorLow));
  const double high = std::log(std::log1p(kPriorHigh));
  std::vector<double> out;
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double x = log_theta(i);
    const double beyond = std::max({0.0, low - x, x - high}) / kPriorSide;
    out.push_back(std::exp(-0.5 * beyond * beyond));
    sum += out.back();
  }
  for (double& each : out) each /= sum;
  return out;
}

/// Returns the value of ln theta below which the posterior has the probability `share`.
double quantile(const std::vector<double>& posterior, double share) noexcept {
  const double width = (std::log(kMostTheta) - std::log(kLeastTheta)) / kCells;
  double below = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double here = posterior[idx(i)];
    if (below + here >= share && here > 0.0) {
      return log_theta(i) + width * ((share - below) / here - 0.5);
    }
    below += here;
  }
  return std::log(kMostTheta);
}

double deep_end(const DiscriminationSettings& settings) noexcept {
  return std::min(settings.deep, settings.largest_force / settings.stiffest);
}

/// Returns the largest difference that fits into the stable zone wherever the pair's mean lies [ln].
double largest_difference(const DiscriminationSettings& settings) noexcept {
  return std::log(settings.stiffest / settings.softest) - 2.0 * settings.rove;
}

void check_setting(const char* name, double value, const NumberRange& range, const char* unit) {
  if (range.contains(value)) return;
  throw std::invalid_argument(
      fmt::format("stiffness discrimination: {} = {} {}; give a number {}", name, value, unit, range.text()));
}

void check_settings(const DiscriminationSettings& settings) {
  check_setting("trials", settings.trials, between(10, 40), "");
  check_setting("presentations", settings.presentations, between(settings.trials, 200), "");
  check_setting("softest", settings.softest, between(20, 1e4), "N/m");
  check_setting("stiffest", settings.stiffest, between(settings.softest, 1e5), "N/m");
  check_setting("rove", settings.rove, between(0, 0.5), "");
  check_setting("largest_force", settings.largest_force, above(0, 15), "N");
  check_setting("deep", settings.deep, between(kLeastEnd, 0.02), "m");
  check_setting("shallow_ratio", settings.shallow_ratio, between(0.5, 1), "");
  check_setting("tolerance", settings.tolerance, between(0.01, 0.1), "");
  if (largest_difference(settings) < kLeastRoom) {
    throw std::invalid_argument(fmt::format(
        "stiffness discrimination: {} to {} N/m is too narrow for pairs of different stiffness; raise the "
        "stiffest to {:.0f} N/m if device and stabiliser are stable there, or lower the softest",
        settings.softest, settings.stiffest,
        std::ceil(settings.softest * std::exp(kLeastRoom + 2.0 * settings.rove))));
  }
  const double shallow = deep_end(settings) * settings.shallow_ratio;
  if (shallow < kLeastEnd) {
    throw std::invalid_argument(fmt::format(
        "stiffness discrimination: an end position of {:.2f} mm is too shallow; raise the largest "
        "force ({} N), or lower the stiffest ({} N/m)",
        1e3 * shallow, settings.largest_force, settings.stiffest));
  }
}

/// Returns the probability that the first sponge is called softer. difference = ln(second / first).
double probability_of_first(double difference, double theta) noexcept {
  return 0.5 * kLapses + (1.0 - kLapses) * normal_probability(difference / theta);
}

}  // namespace

StiffnessDiscrimination::StiffnessDiscrimination(const DiscriminationSettings& settings, std::uint64_t seed)
    : settings_(settings), random_(seed), posterior_(prior()) {
  check_settings(settings);
  for (int i = 0; i < settings.trials; ++i) {
    conditions_.push_back(static_cast<std::uint8_t>(i % kConditions));
  }
  for (std::size_t i = conditions_.size() - 1; i > 0; --i) {  // Fisher & Yates
    const auto j = static_cast<std::size_t>(random_.uniform() * static_cast<double>(i + 1));
    std::swap(conditions_[i], conditions_[j]);
  }
  choose();
}

std::optional<StiffnessPair> StiffnessDiscrimination::pair() const { return pair_; }

double StiffnessDiscrimination::wanted_difference() const {
  double mean = 0.0;
  for (int i = 0; i < kCells; ++i) mean += posterior_[idx(i)] * log_theta(i);
  return std::min(kPlacement * std::exp(mean), largest_difference(settings_));
}

void StiffnessDiscrimination::choose() {
  pair_.reset();
  if (conditions_.empty() || presented_ >= settings_.presentations) return;
  const std::uint8_t condition = conditions_.back();
  const double half = 0.5 * wanted_difference();
  const double middle = std::sqrt(settings_.softest * settings_.stiffest) *
                        std::exp(random_.between(-settings_.rove, settings_.rove));
  const double soft = std::max(middle * std::exp(-half), settings_.softest);
  const double stiff = std::min(middle * std::exp(half), settings_.stiffest);
  const double deep = deep_end(settings_);
  const double shallow = deep * settings_.shallow_ratio;
  const bool second_softer = (condition & kSecondSofter) != 0;
  const bool second_deeper = (condition & kSecondDeeper) != 0;
  StiffnessPair next;
  next.number = ++presented_;
  next.stiffness = second_softer ? std::array{stiff, soft} : std::array{soft, stiff};
  next.end_position = second_deeper ? std::array{shallow, deep} : std::array{deep, shallow};
  if (const std::string reason = refused_pair(next, settings_); !reason.empty()) {
    throw std::logic_error(reason);
  }
  pair_ = next;
}

PairVerdict StiffnessDiscrimination::answer(int softer, const std::array<double, 2>& sent,
                                            PairVerdict presses) {
  if (!pair_) throw std::logic_error("stiffness discrimination: an answer after the end");
  if (softer != 0 && softer != 1) {
    throw std::invalid_argument(fmt::format(
        "stiffness discrimination: answer {}; give 0 for the first sponge or 1 for the second", softer));
  }
  DiscriminationTrial trial{.pair = *pair_, .sent = sent, .answer = softer, .verdict = presses};
  for (std::size_t i = 0; i < 2 && presses == PairVerdict::kCounted; ++i) {
    if (!std::isfinite(sent[i]) || sent[i] <= 0.0) {
      trial.verdict = PairVerdict::kSentNotKnown;
    } else if (trial.verdict == PairVerdict::kCounted &&
               std::abs(sent[i] - pair_->stiffness[i]) > settings_.tolerance * pair_->stiffness[i]) {
      trial.verdict = PairVerdict::kSentDiffers;
    }
  }
  const std::uint8_t condition = conditions_.back();
  conditions_.pop_back();
  if (trial.verdict == PairVerdict::kCounted) {
    ++counted_;
    const double difference = std::log(sent[1] / sent[0]);
    trial.right = softer == 0 ? difference > 0.0 : difference < 0.0;
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
      const double first = probability_of_first(difference, std::exp(log_theta(i)));
      posterior_[idx(i)] *= softer == 0 ? first : 1.0 - first;
      sum += posterior_[idx(i)];
    }
    for (double& each : posterior_) each /= sum;
  } else {
    conditions_.insert(conditions_.begin(),
                       condition);  // it comes again as the last one, so that the balance stays
  }
  trials_.push_back(trial);
  choose();
  return trial.verdict;
}

void StiffnessDiscrimination::skip(const std::array<double, 2>& sent) {
  if (pair_) (void)answer(0, sent, PairVerdict::kNotAnswered);
}

bool StiffnessDiscrimination::finished() const noexcept { return !pair_; }

StiffnessThreshold StiffnessDiscrimination::threshold() const {
  StiffnessThreshold out;
  out.trials = counted_;
  for (const DiscriminationTrial& trial : trials_) {
    if (trial.verdict != PairVerdict::kCounted) {
      ++out.discarded;
      continue;
    }
    if (trial.right) ++out.right;
    if (trial.answer == 0) ++out.called_first;
  }
  double power = 0.0;
  for (int i = 0; i < kCells; ++i) power += posterior_[idx(i)] / std::sqrt(weber_of(log_theta(i)));
  out.weber = 1.0 / (power * power);
  out.low = weber_of(quantile(posterior_, kTail));
  out.high = weber_of(quantile(posterior_, 1.0 - kTail));

  if (!finished()) {
    out.invalid = reason_text<Reason::kNotFinished>(counted_, settings_.trials);
  } else if (counted_ < kFewestCounted * settings_.trials) {
    out.invalid = reason_text<Reason::kTooFewPairs>(counted_, settings_.trials, out.discarded);
  } else if (binomial_at_least(counted_ - out.right, counted_, 0.5) < kGuessing) {
    out.invalid = reason_text<Reason::kMoreWrongThanGuessed>(counted_ - out.right, counted_);
  } else if (binomial_at_least(out.right, counted_, 0.5) >= kGuessing || out.weber > kMostWeber) {
    out.invalid = reason_text<Reason::kNoThresholdShown>(
        out.right, counted_, 100.0 * std::min(kMostWeber, std::expm1(largest_difference(settings_))));
  } else if (out.weber < kLeastWeber) {
    out.invalid = reason_text<Reason::kThresholdTooSmall>(out.right, counted_, 100.0 * kLeastWeber);
  }
  return out;
}

std::string refused_pair(const StiffnessPair& pair, const DiscriminationSettings& settings) {
  for (const double stiffness : pair.stiffness) {
    if (!(stiffness <= settings.stiffest)) {
      return fmt::format(
          "pair {}: {:.0f} N/m is beyond the largest stable stiffness of {:.0f} N/m; choose a smaller one",
          pair.number, stiffness, settings.stiffest);
    }
    if (!(stiffness >= settings.softest)) {
      return fmt::format(
          "pair {}: {:.0f} N/m is below the softest stiffness of {:.0f} N/m; choose a larger one",
          pair.number, stiffness, settings.softest);
    }
  }
  return {};
}

std::vector<Score> threshold_scores(const StiffnessThreshold& threshold) {
  const auto score = [&](const char* name, const char* unit, double value) {
    return Score{.name = name,
                 .unit = unit,
                 .value = threshold.invalid.empty() ? value : 0.0,
                 .origin = ScoreOrigin::kRendered,
                 .invalid = threshold.invalid};
  };
  return {score("stiffness_threshold_percent", "%", 100.0 * threshold.weber),
          score("stiffness_threshold_low_percent", "%", 100.0 * threshold.low),
          score("stiffness_threshold_high_percent", "%", 100.0 * threshold.high),
          score("stiffness_right_percent", "%",
                threshold.trials > 0 ? 100.0 * threshold.right / threshold.trials : 0.0)};
}

}  // namespace phalanx
