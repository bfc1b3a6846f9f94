// SPDX-License-Identifier: Apache-2.0
// The limits that one connection or all of them together must keep: slots, pending connections, the rate of
// messages, the outgoing queue, and the time for a transfer. None of them reads a socket.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/serve/web_server.h"

namespace phalanx::web {

/// One of a limited number of slots. The constructor takes it, the destructor returns it.
class CountedSlot {
 public:
  /// @param used  number of slots in use; outlives the slot
  explicit CountedSlot(std::size_t& used) noexcept : used_(&used) { ++used; }
  CountedSlot(CountedSlot&& other) noexcept : used_(std::exchange(other.used_, nullptr)) {}
  CountedSlot(const CountedSlot&) = delete;
  CountedSlot& operator=(const CountedSlot&) = delete;
  CountedSlot& operator=(CountedSlot&&) = delete;
  ~CountedSlot() {
    if (used_ != nullptr) --*used_;
  }

 private:
  std::size_t* used_;
};

/// Limit on pending connections: those that have not sent an accepted request yet. A new connection is always
/// admitted. At the limit it evicts the oldest pending one, so that idle connections cannot lock others out.
class ConnectionLimiter {
  struct Entry {
    std::string address;
    std::function<void()> evict;
  };
  using Entries = std::list<Entry>;

 public:
  /// The slot of one pending connection. The destructor returns it.
  class Slot {
   public:
    Slot(Slot&& other) noexcept : limiter_(std::exchange(other.limiter_, nullptr)), entry_(other.entry_) {}
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
      if (limiter_ != nullptr) limiter_->entries_.erase(entry_);
    }

   private:
    friend class ConnectionLimiter;
    Slot(ConnectionLimiter& limiter, Entries::iterator entry) : limiter_(&limiter), entry_(entry) {}
    ConnectionLimiter* limiter_;
    Entries::iterator entry_;
  };

  /// @param all          pending connections at once, >= 1
  /// @param per_address  the same of one remote address, >= 1
  ConnectionLimiter(std::size_t all, std::size_t per_address) : all_(all), per_address_(per_address) {}

  /// Admits a connection. Evicts the oldest of its address if that address is at its limit, else the oldest
  /// of all if the server is at its limit.
  /// @param from   remote address; the addresses of one IPv6 network (/64) count as one
  /// @param evict_connection  destroys the slot before it returns; may be called until the slot is destroyed
  [[nodiscard]] Slot admit(const std::string& from, std::function<void()> evict_connection);
  /// @returns the number of pending connections
  [[nodiscard]] std::size_t pending() const noexcept { return entries_.size(); }

 private:
  static void evict(const Entry& entry);

  Entries entries_;  ///< oldest first
  std::size_t all_;
  std::size_t per_address_;
};

/// Rate limit: at most a fixed number of messages in any interval of one second.
class MessageRateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// @param per_second  >= 1
  explicit MessageRateLimit(std::size_t per_second) : last_(per_second, Time::min()) {}

  /// Counts a message. @returns true if it keeps the limit
  [[nodiscard]] bool allow(Time now) noexcept {
    // The oldest entry of the ring is the message that came `per_second` messages ago.
    Time& oldest = last_[next_];
    const bool allowed = oldest == Time::min() || now - oldest >= std::chrono::seconds(1);
    oldest = now;
    next_ = (next_ + 1) % last_.size();
    return allowed;
  }

 private:
  std::vector<Time> last_;
  std::size_t next_ = 0;
};

/// Bounded queue of the messages for one page: ordered messages, and after them at most one newest message of
/// each kind, which a newer one of its kind replaces. The kinds take turns.
class OutgoingQueue {
 public:
  /// @param messages  ordered messages that may wait
  /// @param bytes     their bytes; a message that waits alone may be longer
  OutgoingQueue(std::size_t messages, std::size_t bytes) : messages_(messages), bytes_(bytes) {}

  /// Appends an ordered message. @returns false if the queue is full; it is unchanged then
  [[nodiscard]] bool push(Bytes message);
  /// Sets the newest message of a kind, below WebServer::kNewestKinds. @returns true if it replaced one
  bool set_newest(Bytes message, std::size_t kind = 0) {
    return std::exchange(newest_.at(kind), std::move(message)) != nullptr;
  }
  /// Removes the next message to write. @returns it; null if the queue is empty
  [[nodiscard]] Bytes pop();
  void clear();

 private:
  std::deque<Bytes> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::array<Bytes, WebServer::kNewestKinds> newest_;
  std::size_t turn_ = 0;  ///< kind that is looked at first
  std::size_t messages_;
  std::size_t bytes_;
};

/// @returns how long the transfer of a body may take [s]: a peer below 16 kB/s counts as stuck
[[nodiscard]] inline double transfer_timeout(double idle_timeout, std::size_t bytes) noexcept {
  constexpr double kSlowest = 16e3;  // [bytes/s]
  return idle_timeout + static_cast<double>(bytes) / kSlowest;
}

}  // namespace phalanx::web
