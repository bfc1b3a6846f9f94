// SPDX-License-Identifier: Apache-2.0
// Solver of a small box-constrained quadratic program, without allocation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "phalanx/core/math.h"

namespace phalanx {

template <int kMax>
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMax, kMax>;
template <int kMax>
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMax, 1>;

/// Minimises  1/2 x'Hx - c'x  over  least <= x <= largest  by the primal active set method.
///
/// Each variable is free or rests on a bound. One round moves towards the minimum over the free variables. If
/// a bound is in the way, it stops there and puts that variable on the bound. Otherwise it frees the variable
/// whose multiplier has the wrong sign most, or ends. Every minimum is lower than the one before it, so that
/// no set comes twice and the method ends. Rounding could still make it cycle: it therefore ends after 20
/// rounds a variable in any case, inside the box. Ties go to the lower index: equal input gives equal bits.
/// @param H  symmetric, positive definite
/// @param x  on entry inside the box
/// Real-time: no allocation, lock, throw or I/O.
template <int kMax>
void minimise_in_box(const SmallMatrix<kMax>& H, const SmallVector<kMax>& c, const SmallVector<kMax>& least,
                     const SmallVector<kMax>& largest, SmallVector<kMax>& x) noexcept {
  constexpr double kRounding = 1e-13;
  constexpr int kRoundsPerVariable = 20;
  enum class At { kFree, kLeast, kLargest };
  const Eigen::Index n = x.size();
  std::array<At, static_cast<std::size_t>(kMax)> at;
  at.fill(At::kFree);
  const auto place = [&](Eigen::Index i) -> At& { return at[static_cast<std::size_t>(i)]; };

  for (Eigen::Index round = 0; round < kRoundsPerVariable * n; ++round) {
    std::array<Eigen::Index, static_cast<std::size_t>(kMax)> free{};
    Eigen::Index free_count = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if (place(i) == At::kFree) free[static_cast<std::size_t>(free_count++)] = i;
    const auto nth = [&](Eigen::Index k) { return free[static_cast<std::size_t>(k)]; };

    // The minimum over the free variables.
    SmallMatrix<kMax> H_free(free_count, free_count);
    SmallVector<kMax> c_free(free_count);
    for (Eigen::Index a = 0; a < free_count; ++a) {
      c_free[a] = c[nth(a)];
      for (Eigen::Index i = 0; i < n; ++i)
        if (place(i) != At::kFree) c_free[a] -= H(nth(a), i) * x[i];
      for (Eigen::Index b = 0; b < free_count; ++b) H_free(a, b) = H(nth(a), nth(b));
    }
    const SmallVector<kMax> goal = H_free.llt().solve(c_free);

    // As far towards it as the box allows.
    double way = 1.0;
    Eigen::Index stopped = -1;
    for (Eigen::Index a = 0; a < free_count; ++a) {
      const double from = x[nth(a)];
      const double bound = goal[a] < least[nth(a)] ? least[nth(a)] : largest[nth(a)];
      const bool outside = goal[a] < least[nth(a)] || goal[a] > largest[nth(a)];
      if (!outside) continue;
      const double share = (bound - from) / (goal[a] - from);
      if (share < way) {
        way = share;
        stopped = a;
      }
    }
    for (Eigen::Index a = 0; a < free_count; ++a) {
      double& value = x[nth(a)];
      value = std::clamp(value + way * (goal[a] - value), least[nth(a)], largest[nth(a)]);
    }
    if (stopped >= 0) {
      const Eigen::Index i = nth(stopped);
      place(i) = goal[stopped] < least[i] ? At::kLeast : At::kLargest;
      x[i] = place(i) == At::kLeast ? least[i] : largest[i];
      continue;
    }

    // Test for the minimum in the box: the gradient Hx - c must point inwards at a lower bound, and outwards
    // at an upper one.
    double worst = 0.0;
    Eigen::Index freed = -1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (place(i) == At::kFree) continue;
      double gradient = -c[i];
      double size = std::abs(c[i]);
      for (Eigen::Index j = 0; j < n; ++j) {
        gradient += H(i, j) * x[j];
        size += std::abs(H(i, j) * x[j]);
      }
      const double wrong = place(i) == At::kLeast ? -gradient : gradient;
      if (wrong > kRounding * size && wrong > worst && least[i] < largest[i]) {
        worst = wrong;
        freed = i;
      }
    }
    if (freed < 0) return;
    place(freed) = At::kFree;
  }
}

}  // namespace phalanx
