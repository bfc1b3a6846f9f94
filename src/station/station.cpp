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

#include "phalanx/core/latest.h"
#include "station/history.h"
#include "station/pacer.h"
#include "station/station_step.h"
#include "step/check_parameters.h"

namespace phalanx {
namespace {

constexpr double kReportSeconds = 2.0;  ///< length of samples and steps in a fault report
constexpr std::size_t kRecords = 8192;  ///< steps that may wait to be fetched: 4 s at 2 kHz
constexpr double kRecordSeconds = 8.2;  ///< for which their samples may wait [s]
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

}  // namespace

/// The loop's functions and state, and the data that it shares with other threads.
struct Station::Loop {
  struct WantedParameters {
    HapticParameters parameters;
    std::uint64_t replacement = 0;  ///< number of the rendering that they are for
    std::uint64_t change = 0;       ///< as Station::change_to()
  };

  Loop(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters, Device& of_device,
       ChannelMap map, StationOptions given, const Clock& process_clock);

  // The loop's thread only.
  void run() noexcept;
  void one_step(const Wake& wake) noexcept;
  void serve_requests(double now) noexcept;
  [[nodiscard]] unsigned confirmed_openings() noexcept;
  void exchange_rendering() noexcept;
  void write_down(const Wake& wake, std::size_t count, double sent_at) noexcept;
  void append(std::size_t count) noexcept;
  void freeze_history() noexcept;

  // Other threads.
  void ask(unsigned set, unsigned clear) noexcept;
  void check_rate(const HapticParameters& parameters) const;

  /// A rendering and the number of its replace().
  struct Incoming {
    std::unique_ptr<Rendering> rendering;
    std::uint64_t replacement = 0;
  };

  Device& device;
  const StationOptions options;
  const Clock& clock;
  const double period;

  // The loop's thread only.
  StationStep step;
  std::uint64_t replacement =
      0;  ///< number of the rendering in force: 0 for the first, then counted by replace()
  std::vector<DeviceSample> inbox;
  bool late = false;
  StepRecord record;  ///< of this step
  DeadlineStatistics statistics;
  History<DeviceSample> sample_history;
  History<StepRecord> step_history;
  bool reported = false;          ///< this fault's history has been frozen
  bool wants_parameters = false;  ///< `wanted` has a value for which no ramp has begun

  // Shared between threads.
  std::atomic<unsigned> requests{0};
  std::array<std::atomic<std::uint64_t>, kDigits> openings{};  ///< `running` of a confirmation; 0: none
  std::atomic<bool> finish{false};
  FaultEvent frozen_event;          ///< fault of the frozen history
  LinkStatistics frozen_link;       ///< link statistics at that time
  std::atomic<bool> frozen{false};  ///< true: the history belongs to take_fault_report(), which clears it
  std::atomic<Incoming*> incoming{nullptr};
  std::atomic<Incoming*> outgoing{nullptr};  ///< exchanged; another thread deletes it
  std::mutex readers;                        ///< excludes the other threads from each other
  std::uint64_t replacements = 0;            ///< calls of replace(); guarded by `readers`
  Latest<WantedParameters> wanted;           ///< written under `readers`
  Latest<StationView> newest_view;
  Latest<DeadlineStatistics> newest_deadlines;
  boost::lockfree::spsc_queue<DeviceSample>
      record_samples;  ///< of the records; those of a record come before it
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
      options(std::move(given)),
      clock(process_clock),
      period(checked_period(parameters)),
      step(std::make_unique<Rendering>(std::move(model), parameters), std::move(map), device.info(),
           options.safety, options.witnesses, period),
      inbox(kInbox),
      sample_history(count_of(kReportSeconds, device.info().rate_hz)),
      step_history(count_of(kReportSeconds, parameters.rate_hz)),
      record_samples(kInbox + count_of(kRecordSeconds, device.info().rate_hz)) {
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
  record = {};
  record.station = options.number;
  serve_requests(wake.now);
  record.input.openings = confirmed_openings();
  step.confirm_openings(record.input.openings);
  const std::size_t count = device.receive(wake.now, inbox);
  record.input.connection = device.connection_fault();
  record.command =
      step.step(std::span<const DeviceSample>(inbox.data(), count), record.input.connection, late, wake.now);
  if (step.heard()) device.send(record.command);
  write_down(wake, count, clock.now());
}

void Station::Loop::serve_requests(double now) noexcept {
  const unsigned asked = requests.exchange(0, std::memory_order_acq_rel);
  record.input.requests = asked;
  if (asked != 0) record.input.connection_at_requests = device.connection_fault();
  if (step.serve(asked, record.input.connection_at_requests, now)) {
    device.reset();
    reported = false;
  }
  if (step.ending()) return;
  if (incoming.load(std::memory_order_acquire) != nullptr) exchange_rendering();
  wants_parameters = wanted.update() || wants_parameters;
  if (wants_parameters && wanted.value().replacement == replacement) {
    step.change_to(wanted.value().parameters);
    record.input.changed = wanted.value().change;
    wants_parameters = false;
  }
}

/// @returns the digits whose opening was confirmed in this period of kRunning
unsigned Station::Loop::confirmed_openings() noexcept {
  unsigned digits = 0;
  for (std::size_t digit = 0; digit < openings.size(); ++digit) {
    const std::uint64_t asked = openings[digit].exchange(0, std::memory_order_acq_rel);
    if (asked != 0 && asked == step.running()) digits |= 1U << digit;
  }
  return digits;
}

/// Exchanges the model where there is no force: the ramp down first, then the exchange, then the start ramp.
void Station::Loop::exchange_rendering() noexcept {
  record.input.waits = true;
  if (!step.wait_for_exchange() || outgoing.load() != nullptr) return;
  Incoming* next = incoming.exchange(nullptr, std::memory_order_acq_rel);
  if (next == nullptr) return;
  record.input.exchanged = next->rendering->change;
  next->rendering = step.exchange(std::move(next->rendering));
  std::swap(next->replacement, replacement);
  outgoing.store(next, std::memory_order_release);
}

void Station::Loop::write_down(const Wake& wake, std::size_t count, double sent_at) noexcept {
  const Snapshot& snapshot = step.snapshot();
  const Safety& safety = step.safety();
  record.input.time = wake.now;
  record.input.late = late;
  record.lateness = wake.lateness;
  record.duration = sent_at - wake.now;
  record.samples = static_cast<std::uint32_t>(count);
  step.describe(record);
  record.hash = step.hash();
  append(count);
  if (!frozen.load(std::memory_order_acquire)) {
    for (std::size_t i = 0; i < count; ++i) sample_history.push(inbox[i]);
    step_history.push(record);
    freeze_history();
  }
  StationView view;
  view.time = wake.now;
  view.tick = record.command.tick;
  view.station = options.number;
  view.snapshot = snapshot;
  view.stiffness = record.stiffness;
  view.duration = record.duration;
  view.sent = record.command.torque;
  view.state = safety.state();
  view.fault = safety.fault();
  view.factor = safety.factor();
  view.at_rest = safety.at_rest();
  view.degraded = statistics.degraded(wake.now);
  view.running = step.running();
  view.changing = step.rendering().ramp.moving() || incoming.load(std::memory_order_relaxed) != nullptr;
  view.device = step.newest_sample().state;
  view.estop = step.newest_sample().estop;
  view.oscillates = safety.oscillates();
  view.ending = step.ending();
  view.resets_refused = step.resets_refused();
  view.link = device.statistics();
  view.records_lost = records_lost;
  newest_view.write(view);
}

/// Appends the step's record with its samples, or neither. The samples come first, so that a reader of the record finds
/// them.
void Station::Loop::append(std::size_t count) noexcept {
  if (records.write_available() == 0 || record_samples.write_available() < count) {
    ++records_lost;
    return;
  }
  record_samples.push(inbox.data(), count);
  records.push(record);
}

/// Freezes the history once the torque of a fault has come to rest, until take_fault_report().
void Station::Loop::freeze_history() noexcept {
  const Safety& safety = step.safety();
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

bool Station::next_record(StepRecord& record, std::vector<DeviceSample>& samples) {
  samples.clear();
  samples.reserve(kInbox);  // no step has more; without memory, nothing has been fetched
  if (!loop_->records.pop(record)) return false;
  DeviceSample sample;
  while (samples.size() < record.samples && loop_->record_samples.pop(sample)) samples.push_back(sample);
  return true;
}

std::size_t Station::records_waiting() const { return loop_->records.read_available(); }

void Station::stop_torque() noexcept {
  loop_->ask(StepRequest::kStop | StepRequest::kWithdraw, StepRequest::kResume);
}
void Station::resume_torque() noexcept { loop_->ask(StepRequest::kResume, StepRequest::kStop); }
void Station::reset() noexcept { loop_->ask(StepRequest::kReset, 0); }

void Station::open_digit(int digit, std::uint64_t running) noexcept {
  if (digit >= 0 && digit < kDigits)
    loop_->openings[static_cast<std::size_t>(digit)].store(running, std::memory_order_release);
}

/// Hands over parameters for the model of the last replace(); for an earlier model, the loop drops them.
void Station::change_to(const HapticParameters& parameters, std::uint64_t change) {
  loop_->check_rate(parameters);
  check_parameters(parameters);
  const std::lock_guard lock(loop_->readers);
  loop_->wanted.write({.parameters = parameters, .replacement = loop_->replacements, .change = change});
}

void Station::replace(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters,
                      std::uint64_t change) {
  loop_->check_rate(parameters);
  auto replacement = std::make_unique<Loop::Incoming>();
  replacement->rendering = std::make_unique<Rendering>(std::move(model), parameters, change);
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
  report.angle_origin = loop_->step.channels().angle_origins();
  report.event = loop_->frozen_event;
  loop_->sample_history.clear();
  loop_->step_history.clear();
  loop_->frozen.store(false, std::memory_order_release);
  return report;
}

void Station::shut_down() noexcept {
  if (loop_->thread.joinable()) {
    loop_->ask(StepRequest::kEnd, StepRequest::kResume | StepRequest::kReset);
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
