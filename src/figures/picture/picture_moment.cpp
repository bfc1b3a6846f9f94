// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture_moment.h"

#include <algorithm>

#include "phalanx/record/summary.h"

namespace phalanx {

void PictureMoment::see(const Snapshot& snapshot) {
  const double force = total_force(snapshot);
  const bool wanted = at_ ? tick_ == *at_ : force > peak_ || (peak_ == 0.0 && tick_ == middle_);
  if (wanted) shown_ = snapshot;
  peak_ = std::max(peak_, force);
  ++tick_;
}

}  // namespace phalanx
