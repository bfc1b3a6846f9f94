// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/limit_search.h"

#include <algorithm>
#include <map>
#include <stdexcept>

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

}  // namespace phalanx
