// SPDX-License-Identifier: Apache-2.0
#include "serve/web/doorstep.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "serve/web/boost.h"

namespace phalanx::web {
namespace {

/// An address of IPv6 is its network's /64, of which one computer has as many as it likes.
std::string whose(const std::string& address) {
  constexpr std::size_t kNetwork = 8;  // [bytes]
  error_code error;
  const auto v6 = net::ip::make_address_v6(address, error);
  if (error || v6.is_v4_mapped() || v6.is_loopback()) return address;
  net::ip::address_v6::bytes_type bytes = v6.to_bytes();
  std::fill(bytes.begin() + kNetwork, bytes.end(), std::uint8_t{0});
  return net::ip::make_address_v6(bytes).to_string();
}

}  // namespace

Doorstep::Stay Doorstep::come(const std::string& from, std::function<void()> send_away) {
  const std::string address = whose(from);
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
