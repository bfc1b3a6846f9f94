// SPDX-License-Identifier: Apache-2.0
#include "serve/web/doorstep.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace phalanx::web {

Doorstep::Stay Doorstep::come(const std::string& address, std::function<void()> send_away) {
  const auto is_same = [&](const Guest& guest) { return guest.address == address; };
  const auto same = static_cast<std::size_t>(std::count_if(guests_.begin(), guests_.end(), is_same));
  if (same >= per_address_) {
    turn_out(*std::find_if(guests_.begin(), guests_.end(), is_same));
  } else if (guests_.size() >= all_) {
    turn_out(guests_.front());
  }
  guests_.push_back({.address = address, .send_away = std::move(send_away)});
  return Stay(*this, std::prev(guests_.end()));
}

void Doorstep::turn_out(const Guest& guest) {
  const auto go = guest.send_away;  // what it does ends what it stands in
  go();
}

}  // namespace phalanx::web
