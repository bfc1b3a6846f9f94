// SPDX-License-Identifier: Apache-2.0
// The host of a conformance test: sessions, commands and what the controller has answered.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "device/conform/conform_port.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx {

/// Settings of a conformance test. No command and no limit asks for more torque.
struct ConformSettings {
  double torque = 0.05;       ///< largest torque that is commanded [Nm]
  double torque_rate = 1.0;   ///< [Nm/s]
  double tolerance = 0.01;    ///< of a measured torque [Nm]
  std::uint64_t seed = 1;     ///< of the random frames
  std::uint64_t host_id = 1;  ///< of this host; the other host has the next number
};

/// Reason for which a row cannot be tested to its end, in words: the row fails.
class ConformTrouble : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A frame of the controller with its time of arrival.
struct HeardFrame {
  phx_message message{};
  double at = 0.0;  ///< the host's clock [s]
  ConformSender to = ConformSender::kHost;
};

/// The controller's counters, from a sample. They wrap around.
struct ConformCounts {
  std::uint32_t corrupt = 0, refused = 0, outdated = 0;

  friend ConformCounts operator-(const ConformCounts& a, const ConformCounts& b) {
    return {a.corrupt - b.corrupt, a.refused - b.refused, a.outdated - b.outdated};
  }
};

/// @returns the period at which commands take a third of a line [s]; 0: the line has no limit.
[[nodiscard]] double conform_command_period(double bytes_per_second);

/// Host that plays the stimuli of a row. Nothing is sent or received but in its functions.
class ConformHost {
 public:
  ConformHost(ConformPort& port, const ConformSettings& settings);

  // ---- time ----

  [[nodiscard]] double now() const { return port_.now(); }
  /// Lets time pass: receives, repeats commands while driving(), and CONFIGURE otherwise.
  void pass(double seconds);
  /// Lets as much time pass as the controller needs to show the effect of a frame.
  void settle() { pass(settling()); }
  [[nodiscard]] double settling() const;
  [[nodiscard]] double period() const;          ///< promised period of the samples [s]
  [[nodiscard]] double command_period() const;  ///< [s]
  /// @returns the longest delay of this computer since it was asked last [s]: commands may have grown old.
  [[nodiscard]] double take_delay() { return std::exchange(longest_delay_, 0.0); }
  double round_trip = 0.0;  ///< longest of the row `ping` [s]

  // ---- sessions ----

  /// Opens a new session: HELLO, CONFIGURE, and RESET if the controller is latched.
  /// @throws ConformTrouble
  void open();
  /// Opens a new session without CONFIGURE, and sends none later.
  /// @throws ConformTrouble
  void open_unconfigured();
  /// Repeats HELLO until the session is granted, at most for `seconds`. @returns false if it was not
  bool say_hello(double seconds);
  void configure(double torque_limit);
  /// Commands with ENABLE from now on, until the controller acts. @throws ConformTrouble
  void enable(double torque_share = 0.0);
  void stop_driving() { driving_ = false; }
  /// Sends nothing more by itself.
  void be_quiet() { driving_ = false, keeps_alive_ = false; }
  [[nodiscard]] bool driving() const { return driving_; }
  /// Ends the session with commands without ENABLE and GOODBYE.
  void leave();

  // ---- frames ----

  [[nodiscard]] phx_message message(std::uint8_t type) const;  ///< with the session's epoch
  [[nodiscard]] phx_message hello(std::uint64_t host_id, std::uint32_t sequence) const;
  /// Makes a command of the next tick from the newest sample.
  [[nodiscard]] phx_message command(std::uint8_t flags, double torque = 0.0);
  /// Encodes a message. If its sequence is 0, it gets the next of its type.
  [[nodiscard]] std::vector<std::uint8_t> encode(phx_message message);
  void send(const phx_message& message, ConformSender sender = ConformSender::kHost);
  void send(std::span<const std::uint8_t> frame, ConformSender sender = ConformSender::kHost);
  /// Writes the right CRC into a frame whose bytes have been changed.
  static void seal(std::vector<std::uint8_t>& frame);

  // ---- what was heard ----

  void forget() { samples_.clear(), answers_.clear(); }
  [[nodiscard]] const std::vector<HeardFrame>& samples() const { return samples_; }
  [[nodiscard]] const std::vector<HeardFrame>& answers() const { return answers_; }
  /// @returns the newest answer of a type, if there is one.
  [[nodiscard]] std::optional<HeardFrame> answer(std::uint8_t type) const;
  [[nodiscard]] const phx_sample& newest() const { return newest_; }
  [[nodiscard]] ConformCounts counts() const { return {newest_.corrupt, newest_.refused, newest_.outdated}; }
  [[nodiscard]] std::uint32_t undecodable() const { return undecodable_; }
  [[nodiscard]] const std::optional<phx_welcome>& welcome() const { return welcome_; }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
  [[nodiscard]] std::uint32_t hello_sequence() const { return hello_sequence_; }
  [[nodiscard]] std::uint64_t last_tick() const { return tick_; }

  /// Joint that is commanded: one with a TORQUE channel, or the first that is measured.
  [[nodiscard]] int joint() const;
  /// TORQUE channel of joint(); -1: it has none.
  [[nodiscard]] int torque_channel() const;
  /// @returns the torque that a sample shows on joint() [Nm]. @pre torque_channel() >= 0
  [[nodiscard]] double measured_torque(const phx_sample& sample) const;

  [[nodiscard]] ConformPort& port() { return port_; }
  [[nodiscard]] const ConformSettings& settings() const { return settings_; }

 private:
  bool take_until(double until);
  void take(const phx_message& message, ConformSender to);

  ConformPort& port_;
  ConformSettings settings_;
  std::optional<phx_welcome> welcome_;
  std::uint32_t epoch_ = 0;
  std::uint32_t hello_sequence_ = 0;  ///< of the HELLO that was granted
  std::vector<std::uint32_t> sequence_;
  phx_sample newest_{};
  std::vector<HeardFrame> samples_;
  std::vector<HeardFrame> answers_;
  std::uint32_t undecodable_ = 0;
  std::uint64_t tick_ = 1000;  ///< of the last command
  bool driving_ = false;
  bool keeps_alive_ = false;
  double limit_ = 0.0;           ///< of the last configure() [Nm]
  double driven_torque_ = 0.0;   ///< [Nm]
  double next_command_ = 0.0;    ///< [s]
  double next_configure_ = 0.0;  ///< [s]
  double longest_delay_ = 0.0;   ///< [s]
};

}  // namespace phalanx
