// SPDX-License-Identifier: Apache-2.0
#include "serve/web/limits.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "serve/web/boost.h"

namespace phalanx::web {
namespace {

/// @returns the address; of an IPv6 address its /64 network, within which one computer has any
/// number of addresses
std::string network_of(const std::string& address) {
  constexpr std::size_t kNetwork = 8;  // [bytes]
  error_code error;
  const auto v6 = net::ip::make_address_v6(address, error);
  if (error || v6.is_v4_mapped() || v6.is_loopback()) return address;
  net::ip::address_v6::bytes_type bytes = v6.to_bytes();
  std::fill(bytes.begin() + kNetwork, bytes.end(), std::uint8_t{0});
  return net::ip::make_address_v6(bytes).to_string();
}

}  // namespace

ConnectionLimiter::Slot ConnectionLimiter::admit(const std::string& from,
                                                 std::function<void()> evict_connection) {
  const std::string address = network_of(from);
  const auto is_same = [&](const Entry& entry) { return entry.address == address; };
  const auto same = static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), is_same));
  if (same >= per_address_) {
    evict(*std::find_if(entries_.begin(), entries_.end(), is_same));
  } else if (entries_.size() >= all_) {
    evict(entries_.front());
  }
  entries_.push_back({.address = address, .evict = std::move(evict_connection)});
  return Slot(*this, std::prev(entries_.end()));
}

void ConnectionLimiter::evict(const Entry& entry) {
  const auto call = entry.evict;  // a copy: the call destroys the entry
  call();
}

bool OutgoingQueue::push(Bytes message) {
  const bool full = waiting_.size() >= messages_ || waiting_bytes_ + message->size() > bytes_;
  if (full && !waiting_.empty()) return false;
  waiting_bytes_ += message->size();
  waiting_.push_back(std::move(message));
  return true;
}

Bytes OutgoingQueue::pop() {
  if (waiting_.empty()) {
    for (std::size_t i = 0; i < newest_.size(); ++i) {
      const std::size_t kind = (turn_ + i) % newest_.size();
      if (!newest_[kind]) continue;
      turn_ = kind + 1;
      return std::exchange(newest_[kind], nullptr);
    }
    return nullptr;
  }
  Bytes first = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= first->size();
  return first;
}

void OutgoingQueue::clear() {
  waiting_.clear();
  waiting_bytes_ = 0;
  newest_.fill(nullptr);
}

}  // namespace phalanx::web
