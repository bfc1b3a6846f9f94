// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station_host.h"

#include <chrono>
#include <future>
#include <utility>

#include "phalanx/core/error_text.h"
#include "station/change_queue.h"
#include "station/shared_station.h"
#include "station/station_changer.h"

namespace phalanx {
namespace {

using Step = CalibrationSession::Step;
using Answers = std::vector<ChangeAnswer>;

/// Applies a request on the worker's thread. A refusal becomes an answer, not an exception.
Answers apply(StationChanger& changer, ChangeRequest request) {
  if (!request.work) return changer.set(std::move(request.sets));
  std::string refused;
  try {
    request.work();
  } catch (const std::exception& error) {
    refused = error_text(error);
    if (refused.empty()) refused = "refused without a reason";
  }
  return {{.done = std::move(request.done), .overtaken = {}, .refused = std::move(refused)}};
}

/// Refuses all parts of a request without trying them.
Answers refuse(ChangeRequest request, const std::string& why) {
  Answers answers;
  for (SetPart& part : request.sets) answers.push_back(answer_to(std::move(part), why));
  answers.push_back({.done = std::move(request.done), .overtaken = {}, .refused = why});
  return answers;
}

void tell(const Answers& answers) {
  for (const ChangeAnswer& answer : answers) {
    for (const StationHost::Done& done : answer.overtaken) done({.refused = {}, .overtaken = true});
    if (answer.done) answer.done({.refused = answer.refused, .overtaken = false});
  }
}

}  // namespace

struct StationHost::Parts {
  Parts(const StationHostSettings& settings, const Clock& process_clock)
      : clock(process_clock), changer(settings, process_clock, shared) {}

  void ask(std::string text, std::function<void()> work, Done done) {
    queue.ask({.text = std::move(text),
               .work = std::move(work),
               .done = std::move(done),
               .sets = {},
               .retry = false});
  }

  void end_work() {
    if (!working.valid() || working.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const Answers answers = working.get();
    shared.change_state([](HostState& s) { s.busy.clear(); });
    tell(answers);
  }

  void begin_work() {
    if (working.valid()) return;
    std::optional<ChangeRequest> next = queue.take();
    if (!next) return;
    shared.change_state([&](HostState& s) { s.busy = next->text; });
    try {
      working = std::async(std::launch::async,
                           [this, request = *next]() mutable { return apply(changer, std::move(request)); });
    } catch (const std::exception& error) {  // no thread or no memory
      shared.change_state([](HostState& s) { s.busy.clear(); });
      tell(refuse(std::move(*next), error_text(error)));
    }
  }

  /// Publishes the granted scheduling, which is known once the loop has begun.
  void learn_grant() {
    const auto now = shared.current();
    if (!now || !shared.state()->realtime.empty()) return;
    if (const auto granted = now->station->grant())
      shared.change_state([&](HostState& s) { s.realtime = describe(*granted); });
  }

  const Clock& clock;
  SharedStation shared;
  ChangeQueue queue;
  StationChanger changer;  ///< the worker's thread uses it while there is one
  std::future<Answers> working;
  bool ended = false;
};

StationHost::StationHost(StationHostSettings settings, const Clock& clock)
    : settings_(std::move(settings)), parts_(std::make_unique<Parts>(settings_, clock)) {
  parts_->changer.first_station();
}

StationHost::~StationHost() { shut_down(); }

void StationHost::stop() noexcept { parts_->shared.stop(); }

bool StationHost::resume() noexcept { return parts_->shared.resume(parts_->shared.stops()); }

bool StationHost::resume(std::uint64_t stops) noexcept { return parts_->shared.resume(stops); }

std::uint64_t StationHost::stops() const noexcept { return parts_->shared.stops(); }

bool StationHost::reset(double fault_time) noexcept {
  const StationView seen = view();
  const double time = seen.fault.fault == Fault::kNone ? 0.0 : seen.fault.time;
  if (parts_->shared.current() && time != fault_time) return false;
  reset();
  return true;
}

void StationHost::reset() noexcept {
  if (const auto now = parts_->shared.current()) return now->station->reset();
  try {
    parts_->queue.ask({.text = "another try",
                       .work = [changer = &parts_->changer] { changer->try_again(); },
                       .done = {},
                       .sets = {},
                       .retry = true});
  } catch (const std::exception&) {  // with so many changes waiting, a station will be tried anyway
  }
}

void StationHost::set(Overrides changes, Done done) {
  parts_->queue.ask_set(std::move(changes), std::move(done));
}

void StationHost::load_scene(std::string scene, Done done) {
  std::string text = "scene " + scene;
  parts_->ask(
      std::move(text), [changer = &parts_->changer, scene = std::move(scene)] { changer->load_scene(scene); },
      std::move(done));
}

void StationHost::set_source(HandSource source, Done done) {
  parts_->ask(
      source == HandSource::kSliders ? "sliders" : "simulated patient",
      [changer = &parts_->changer, source] { changer->set_source(source); }, std::move(done));
}

bool StationHost::set_sliders(const JointArray& angle) noexcept { return parts_->shared.set_sliders(angle); }

void StationHost::calibrate(Step step, std::size_t pose, Done done) {
  auto work = [changer = &parts_->changer, step, pose] {
    switch (step) {
      case Step::kBegin:
        return changer->begin_wizard();
      case Step::kAbandon:
        return changer->abandon_wizard();
      case Step::kWrite:
        return changer->write_wizard();
      default:
        return changer->step_wizard(step, pose);
    }
  };
  parts_->ask("calibration", std::move(work), std::move(done));
}

bool StationHost::held_stopped() const noexcept { return parts_->shared.held(); }

JointArray StationHost::sliders() const { return parts_->shared.sliders(); }

StationView StationHost::view() const { return parts_->shared.view(); }

DeadlineStatistics StationHost::deadlines() const { return parts_->shared.deadlines(); }

SessionStatistics StationHost::session() const { return parts_->shared.session(); }

std::shared_ptr<const HostState> StationHost::state() const { return parts_->shared.state(); }

double StationHost::now() const noexcept { return parts_->clock.now(); }

void StationHost::poll() {
  if (parts_->ended) return;
  parts_->end_work();
  parts_->learn_grant();
  if (!parts_->working.valid()) parts_->changer.serve_wizard();
  parts_->begin_work();
}

bool StationHost::next_record(StepRecord& record) { return parts_->shared.next_record(record); }

std::optional<FaultReport> StationHost::take_fault_report() { return parts_->shared.take_fault_report(); }

std::optional<RealtimeGrant> StationHost::grant() const {
  const auto now = parts_->shared.current();
  return now ? now->station->grant() : std::nullopt;
}

void StationHost::shut_down() noexcept {
  parts_->ended = true;
  parts_->shared.end();  // a change being made may take long, but not with torque on
  if (parts_->working.valid()) parts_->working.wait();
  if (const auto now = parts_->shared.current()) now->station->shut_down();
  parts_->changer.close_wizard();
  parts_->queue.clear();
}

}  // namespace phalanx
