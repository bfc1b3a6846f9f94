// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/session.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "phalanx/mesh/import_cache.h"
#include "station/command_queue.h"
#include "station/session_state.h"
#include "station/session_worker.h"

namespace phalanx {

Session::Session(SessionSettings settings, const Clock& clock)
    : settings_(std::move(settings)),
      clock_(clock),
      state_(std::make_unique<SessionState>()),
      queue_(std::make_unique<CommandQueue>()),
      imports_(std::make_shared<ImportCache>()),
      worker_(std::make_unique<SessionWorker>(settings_, clock_, *state_, *queue_, *imports_)) {}

Session::~Session() { shut_down(); }

// ---- any thread ----

void Session::stop() noexcept { state_->stop(); }

bool Session::resume() noexcept { return state_->resume(state_->stops()); }

bool Session::resume(std::uint64_t stops) noexcept { return state_->resume(stops); }

std::uint64_t Session::stops() const noexcept { return state_->stops(); }

bool Session::reset(double fault_time) noexcept {
  const StationView seen = view();
  const double time = seen.fault.fault == Fault::kNone ? 0.0 : seen.fault.time;
  if (state_->current() && time != fault_time) return false;
  reset();
  return true;
}

void Session::reset() noexcept {
  if (const auto now = state_->current()) return now->station->reset();
  try {
    queue_->ask(MakeStation{}, {});
  } catch (const std::exception&) {  // without memory, or after shut_down() has begun: no other try
  }
}

void Session::open_digit(int digit, double way, std::uint64_t running) {
  if (digit < 0 || digit >= kDigits)
    throw std::invalid_argument(fmt::format("digit {}: there are 0 to {}", digit, kDigits - 1));
  const std::string_view name = digit_name(digit);
  const auto now = state_->current();
  const StationView seen = view();
  const DigitOpening& opening = seen.snapshot.opening[static_cast<std::size_t>(digit)];
  if (!now || seen.state != SafetyState::kRunning)
    throw std::invalid_argument(
        fmt::format("{}: forces are not on; let them start, then open the digit", name));
  if (!info()->device.renders_torque)
    throw std::invalid_argument(
        fmt::format("{}: the device has no motors that could open a digit; the person opens the hand", name));
  if (opening.phase == OpeningPhase::kNone)
    throw std::invalid_argument(fmt::format("{}: the digit is not inside the object, or has left it", name));
  if (opening.phase == OpeningPhase::kConfirmed)
    throw std::invalid_argument(fmt::format("{}: the digit is being opened; wait, or stop the torque", name));
  if (running != seen.running)
    throw std::invalid_argument(
        fmt::format("{}: forces have been off since you looked; look, then confirm again", name));
  if (!(std::abs(opening.way - way) <= OpeningState::kSameWay))
    throw std::invalid_argument(
        fmt::format("{}: the way out was {:.0f} mm and is {:.0f} mm now; look, then confirm again", name,
                    1e3 * way, 1e3 * opening.way));
  now->station->open_digit(digit, running);
}

void Session::set(Overrides changes, Done done) {
  queue_->ask(SetValues{std::move(changes)}, std::move(done));
}

void Session::load_scene(std::string scene, Done done) {
  queue_->ask(LoadScene{std::move(scene)}, std::move(done));
}

void Session::replace(StationOrder order, Done done) { queue_->ask(std::move(order), std::move(done)); }

void Session::set_source(HandSource source, Done done) { queue_->ask(SelectSource{source}, std::move(done)); }

bool Session::set_sliders(const JointArray& angle) noexcept { return state_->set_sliders(angle); }

void Session::calibrate(WizardStep step, Done done) { queue_->ask(std::move(step), std::move(done)); }

bool Session::held_stopped() const noexcept { return state_->held(); }

double Session::now() const noexcept { return clock_.now(); }

JointArray Session::sliders() const { return state_->sliders(); }

StationView Session::view() const { return state_->view(); }

DeadlineStatistics Session::deadlines() const { return state_->deadlines(); }

SessionStatistics Session::statistics() const { return state_->statistics(); }

std::shared_ptr<const SessionInfo> Session::info() const { return state_->info(); }

// ---- one thread at a time ----

bool Session::next_change(SessionChange& change) { return state_->next_change(change); }

bool Session::next_record(StepRecord& record, std::vector<DeviceSample>& samples) {
  return state_->next_record(record, samples);
}

// ---- the owner's thread ----

void Session::poll() {
  if (ended_) return;
  publish_grant();
  while (!ended_) {  // a Done may call shut_down()
    const std::optional<Answer> answer = queue_->next_answer();
    if (!answer) return;
    answer->done(answer->outcome);
  }
}

/// Publishes the granted scheduling, which is known once the loop has begun.
void Session::publish_grant() {
  if (!info()->realtime.empty()) return;
  if (const auto granted = grant())
    state_->change_info([&](SessionInfo& info) { info.realtime = describe(*granted); });
}

std::optional<FaultReport> Session::take_fault_report() { return state_->take_fault_report(); }

std::optional<RealtimeGrant> Session::grant() const {
  const auto now = state_->current();
  return now ? now->station->grant() : std::nullopt;
}

void Session::shut_down() noexcept {
  ended_ = true;
  state_->end();  // a change being made may take long, but not with torque on
  worker_->end();
  if (const auto now = state_->current()) now->station->shut_down();
}

}  // namespace phalanx
