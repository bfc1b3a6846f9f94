// SPDX-License-Identifier: Apache-2.0
#include "device/link/link_session.h"

#include <algorithm>
#include <cstring>

#include "phalanx/device/link/messages.h"

namespace phalanx {
namespace {

constexpr double kHelloPeriod = 0.1;       // [s], as all constants here
constexpr double kConfigurePeriod = 0.01;  // until a sample has the flag CONFIGURED
constexpr double kKeepAlivePeriod = 0.25;  // CONFIGURE again: a session ends after PHX_SESSION_US of silence
constexpr double kResetPeriod = 0.005;
/// Longest repetition of RESET. If the cause is gone later, another reset() is needed: releasing an emergency
/// stop must not start the motors.
constexpr double kResetFor = 0.2;
constexpr double kCommandPeriod = 0.001;
/// Longest repetition of a command. The controller would not use an older one, and a host that was suspended
/// must not send an old command.
constexpr double kRepeatFor = 0.02;
constexpr double kSilent = 0.01;  // without a sample for this long, a PING is sent
constexpr double kPingPeriod = 0.01;
constexpr double kSessionGone = 0.1;  // PING is answered for this long, but no sample comes
constexpr int kFramesPerCall = 2 * static_cast<int>(SampleQueue::kCapacity);

bool same_device(const phx_welcome& a, const phx_welcome& b) noexcept {
  if (std::memcmp(a.serial, b.serial, sizeof a.serial) != 0 || a.rate_hz != b.rate_hz ||
      a.channel_count != b.channel_count || a.flags != b.flags)
    return false;
  return std::equal(
      a.channel, a.channel + a.channel_count, b.channel, [](const phx_channel& x, const phx_channel& y) {
        return x.kind == y.kind && x.index == y.index && x.raw_min == y.raw_min && x.raw_max == y.raw_max;
      });
}

}  // namespace

LinkSession::LinkSession(Transport& transport, const LinkSettings& settings, std::uint64_t host_id,
                         LinkShared& shared)
    : transport_(transport), shared_(shared), host_id_(host_id), hello_timeout_(settings.hello_timeout) {}

void LinkSession::ask(double now) noexcept {
  phase_ = Phase::kAsking;
  refusal_.reset();
  // Earlier commands and requests do not apply to the next session.
  shared_.command.update();
  has_command_ = false;
  resets_seen_ = shared_.resets.load(std::memory_order_acquire);
  next_hello_ = now;
  ask_until_ = now + hello_timeout_;
}

void LinkSession::forget() noexcept {
  phase_ = Phase::kIdle;
  known_ = false;
  epoch_ = 0;
  reset_until_ = -1.0;
  shared_.fault.store(Fault::kNone, std::memory_order_release);
}

// ---- in ----

void LinkSession::receive(double now) noexcept {
  std::array<std::uint8_t, PHX_FRAME_MAX> frame;
  for (int i = 0; i < kFramesPerCall; ++i) {
    Peer from = 0;
    const std::size_t size = transport_.receive(frame, from);
    if (size == 0) break;
    phx_message message{};
    const phx_decoded decoded = phx_decode(frame.data(), size, &message);
    if (decoded == PHX_OK) {
      take(message, now);
      continue;
    }
    LinkCounters::count(shared_.counters.corrupt);
    if (decoded == PHX_OTHER_VERSION && phase_ == Phase::kAsking)
      refusal_ = Refusal{.reason = PHX_REFUSED_VERSION, .version = message.header.version};
  }
  // Pieces that the wire itself dropped: too long, or not a frame.
  const std::uint64_t dropped = transport_.dropped();
  LinkCounters::count(shared_.counters.corrupt, dropped - dropped_seen_);
  dropped_seen_ = dropped;
  if (transport_.lost()) fail(Fault::kDeviceLost);
}

void LinkSession::take(const phx_message& message, double now) noexcept {
  switch (message.header.type) {
    case PHX_WELCOME:
      return take_welcome(message, now);
    case PHX_REFUSED:
      return take_refusal(message, now);
    case PHX_SAMPLE:
      return take_sample(message, now);
    case PHX_PONG:
      return take_pong(message.as.ping, now);
    default:
      LinkCounters::count(shared_.counters.refused);
  }
}

// Handles WELCOME. Two HELLOs may have been on their way: the session is the one that the later HELLO opened.
// Once the session is settled, another epoch means that the controller has forgotten it.
void LinkSession::take_welcome(const phx_message& message, double now) noexcept {
  const phx_welcome& welcome = message.as.welcome;
  const std::uint32_t epoch = message.header.epoch;
  const bool later = phase_ == Phase::kRunning && !settled_ && static_cast<std::int32_t>(epoch - epoch_) > 0;
  if (welcome.host_id != host_id_ || (phase_ != Phase::kAsking && !later)) {
    if (epoch != epoch_) LinkCounters::count(shared_.counters.refused);
    return;
  }
  epoch_ = epoch;
  if (known_ && !same_device(welcome, welcome_)) {
    send_goodbye();
    return fail(Fault::kDeviceLost);
  }
  known_ = true;
  welcome_ = welcome;
  begin(now);
}

void LinkSession::begin(double now) noexcept {
  lost_before_ += window_.lost();
  window_ = {};
  configured_ = false;
  settled_ = false;
  sample_time_us_ = 0;
  heard_ = now;
  silence_ = std::max(kSilent, 3.0 / std::max<double>(welcome_.rate_hz, 1.0));
  first_pong_ = -1.0;
  pings_before_sample_ = pings_;
  next_configure_ = now;
  if (reset_until_ >= 0.0) reset_until_ = now + kResetFor;
  phase_ = Phase::kRunning;
  shared_.fault.store(Fault::kNone, std::memory_order_release);
}

void LinkSession::take_refusal(const phx_message& message, double now) noexcept {
  const phx_refused& refused = message.as.refused;
  if (refused.host_id != host_id_) return LinkCounters::count(shared_.counters.refused);
  if (phase_ == Phase::kAsking) {
    refusal_ = Refusal{.reason = refused.reason, .version = refused.version};
    // At the first session, open() decides; later, only the fault can report it.
    if (known_) fail(Fault::kRefused);
  } else if (phase_ == Phase::kRunning && silent(now)) {
    fail(Fault::kRefused);  // while samples come, it is a late answer to an earlier HELLO
  }
}

void LinkSession::take_sample(const phx_message& message, double now) noexcept {
  LinkCounters& counters = shared_.counters;
  if (message.header.epoch != epoch_ || epoch_ == 0) {
    LinkCounters::count(counters.refused);
    if (phase_ == Phase::kRunning && settled_ && silent(now)) fail(Fault::kControllerRestarted);
    return;
  }
  if (phase_ != Phase::kRunning) return;
  heard_ = now;
  first_pong_ = -1.0;
  pings_before_sample_ = pings_;
  const bool fresh = window_.take(message.header.sequence) == SequenceWindow::Frame::kNew;
  counters.lost.store(lost_before_ + window_.lost(), std::memory_order_relaxed);
  if (!fresh) return LinkCounters::count(counters.outdated);
  LinkCounters::count(counters.received);
  const phx_sample& sample = message.as.sample;
  counters.device_corrupt.store(sample.corrupt, std::memory_order_relaxed);
  counters.device_refused.store(sample.refused, std::memory_order_relaxed);
  counters.device_outdated.store(sample.outdated, std::memory_order_relaxed);
  configured_ = (sample.flags & PHX_SAMPLE_CONFIGURED) != 0;
  settled_ = settled_ || configured_;
  sample_time_us_ = sample.time_us;
  // The first RESET is sent when reset_until_ is set. A later sample that is not latched has seen it, or
  // there was nothing to clear.
  if (sample.state != PHX_STATE_LATCHED) reset_until_ = -1.0;
  if (!shared_.samples.push(read_sample(message, now))) LinkCounters::count(counters.overflowed);
}

// Handles PONG. A controller that answers PING but sends no sample has forgotten the session, in two cases:
// its clock has begun again, or no sample comes for longer than chance losses explain.
void LinkSession::take_pong(const phx_ping& pong, double now) noexcept {
  const std::uint64_t number = pong.stamp - host_id_;
  const bool answers = number > pings_before_sample_ && number <= pings_;
  if (phase_ != Phase::kRunning || !silent(now) || !answers) return;
  if (first_pong_ < 0.0) first_pong_ = now;
  if (pong.time_us >= sample_time_us_ && now - first_pong_ <= kSessionGone) return;
  if (settled_) return fail(Fault::kControllerRestarted);
  ask(now);  // WELCOME of a later session was lost; nothing was commanded in any
}

void LinkSession::fail(Fault fault) noexcept {
  phase_ = Phase::kDown;
  has_command_ = false;
  shared_.fault.store(fault, std::memory_order_release);
}

// ---- out ----

void LinkSession::send_due(double now) noexcept {
  watch_for_reset(now);
  if (phase_ == Phase::kAsking) send_hello(now);
  if (phase_ != Phase::kRunning) return;
  send_configure(now);
  send_reset(now);
  send_ping(now);
  send_command(now);
}

void LinkSession::send_hello(double now) noexcept {
  if (known_ && now > ask_until_) {
    reset_until_ = -1.0;
    // For a controller that comes up much later, another reset() is needed.
    return fail(Fault::kControllerRestarted);
  }
  if (now < next_hello_) return;
  next_hello_ = now + kHelloPeriod;
  phx_message hello{};
  hello.header.type = PHX_HELLO;
  hello.as.hello.host_id = host_id_;
  send(hello, 0);
}

void LinkSession::watch_for_reset(double now) noexcept {
  const std::uint32_t resets = shared_.resets.load(std::memory_order_acquire);
  if (resets == resets_seen_) return;
  resets_seen_ = resets;
  // A command from before a reset is no longer valid.
  shared_.command.update();
  has_command_ = false;
  if (phase_ == Phase::kDown) {
    if (transport_.lost()) return fail(Fault::kDeviceLost);
    ask(now);
  }
  reset_until_ = now + kResetFor;
  next_reset_ = now;
}

void LinkSession::send_configure(double now) noexcept {
  if (now < next_configure_) return;
  next_configure_ = now + (configured_ ? kKeepAlivePeriod : kConfigurePeriod);
  send(configure_, epoch_);
}

void LinkSession::send_reset(double now) noexcept {
  if (reset_until_ < 0.0 || now < next_reset_) return;
  if (now > reset_until_) {
    reset_until_ = -1.0;
    return;
  }
  next_reset_ = now + kResetPeriod;
  send(PHX_RESET, epoch_);
}

void LinkSession::send_ping(double now) noexcept {
  if (!silent(now) || now < next_ping_) return;
  next_ping_ = now + kPingPeriod;
  phx_message ping{};
  ping.header.type = PHX_PING;
  ping.as.ping.stamp = host_id_ + ++pings_;
  send(ping, 0);
}

bool LinkSession::repeats_command(double now) const noexcept {
  return has_command_ && now - shared_.command.value().at <= kRepeatFor;
}

void LinkSession::send_command(double now) noexcept {
  const bool fresh = shared_.command.update();
  if (fresh) has_command_ = true;
  if (!repeats_command(now) || (!fresh && now < next_command_)) return;
  const SentCommand& newest = shared_.command.value();
  next_command_ =
      std::clamp(next_command_ + kCommandPeriod, now + 0.5 * kCommandPeriod, now + 1.5 * kCommandPeriod);
  phx_message message{};
  write_command(newest.command, message);
  last_tick_ = newest.command.tick;
  send(message, epoch_);
  LinkCounters::count(shared_.counters.sent);
}

void LinkSession::send_disabled() noexcept {
  if (phase_ != Phase::kRunning) return;
  phx_message message{};
  message.header.type = PHX_COMMAND;
  message.as.command.tick = ++last_tick_;
  message.as.command.sample_time_us = sample_time_us_;
  message.as.command.flags = PHX_COMMAND_FAULT;  // a host that ends without a ramp needs zero torque at once
  send(message, epoch_);
  LinkCounters::count(shared_.counters.sent);
}

double LinkSession::next_due(double now) const noexcept {
  // At most one period: the loop may send a command or a reset at any time.
  const double soonest = now + kCommandPeriod;
  return phase_ == Phase::kRunning && repeats_command(now) ? std::min(next_command_, soonest) : soonest;
}

void LinkSession::send(std::uint8_t type, std::uint32_t epoch) noexcept {
  phx_message message{};
  message.header.type = type;
  send(message, epoch);
}

void LinkSession::send(phx_message& message, std::uint32_t epoch) noexcept {
  std::array<std::uint8_t, PHX_FRAME_MAX> frame;
  message.header.epoch = epoch;
  message.header.sequence = ++sequence_[message.header.type];
  const std::size_t size = phx_encode(&message, frame.data(), frame.size());
  if (size > 0) transport_.send({frame.data(), size}, 0);
}

}  // namespace phalanx
