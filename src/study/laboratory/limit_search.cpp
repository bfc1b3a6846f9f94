// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/limit_search.h"

#include <algorithm>
#include <bit>
#include <map>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

constexpr int kFurther = 2;  // points on each side that are checked beyond those of the bisection

/// Verdicts that were asked for, each once.
class Answers {
 public:
  Answers(int size, const std::function<bool(int)>& stable) : size_(size), stable_(stable) {}

  bool operator()(int index) {
    const auto known = answers_.find(index);
    if (known != answers_.end()) return known->second;
    return answers_.emplace(index, stable_(index)).first->second;
  }
  void try_if_on_grid(int index) {
    if (index >= 0 && index < size_) (*this)(index);
  }
  /// @returns the first unstable point that was tried; size if there is none.
  [[nodiscard]] int first_unstable() const {
    const auto it =
        std::find_if(answers_.begin(), answers_.end(), [](const auto& answer) { return !answer.second; });
    return it == answers_.end() ? size_ : it->first;
  }
  /// @returns the last point that was tried below `index`; -1 if there is none.
  [[nodiscard]] int last_tried_below(int index) const {
    const auto it = answers_.lower_bound(index);
    return it == answers_.begin() ? -1 : std::prev(it)->first;
  }
  [[nodiscard]] const std::map<int, bool>& all() const noexcept { return answers_; }

 private:
  int size_;
  const std::function<bool(int)>& stable_;
  std::map<int, bool> answers_;
};

/// Bisects until the point just below the first unstable one has been tried.
void bisect(Answers& answers) {
  for (;;) {
    const int unstable = answers.first_unstable();
    const int below = answers.last_tried_below(unstable);
    if (unstable - below <= 1) return;
    answers(below + (unstable - below) / 2);
  }
}

/// Checks the points below the boundary, which moves down if one of them is unstable.
void check_below(Answers& answers) {
  for (int unstable = -1; unstable != answers.first_unstable();) {
    unstable = answers.first_unstable();
    for (int i = 1; i <= 1 + kFurther && answers.first_unstable() == unstable; ++i)
      answers.try_if_on_grid(unstable - i);
  }
}

LimitSearch conclusion(const Answers& answers, int size) {
  LimitSearch search;
  const int unstable = answers.first_unstable();
  search.limit = unstable - 1;
  search.at_least = unstable == size;
  for (const auto& [index, stable] : answers.all()) {
    search.checked.push_back({index, stable});
    if (stable && index > unstable) search.non_monotone = true;
  }
  return search;
}

/// Verdicts on pairs of grid point and seed that were asked for, each once.
class SeedAnswers {
 public:
  explicit SeedAnswers(const std::function<bool(int, int)>& stable) : stable_(stable) {}

  bool operator()(int index, int seed) {
    const auto known = answers_.find({seed, index});
    if (known != answers_.end()) return known->second;
    return answers_.emplace(std::pair(seed, index), stable_(index, seed)).first->second;
  }

  /// @returns the first point that is unstable with the seed, between `unstable`, which is known to be, and a
  /// stable one below it, which is sought in steps of 1, 2, 4 .. points.
  int first_unstable_below(int unstable, int seed) {
    int stable = unstable - 1;
    for (int step = 1; stable >= 0 && !(*this)(stable, seed); step *= 2) {
      unstable = stable;
      stable -= step;
    }
    return bisected(std::max(stable, -1), unstable, seed);
  }

  /// @returns the first unstable point above `stable`, by bisection up to `unstable`.
  int bisected(int stable, int unstable, int seed) {
    while (unstable - stable > 1) {
      const int middle = stable + (unstable - stable) / 2;
      ((*this)(middle, seed) ? stable : unstable) = middle;
    }
    return unstable;
  }

  /// @returns true if a seed was unstable at a point and stable at a higher one.
  [[nodiscard]] bool non_monotone() const {
    const auto reverses = [](const auto& lower, const auto& higher) {
      return lower.first.first == higher.first.first && !lower.second && higher.second;
    };
    return std::adjacent_find(answers_.begin(), answers_.end(), reverses) != answers_.end();
  }

 private:
  const std::function<bool(int, int)>& stable_;
  std::map<std::pair<int, int>, bool> answers_;  ///< by seed, then index
};

}  // namespace

LimitSearch search_limit(int size, const std::function<bool(int)>& stable, int coarse) {
  if (size <= 0) throw std::invalid_argument("search_limit: the grid is empty; give it at least one point");
  if (coarse <= 0) throw std::invalid_argument("search_limit: coarse must be positive");
  Answers answers(size, stable);
  for (int i = 0; i < size; i += coarse) answers(i);
  answers(size - 1);
  bisect(answers);
  check_below(answers);
  for (int i = 1; i <= kFurther; ++i) answers.try_if_on_grid(answers.first_unstable() + i);
  return conclusion(answers, size);
}

TracedLimit trace_limit(int size, int seeds, const std::function<bool(int index, int seed)>& stable,
                        int coarse) {
  if (size <= 0) throw std::invalid_argument("trace_limit: the grid is empty; give it at least one point");
  if (seeds <= 0) throw std::invalid_argument("trace_limit: there is no seed; give it at least one");
  if (coarse <= 0) throw std::invalid_argument("trace_limit: coarse must be positive");
  SeedAnswers answers(stable);
  int unstable = answers.bisected(-1, size, 0);
  for (int before = -1; unstable != before && unstable > 0;) {
    before = unstable;
    for (int seed = 0; seed < seeds && unstable > 0; ++seed)
      if (!answers(unstable - 1, seed)) unstable = answers.first_unstable_below(unstable - 1, seed);
    for (int index = 0; index < unstable - 1 && unstable == before; index += coarse) {
      const int seed = index / coarse % seeds;
      if (!answers(index, seed)) unstable = answers.first_unstable_below(index, seed);
    }
  }
  return {.limit = unstable - 1, .at_least = unstable == size, .non_monotone = answers.non_monotone()};
}

int most_checked_if_monotone(int size, int coarse) {
  int most = 0;
  for (int limit = -1; limit < size; ++limit) {
    // In the middle of a long grid, limits that are a multiple of `coarse` apart need equally many points.
    if (limit > 4 * coarse && limit < size - 4 * coarse) continue;
    const auto search = search_limit(size, [&](int index) { return index <= limit; }, coarse);
    most = std::max(most, static_cast<int>(search.checked.size()));
  }
  return most;
}

int most_traced_if_monotone(int size, int seeds, int coarse) {
  const auto halvings = static_cast<int>(std::bit_width(static_cast<unsigned>(size)));
  const int lowering = 2 * halvings;  // downwards, then bisected
  const long long most = halvings + (seeds - 1LL) * (1 + lowering) + seeds + (size + coarse - 1) / coarse;
  return static_cast<int>(std::min(most, static_cast<long long>(size) * seeds));
}

}  // namespace phalanx
