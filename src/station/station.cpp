// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/lockfree/spsc_queue.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "phalanx/station/pacer.h"

namespace phalanx {
namespace {

constexpr double kReportSeconds = 2.0;  ///< of samples and steps in a fault report
constexpr std::size_t kRecords = 8192;  ///< steps that may wait for whoever writes them down: 4 s at 2 kHz
constexpr std::size_t kInbox = 512;     ///< samples between two steps
constexpr double kLook = 0.005;         ///< whether the ramp at the end is over, as often as this [s]

double checked_period(const HapticModel& model) {
  check_station_rate(model.rate_hz);
  return 1.0 / model.rate_hz;
}

std::size_t count_of(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::ceil(seconds * std::clamp(rate_hz, 1.0, 10000.0)));
}

/// Time that the ramp at the end may take [s]: as long as the rate limit needs, and some more.
double shut_down_within(const SafetySettings& safety) {
  return 2.0 + safety.stop_ramp + 1.5 * safety.joint_torque / safety.torque_rate;
}

DigitArray digit_forces(const Snapshot& snapshot) noexcept {
  DigitArray force{};
  for (int digit = 0; digit < kDigits; ++digit) {
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force[static_cast<std::size_t>(digit)] +=
          snapshot.segment[static_cast<std::size_t>(segment_index(digit, k))].force;
  }
  return force;
}

}  // namespace

struct Station::Records {
  explicit Records(std::size_t size) : queue(size) {}
  boost::lockfree::spsc_queue<StepRecord> queue;
};

bool Station::next_record(StepRecord& record) { return records_->queue.pop(record); }

void check_station_rate(double rate_hz) {
  if (rate_hz >= 200.0 && rate_hz <= 2000.0) return;
  throw std::invalid_argument(
      fmt::format("rate_hz = {}: a station runs at 200 to 2000 Hz; change rate_hz", rate_hz));
}

Station::Station(std::unique_ptr<HapticModel> model, Device& device, ChannelMap channels,
                 StationOptions options, const Clock& clock)
    : device_(device),
      channels_(std::move(channels)),
      options_(std::move(options)),
      clock_(clock),
      period_(checked_period(*model)),
      model_(std::move(model)),
      safety_(options_.safety, channels_, device.info(), model_.model().hand.parameters(), options_.witnesses,
              period_),
      inbox_(kInbox),
      samples_(count_of(kReportSeconds, device.info().rate_hz)),
      steps_(count_of(kReportSeconds, model_.model().rate_hz)),
      records_(std::make_unique<Records>(kRecords)) {
  statistics_.period = period_;
}

Station::~Station() { shut_down(); }

void Station::start() {
  thread_ = std::thread([this] { loop(); });
}

// ---- the loop ----

void Station::loop() noexcept {
  if (options_.ask_for_realtime) {
    RealtimeGrant granted = make_realtime(options_.realtime);
    const std::lock_guard lock(readers_);
    grant_ = std::move(granted);
  }
  Pacer pacer(clock_, period_);
  while (!finish_.load(std::memory_order_acquire)) {
    const Wake wake = pacer.wait();
    one_step(wake);
    statistics_.add(wake, clock_.now());
    late_ = statistics_.overruns_in_row > 0;
    deadlines_.write(statistics_);
  }
}

void Station::one_step(const Wake& wake) noexcept {
  serve_requests(wake.now);
  const std::size_t count = device_.receive(wake.now, inbox_);
  const std::span<const DeviceSample> samples(inbox_.data(), count);
  safety_.observe(samples, device_.connection_fault(), late_, wake.now);
  if (count > 0) {
    newest_ = samples.back();
    heard_ = true;
  }
  if (heard_) {
    channels_.convert(newest_, sample_);
    status_ = model_.advance(sample_);
  }
  const double extra = extra_.load(std::memory_order_relaxed);
  while (extra > 0.0 && clock_.now() < wake.now + extra) {
  }
  safety_.command(model_.snapshot(), newest_, wake.now, command_);
  if (heard_) device_.send(command_);
  write_down(wake, count, clock_.now());
}

void Station::serve_requests(double now) noexcept {
  const unsigned asked = requests_.exchange(0, std::memory_order_acq_rel);
  ending_ = ending_ || (asked & kEnd) != 0;
  if ((asked & kStop) != 0 || ending_) {
    safety_.stop();
    resume_after_exchange_ = false;
  }
  if (ending_) return;
  if ((asked & kResume) != 0) safety_.start();
  if ((asked & kReset) != 0) reset_now(now);
  if (incoming_.load(std::memory_order_acquire) != nullptr) {
    exchange_model();
  } else if (blend_.update()) {
    model_.blend_to(blend_.value());
  }
}

void Station::reset_now(double now) noexcept {
  if (safety_.state() != SafetyState::kFault) return;
  if (!safety_.reset(device_.connection_fault(), now)) {
    ++resets_refused_;
    return;
  }
  device_.reset();
  heard_ = false;
  reported_ = false;
}

/// Another model only where no force is: the ramp down first, then the exchange, then the start ramp.
void Station::exchange_model() noexcept {
  const SafetyState state = safety_.state();
  if (state == SafetyState::kStarting || state == SafetyState::kRunning) {
    safety_.stop();
    resume_after_exchange_ = true;
  }
  if (!safety_.at_rest() || safety_.state() == SafetyState::kStopping || outgoing_.load() != nullptr) return;
  LiveModel* incoming = incoming_.exchange(nullptr, std::memory_order_acq_rel);
  if (incoming == nullptr) return;
  model_.swap(*incoming);
  outgoing_.store(incoming, std::memory_order_release);
  if (std::exchange(resume_after_exchange_, false)) safety_.start();
}

void Station::write_down(const Wake& wake, std::size_t count, double sent_at) noexcept {
  const Snapshot& snapshot = model_.snapshot();
  const StepRecord record{.tick = command_.tick,
                          .time = wake.now,
                          .lateness = wake.lateness,
                          .duration = sent_at - wake.now,
                          .overrun = late_,
                          .samples = static_cast<std::uint32_t>(count),
                          .sample_sequence = newest_.sequence,
                          .sample_time_us = newest_.time_us,
                          .state = safety_.state(),
                          .fault = safety_.fault().fault,
                          .factor = safety_.factor(),
                          .status = status_,
                          .stiffness = model_.model().force.stiffness,
                          .angle = snapshot.hcp_angle,
                          .torque = command_.torque,
                          .force = digit_forces(snapshot)};
  if (!records_->queue.push(record)) ++records_lost_;
  if (!frozen_.load(std::memory_order_acquire)) {
    for (std::size_t i = 0; i < count; ++i) samples_.push(inbox_[i]);
    steps_.push(record);
    freeze_history();
  }
  StationView view;
  view.time = wake.now;
  view.snapshot = snapshot;
  view.stiffness = record.stiffness;
  view.duration = record.duration;
  view.sent = command_.torque;
  view.state = safety_.state();
  view.fault = safety_.fault();
  view.factor = safety_.factor();
  view.at_rest = safety_.at_rest();
  view.degraded = statistics_.degraded(wake.now);
  view.changing = model_.blending() || incoming_.load(std::memory_order_relaxed) != nullptr;
  view.device = newest_.state;
  view.estop = newest_.estop;
  view.oscillates = safety_.oscillates();
  view.ending = ending_;
  view.resets_refused = resets_refused_;
  view.link = device_.statistics();
  view.records_lost = records_lost_;
  view_.write(view);
}

/// Once the torque of a fault has come to rest, its history stands still until somebody has taken it.
void Station::freeze_history() noexcept {
  if (safety_.state() != SafetyState::kFault || reported_ || !safety_.at_rest()) return;
  reported_ = true;
  frozen_event_ = safety_.fault();
  frozen_link_ = device_.statistics();  // only this thread may ask the device
  frozen_.store(true, std::memory_order_release);
}

// ---- other threads ----

/// Of what is asked between two steps the last word counts; an end is never taken back.
void Station::ask(unsigned set, unsigned clear) noexcept {
  unsigned before = requests_.load(std::memory_order_relaxed);
  while (!requests_.compare_exchange_weak(before, (before & ~clear) | set, std::memory_order_acq_rel)) {
  }
}

void Station::stop_torque() noexcept { ask(kStop, kResume); }
void Station::resume_torque() noexcept { ask(kResume, kStop); }
void Station::reset() noexcept { ask(kReset, 0); }

void Station::blend_to(const BlendedParameters& parameters) {
  const std::lock_guard lock(readers_);
  blend_.write(parameters);
}

void Station::replace(std::unique_ptr<LiveModel> replacement) {
  const double rate = replacement->model().rate_hz;
  if (1.0 / rate != period_) {
    throw std::invalid_argument(
        fmt::format("rate_hz = {}: the running station has {}; end it and start one with the new rate", rate,
                    1.0 / period_));
  }
  const std::lock_guard lock(readers_);
  delete outgoing_.exchange(nullptr, std::memory_order_acq_rel);
  delete incoming_.exchange(replacement.release(), std::memory_order_acq_rel);
}

StationView Station::view() const {
  const std::lock_guard lock(readers_);
  delete outgoing_.exchange(nullptr, std::memory_order_acq_rel);
  view_.update();
  return view_.value();
}

DeadlineStatistics Station::deadlines() const {
  const std::lock_guard lock(readers_);
  deadlines_.update();
  return deadlines_.value();
}

std::optional<RealtimeGrant> Station::grant() const {
  const std::lock_guard lock(readers_);
  return grant_;
}

std::optional<FaultReport> Station::take_fault_report() {
  if (!frozen_.load(std::memory_order_acquire)) return std::nullopt;
  FaultReport report;
  report.samples = samples_.all();
  report.steps = steps_.all();
  report.device = device_.info();
  report.link = frozen_link_;
  report.event = frozen_event_;
  samples_.clear();
  steps_.clear();
  frozen_.store(false, std::memory_order_release);
  return report;
}

void Station::shut_down() noexcept {
  if (thread_.joinable()) {
    ask(kEnd, kResume | kReset);
    // Counted, not timed: while the machine stands still, the ramp does not go on either.
    for (double waited = 0.0; waited < shut_down_within(options_.safety); waited += kLook) {
      const StationView now = view();
      const bool stopped = now.state == SafetyState::kStopped || now.state == SafetyState::kFault;
      if (now.ending && stopped && now.at_rest) break;
      clock_.sleep_until(clock_.now() + kLook);
    }
    finish_.store(true, std::memory_order_release);
    thread_.join();
  }
  device_.close();
  delete incoming_.exchange(nullptr);
  delete outgoing_.exchange(nullptr);
}

}  // namespace phalanx
