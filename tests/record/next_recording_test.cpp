// SPDX-License-Identifier: Apache-2.0
// Several recordings of one session: each step is in one of them, and each is replayed on its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/recording.pb.h"
#include "record/mcap/mcap_reader.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"
#include "serve/full_disk.h"
#include "station/session_fixture.h"

namespace phalanx::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Station and tick of a step.
using StepName = std::pair<std::uint64_t, std::uint64_t>;

/// What was reported of one recording.
struct Reported {
  std::atomic<bool> ready = false;
  std::atomic<bool> begun = false;
  std::atomic<bool> ended = false;
  std::atomic<bool> last = false;
  std::atomic<bool> whole = false;
  std::mutex mutex;
  std::string refused;
  fs::path file;
  std::vector<StepName> steps;

  std::string why() {
    const std::lock_guard lock(mutex);
    return refused;
  }
};

class NextRecordings : public SessionFixture {
 protected:
  ~NextRecordings() override {
    if (session) session->shut_down();
    recorder.finish(false);
  }
  void begin(bool recorded = true) {
    SessionSettings settings = with("sliders");
    settings.overrides = {{"hand.meshes", "\"capsules\""}, {"grasp.type", "\"none\""}};
    settings.keep_changes = true;
    start(settings);
    recorder.begin(*session, clock, recorded ? std::optional(to(false)) : std::nullopt, watch(first));
  }
  [[nodiscard]] RecorderSettings to(bool encrypted) const {
    RecorderSettings settings{
        .folder = folder.path(), .least_room = 0, .metadata = recording_metadata("test")};
    if (encrypted) settings.encryption = test_encryption();
    return settings;
  }
  RecordingWatch watch(const std::shared_ptr<Reported>& of) {
    return {.on_step =
                [of](const StepRecord& record) {
                  const std::lock_guard lock(of->mutex);
                  of->steps.emplace_back(record.station, record.command.tick);
                },
            .on_last = [of] { of->last = true; },
            .on_ended =
                [of](const fs::path& file, bool whole) {
                  {
                    const std::lock_guard lock(of->mutex);
                    of->file = file;
                  }
                  of->whole = whole;
                  of->ended = true;
                }};
  }
  std::uint64_t ask_next(const std::shared_ptr<Reported>& of, RecorderSettings settings) {
    return recorder.next_recording({.settings = std::move(settings),
                                    .watch =
                                        [this, of](const fs::path&) {
                                          of->begun = true;
                                          return watch(of);
                                        },
                                    .on_ready = [of](const std::filesystem::path&) { of->ready = true; },
                                    .on_refused =
                                        [of](const std::string& why) {
                                          const std::lock_guard lock(of->mutex);
                                          of->refused = why;
                                        }});
  }
  void own() override {
    session->poll();
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
  }
  std::string replace(const StationOrder& order) {
    return ask([&](Session::Done done) { session->replace(order, std::move(done)); });
  }
  StationOrder order_with(std::uint64_t recording, const std::string& scene = "first_touch") const {
    return {.scene = scene,
            .overrides = {{"hand.meshes", "\"capsules\""}, {"grasp.type", "\"none\""}},
            .recording = recording};
  }
  void end() {
    session->shut_down();
    recorder.finish(true);
  }
  /// @returns the steps of a file, in their order
  [[nodiscard]] static std::vector<StepName> steps_in(const fs::path& name) {
    const mcap::ReadableFile file(name, test_keys());
    mcap::McapReader reader(file);
    std::vector<StepName> steps;
    wire::Step step;
    for (mcap::Message message; reader.next(message);) {
      if (reader.schema_of(message.channel) != "phalanx.wire.Step") continue;
      EXPECT_TRUE(step.ParseFromArray(message.data.data(), static_cast<int>(message.data.size())));
      steps.emplace_back(step.station(), step.tick());
    }
    return steps;
  }
  /// Expects that a file has these steps, its end, and the same bits when it is played again.
  static void expect_replays(const fs::path& file, const std::vector<StepName>& steps) {
    SCOPED_TRACE(file.string());
    EXPECT_EQ(steps_in(file), steps);
    const RecordingSummary summary = summarise_recording(file, test_keys());
    EXPECT_EQ(recording_state(summary), "whole");
    const ReplayResult result = replay(file, {}, nullptr, test_keys());
    EXPECT_EQ(result.different, 0U) << result.first->tick << ": " << result.first->what;
    EXPECT_TRUE(result.exact);
    EXPECT_EQ(result.compared, steps.size());
    EXPECT_EQ(result.not_compared, 0U);
    EXPECT_EQ(result.missing, 0U);
  }
  /// Expects that these are all steps of the stations, each once: the ticks of each station rise by 1 from 1 on.
  static void expect_all_once(const std::vector<StepName>& steps) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (i > 0 && steps[i].first == steps[i - 1].first)
        ASSERT_EQ(steps[i].second, steps[i - 1].second + 1) << "station " << steps[i].first;
      else
        ASSERT_EQ(steps[i].second, 1U) << "station " << steps[i].first;
      ASSERT_TRUE(i == 0 || steps[i].first >= steps[i - 1].first);
    }
  }
  [[nodiscard]] std::vector<std::string> events_of(const fs::path& file) const {
    std::vector<std::string> texts;
    for (const auto& event : read_recording(file, {}, test_keys()).events)
      if (event.code == "marker") texts.push_back(event.text);
    return texts;
  }
  [[nodiscard]] std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(folder.path())) all.push_back(entry.path());
    std::sort(all.begin(), all.end());
    return all;
  }

  const testing::TemporaryFolder folder;
  const std::shared_ptr<Reported> first = std::make_shared<Reported>();
  const std::shared_ptr<Reported> second = std::make_shared<Reported>();
  RunRecorder recorder{"", fs::temp_directory_path()};
};

TEST_F(NextRecordings, HaveEachStepOnceAndEachIsReplayedOnItsOwn) {
  begin();
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  pass(1.0);
  EXPECT_EQ(load("pinch_ball"), "") << "another station in the same recording";
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  ASSERT_TRUE(until([&] { return second->ready.load(); }));
  EXPECT_FALSE(second->begun) << "its station has not begun";
  pass(0.5);
  EXPECT_EQ(replace(order_with(number)), "");
  ASSERT_TRUE(until([&] { return second->begun && first->ended; }));
  EXPECT_TRUE(first->last);
  EXPECT_TRUE(first->whole);
  ASSERT_TRUE(until_running());
  EXPECT_THAT(recorder.recording()->file.string(), EndsWith(".mcap.enc"));
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.3"}}), "");
  EXPECT_EQ(set({{"force.law", "\"kelvin_voigt\""}}), "");
  pass(2.0);
  session->stop();
  EXPECT_EQ(load("pinch_ball"), "");
  pass(1.0);
  EXPECT_FALSE(second->ended);
  end();
  EXPECT_TRUE(second->ended && second->whole);
  EXPECT_FALSE(recorder.lost());
  expect_replays(first->file, first->steps);
  expect_replays(second->file, second->steps);
  EXPECT_EQ(first->steps.back().first, 2U);
  EXPECT_EQ(second->steps.front(), StepName(3, 1));
  EXPECT_EQ(second->steps.back().first, 4U);
  std::vector<StepName> all = first->steps;
  all.insert(all.end(), second->steps.begin(), second->steps.end());
  expect_all_once(all);
  EXPECT_EQ(all.size(), session->statistics().deadlines.steps) << "no step is lost";
  EXPECT_THROW(static_cast<void>(replay(second->file)), std::runtime_error) << "it is encrypted";
}

// The first one is not encrypted, the second one is a patient's.
TEST_F(NextRecordings, NothingOfTheNextStationIsInTheRecordingBeforeIt) {
  begin();
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  EXPECT_EQ(replace(order_with(number, "pinch_ball")), "");
  ASSERT_TRUE(until_running());
  pass(1.0);
  end();
  const mcap::ReadableFile file(first->file);
  mcap::McapReader reader(file);
  std::uint64_t last_step = 0;
  std::uint64_t last_pose = 0;
  std::size_t setups = 0;
  for (mcap::Message message; reader.next(message);) {
    const std::string_view schema = reader.schema_of(message.channel);
    if (schema == "phalanx.wire.Step") last_step = std::max(last_step, message.time);
    if (schema == "phalanx.wire.Tick" || schema == "foxglove.FrameTransforms")
      last_pose = std::max(last_pose, message.time);
    setups += schema == "phalanx.wire.Setup" ? 1U : 0U;
    EXPECT_EQ(message.data.find("pinch_ball"), std::string_view::npos) << schema;
  }
  EXPECT_EQ(setups, 1U);
  EXPECT_GT(last_pose, 0U);
  EXPECT_LE(last_pose, last_step);
}

TEST_F(NextRecordings, AnEventIsInTheRecordingOfItsMoment) {
  begin();
  ASSERT_TRUE(until_running());
  recorder.event("marker", "", "before");
  const auto own_last = [](const StepRecord&) {};
  const std::uint64_t number = recorder.next_recording(
      {.settings = to(true),
       .watch =
           [&](const fs::path&) {
             recorder.event("marker", "", "begins");
             return RecordingWatch{.on_step = own_last,
                                   .on_last = [&] { recorder.event("marker", "", "ends"); },
                                   .on_ended = watch(second).on_ended};
           },
       .on_ready = {},
       .on_refused = {}});
  EXPECT_EQ(replace(order_with(number)), "");
  ASSERT_TRUE(until([&] { return first->ended.load(); }));
  ASSERT_TRUE(until_running());
  recorder.event("marker", "", "during");
  const auto third = std::make_shared<Reported>();
  EXPECT_EQ(replace(order_with(ask_next(third, to(false)))), "");
  ASSERT_TRUE(until([&] { return second->ended.load(); }));
  recorder.event("marker", "", "after");
  end();
  EXPECT_THAT(events_of(first->file), ElementsAre("before"));
  EXPECT_THAT(events_of(second->file), ElementsAre("begins", "during", "ends"));
  EXPECT_THAT(events_of(third->file), ElementsAre("after"));
}

TEST_F(NextRecordings, OnlyTheOrderedStationBeginsIt) {
  begin();
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  ASSERT_TRUE(until([&] { return second->ready.load(); }));
  EXPECT_EQ(load("pinch_ball"), "");
  EXPECT_EQ(replace(order_with(0)), "");
  EXPECT_EQ(replace(order_with(number + 1)), "") << "of another number";
  ASSERT_TRUE(until_running());
  EXPECT_FALSE(second->begun);
  EXPECT_FALSE(replace({.scene = "no_such_scene", .recording = number}).empty());
  EXPECT_TRUE(recorder.cancel_recording(number));
  EXPECT_FALSE(recorder.cancel_recording(number)) << "once";
  ASSERT_TRUE(until([&] { return files().size() == 1; })) << "its file is removed";
  EXPECT_EQ(replace(order_with(number)), "");
  ASSERT_TRUE(until_running());
  pass(0.3);
  EXPECT_FALSE(second->begun);
  EXPECT_EQ(second->why(), "");
  end();
  expect_replays(first->file, first->steps);
  expect_all_once(first->steps);
  EXPECT_EQ(first->steps.back().first, 5U);
}

TEST_F(NextRecordings, ALaterOrderCancelsTheOneThatWaits) {
  begin();
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  ASSERT_TRUE(until([&] { return second->ready.load(); }));
  const auto third = std::make_shared<Reported>();
  const std::uint64_t later = ask_next(third, to(true));
  EXPECT_EQ(later, number + 1);
  EXPECT_FALSE(recorder.cancel_recording(number));
  EXPECT_EQ(replace(order_with(later)), "");
  ASSERT_TRUE(until([&] { return third->begun.load(); }));
  EXPECT_FALSE(recorder.cancel_recording(later)) << "it has begun";
  end();
  EXPECT_FALSE(second->begun);
  EXPECT_THAT(files(), SizeIs(2));
  expect_replays(third->file, third->steps);
}

TEST_F(NextRecordings, ThatCannotBeginAreRefusedAndTheStepsGoOnInTheOneBefore) {
  begin();
  ASSERT_TRUE(until_running());
  RecorderSettings no_room = to(true);
  no_room.least_room = std::uint64_t{1} << 62U;
  const std::uint64_t number = ask_next(second, no_room);
  ASSERT_TRUE(until([&] { return !second->why().empty(); }));
  EXPECT_THAT(second->why(), HasSubstr("MB of room left"));
  EXPECT_FALSE(second->ready);
  EXPECT_FALSE(recorder.cancel_recording(number));
  EXPECT_EQ(replace(order_with(number)), "");
  ASSERT_TRUE(until_running());
  pass(0.3);
  EXPECT_FALSE(second->begun);
  const auto third = std::make_shared<Reported>();
  static_cast<void>(ask_next(third, to(true)));
  ASSERT_TRUE(until([&] { return third->ready.load(); }));
  end();
  EXPECT_EQ(third->why(), "the station has ended");
  EXPECT_THAT(files(), SizeIs(1));
  EXPECT_EQ(first->steps.back().first, 2U);
  expect_replays(first->file, first->steps);
  std::vector<std::string> notes;
  while (const auto note = recorder.next_note()) notes.push_back(note->complaint);
  EXPECT_THAT(notes, SizeIs(2));
  EXPECT_THAT(notes, Each(HasSubstr("the next recording cannot begin")));
  EXPECT_FALSE(recorder.lost()) << "nothing is missing";
}

TEST_F(NextRecordings, OfASessionThatRecordedNothingBegin) {
  begin(false);
  ASSERT_TRUE(until_running());
  EXPECT_FALSE(recorder.recording());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  EXPECT_EQ(load("pinch_ball"), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(replace(order_with(ask_next(second, to(true)))), "");
  ASSERT_TRUE(until_running());
  pass(0.5);
  end();
  EXPECT_FALSE(first->ended) << "there was no recording";
  EXPECT_TRUE(first->last);
  ASSERT_TRUE(second->whole);
  expect_replays(second->file, second->steps);
  EXPECT_EQ(second->steps.front(), StepName(3, 1));
}

TEST_F(NextRecordings, ADiskThatRefusesTheEndForAWhileLosesNothing) {
  begin();
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  ASSERT_TRUE(until([&] { return second->ready.load(); }));
  {
    const FullDisk full;
    EXPECT_EQ(replace(order_with(number)), "");
    ASSERT_TRUE(until([&] { return second->begun.load(); }));
    pass(2.0);
    EXPECT_FALSE(first->ended);
    EXPECT_EQ(session->view().state, SafetyState::kRunning);
  }
  ASSERT_TRUE(until([&] { return first->ended.load(); }));
  EXPECT_TRUE(first->whole);
  pass(0.5);
  end();
  EXPECT_FALSE(recorder.lost());
  expect_replays(first->file, first->steps);
  expect_replays(second->file, second->steps);
}

TEST_F(NextRecordings, ADiskThatRefusesTheEndForLongLeavesItTornAndTheNextOneGoesOn) {
  begin();
  ASSERT_TRUE(until_running());
  const std::uint64_t number = ask_next(second, to(true));
  ASSERT_TRUE(until([&] { return second->ready.load(); }));
  pass(1.0);
  {
    const FullDisk full;
    EXPECT_EQ(replace(order_with(number)), "");
    ASSERT_TRUE(until([&] { return first->ended.load(); }));
  }
  EXPECT_FALSE(first->whole);
  EXPECT_TRUE(recorder.lost());
  const auto note = recorder.next_note();
  ASSERT_TRUE(note);
  EXPECT_THAT(note->complaint, HasSubstr("the recording has no end"));
  EXPECT_EQ(recording_state(summarise_recording(first->file)), "no end: repair");
  pass(0.5);
  end();
  EXPECT_TRUE(second->whole);
  expect_replays(second->file, second->steps);
}

// Orders, changes and stations at arbitrary times.
TEST_F(NextRecordings, OfARandomCourseHaveEachStepOnce) {
  constexpr std::uint64_t kSeed = 2511;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  begin();
  ASSERT_TRUE(until_running());
  std::vector<std::shared_ptr<Reported>> all = {first};
  for (int i = 0; i < 5; ++i) {
    pass(1e-3 * static_cast<double>(random() % 300));
    if (random() % 2 == 0) {
      EXPECT_EQ(set({{"force.stiffness_n_per_mm", random() % 2 == 0 ? "0.3" : "0.6"}}), "");
    }
    if (random() % 3 == 0) {
      EXPECT_EQ(load("first_touch"), "");
    }
    if (random() % 2 == 0) session->stop();
    all.push_back(std::make_shared<Reported>());
    const std::uint64_t number = ask_next(all.back(), to(i % 2 == 0));
    if (random() % 2 == 0) pass(1e-3 * static_cast<double>(random() % 50));
    EXPECT_EQ(replace(order_with(number)), "");
    if (session->held_stopped()) {
      EXPECT_TRUE(session->resume());
    }
    ASSERT_TRUE(until([&] { return all.back()->begun.load(); }));
  }
  end();
  std::vector<StepName> steps;
  for (const auto& each : all) {
    ASSERT_TRUE(each->whole);
    expect_replays(each->file, each->steps);
    steps.insert(steps.end(), each->steps.begin(), each->steps.end());
  }
  expect_all_once(steps);
  EXPECT_EQ(steps.size(), session->statistics().deadlines.steps);
}

TEST(NextRecording, NeedsASessionThatKeepsItsChanges) {
  RunRecorder recorder("", fs::temp_directory_path());
  EXPECT_THROW(static_cast<void>(recorder.next_recording({})), std::invalid_argument) << "it has not begun";
  EXPECT_FALSE(recorder.cancel_recording(0));
  EXPECT_FALSE(recorder.recording());
}

}  // namespace
}  // namespace phalanx::test
