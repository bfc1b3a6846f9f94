// SPDX-License-Identifier: Apache-2.0
// A Session and its owner. The program runs under a held clock: a busy machine makes no faults of its
// own.
#pragma once

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/station/session.h"
#include "support/held_clock/hold_this_process.h"
#include "support/reading_helper.h"

namespace phalanx::test {

class SessionFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { read_meshes_in_helper(); }

  static SessionSettings with(const std::string& device, const std::string& scene = "first_touch") {
    SessionSettings settings;
    settings.scene = scene;
    settings.device = device;
    settings.ask_for_realtime = false;
    return settings;
  }
  void start(const SessionSettings& settings) { session = std::make_unique<Session>(settings, clock); }

  /// Does what an owner does until it is so. @returns whether it came, within minutes
  bool until(const std::function<bool()>& so) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (std::chrono::steady_clock::now() < give_up) {
      own();
      if (so()) return true;
      sleep(0.005);
    }
    return false;
  }
  virtual void own() {
    session->poll();
    StepRecord record;
    std::vector<DeviceSample> samples;
    while (session->next_record(record, samples)) records.push_back(record);
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
  }
  void sleep(double seconds) const { clock.sleep_until(clock.now() + seconds); }
  /// The owner's work for so long by the process's clock.
  void pass(double seconds) {
    const double end = clock.now() + seconds;
    ASSERT_TRUE(until([&] { return clock.now() >= end; }));
  }
  bool until_running() {
    return until([&] { return session->info()->running && session->view().state == SafetyState::kRunning; });
  }

  /// Waits until the worker makes a change that needs clock time: a running station that has to end first.
  /// The clock stands still meanwhile, because this thread runs and does not look at it; so the change is
  /// not done when this returns. Another change may be missed, and the test then ends at its time limit.
  /// @returns SessionInfo::busy
  std::string until_busy() const {
    std::string busy;
    while ((busy = session->info()->busy).empty())
      ::syscall(SYS_sched_yield);  // not sched_yield(), with which a held clock lets time pass
    return busy;
  }
  /// Lets the worker load a scene while a station runs. What is asked next waits until this thread sleeps,
  /// because that station ends first.
  void occupy(const std::string& scene = "first_touch") {
    session->load_scene(scene, {});
    ASSERT_EQ(until_busy(), "scene " + scene);
  }

  /// Until steps that end too late have led to a fault, at rest.
  void overload() {
    const LoopWakesLate late(0.0075);  // the period is 5 ms
    ASSERT_TRUE(until([&] {
      const StationView view = session->view();
      return view.state == SafetyState::kFault && view.at_rest;
    }));
  }

  /// What a request is answered with.
  struct Answer {
    std::optional<std::string> refused;
    bool overtaken = false;
    int times = 0;
  };
  std::pair<std::shared_ptr<Answer>, Session::Done> awaited() {
    auto answer = std::make_shared<Answer>();
    return {answer, [answer](const ChangeOutcome& outcome) {
              answer->refused = outcome.refused;
              answer->overtaken = outcome.overtaken;
              ++answer->times;
            }};
  }
  /// Asks and waits. @returns why it was refused; empty: it is done
  std::string ask(const std::function<void(Session::Done)>& how) {
    auto [answer, done] = awaited();
    how(done);
    const auto got = answer;
    EXPECT_TRUE(until([&] { return got->refused.has_value(); })) << "no answer";
    EXPECT_EQ(got->times, 1);
    EXPECT_FALSE(got->overtaken);
    return got->refused.value_or("no answer");
  }
  std::string set(const Overrides& changes) {
    return ask([&](Session::Done done) { session->set(changes, std::move(done)); });
  }
  std::string load(const std::string& scene) {
    return ask([&](Session::Done done) { session->load_scene(scene, std::move(done)); });
  }
  std::string move_by(HandSource source) {
    return ask([&](Session::Done done) { session->set_source(source, std::move(done)); });
  }
  std::string calibrate(const WizardStep& step) {
    return ask([&](Session::Done done) { session->calibrate(step, std::move(done)); });
  }
  std::string calibrate(WizardStep::Kind kind, std::size_t pose = 0) {
    return calibrate(WizardStep{.kind = kind, .pose = pose});
  }

  [[nodiscard]] std::string value(const std::string& key) const {
    std::string found;
    for (const auto& [name, text] : session->info()->values)
      if (name == key) found = text;
    return found;
  }
  [[nodiscard]] static bool any_torque(const StationView& view) {
    for (const double torque : view.sent)
      if (torque != 0.0) return true;
    return false;
  }

  const Clock clock;
  std::vector<StepRecord> records;
  std::vector<FaultReport> reports;
  std::unique_ptr<Session> session;
};

}  // namespace phalanx::test
