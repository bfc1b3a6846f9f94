// SPDX-License-Identifier: Apache-2.0
// Assessment "which object is in the hand, unseen": order of presentation, confusion matrix and its scores.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/exercise/score.h"

namespace phalanx {

/// A proportion with its exact interval by Clopper & Pearson (1934).
struct Proportion {
  double value = 0.0;
  double low = 0.0;
  double high = 1.0;
};

/// Returns successes / trials and the exact two-sided interval of the given confidence: `low` solves
/// P(X >= successes | low) = (1 - confidence) / 2, `high` solves P(X <= successes | high) =
/// (1 - confidence) / 2, with binomial X. It covers at least `confidence`. Not real-time.
/// @throws std::invalid_argument if trials < 1, successes is not in 0 .. trials, or confidence is not
/// in (0, 1)
[[nodiscard]] Proportion exact_proportion(int successes, int trials, double confidence = 0.95);

/// Result of an identification.
struct IdentificationResult {
  int trials = 0;           ///< that counted
  int discarded = 0;        ///< presented, not counted
  Proportion right;         ///< with its 95 % interval
  double chance = 0.0;      ///< proportion by guessing: 1 / objects
  double bits = 0.0;        ///< information transmitted, corrected for its bias, >= 0 [bit]
  double plain_bits = 0.0;  ///< without the correction [bit]
  double most_bits = 0.0;   ///< of answers that are all right: the entropy of the presented objects [bit]
  std::vector<int> confusion = {};  ///< [presented * objects + answered]
  std::string invalid = {};         ///< why there is no result, for people. Empty: it holds
};

/// Returns the information transmitted by a confusion matrix of n x n counts [bit]:
///   sum p(s,r) log2 p(s,r) / (p(s) p(r))                                        Miller & Nicely 1955
/// @throws std::invalid_argument if the size is not n * n, n < 1, or a count is negative
[[nodiscard]] double transmitted_bits(const std::vector<int>& confusion, int n);
/// Returns the bias that transmitted_bits() has on average: (r - 1) (c - 1) / (2 N ln 2), with r presented
/// objects, c different answers and N trials [bit].            Miller 1955
[[nodiscard]] double transmitted_bits_bias(const std::vector<int>& confusion, int n);

/// Run of an identification. Each object comes equally often, in a drawn order. The participant must not see
/// hand or object, and is not told whether an answer was right. The same arguments and answers give the same
/// run. Not real-time.
class Identification {
 public:
  /// @param objects  2 .. 12
  /// @param rounds   how often each object comes, 1 .. 50
  /// @throws std::invalid_argument naming the argument, its value and the range
  Identification(int objects, int rounds, std::uint64_t seed);

  /// @returns the object to present now; none when it is finished
  [[nodiscard]] std::optional<int> object() const;
  /// Takes the answer to object(). @throws std::invalid_argument for an answer that is no object;
  /// std::logic_error after the end
  void answer(int object);
  /// Discards the present trial, for example after a fault: the object comes once more at the end, up to
  /// `rounds` times in all.
  void discard();
  [[nodiscard]] bool finished() const noexcept { return next_ >= order_.size(); }
  [[nodiscard]] int objects() const noexcept { return objects_; }
  /// Returns the result up to now. It is invalid before the end, or if more than a fifth of the
  /// trials are missing.
  [[nodiscard]] IdentificationResult result() const;

 private:
  int objects_ = 0;
  int rounds_ = 0;
  std::vector<int> order_;
  std::vector<int> confusion_;
  std::vector<int> repeated_;  ///< how often each object was put at the end
  std::size_t next_ = 0;
  int discarded_ = 0;
};

/// Returns the result as scores: identified_percent with its interval's ends, transmitted_bit,
/// transmitted_plain_bit. Their origin is "rendered".
[[nodiscard]] std::vector<Score> identification_scores(const IdentificationResult& result);

}  // namespace phalanx
