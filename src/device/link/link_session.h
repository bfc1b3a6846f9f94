// SPDX-License-Identifier: Apache-2.0
// The host's side of a session: a state machine without a thread or a clock. One thread calls it
// with the time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "device/link/link_shared.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/device/link/sequence_window.h"

namespace phalanx {

/// Host's side of a link session. Real-time except for the constructor.
class LinkSession {
 public:
  enum class Phase {
    kIdle,     ///< no session is wanted
    kAsking,   ///< HELLO is repeated until WELCOME
    kRunning,  ///< a session is open
    kDown,     ///< a connection fault is latched: nothing is sent until reset
  };

  /// Reason for which a controller did not open a session.
  struct Refusal {
    std::uint8_t reason = 0;   ///< enum phx_refusal
    std::uint8_t version = 0;  ///< version that the controller speaks
  };

  LinkSession(Transport& transport, const LinkSettings& settings, std::uint64_t host_id, LinkShared& shared);

  /// Sets the PHX_CONFIGURE that is sent in every session.
  void set_configuration(const phx_message& configure) noexcept { configure_ = configure; }
  /// Asks for a session from now on; an earlier one is forgotten.
  void ask(double now) noexcept;
  /// Handles all frames that the transport has.
  void receive(double now) noexcept;
  /// Sends the frames that are due. Missed ones are not sent later.
  void send_due(double now) noexcept;
  /// @returns the time at which send_due() has to act again [s].
  [[nodiscard]] double next_due(double now) const noexcept;

  /// Sends a command without ENABLE, newer than all before it.
  void send_disabled() noexcept;
  void send_goodbye() noexcept { send(PHX_GOODBYE, epoch_); }
  /// Returns to the state before the first ask().
  void forget() noexcept;

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] const phx_welcome& welcome() const noexcept { return welcome_; }
  [[nodiscard]] const std::optional<Refusal>& refusal() const noexcept { return refusal_; }
  [[nodiscard]] double heard() const noexcept { return heard_; }  ///< when the last sample came [s]

 private:
  void take(const phx_message& message, double now) noexcept;
  void take_welcome(const phx_message& message, double now) noexcept;
  void begin(double now) noexcept;
  void take_refusal(const phx_message& message, double now) noexcept;
  void take_sample(const phx_message& message, double now) noexcept;
  void take_pong(const phx_ping& pong, double now) noexcept;
  void send_hello(double now) noexcept;
  void watch_for_reset(double now) noexcept;
  void send_configure(double now) noexcept;
  void send_reset(double now) noexcept;
  void send_ping(double now) noexcept;
  [[nodiscard]] bool repeats_command(double now) const noexcept;
  void send_command(double now) noexcept;
  [[nodiscard]] bool silent(double now) const noexcept { return now - heard_ > silence_; }
  void fail(Fault fault) noexcept;
  void send(phx_message& message, std::uint32_t epoch) noexcept;
  void send(std::uint8_t type, std::uint32_t epoch) noexcept;

  Transport& transport_;
  LinkShared& shared_;
  std::uint64_t host_id_;
  double hello_timeout_;

  Phase phase_ = Phase::kIdle;
  bool known_ = false;  ///< the first session of this run was granted: welcome_ is valid
  phx_welcome welcome_{};
  phx_message configure_{};
  std::optional<Refusal> refusal_;
  std::uint32_t epoch_ = 0;
  std::array<std::uint32_t, PHX_PONG + 1> sequence_{};  ///< of the host's frames, by type

  SequenceWindow window_;
  std::uint64_t lost_before_ = 0;  ///< lost frames of earlier sessions
  bool configured_ = false;        ///< the newest sample has the flag CONFIGURED
  bool settled_ = false;           ///< a sample of this session had the flag CONFIGURED
  double heard_ = 0.0;
  double silence_ = 0.0;              ///< time without a sample after which a PING is sent [s]
  std::uint64_t sample_time_us_ = 0;  ///< of the newest sample
  std::uint64_t pings_ = 0;           ///< number sent; the stamp of a PING is host_id_ + its number
  std::uint64_t pings_before_sample_ = 0;
  double first_pong_ = -1.0;  ///< time of the first PONG to a PING sent since the last sample [s]; < 0: none

  bool has_command_ = false;
  std::uint64_t last_tick_ = 0;  ///< tick of the last command sent
  std::uint32_t resets_seen_ = 0;
  std::uint64_t dropped_seen_ = 0;  ///< part of transport_.dropped() that is counted already
  double reset_until_ = -1.0;       ///< RESET is repeated until then [s]; < 0: not requested

  double next_hello_ = 0.0;
  double ask_until_ = 0.0;  ///< after a reset; open() has its own limit
  double next_configure_ = 0.0;
  double next_reset_ = 0.0;
  double next_ping_ = 0.0;
  double next_command_ = 0.0;
};

}  // namespace phalanx
