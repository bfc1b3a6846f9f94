// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture_moment.h"

#include <algorithm>

#include "phalanx/record/summary.h"

namespace phalanx {

void PictureMoment::see(const Snapshot& snapshot) {
  const double force = total_force(snapshot);
  const bool wanted = at_ ? tick_ == *at_ : force > peak_ || (peak_ == 0.0 && tick_ == middle_);
  if (hand_ && (wanted || tick_ == 0 || snapshot.time_s - followed_ >= kFrame)) {
    hand_->follow(snapshot.gdp_angle, tick_ == 0 ? 0.0 : snapshot.time_s - followed_);
    followed_ = snapshot.time_s;
  }
  if (wanted) {
    shown_ = snapshot;
    if (hand_) hand_->draw(shown_);
  }
  peak_ = std::max(peak_, force);
  ++tick_;
}

}  // namespace phalanx
