// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <boost/lockfree/spsc_queue.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "phalanx/station/pacer.h"
#include "station/parameter_ramp.h"
#include "step/check_parameters.h"

namespace phalanx {
namespace {

constexpr double kReportSeconds = 2.0;  ///< length of samples and steps in a fault report
constexpr std::size_t kRecords = 8192;  ///< steps that may wait to be fetched: 4 s at 2 kHz
constexpr std::size_t kInbox = 512;     ///< capacity for the samples between two steps
constexpr double kLook = 0.005;         ///< interval of checking whether the ramp at the end is over [s]

double checked_period(const HapticParameters& parameters) {
  check_station_rate(parameters.rate_hz);
  return parameters.period();
}

std::size_t count_of(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::ceil(seconds * std::clamp(rate_hz, 1.0, 10000.0)));
}

/// @returns the longest time for the ramp at the end [s]: the time that the rate limit needs, and a reserve.
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

/// A model, its parameters and its state, which are exchanged together.
struct Station::Rendering {
  Rendering(std::shared_ptr<const HapticModel> of_model, const HapticParameters& parameters)
      : model(std::move(of_model)), ramp(parameters), state(*model, parameters) {}

  const std::shared_ptr<const HapticModel> model;
  ParameterRamp ramp;
  HapticState state;
  std::uint64_t replacement = 0;  ///< 0 for the first, then counted by replace()
};

struct Station::Records {
  explicit Records(std::size_t size) : queue(size) {}
  boost::lockfree::spsc_queue<StepRecord> queue;
};

bool Station::next_record(StepRecord& record) { return records_->queue.pop(record); }

std::size_t Station::records_waiting() const { return records_->queue.read_available(); }

void check_station_rate(double rate_hz) {
  if (rate_hz >= 200.0 && rate_hz <= 2000.0) return;
  throw std::invalid_argument(
      fmt::format("rate_hz = {}: a station runs at 200 to 2000 Hz; change rate_hz", rate_hz));
}

Station::Station(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters, Device& device,
                 ChannelMap channels, StationOptions options, const Clock& clock)
    : device_(device),
      channels_(std::move(channels)),
      options_(std::move(options)),
      clock_(clock),
      period_(checked_period(parameters)),
      rendering_(std::make_unique<Rendering>(std::move(model), parameters)),
      safety_(options_.safety, channels_, device.info(), rendering_->model->hand.parameters(),
              options_.witnesses, period_),
      inbox_(kInbox),
      samples_(count_of(kReportSeconds, device.info().rate_hz)),
      steps_(count_of(kReportSeconds, parameters.rate_hz)),
      records_(std::make_unique<Records>(kRecords)) {
  check_watchdog(options_.safety, device.info());
  statistics_.period = period_;
}

Station::~Station() { shut_down(); }

void Station::start() {
  thread_ = std::thread([this] { loop(); });
}

// ---- the loop ----

void Station::loop() noexcept {
  ::pthread_setname_np(::pthread_self(), "phalanx-loop");
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
    rendering_->ramp.advance();
    status_ = step(*rendering_->model, rendering_->ramp.parameters(), sample_, rendering_->state);
  }
  safety_.command(rendering_->state.snapshot(), newest_, wake.now, command_);
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
  if (incoming_.load(std::memory_order_acquire) != nullptr) exchange_rendering();
  wants_parameters_ = wanted_.update() || wants_parameters_;
  if (wants_parameters_ && wanted_.value().replacement == rendering_->replacement) {
    rendering_->ramp.go_to(wanted_.value().parameters);
    wants_parameters_ = false;
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

/// Exchanges the model where there is no force: the ramp down first, then the exchange, then the start ramp.
void Station::exchange_rendering() noexcept {
  const SafetyState state = safety_.state();
  if (state == SafetyState::kStarting || state == SafetyState::kRunning) {
    safety_.stop();
    resume_after_exchange_ = true;
  }
  if (!safety_.at_rest() || safety_.state() == SafetyState::kStopping || outgoing_.load() != nullptr) return;
  Rendering* incoming = incoming_.exchange(nullptr, std::memory_order_acq_rel);
  if (incoming == nullptr) return;
  outgoing_.store(rendering_.release(), std::memory_order_release);
  rendering_.reset(incoming);  // frees nothing, since it is empty
  if (std::exchange(resume_after_exchange_, false)) safety_.start();
}

void Station::write_down(const Wake& wake, std::size_t count, double sent_at) noexcept {
  const Snapshot& snapshot = rendering_->state.snapshot();
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
                          .stiffness = rendering_->ramp.parameters().force.stiffness,
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
  view.changing = rendering_->ramp.moving() || incoming_.load(std::memory_order_relaxed) != nullptr;
  view.device = newest_.state;
  view.estop = newest_.estop;
  view.oscillates = safety_.oscillates();
  view.ending = ending_;
  view.resets_refused = resets_refused_;
  view.link = device_.statistics();
  view.records_lost = records_lost_;
  view_.write(view);
}

/// Freezes the history once the torque of a fault has come to rest, until take_fault_report().
void Station::freeze_history() noexcept {
  if (safety_.state() != SafetyState::kFault || reported_ || !safety_.at_rest()) return;
  reported_ = true;
  frozen_event_ = safety_.fault();
  frozen_link_ = device_.statistics();  // only this thread may call the device
  frozen_.store(true, std::memory_order_release);
}

// ---- other threads ----

/// Adds requests for the next step. If several are made between two steps, the last one counts. An end is
/// never taken back.
void Station::ask(unsigned set, unsigned clear) noexcept {
  unsigned before = requests_.load(std::memory_order_relaxed);
  while (!requests_.compare_exchange_weak(before, (before & ~clear) | set, std::memory_order_acq_rel)) {
  }
}

void Station::stop_torque() noexcept { ask(kStop, kResume); }
void Station::resume_torque() noexcept { ask(kResume, kStop); }
void Station::reset() noexcept { ask(kReset, 0); }

void Station::check_rate(const HapticParameters& parameters) const {
  if (parameters.period() == period_) return;
  throw std::invalid_argument(
      fmt::format("rate_hz = {}: the running station has {}; end it and start one with the new rate",
                  parameters.rate_hz, 1.0 / period_));
}

/// Hands over parameters for the model of the last replace(); for an earlier model, the loop drops them.
void Station::change_to(const HapticParameters& parameters) {
  check_rate(parameters);
  check_parameters(parameters);
  const std::lock_guard lock(readers_);
  wanted_.write({.parameters = parameters, .replacement = replacements_});
}

void Station::replace(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters) {
  check_rate(parameters);
  auto replacement = std::make_unique<Rendering>(std::move(model), parameters);
  const std::lock_guard lock(readers_);
  replacement->replacement = ++replacements_;
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
    // Counted, not timed: while the machine stands still, the ramp does not advance either.
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
