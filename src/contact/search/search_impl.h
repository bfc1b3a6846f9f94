// SPDX-License-Identifier: Apache-2.0
// Table of the search functions of one instruction set. See docs/contact.md.
#pragma once

#include "contact/search/moving_pairs.h"
#include "contact/search/near_pairs.h"
#include "contact/search/search_functions.h"
#include "contact/search/triangle_pair.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// Implements SearchFunctions::closest.
inline void closest(const double (*a)[3], const double (*b)[3], PairDistance& out) noexcept {
  Triangles ta;
  Triangles tb;
  for (int c = 0; c < 3; ++c) {
    ta.corner[c] = {all(a[c][0]), all(a[c][1]), all(a[c][2])};
    tb.corner[c] = {all(b[c][0]), all(b[c][1]), all(b[c][2])};
  }
  const Closest found = closest_points(ta, tb);
  out = {{0, 0},
         found.squared[0],
         {found.on_a.x[0], found.on_a.y[0], found.on_a.z[0]},
         {found.on_b.x[0], found.on_b.y[0], found.on_b.z[0]}};
}

inline constexpr SearchFunctions kFunctions{&visit,   &crosses, &lower_bound, &gather, &advance,
                                            &closest, &list,    &measure,     &sift};

}  // namespace phalanx::search::PHALANX_SEARCH_SET
