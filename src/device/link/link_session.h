// SPDX-License-Identifier: Apache-2.0
// The host's side of a session as a machine without a thread or a clock: one thread calls it with the time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "device/link/link_shared.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/device/link/sequence_window.h"

namespace phalanx {

/// All of it is real-time but for the constructor.
class LinkSession {
 public:
  enum class Phase {
    kIdle,     ///< nothing is asked for
    kAsking,   ///< HELLO until WELCOME
    kRunning,  ///< a session is open
    kDown,     ///< a connection fault is latched: nothing is sent until reset
  };

  /// Why a controller did not open a session.
  struct Refusal {
    std::uint8_t reason = 0;   ///< enum phx_refusal
    std::uint8_t version = 0;  ///< that the controller speaks
  };

  LinkSession(Transport& transport, const LinkSettings& settings, std::uint64_t host_id, LinkShared& shared);

  /// PHX_CONFIGURE as it is to be sent in every session.
  void set_configuration(const phx_message& configure) noexcept { configure_ = configure; }
  /// Asks for a session from now on; the one before, if any, is forgotten.
  void ask(double now) noexcept;
  /// Takes what the transport has.
  void receive(double now) noexcept;
  /// Sends what is due. What was missed is not made up for.
  void send_due(double now) noexcept;
  /// When send_due() has something to do again [s].
  [[nodiscard]] double next_due(double now) const noexcept;

  /// A command without ENABLE, newer than all before it.
  void send_disabled() noexcept;
  void send_goodbye() noexcept { send(PHX_GOODBYE, epoch_); }
  /// As before the first ask().
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
  bool known_ = false;  ///< the first session of this run has been granted: welcome_ is who we talk to
  phx_welcome welcome_{};
  phx_message configure_{};
  std::optional<Refusal> refusal_;
  std::uint32_t epoch_ = 0;
  std::array<std::uint32_t, PHX_PONG + 1> sequence_{};  ///< of our frames, by type

  SequenceWindow window_;
  std::uint64_t lost_before_ = 0;  ///< in earlier sessions
  bool configured_ = false;        ///< says the newest sample
  bool settled_ = false;           ///< said a sample of this session
  double heard_ = 0.0;
  double silence_ = 0.0;              ///< without a sample that is worth a PING
  std::uint64_t sample_time_us_ = 0;  ///< of the newest sample
  std::uint64_t pings_ = 0;           ///< sent; the stamp of one is host_id_ + its number
  std::uint64_t pings_before_sample_ = 0;
  double first_pong_ = -1.0;  ///< of a PING sent since the last sample [s]; < 0: none

  bool has_command_ = false;
  std::uint64_t last_tick_ = 0;  ///< sent
  std::uint32_t resets_seen_ = 0;
  std::uint64_t dropped_seen_ = 0;  ///< of transport_.dropped(), counted already
  double reset_until_ = -1.0;       ///< RESET is repeated until then; < 0: not asked for

  double next_hello_ = 0.0;
  double ask_until_ = 0.0;  ///< after a reset; open() has its own limit
  double next_configure_ = 0.0;
  double next_reset_ = 0.0;
  double next_ping_ = 0.0;
  double next_command_ = 0.0;
};

}  // namespace phalanx
