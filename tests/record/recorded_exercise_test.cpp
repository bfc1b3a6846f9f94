// SPDX-License-Identifier: Apache-2.0
// Exercises are carried out on a station that is recorded, and once more from the recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/record/live_exercise.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/replay_visitor.h"
#include "phalanx/record/session_recorder.h"
#include "record/exercise/exercise_events.h"
#include "record/memory_file.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"
#include "station/session_fixture.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Press and hold with the index, in trials of 3 s.
ExerciseStart press_and_hold() {
  ExerciseStart start;
  start.exercise.name = "press_test";
  start.exercise.title = "Press \"and\" hold";
  start.exercise.measure = ExerciseMeasure::kPressAndHold;
  start.exercise.scene = "index_ball";
  start.exercise.digits = {false, true, false, false, false};
  start.exercise.instruction = "Press and hold.";
  start.exercise.trials = 2;
  start.exercise.trial_s = 3.0;
  start.exercise.rest_s = 0.5;
  for (auto& force : start.person.own_force) force = 3.0;
  start.seed = 18'446'744'073'709'551'615U;
  start.record = std::string(32, 'a');
  start.conditions = {{"device", "a \"device\" \xc3\xbc"}, {"stabiliser", "smoothing"}};
  return start;
}

/// Equal bits, NaN with NaN.
bool same_bits(const DigitArray& a, const DigitArray& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

class Exercised : public SessionFixture {
 protected:
  void record(const ExerciseStart& begun) {
    SessionSettings settings = with("sliders", begun.exercise.scene);
    settings.overrides = {{"rate_hz", "200"}};
    settings.keep_changes = true;
    start(settings);
    auto made = std::make_unique<MemoryFile>([this] { return clock.now(); });
    file = made.get();
    RecorderSettings to{.folder = {}, .least_room = 0, .metadata = recording_metadata("test")};
    if (encrypted) to.encryption = test_encryption();
    recorder = std::make_unique<SessionRecorder>(std::move(to), *session, clock, "a.mcap", std::move(made));
    live = std::make_unique<LiveExercise>(begun, 1, [this](const std::string& code, const std::string& text) {
      recorder->event(code, "", text);
    });
  }
  void own() override {
    session->poll();
    StepRecord step;
    std::vector<DeviceSample> samples;
    while (session->next_record(step, samples)) {
      records.push_back(step);
      if (!drops(step)) recorder->add(step, samples);
      live->step(step);
      observations.push_back(*live->newest());
    }
    const bool torque = live->demand().torque;
    if (torque && session->held_stopped()) static_cast<void>(session->resume());
    if (!torque && !session->held_stopped()) session->stop();
    recorder->update();
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
  }
  virtual bool drops(const StepRecord&) { return false; }
  /// Ends the session, the exercise and the recording. @returns the file
  std::string finished() {
    session->shut_down();
    own();
    live->finish();
    EXPECT_TRUE(recorder->finish());
    return file->content;
  }
  [[nodiscard]] std::filesystem::path on_disk(const std::string& bytes) const {
    const auto name = folder / (encrypted ? "recording.mcap.enc" : "recording.mcap");
    std::ofstream(name, std::ios::binary) << bytes;
    return name;
  }
  [[nodiscard]] std::vector<RecordedExercise> again(const std::string& bytes) const {
    return recorded_exercises(on_disk(bytes), test_keys());
  }
  void bend_index(double share) {
    JointArray angle = session->sliders();
    const HandParameters& hand = session->info()->geometry->hand;
    for (const int i : {0, 2, 3}) {
      const auto j = idx(joint_index(1, i));
      angle[j] = hand.open_angle[j] +
                 share * (hand.closed_angle[j].value_or(hand.max_angle[j]) - hand.open_angle[j]);
    }
    ASSERT_TRUE(session->set_sliders(angle));
  }
  /// Bends the index until it presses with more than 1 N, or is closed.
  void press() {
    for (double share = 0.2; share < 1.0; share += 0.02) {
      bend_index(share);
      pass(0.03);
      if (live->newest() && live->newest()->force[1] > 1.0) return;
    }
  }
  bool in_phase(ExercisePhase phase) {
    return until([&] { return live->view().phase == phase; });
  }
  void input(ExerciseInput::Kind kind, double value = 0.0) { live->input({.kind = kind, .value = value}); }

  const testing::TemporaryFolder folder;
  bool encrypted = false;
  std::unique_ptr<SessionRecorder> recorder;
  std::unique_ptr<LiveExercise> live;
  std::vector<Observation> observations;
  MemoryFile* file = nullptr;  ///< of the recorder
};

class ExercisedEncrypted : public Exercised {
  void SetUp() override { encrypted = true; }
};

class ExercisedWithGap : public Exercised {
 protected:
  bool drops(const StepRecord& step) override {
    return step.command.tick >= first && step.command.tick < first + 5;
  }
  std::uint64_t first = 0;
};

TEST_F(Exercised, ThroughPauseChangeAndRatingsTheReplayGivesTheSameBytes) {
  record(press_and_hold());
  pass(0.3);
  EXPECT_EQ(live->view().phase, ExercisePhase::kReady);
  EXPECT_FALSE(any_torque(session->view())) << "before it begins";
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  press();
  pass(0.2);
  input(ExerciseInput::Kind::kPause);
  ASSERT_TRUE(in_phase(ExercisePhase::kPaused));
  pass(0.5);
  EXPECT_FALSE(any_torque(session->view())) << "while it pauses";
  input(ExerciseInput::Kind::kAnswer, 1.0);
  input(ExerciseInput::Kind::kPain, 2.0);
  input(ExerciseInput::Kind::kResume);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.3"}}), "");
  ASSERT_TRUE(until([&] { return live->done(); }));
  const std::string bytes = finished();
  const std::vector<RecordedExercise> found = again(bytes);
  ASSERT_THAT(found, SizeIs(1));
  const RecordedExercise& exercise = found.front();
  EXPECT_EQ(exercise.difference, "");
  EXPECT_EQ(exercise.invalid, "");
  EXPECT_TRUE(exercise.proven());
  EXPECT_EQ(exercise.text, exercise_result_text(live->result()));
  EXPECT_EQ(exercise.recorded, exercise.text);
  const ExerciseResult read = read_exercise_result(exercise.recorded, exercise.start.exercise);
  EXPECT_EQ(exercise_result_text(read), exercise.recorded) << "read back, it is the same";
  EXPECT_THROW(static_cast<void>(read_exercise_result("{}", exercise.start.exercise)), std::runtime_error);
  EXPECT_FALSE(exercise.other_program);
  EXPECT_EQ(exercise.start.exercise, live->start().exercise);
  EXPECT_EQ(exercise.start.person, live->start().person);
  EXPECT_EQ(exercise.start.seed, live->start().seed);
  EXPECT_EQ(exercise.start.record, live->start().record);
  EXPECT_EQ(exercise.start.conditions, live->start().conditions);
  EXPECT_GT(exercise.begin_utc, 1.6e9);
  EXPECT_THAT(live->take_refusals(), SizeIs(1)) << "the answer";
  // The test would show nothing if nothing had happened.
  EXPECT_FALSE(exercise.result.interrupted);
  ASSERT_THAT(exercise.result.trials, SizeIs(3)) << "one was paused";
  EXPECT_NE(exercise.result.trials.front().invalid, "");
  EXPECT_EQ(exercise.result.trials.back().invalid, "");
  EXPECT_THAT(exercise.result.ratings, SizeIs(1));
  EXPECT_TRUE(std::any_of(observations.begin(), observations.end(), [](const Observation& o) {
    return o.force[1] > 0.5 && o.touching[1] && std::isfinite(o.sent_stiffness[1]);
  }));
}

TEST_F(Exercised, APauseBringsTheTorqueToZeroWithinTheStopsRamp) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  press();
  const auto sends_torque = [](const StepRecord& step) {
    return std::any_of(step.command.torque.begin(), step.command.torque.end(),
                       [](double t) { return t != 0.0; });
  };
  ASSERT_TRUE(sends_torque(records.back()));
  input(ExerciseInput::Kind::kPause);
  const double asked = records.back().input.time;
  pass(1.0);
  double last = asked;
  for (const StepRecord& step : records)
    if (sends_torque(step)) last = std::max(last, step.input.time);
  constexpr double kOwner = 0.02;  // for which this owner looks away, and a period of the loop [s]
  EXPECT_LE(last - asked, SafetySettings{}.stop_ramp + kOwner);
  EXPECT_GT(last, asked) << "over a ramp";
}

TEST_F(Exercised, AFaultInATrialInvalidatesItAndTheReplayDoesTheSame) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  overload();
  session->reset();
  input(ExerciseInput::Kind::kResume);
  ASSERT_TRUE(until([&] { return live->done(); }));
  const std::vector<RecordedExercise> found = again(finished());
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found.front().difference, "");
  EXPECT_TRUE(found.front().proven());
  ASSERT_THAT(found.front().result.trials, SizeIs(3));
  EXPECT_NE(found.front().result.trials.front().invalid, "");
  for (const Score& score : found.front().result.trials.front().scores)
    EXPECT_FALSE(score.valid()) << score.name;
  EXPECT_FALSE(reports.empty());
}

TEST_F(ExercisedEncrypted, TheSameFromAnEncryptedRecordingWithItsKeyOnly) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  const std::string bytes = finished();
  EXPECT_THAT(bytes, ::testing::Not(HasSubstr("exercise_begin")));
  const std::vector<RecordedExercise> found = again(bytes);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found.front().difference, "");
  EXPECT_TRUE(found.front().result.interrupted);
  EXPECT_THROW(static_cast<void>(recorded_exercises(on_disk(bytes))), std::runtime_error);
}

/// Keeps what a replay shows.
class Shown final : public ReplayVisitor {
 public:
  void step(const StepRecord& record, std::span<const DeviceSample> /*samples*/, double /*time*/) override {
    steps.push_back(record);
  }
  std::vector<StepRecord> steps;
};

TEST_F(Exercised, AReplayDescribesEachStepAsItsStationDid) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  press();
  pass(0.5);
  Shown shown;
  static_cast<void>(replay(on_disk(finished()), {}, &shown));
  ASSERT_EQ(shown.steps.size(), records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    SCOPED_TRACE(i);
    const StepRecord& live_step = records[i];
    const StepRecord& made = shown.steps[i];
    ASSERT_EQ(made.hash, live_step.hash);
    ASSERT_EQ(made.samples, live_step.samples);
    ASSERT_EQ(made.angle, live_step.angle);
    ASSERT_EQ(made.angle_origin, live_step.angle_origin);
    ASSERT_EQ(made.pad, live_step.pad);
    ASSERT_EQ(made.touching, live_step.touching);
    ASSERT_EQ(made.slips, live_step.slips);
    ASSERT_TRUE(same_bits(made.force, live_step.force));
    ASSERT_TRUE(same_bits(made.measured_force, live_step.measured_force));
    ASSERT_TRUE(same_bits(made.sent_stiffness, live_step.sent_stiffness));
    ASSERT_TRUE(same_bits(made.sent_share, live_step.sent_share));
    ASSERT_EQ(made.factor, live_step.factor);
    ASSERT_EQ(made.stiffness, live_step.stiffness);
    ASSERT_EQ(made.state, live_step.state);
  }
}

TEST_F(ExercisedWithGap, MissingStepsMakeTheWholeExerciseInvalid) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  first = records.back().command.tick + 20;
  pass(0.6);
  const std::vector<RecordedExercise> found = again(finished());
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found.front().invalid, HasSubstr("steps are missing in the recording"));
  EXPECT_FALSE(found.front().proven());
  for (const Score& score : without_scores(found.front().result, found.front().invalid).scores)
    EXPECT_FALSE(score.valid()) << score.name;
}

TEST_F(Exercised, ARecordingThatEndsBeforeTheExerciseIsNotScored) {
  record(press_and_hold());
  input(ExerciseInput::Kind::kBegin);
  ASSERT_TRUE(in_phase(ExercisePhase::kTrial));
  pass(1.0);
  const std::string torn = file->content;  // as after SIGKILL
  const std::string whole = finished();
  ASSERT_LT(torn.size(), whole.size());
  const std::filesystem::path name = on_disk(torn);
  EXPECT_THROW(static_cast<void>(recorded_exercises(name)), std::runtime_error) << "it has no end";
  EXPECT_TRUE(repair_recording(name).changed);
  const std::vector<RecordedExercise> found = recorded_exercises(name);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found.front().invalid, HasSubstr("the recording ends before the exercise"));
  EXPECT_TRUE(found.front().recorded.empty());
  EXPECT_TRUE(found.front().result.interrupted);
  EXPECT_THAT(again(whole), SizeIs(1));
}

TEST_F(Exercised, ARecordingWithoutAnExerciseHasNone) {
  record(press_and_hold());
  session->shut_down();
  ASSERT_TRUE(recorder->finish());
  EXPECT_THAT(again(file->content), IsEmpty());
}

TEST(LiveExercise, AnswersWhileAStepIsEvaluated) {
  // The recorder's thread may take long within a step: for a trial's scores, or for the disk.
  LiveExercise* live = nullptr;
  int asked = 0;
  LiveExercise exercise(press_and_hold(), 1, [&](const std::string& code, const std::string&) {
    if (code == kExerciseResult) return;
    EXPECT_EQ(live->steps(), 0U) << code;
    EXPECT_FALSE(live->done());
    EXPECT_FALSE(live->demand().torque);
    EXPECT_EQ(live->view().phase, ExercisePhase::kReady);
    EXPECT_FALSE(live->newest());
    EXPECT_THAT(live->take_refusals(), IsEmpty());
    if (++asked < 3) live->input({.kind = ExerciseInput::Kind::kAbort});
  });
  live = &exercise;
  StepRecord step;
  step.station = 1;
  step.command.tick = 1;
  exercise.step(step);
  EXPECT_GE(asked, 2) << "the beginning, and the input that was given within the step";
  EXPECT_EQ(exercise.steps(), 1U);
  EXPECT_TRUE(exercise.newest());
}

TEST(ExerciseEvents, AreReadBackAsTheyWereWritten) {
  const ExerciseBeginEvent begin{.place = {.number = 3, .station = 7, .tick = 1'000'000'000'001},
                                 .start = press_and_hold()};
  const ExerciseBeginEvent read = read_begin_event(begin_event_text(begin));
  EXPECT_EQ(read.place, begin.place);
  EXPECT_EQ(read.start.exercise, begin.start.exercise);
  EXPECT_EQ(read.start.person, begin.start.person);
  EXPECT_EQ(read.start.seed, begin.start.seed);
  EXPECT_EQ(read.start.conditions, begin.start.conditions);
  const ExerciseInputEvent input{.place = {.number = 1, .station = 2, .tick = 3},
                                 .input = {.kind = ExerciseInput::Kind::kDifficulty, .value = 0.1}};
  EXPECT_EQ(read_input_event(input_event_text(input)).input, input.input);
  EXPECT_EQ(read_input_event(input_event_text(input)).place, input.place);
  const ExerciseResultEvent result{.number = 12, .text = "{\"a\":{\"b\":[1,2]}}"};
  EXPECT_EQ(read_result_event(result_event_text(result)).text, result.text);
  EXPECT_EQ(read_result_event(result_event_text(result)).number, 12);
}

TEST(ExerciseEvents, ABrokenOneIsRefusedInWords) {
  for (const char* text : {"", "{}", "[1]", "{\"exercise\":1,\"result\":",
                           "{\"exercise\":\"x\",\"result\":{}}", "{ \"exercise\":1,\"result\":{}}"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(static_cast<void>(read_begin_event(text)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(read_input_event(text)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(read_result_event(text)), std::runtime_error);
  }
}

constexpr double kPeriod = 0.00390625;  // a power of 2, so that times are exact [s]

/// A step of a running station.
StepRecord step_at(std::uint64_t tick) {
  StepRecord record;
  record.station = 1;
  record.command.tick = tick;
  record.input.time = 10.0 + kPeriod * static_cast<double>(tick);
  record.samples = 1;
  record.state = SafetyState::kRunning;
  record.factor = 0.5;
  record.sent_share.fill(0.5);
  record.sent_share.fill(0.5);
  record.force = {0.0, 2.0, 0.0, 0.0, 0.0};
  return record;
}

TEST(HandObserver, AForceIsWhatTheRampsLeaveOfIt) {
  HandObserver observer;
  const Observation first = observer.observe(step_at(1));
  EXPECT_EQ(first.time, 0.0);
  EXPECT_EQ(first.force[1], 1.0);
  EXPECT_TRUE(first.torque_on);
  EXPECT_EQ(first.fault, ObservationFault::kNone);
  const Observation second = observer.observe(step_at(2));
  EXPECT_EQ(second.time, kPeriod);
  StepRecord stopped = step_at(3);
  stopped.state = SafetyState::kStopped;
  stopped.factor = 0.0;
  EXPECT_FALSE(observer.observe(stopped).torque_on);
}

TEST(HandObserver, NamesWhyAStepCannotBeScored) {
  const auto second = [](const std::function<void(StepRecord&)>& change) {
    HandObserver observer;
    static_cast<void>(observer.observe(step_at(1)));
    StepRecord step = step_at(2);
    change(step);
    return observer.observe(step).fault;
  };
  EXPECT_EQ(second([](StepRecord&) {}), ObservationFault::kNone);
  EXPECT_EQ(second([](StepRecord& step) { step.command.tick = 3; }), ObservationFault::kGap);
  EXPECT_EQ(second([](StepRecord& step) { step.input.time = 10.0 + kPeriod; }), ObservationFault::kGap);
  EXPECT_EQ(second([](StepRecord& step) { step.state = SafetyState::kFault; }), ObservationFault::kFault);
  EXPECT_EQ(second([](StepRecord& step) { step.angle[3] = std::numeric_limits<double>::quiet_NaN(); }),
            ObservationFault::kNotFinite);
  EXPECT_EQ(second([](StepRecord& step) { step.force[0] = std::numeric_limits<double>::infinity(); }),
            ObservationFault::kNotFinite);
  EXPECT_EQ(second([](StepRecord& step) {
              step.samples = 0;
              step.input.time += 0.2;
            }),
            ObservationFault::kNoSample);
  EXPECT_EQ(second([](StepRecord& step) {
              step.samples = 0;
              step.station = 2;
              step.command.tick = 1;
            }),
            ObservationFault::kNoSample)
      << "no sample of this station has come yet";
  EXPECT_EQ(second([](StepRecord& step) {
              step.station = 2;
              step.command.tick = 1;
            }),
            ObservationFault::kNone)
      << "another station begins";
}

}  // namespace
}  // namespace phalanx::test
