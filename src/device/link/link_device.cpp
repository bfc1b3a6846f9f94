// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/link/link_device.h"

#include <fmt/format.h>

#include <atomic>
#include <random>
#include <thread>

#include "device/link/link_session.h"
#include "phalanx/device/link/messages.h"

namespace phalanx {
namespace {

constexpr double kAskingStep = 0.005;  // [s], as all constants here
/// Time of asking a busy controller: a host that was killed holds its session for PHX_SESSION_US.
constexpr double kPatienceWhenBusy = 1.25e-6 * PHX_SESSION_US;
constexpr int kFarewells = 50;  // commands without ENABLE before GOODBYE
constexpr double kFarewellPeriod = 0.001;
constexpr int kGoodbyes = 5;  // repeated, since one may be lost; continuing samples show that
constexpr double kGoodbyePeriod = 0.005;

std::uint64_t random_host_id() {
  std::random_device random;
  return (std::uint64_t{random()} << 32) | (random() | 1u);
}

class WiredDevice final : public LinkDevice {
 public:
  WiredDevice(std::unique_ptr<Transport> transport, const Clock& clock, LinkSettings settings)
      : transport_(std::move(transport)),
        clock_(clock),
        settings_(std::move(settings)),
        session_(*transport_, settings_, random_host_id(), shared_) {}
  ~WiredDevice() override { close(); }
  WiredDevice(const WiredDevice&) = delete;
  WiredDevice& operator=(const WiredDevice&) = delete;

  void set_calibration(std::vector<DeviceChannel> channels) override { calibration_ = std::move(channels); }
  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }

  [[nodiscard]] std::size_t receive(double, std::span<DeviceSample> out) noexcept override {
    const SampleQueue::Taken taken = shared_.samples.take(out);
    if (taken.dropped > 0) LinkCounters::count(shared_.counters.overflowed, taken.dropped);
    return taken.count;
  }
  void send(const DeviceCommand& command) noexcept override {
    shared_.command.write({.command = command, .at = clock_.now()});
  }
  void reset() noexcept override {
    // Before the link's thread has seen the reset, the loop must not take the old fault for a new one.
    shared_.fault.store(Fault::kNone, std::memory_order_release);
    shared_.resets.fetch_add(1, std::memory_order_release);
  }
  [[nodiscard]] Fault connection_fault() const noexcept override {
    return shared_.fault.load(std::memory_order_acquire);
  }
  [[nodiscard]] LinkStatistics statistics() const noexcept override;

 private:
  void shake_hands();
  [[noreturn]] void refuse(const LinkSession::Refusal& refusal) const;
  phx_message configuration() const;
  void run() noexcept;
  void take_leave() noexcept;
  void wait_until(double t) noexcept {
    const double left = t - clock_.now();
    if (left > 0.0) transport_->wait(left * clock_.slowdown());
  }

  std::unique_ptr<Transport> transport_;
  const Clock& clock_;
  LinkSettings settings_;
  std::optional<std::vector<DeviceChannel>> calibration_;
  DeviceInfo info_;
  LinkShared shared_;
  LinkSession session_;  ///< open() uses it until thread_ runs, then thread_ does
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// ---- set-up ----

void WiredDevice::open() {
  close();
  shared_.samples.take({});  // samples of an earlier session
  shake_hands();
  try {
    info_ = device_info(session_.welcome());
    session_.set_configuration(configuration());
    stop_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { run(); });
  } catch (...) {
    session_.send_goodbye();
    session_.forget();
    throw;
  }
}

void WiredDevice::shake_hands() {
  const double begin = clock_.now();
  double give_up = begin + settings_.hello_timeout;
  bool refused = false;
  session_.ask(begin);
  while (true) {
    const double now = clock_.now();
    session_.receive(now);
    if (session_.phase() == LinkSession::Phase::kRunning) return;
    const std::optional<LinkSession::Refusal> refusal = session_.refusal();
    if (refusal && !refused) {
      refused = true;
      give_up = std::min(give_up, now + kPatienceWhenBusy);
    }
    const bool lost = session_.phase() == LinkSession::Phase::kDown;
    if (now >= give_up || lost || (refusal && refusal->reason != PHX_REFUSED_BUSY)) {
      session_.forget();
      if (refusal) refuse(*refusal);
      throw DeviceError(
          fmt::format("{}: {}", transport_->address(),
                      lost ? std::string("the port has failed; is the device plugged in?")
                           : fmt::format("no controller answers within {:.1f} s; is it switched on and "
                                         "connected, and is the address right?",
                                         settings_.hello_timeout)));
    }
    session_.send_due(now);
    wait_until(now + kAskingStep);
  }
}

void WiredDevice::refuse(const LinkSession::Refusal& refusal) const {
  if (refusal.reason == PHX_REFUSED_BUSY) {
    throw DeviceError(
        fmt::format("{}: the device belongs to another host; end that program (a host that was "
                    "killed loses the device after {} s) and try again",
                    transport_->address(), PHX_SESSION_US / 1000000u));
  }
  throw DeviceError(fmt::format(
      "{}: the controller speaks version {} of the link, this program version {}; update the older",
      transport_->address(), refusal.version, PHX_VERSION));
}

phx_message WiredDevice::configuration() const {
  const std::vector<DeviceChannel>& channels = calibration_ ? *calibration_ : info_.channels;
  if (channels.size() != info_.channels.size()) {
    throw DeviceError(
        fmt::format("{}: the calibration has {} channels, device {} has {}; calibrate this device",
                    transport_->address(), channels.size(), info_.serial, info_.channels.size()));
  }
  return configure_message(channels, settings_.torque_limit, settings_.torque_rate);
}

void WiredDevice::close() noexcept {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_release);
  thread_.join();
  session_.forget();
}

// ---- the link's thread ----

void WiredDevice::run() noexcept {
  if (settings_.on_thread_start) settings_.on_thread_start();
  while (!stop_.load(std::memory_order_acquire)) {
    const double now = clock_.now();
    session_.receive(now);
    session_.send_due(now);
    wait_until(session_.next_due(now));
  }
  take_leave();
}

void WiredDevice::take_leave() noexcept {
  if (session_.phase() != LinkSession::Phase::kRunning) return;
  const double begin = clock_.now();
  for (int i = 0; i < kFarewells; ++i) {
    const double next = begin + i * kFarewellPeriod;
    session_.receive(clock_.now());
    session_.send_disabled();
    while (clock_.now() < next) {
      wait_until(next);
      session_.receive(clock_.now());  // an unread sample would end every further wait at once
    }
  }
  for (int i = 0; i < kGoodbyes && session_.phase() == LinkSession::Phase::kRunning; ++i) {
    session_.send_goodbye();
    // Samples that were on their way arrive within half the period.
    const double sent = clock_.now();
    while (clock_.now() < sent + kGoodbyePeriod) {
      session_.receive(clock_.now());
      wait_until(sent + kGoodbyePeriod);
    }
    if (session_.heard() < sent + 0.5 * kGoodbyePeriod) return;
  }
}

LinkStatistics WiredDevice::statistics() const noexcept {
  const auto read = [](const std::atomic<std::uint64_t>& counter) {
    return counter.load(std::memory_order_relaxed);
  };
  const LinkCounters& c = shared_.counters;
  return {.received = read(c.received),
          .lost = read(c.lost),
          .outdated = read(c.outdated),
          .corrupt = read(c.corrupt),
          .refused = read(c.refused),
          .overflowed = read(c.overflowed),
          .sent = read(c.sent),
          .device_corrupt = read(c.device_corrupt),
          .device_refused = read(c.device_refused),
          .device_outdated = read(c.device_outdated)};
}

}  // namespace

std::unique_ptr<LinkDevice> make_link_device(std::unique_ptr<Transport> transport, const Clock& clock,
                                             const LinkSettings& settings) {
  return std::make_unique<WiredDevice>(std::move(transport), clock, settings);
}

}  // namespace phalanx
