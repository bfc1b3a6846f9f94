// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <string>
#include <utility>

namespace phalanx::web {

/// Connections that have not yet asked for anything rightly. There are few places, and a new one takes that
/// of the oldest: whoever only connects cannot keep out who has something to say.
class Doorstep {
  struct Guest {
    std::string address;
    std::function<void()> send_away;
  };
  using Guests = std::list<Guest>;

 public:
  /// A place, given back when it goes.
  class Stay {
   public:
    Stay(Stay&& other) noexcept : doorstep_(std::exchange(other.doorstep_, nullptr)), guest_(other.guest_) {}
    Stay(const Stay&) = delete;
    Stay& operator=(const Stay&) = delete;
    Stay& operator=(Stay&&) = delete;
    ~Stay() {
      if (doorstep_ != nullptr) doorstep_->guests_.erase(guest_);
    }

   private:
    friend class Doorstep;
    Stay(Doorstep& doorstep, Guests::iterator guest) : doorstep_(&doorstep), guest_(guest) {}
    Doorstep* doorstep_;
    Guests::iterator guest_;
  };

  /// @param all, per_address  >= 1
  Doorstep(std::size_t all, std::size_t per_address) : all_(all), per_address_(per_address) {}

  /// Sends the oldest of that address away if it has all its places, or the oldest of all if there is none
  /// left.
  /// @param from       address of the other end; those of one IPv6 network (/64) count as one
  /// @param send_away  gives the place back, at once; may be called until the place is given back
  [[nodiscard]] Stay come(const std::string& from, std::function<void()> send_away);
  [[nodiscard]] std::size_t waiting() const noexcept { return guests_.size(); }

 private:
  static void turn_out(const Guest& guest);

  Guests guests_;  ///< oldest first
  std::size_t all_;
  std::size_t per_address_;
};

}  // namespace phalanx::web
