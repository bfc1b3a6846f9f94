// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/identification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "exercise/distributions.h"
#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr int kMostObjects = 12;
constexpr int kMostRounds = 50;

/// Returns the p in 0 .. 1 at which a function that increases from below 0 to above 0 is 0.
template <typename Increasing>
double zero_of(Increasing&& function) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Sums of a confusion matrix.
struct Marginals {
  std::vector<double> presented;
  std::vector<double> answered;
  double trials = 0.0;
};

Marginals marginals_of(const std::vector<int>& confusion, int n) {
  if (n < 1 || confusion.size() != idx(n) * idx(n)) {
    throw std::invalid_argument(fmt::format("confusion matrix: {} counts for {} objects; give {} x {} counts",
                                            confusion.size(), n, n, n));
  }
  Marginals sums{std::vector<double>(idx(n)), std::vector<double>(idx(n)), 0.0};
  for (std::size_t s = 0; s < idx(n); ++s) {
    for (std::size_t r = 0; r < idx(n); ++r) {
      const int count = confusion[s * idx(n) + r];
      if (count < 0) {
        throw std::invalid_argument(fmt::format("confusion matrix: count {} is negative", count));
      }
      sums.presented[s] += count;
      sums.answered[r] += count;
      sums.trials += count;
    }
  }
  return sums;
}

int checked(const char* name, int value, int least, int most) {
  if (value < least || value > most) {
    throw std::invalid_argument(
        fmt::format("identification: {} = {}; give {} to {}", name, value, least, most));
  }
  return value;
}

double positive_terms(const std::vector<double>& counts) {
  return static_cast<double>(
      std::count_if(counts.begin(), counts.end(), [](double count) { return count > 0.0; }));
}

}  // namespace

Proportion exact_proportion(int successes, int trials, double confidence) {
  if (trials < 1 || successes < 0 || successes > trials) {
    throw std::invalid_argument(
        fmt::format("proportion: {} successes of {} trials; give 0 to {} successes of at least 1 trial",
                    successes, trials, std::max(trials, 0)));
  }
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument(
        fmt::format("proportion: confidence {}; give a number between 0 and 1", confidence));
  }
  const double tail = 0.5 * (1.0 - confidence);
  Proportion out;
  out.value = static_cast<double>(successes) / trials;
  out.low = successes == 0
                ? 0.0
                : zero_of([&](double p) { return binomial_at_least(successes, trials, p) - tail; });
  // P(X <= s | p) = P(Y >= trials - s | 1 - p), where Y counts failures: it keeps the small tail exact.
  out.high = successes == trials ? 1.0 : 1.0 - zero_of([&](double q) {
                                           return binomial_at_least(trials - successes, trials, q) - tail;
                                         });
  return out;
}

double transmitted_bits(const std::vector<int>& confusion, int n) {
  const Marginals sums = marginals_of(confusion, n);
  double bits = 0.0;
  for (std::size_t s = 0; s < idx(n); ++s) {
    for (std::size_t r = 0; r < idx(n); ++r) {
      const double count = confusion[s * idx(n) + r];
      if (count == 0.0) continue;
      bits += count / sums.trials * std::log2(count * sums.trials / (sums.presented[s] * sums.answered[r]));
    }
  }
  return std::max(bits, 0.0);
}

double transmitted_bits_bias(const std::vector<int>& confusion, int n) {
  const Marginals sums = marginals_of(confusion, n);
  if (sums.trials == 0.0) return 0.0;
  return (positive_terms(sums.presented) - 1.0) * (positive_terms(sums.answered) - 1.0) /
         (2.0 * sums.trials * std::numbers::ln2);
}

Identification::Identification(int objects, int rounds, std::uint64_t seed)
    : objects_(checked("objects", objects, 2, kMostObjects)),
      rounds_(checked("rounds", rounds, 1, kMostRounds)) {
  Random random(seed);
  for (int i = 0; i < objects_ * rounds_; ++i) order_.push_back(i % objects_);
  for (std::size_t i = order_.size() - 1; i > 0; --i) {  // Fisher & Yates
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1));
    std::swap(order_[i], order_[j]);
  }
  confusion_.resize(idx(objects_) * idx(objects_));
  repeated_.resize(idx(objects_));
}

std::optional<int> Identification::object() const {
  if (finished()) return std::nullopt;
  return order_[next_];
}

void Identification::answer(int object) {
  if (finished()) throw std::logic_error("identification: an answer after the end");
  if (object < 0 || object >= objects_) {
    throw std::invalid_argument(fmt::format("identification: answer {}; give 0 to {}", object, objects_ - 1));
  }
  ++confusion_[idx(order_[next_]) * idx(objects_) + idx(object)];
  ++next_;
}

void Identification::discard() {
  if (finished()) return;
  const int object = order_[next_];
  ++next_;
  ++discarded_;
  if (repeated_[idx(object)] < rounds_) {
    ++repeated_[idx(object)];
    order_.push_back(object);
  }
}

IdentificationResult Identification::result() const {
  IdentificationResult out;
  out.confusion = confusion_;
  out.discarded = discarded_;
  out.chance = 1.0 / objects_;
  const Marginals sums = marginals_of(confusion_, objects_);
  out.trials = static_cast<int>(sums.trials);
  const int wanted = objects_ * rounds_;
  if (!finished()) {
    out.invalid = reason_text<Reason::kNotFinished>(out.trials, wanted);
    return out;
  }
  if (5 * out.trials < 4 * wanted) {
    out.invalid = reason_text<Reason::kTooFewObjects>(out.trials, wanted, discarded_);
    return out;
  }
  int right = 0;
  for (int i = 0; i < objects_; ++i) right += confusion_[idx(i) * idx(objects_) + idx(i)];
  out.right = exact_proportion(right, out.trials);
  out.plain_bits = transmitted_bits(confusion_, objects_);
  out.bits = std::max(0.0, out.plain_bits - transmitted_bits_bias(confusion_, objects_));
  for (const double presented : sums.presented) {
    if (presented > 0.0) out.most_bits -= presented / sums.trials * std::log2(presented / sums.trials);
  }
  return out;
}

std::vector<Score> identification_scores(const IdentificationResult& result) {
  const auto score = [&](const char* name, const char* unit, double value) {
    return Score{.name = name,
                 .unit = unit,
                 .value = result.invalid.empty() ? value : 0.0,
                 .origin = ScoreOrigin::kRendered,
                 .invalid = result.invalid};
  };
  return {score("identified_percent", "%", 100.0 * result.right.value),
          score("identified_low_percent", "%", 100.0 * result.right.low),
          score("identified_high_percent", "%", 100.0 * result.right.high),
          score("transmitted_bit", "bit", result.bits),
          score("transmitted_plain_bit", "bit", result.plain_bits)};
}

}  // namespace phalanx
