// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "phalanx/device/latest.h"
#include "station/history.h"
#include "station/pacer.h"
#include "station/parameter_ramp.h"
#include "station/safety.h"
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

/// The loop's functions and state, and the data that it shares with other threads.
struct Station::Loop {
  enum Request : unsigned { kStop = 1, kResume = 2, kReset = 4, kEnd = 8, kWithdraw = 16 };

  /// A model, its parameters and its state, which are exchanged together.
  struct Rendering {
    Rendering(std::shared_ptr<const HapticModel> of_model, const HapticParameters& parameters)
        : model(std::move(of_model)), ramp(parameters), state(*model, parameters) {}

    const std::shared_ptr<const HapticModel> model;
    ParameterRamp ramp;
    HapticState state;
    std::uint64_t replacement = 0;  ///< 0 for the first, then counted by replace()
  };

  struct WantedParameters {
    HapticParameters parameters;
    std::uint64_t replacement = 0;  ///< number of their Rendering
  };

  Loop(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters, Device& of_device,
       ChannelMap map, StationOptions given, const Clock& process_clock);

  // The loop's thread only.
  void run() noexcept;
  void serve_requests(double now) noexcept;
  void reset_now(double now) noexcept;
  void serve_openings() noexcept;
  void number_running() noexcept;
  void end_running() noexcept;
  void exchange_rendering() noexcept;
  void one_step(const Wake& wake) noexcept;
  void write_down(const Wake& wake, std::size_t count, double sent_at) noexcept;
  void freeze_history() noexcept;

  // Other threads.
  void ask(unsigned set, unsigned clear) noexcept;
  void check_rate(const HapticParameters& parameters) const;

  Device& device;
  const ChannelMap channels;
  const StationOptions options;
  const Clock& clock;
  const double period;

  // The loop's thread only.
  std::unique_ptr<Rendering> rendering;
  Safety safety;
  std::vector<DeviceSample> inbox;
  DeviceSample newest_sample;
  bool heard = false;  ///< a sample has come since the beginning or the last reset
  bool late = false;
  bool ending = false;
  std::uint64_t resets_refused = 0;
  Sample sample;
  Status status = Status::kOk;
  DeviceCommand command;
  DeadlineStatistics statistics;
  History<DeviceSample> sample_history;
  History<StepRecord> step_history;
  bool reported = false;  ///< this fault's history has been frozen
  bool resume_after_exchange = false;
  std::uint64_t running = 0;      ///< number of this period of SafetyState::kRunning; 0: another state
  bool wants_parameters = false;  ///< `wanted` has a value for which no ramp has begun

  // Shared between threads.
  std::atomic<unsigned> requests{0};
  std::array<std::atomic<std::uint64_t>, kDigits> openings{};  ///< `running` of a confirmation; 0: none
  std::atomic<bool> finish{false};
  FaultEvent frozen_event;          ///< fault of the frozen history
  LinkStatistics frozen_link;       ///< link statistics at that time
  std::atomic<bool> frozen{false};  ///< true: the history belongs to take_fault_report(), which clears it
  std::atomic<Rendering*> incoming{nullptr};
  std::atomic<Rendering*> outgoing{nullptr};  ///< exchanged; another thread deletes it
  std::mutex readers;                         ///< excludes the other threads from each other
  std::uint64_t replacements = 0;             ///< calls of replace(); guarded by `readers`
  Latest<WantedParameters> wanted;            ///< written under `readers`
  Latest<StationView> newest_view;
  Latest<DeadlineStatistics> newest_deadlines;
  boost::lockfree::spsc_queue<StepRecord> records{kRecords};
  std::uint64_t records_lost = 0;  ///< the loop's thread only
  std::optional<RealtimeGrant> grant;
  std::thread thread;
};

void check_station_rate(double rate_hz) {
  if (rate_hz >= 200.0 && rate_hz <= 2000.0) return;
  throw std::invalid_argument(
      fmt::format("rate_hz = {}: a station runs at 200 to 2000 Hz; change rate_hz", rate_hz));
}

Station::Loop::Loop(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters,
                    Device& of_device, ChannelMap map, StationOptions given, const Clock& process_clock)
    : device(of_device),
      channels(std::move(map)),
      options(std::move(given)),
      clock(process_clock),
      period(checked_period(parameters)),
      rendering(std::make_unique<Rendering>(std::move(model), parameters)),
      safety(options.safety, channels, device.info(), rendering->model->hand.parameters(), options.witnesses,
             period),
      inbox(kInbox),
      sample_history(count_of(kReportSeconds, device.info().rate_hz)),
      step_history(count_of(kReportSeconds, parameters.rate_hz)) {
  check_watchdog(options.safety, device.info());
  statistics.period = period;
}

void Station::Loop::run() noexcept {
  ::pthread_setname_np(::pthread_self(), "phalanx-loop");
  if (options.ask_for_realtime) {
    RealtimeGrant granted = make_realtime(options.realtime);
    const std::lock_guard lock(readers);
    grant = std::move(granted);
  }
  Pacer pacer(clock, period);
  while (!finish.load(std::memory_order_acquire)) {
    const Wake wake = pacer.wait();
    one_step(wake);
    statistics.add(wake, clock.now());
    late = statistics.overruns_in_row > 0;
    newest_deadlines.write(statistics);
  }
}

void Station::Loop::one_step(const Wake& wake) noexcept {
  serve_requests(wake.now);
  serve_openings();
  const std::size_t count = device.receive(wake.now, inbox);
  const std::span<const DeviceSample> samples(inbox.data(), count);
  safety.observe(samples, device.connection_fault(), late, wake.now);
  if (count > 0) {
    newest_sample = samples.back();
    heard = true;
  }
  if (heard) {
    channels.convert(newest_sample, sample);
    rendering->ramp.advance();
    status = step(*rendering->model, rendering->ramp.parameters(), sample, rendering->state);
  }
  safety.command(rendering->state.snapshot(), newest_sample, wake.now, command);
  number_running();
  if (heard) device.send(command);
  write_down(wake, count, clock.now());
}

void Station::Loop::serve_requests(double now) noexcept {
  const unsigned asked = requests.exchange(0, std::memory_order_acq_rel);
  if ((asked & kWithdraw) != 0) end_running();
  ending = ending || (asked & kEnd) != 0;
  if ((asked & kStop) != 0 || ending) {
    safety.stop();
    resume_after_exchange = false;
  }
  if (ending) return;
  if ((asked & kResume) != 0) safety.start();
  if ((asked & kReset) != 0) reset_now(now);
  if (incoming.load(std::memory_order_acquire) != nullptr) exchange_rendering();
  wants_parameters = wanted.update() || wants_parameters;
  if (wants_parameters && wanted.value().replacement == rendering->replacement) {
    rendering->ramp.go_to(wanted.value().parameters);
    wants_parameters = false;
  }
}

/// Confirms openings that belong to this period of kRunning.
void Station::Loop::serve_openings() noexcept {
  if (safety.state() != SafetyState::kRunning) end_running();
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::uint64_t asked =
        openings[static_cast<std::size_t>(digit)].exchange(0, std::memory_order_acq_rel);
    if (asked != 0 && asked == running) rendering->state.confirm_opening(digit);
  }
}

/// Numbers the periods of kRunning, over all stations.
void Station::Loop::number_running() noexcept {
  static std::atomic<std::uint64_t> last{0};
  if (safety.state() != SafetyState::kRunning) return end_running();
  if (running == 0) running = last.fetch_add(1, std::memory_order_relaxed) + 1;
}

void Station::Loop::end_running() noexcept {
  running = 0;
  rendering->state.withdraw_openings();
}

void Station::Loop::reset_now(double now) noexcept {
  if (safety.state() != SafetyState::kFault) return;
  if (!safety.reset(device.connection_fault(), now)) {
    ++resets_refused;
    return;
  }
  device.reset();
  heard = false;
  reported = false;
}

/// Exchanges the model where there is no force: the ramp down first, then the exchange, then the start ramp.
void Station::Loop::exchange_rendering() noexcept {
  const SafetyState state = safety.state();
  if (state == SafetyState::kStarting || state == SafetyState::kRunning) {
    safety.stop();
    resume_after_exchange = true;
  }
  if (!safety.at_rest() || safety.state() == SafetyState::kStopping || outgoing.load() != nullptr) return;
  Rendering* next = incoming.exchange(nullptr, std::memory_order_acq_rel);
  if (next == nullptr) return;
  outgoing.store(rendering.release(), std::memory_order_release);
  rendering.reset(next);  // frees nothing, since it is empty
  if (std::exchange(resume_after_exchange, false)) safety.start();
}

void Station::Loop::write_down(const Wake& wake, std::size_t count, double sent_at) noexcept {
  const Snapshot& snapshot = rendering->state.snapshot();
  const StepRecord record{.tick = command.tick,
                          .time = wake.now,
                          .lateness = wake.lateness,
                          .duration = sent_at - wake.now,
                          .overrun = late,
                          .samples = static_cast<std::uint32_t>(count),
                          .sample_sequence = newest_sample.sequence,
                          .sample_time_us = newest_sample.time_us,
                          .state = safety.state(),
                          .fault = safety.fault().fault,
                          .factor = safety.factor(),
                          .status = status,
                          .stiffness = rendering->ramp.parameters().force.stiffness,
                          .angle = snapshot.hcp_angle,
                          .torque = command.torque,
                          .force = digit_forces(snapshot)};
  if (!records.push(record)) ++records_lost;
  if (!frozen.load(std::memory_order_acquire)) {
    for (std::size_t i = 0; i < count; ++i) sample_history.push(inbox[i]);
    step_history.push(record);
    freeze_history();
  }
  StationView view;
  view.time = wake.now;
  view.snapshot = snapshot;
  view.stiffness = record.stiffness;
  view.duration = record.duration;
  view.sent = command.torque;
  view.state = safety.state();
  view.fault = safety.fault();
  view.factor = safety.factor();
  view.at_rest = safety.at_rest();
  view.degraded = statistics.degraded(wake.now);
  view.running = running;
  view.changing = rendering->ramp.moving() || incoming.load(std::memory_order_relaxed) != nullptr;
  view.device = newest_sample.state;
  view.estop = newest_sample.estop;
  view.oscillates = safety.oscillates();
  view.ending = ending;
  view.resets_refused = resets_refused;
  view.link = device.statistics();
  view.records_lost = records_lost;
  newest_view.write(view);
}

/// Freezes the history once the torque of a fault has come to rest, until take_fault_report().
void Station::Loop::freeze_history() noexcept {
  if (safety.state() != SafetyState::kFault || reported || !safety.at_rest()) return;
  reported = true;
  frozen_event = safety.fault();
  frozen_link = device.statistics();  // only this thread may call the device
  frozen.store(true, std::memory_order_release);
}

// ---- other threads ----

/// Adds requests for the next step. If several are made between two steps, the last one counts. An end is
/// never taken back.
void Station::Loop::ask(unsigned set, unsigned clear) noexcept {
  unsigned before = requests.load(std::memory_order_relaxed);
  while (!requests.compare_exchange_weak(before, (before & ~clear) | set, std::memory_order_acq_rel)) {
  }
}

void Station::Loop::check_rate(const HapticParameters& parameters) const {
  if (parameters.period() == period) return;
  throw std::invalid_argument(
      fmt::format("rate_hz = {}: the running station has {}; end it and start one with the new rate",
                  parameters.rate_hz, 1.0 / period));
}

Station::Station(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters, Device& device,
                 ChannelMap channels, StationOptions options, const Clock& clock)
    : loop_(std::make_unique<Loop>(std::move(model), parameters, device, std::move(channels),
                                   std::move(options), clock)) {}

Station::~Station() { shut_down(); }

void Station::start() {
  loop_->thread = std::thread([loop = loop_.get()] { loop->run(); });
}

bool Station::next_record(StepRecord& record) { return loop_->records.pop(record); }

std::size_t Station::records_waiting() const { return loop_->records.read_available(); }

void Station::stop_torque() noexcept { loop_->ask(Loop::kStop | Loop::kWithdraw, Loop::kResume); }
void Station::resume_torque() noexcept { loop_->ask(Loop::kResume, Loop::kStop); }
void Station::reset() noexcept { loop_->ask(Loop::kReset, 0); }

void Station::open_digit(int digit, std::uint64_t running) noexcept {
  if (digit >= 0 && digit < kDigits)
    loop_->openings[static_cast<std::size_t>(digit)].store(running, std::memory_order_release);
}

/// Hands over parameters for the model of the last replace(); for an earlier model, the loop drops them.
void Station::change_to(const HapticParameters& parameters) {
  loop_->check_rate(parameters);
  check_parameters(parameters);
  const std::lock_guard lock(loop_->readers);
  loop_->wanted.write({.parameters = parameters, .replacement = loop_->replacements});
}

void Station::replace(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters) {
  loop_->check_rate(parameters);
  auto replacement = std::make_unique<Loop::Rendering>(std::move(model), parameters);
  const std::lock_guard lock(loop_->readers);
  replacement->replacement = ++loop_->replacements;
  delete loop_->outgoing.exchange(nullptr, std::memory_order_acq_rel);
  delete loop_->incoming.exchange(replacement.release(), std::memory_order_acq_rel);
}

StationView Station::view() const {
  const std::lock_guard lock(loop_->readers);
  delete loop_->outgoing.exchange(nullptr, std::memory_order_acq_rel);
  loop_->newest_view.update();
  return loop_->newest_view.value();
}

DeadlineStatistics Station::deadlines() const {
  const std::lock_guard lock(loop_->readers);
  loop_->newest_deadlines.update();
  return loop_->newest_deadlines.value();
}

std::optional<RealtimeGrant> Station::grant() const {
  const std::lock_guard lock(loop_->readers);
  return loop_->grant;
}

std::optional<FaultReport> Station::take_fault_report() {
  if (!loop_->frozen.load(std::memory_order_acquire)) return std::nullopt;
  FaultReport report;
  report.samples = loop_->sample_history.all();
  report.steps = loop_->step_history.all();
  report.device = loop_->device.info();
  report.link = loop_->frozen_link;
  report.angle_origin = loop_->channels.angle_origins();
  report.event = loop_->frozen_event;
  loop_->sample_history.clear();
  loop_->step_history.clear();
  loop_->frozen.store(false, std::memory_order_release);
  return report;
}

void Station::shut_down() noexcept {
  if (loop_->thread.joinable()) {
    loop_->ask(Loop::kEnd, Loop::kResume | Loop::kReset);
    // Counted, not timed: while the machine stands still, the ramp does not advance either.
    for (double waited = 0.0; waited < shut_down_within(loop_->options.safety); waited += kLook) {
      const StationView now = view();
      const bool stopped = now.state == SafetyState::kStopped || now.state == SafetyState::kFault;
      if (now.ending && stopped && now.at_rest) break;
      loop_->clock.sleep_until(loop_->clock.now() + kLook);
    }
    loop_->finish.store(true, std::memory_order_release);
    loop_->thread.join();
  }
  loop_->device.close();
  delete loop_->incoming.exchange(nullptr);
  delete loop_->outgoing.exchange(nullptr);
}

}  // namespace phalanx
