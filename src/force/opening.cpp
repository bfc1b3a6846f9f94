// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/opening.h"

#include <algorithm>

namespace phalanx {

void OpeningState::advance(bool inside, std::optional<double> way, double sent, double period) noexcept {
  if (!inside) {
    *this = {};
    return;
  }
  if (now_.phase == OpeningPhase::kNone) now_.phase = OpeningPhase::kUnconfirmed;
  now_.way = way.value_or(now_.way);
  if (now_.phase != OpeningPhase::kConfirmed) return;
  if (!(now_.way <= confirmed_ + kSameWay)) return withdraw();
  if (now_.way < shortest_ - std::min(kLeastProgress, 0.5 * confirmed_)) {
    shortest_ = now_.way;
    waited_ = 0.0;
  } else {
    waited_ += period;
  }
  if (waited_ < kPatience) {
    now_.force = std::min(kMostForce, std::min(now_.force, sent) + kForceRate * period);
  } else {
    now_.phase = OpeningPhase::kNotFollowed;
    now_.force = 0.0;
  }
}

bool OpeningState::confirm() noexcept {
  if (now_.phase != OpeningPhase::kUnconfirmed && now_.phase != OpeningPhase::kNotFollowed) return false;
  if (!(now_.way > 0.0)) return false;
  now_.phase = OpeningPhase::kConfirmed;
  now_.force = 0.0;
  confirmed_ = shortest_ = now_.way;
  waited_ = 0.0;
  return true;
}

void OpeningState::withdraw() noexcept {
  if (now_.phase != OpeningPhase::kConfirmed) return;
  now_.phase = OpeningPhase::kUnconfirmed;
  now_.force = 0.0;
}

}  // namespace phalanx
