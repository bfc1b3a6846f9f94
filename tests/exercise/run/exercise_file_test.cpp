// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/exercise_file.h"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include "exercise/run/exercise_fixture.h"
#include "phalanx/core/random.h"
#include "phalanx/scene/scene_file.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

constexpr const char* kPress = R"(format = 1
title = "Press"
kind = "assessment"
measure = "press_and_hold"
scene = "index_ball"
digits = "index middle"
instruction = "Press."
trials = 4
target = 0.3
[limits]
stiffness_n_per_mm = 0.3
)";

TEST(ExerciseFile, IsReadInSiUnits) {
  const ExerciseDescription exercise = parse_exercise(kPress, "folder/press.toml");
  EXPECT_EQ(exercise.name, "press");
  EXPECT_EQ(exercise.trials, 4);
  EXPECT_DOUBLE_EQ(exercise.limits.stiffness.value_or(0.0), 300.0);
  EXPECT_EQ(exercise.digits, (std::array<bool, kDigits>{false, true, true, false, false}));
}

TEST(ExerciseFile, RefusesWithPlaceKeyValueAndRemedy) {
  const auto parse = [](std::string text) { static_cast<void>(parse_exercise(text, "a.toml")); };
  const std::string press = kPress;
  expect_scene_error([&] { parse(press + "colour = 3\n"); }, {"a.toml:12", "colour"});
  expect_scene_error([&] { parse("trails = 3\n" + press); }, {"a.toml:1", "trails", "trials"});
  expect_scene_error([&] { parse("rate_hz = 1\n" + press); },
                     {"a.toml:1", "rate_hz", "does not have this key"});
  expect_scene_error([&] { parse("trial_s = 100\n" + press); }, {"a.toml:1", "trial_s = 100", "<= 60"});
  expect_scene_error([&] { parse("trials = 2.5\n" + press.substr(0, press.find("trials")) + "\n"); },
                     {"trials = 2.5", "whole number"});
  expect_scene_error([&] { parse("format = 2\n"); }, {"a.toml:1", "format = 2", "reads format 1"});
  expect_scene_error([&] { parse(press + "[difficulty]\nstart = 0.5\n"); }, {"difficulty"});
  expect_scene_error([&] { parse("format = 1\n"); }, {"title"});
  expect_scene_error([&] { parse("x = ["); }, {"a.toml:1"});
}

TEST(ExerciseFile, ReadsWhatItWritesOfEveryMeasureExactly) {
  Random random(20261129);
  for (int i = 0; i < 40 * kExerciseMeasures; ++i) {
    ExerciseDescription exercise = small_exercise(static_cast<ExerciseMeasure>(i % kExerciseMeasures));
    exercise.name = "any";
    exercise.trial_s = random.between(6.0, 60.0);
    exercise.rest_s = random.between(0.0, 120.0);
    exercise.limits.stiffness = random.between(50.0, 20'000.0);
    if (exercise.measure == ExerciseMeasure::kFeelAndFind) exercise.feel.deep = random.between(1e-3, 0.02);
    if (exercise.measure == ExerciseMeasure::kEntryCheck) exercise.entry.flexion = random.between(0.0, 3.0);
    for (ObjectChoice& object : exercise.objects) object.size = random.between(0.02, 0.12);
    // A number that came from a file in the key's unit is written exactly; these are rounded to one at first.
    const ExerciseDescription first = parse_exercise(exercise_text(exercise), "any.toml");
    EXPECT_EQ(parse_exercise(exercise_text(first), "any.toml"), first) << exercise_text(first);
    EXPECT_EQ(exercise_text(first), exercise_text(exercise));
  }
  ExerciseDescription training = small_training();
  training.name = "any";
  EXPECT_EQ(parse_exercise(exercise_text(training), "any.toml"), training) << exercise_text(training);
  training.success->at_most = true;
  EXPECT_EQ(parse_exercise(exercise_text(training), "any.toml"), training);
}

TEST(ExerciseFile, ShippedExercisesAreGoodAndThereIsOneOfEveryMeasure) {
  std::set<ExerciseMeasure> measures;
  int trainings = 0;
  const std::vector<ExerciseInfo> exercises = list_exercises();
  EXPECT_GE(exercises.size(), 12U);
  for (const ExerciseInfo& info : exercises) {
    SCOPED_TRACE(info.name);
    ASSERT_TRUE(info.readable) << info.title;
    EXPECT_FALSE(info.exercise.title_de.empty()) << info.name;
    EXPECT_THAT(problems_of_exercise(info.name), testing::IsEmpty());
    EXPECT_EQ(parse_exercise(exercise_text(info.exercise), "again.toml"), info.exercise);
    measures.insert(info.exercise.measure);
    if (info.exercise.kind == ExerciseKind::kTraining) ++trainings;
    PersonLimits person = able_person();
    EXPECT_NO_THROW(ExerciseRun(info.exercise, person, 1));
  }
  EXPECT_EQ(measures.size(), static_cast<std::size_t>(kExerciseMeasures));
  EXPECT_GE(trainings, 3);
  EXPECT_THROW(static_cast<void>(load_exercise("presss")), SceneError);
}

TEST(ExerciseFile, APinchNeedsASceneWhoseContactsSlide) {
  ExerciseDescription exercise = load_exercise("pinch");
  SceneDescription scene = load_scene(exercise.scene, {});
  EXPECT_TRUE(apply_exercise(scene, exercise, able_person()).detects_slips);
  SceneDescription fixed = load_scene("pinch_ball", {});
  EXPECT_FALSE(apply_exercise(fixed, exercise, able_person()).detects_slips);
  exercise.scene = "pinch_ball";
  const std::string file = testing::TempDir() + "pinch_on_static_contacts.toml";
  std::ofstream(file) << exercise_text(exercise);
  EXPECT_THAT(problems_of_exercise(file), testing::ElementsAre(testing::HasSubstr("contact.mode")));
}

TEST(ExerciseFile, ReadsOrRefusesAnyBytes) {
  constexpr std::uint64_t kSeed = 20261130;
  Random random(kSeed);
  SCOPED_TRACE(kSeed);
  std::vector<std::string> texts;
  for (const ExerciseInfo& info : list_exercises()) texts.push_back(exercise_text(info.exercise));
  texts.push_back(person_limits_text(able_person()));
  int accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = texts[static_cast<std::size_t>(i) % texts.size()];
    const int changes = 1 + static_cast<int>(random.between(0.0, 2.0));
    for (int k = 0; k < changes && !text.empty(); ++k) {
      const auto at = static_cast<std::size_t>(random.between(0.0, static_cast<double>(text.size())));
      const double draw = random.uniform();
      if (draw < 0.4)
        text[at] = static_cast<char>(static_cast<unsigned char>(random.between(0.0, 256.0)));
      else if (draw < 0.6)
        text.erase(at, static_cast<std::size_t>(random.between(1.0, 20.0)));
      else if (draw < 0.8)
        text.insert(at, text.substr(text.size() / 2, 10));
      else
        text.insert(at, 1, "[]\"=\n.-e0"[static_cast<std::size_t>(random.between(0.0, 10.0))]);
    }
    try {
      const ExerciseDescription exercise = parse_exercise(text, "bytes.toml");
      EXPECT_NO_THROW(check_exercise(exercise));
      ++accepted;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
    try {
      static_cast<void>(parse_person_limits(text, "bytes.toml"));
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  }
  EXPECT_GT(accepted, 100);
}

TEST(PersonLimitsText, ReadsWhatItWritesExactly) {
  EXPECT_EQ(parse_person_limits(person_limits_text({}), "p"), PersonLimits{});
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    PersonLimits person;
    for (auto& force : person.own_force)
      if (random.uniform() < 0.7) force = random.between(0.0, 40.0);
    for (auto& range : person.own_range)
      if (random.uniform() < 0.7) range = OwnRange{.min = random.between(-1.0, 0.0), .max = random.uniform()};
    person.felt[3] = random.uniform() < 0.5;
    person.calibration_independent = random.uniform() < 0.5;
    person.minutes_today = random.between(0.0, 20.0);
    if (random.uniform() < 0.5) person.difficulty = random.uniform();
    EXPECT_EQ(parse_person_limits(person_limits_text(person), "p"), person);
  }
  expect_scene_error([] { static_cast<void>(parse_person_limits("format = 1\n", "p")); }, {"felt"});
}

/// Hash of an assessment after changes.
std::string protocol_of(ExerciseMeasure measure,
                        const std::function<void(ExerciseDescription&)>& change_exercise,
                        const std::function<void(PersonLimits&)>& change_person = {},
                        const Overrides& more = {}) {
  ExerciseDescription exercise = small_exercise(measure);
  PersonLimits person = able_person();
  Overrides values = {{"objects.0.kind", "\"sphere\""}, {"force.stiffness_n_per_mm", "0.5"}};
  values.insert(values.begin(), more.begin(), more.end());
  if (change_exercise) change_exercise(exercise);
  if (change_person) change_person(person);
  return assessment_protocol(exercise, person, values);
}

TEST(AssessmentProtocol, IsOfTheFixedConditionsAlone) {
  constexpr ExerciseMeasure kPressed = ExerciseMeasure::kPressAndHold;
  const std::string same = protocol_of(kPressed, {});
  EXPECT_THAT(same, testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(protocol_of(kPressed,
                        [](ExerciseDescription& exercise) {
                          exercise.title = "another title";
                          exercise.title_de = "ein anderer Titel";
                          exercise.instruction = "Do the same.";
                          exercise.dose = {.repetitions = 7, .minutes = 3.0};
                          exercise.ratings.pain = 3;
                          exercise.scene = "folder/index_ball.toml";
                        }),
            same);
  EXPECT_EQ(protocol_of(kPressed, {},
                        [](PersonLimits& person) {
                          person.own_force.fill(6.0);
                          person.own_range[3] = OwnRange{.min = 0.1, .max = 0.9};
                          person.repetitions_today = 5;
                          person.minutes_today = 2.0;
                          person.stable_stiffness.reset();
                        }),
            same)
      << "targets are shares of what the person can do";
  EXPECT_EQ(protocol_of(kPressed, {}, {}, {{"loop.rate_hz", "500"}}), same);
  EXPECT_EQ(assessment_protocol(small_training(), able_person(), {}), "") << "a training makes no trend";
}

TEST(AssessmentProtocol, DiffersIfATrialDoes) {
  constexpr ExerciseMeasure kPressed = ExerciseMeasure::kPressAndHold;
  std::set<std::string> all = {protocol_of(kPressed, {})};
  const auto is_new = [&all](const std::string& protocol) { return all.insert(protocol).second; };
  EXPECT_TRUE(is_new(protocol_of(kPressed, [](ExerciseDescription& exercise) { exercise.trials = 3; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, [](ExerciseDescription& exercise) { exercise.trial_s = 7.0; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, [](ExerciseDescription& exercise) { exercise.target = 0.4; })));
  EXPECT_TRUE(
      is_new(protocol_of(kPressed, [](ExerciseDescription& exercise) { exercise.digits[2] = true; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, [](ExerciseDescription& exercise) { exercise.scene = "wave"; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, [](PersonLimits& person) { person.force_cap = 3.0; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, [](PersonLimits& person) { person.stiffness_cap = 300.0; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, [](PersonLimits& person) { person.felt[3] = false; })));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, {}, {{"limits.joint_torque_nm", "0.1"}})));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, {}, {{"objects.0.diameter_mm", "40"}})));
  EXPECT_TRUE(is_new(protocol_of(kPressed, {}, {}, {{"contact.mode", "\"sliding\""}})));
}

TEST(AssessmentProtocol, OfAMotionWithoutForcesDoesNotDependOnTheirLimits) {
  constexpr ExerciseMeasure kFree = ExerciseMeasure::kRangeOfMotion;
  EXPECT_EQ(protocol_of(kFree, {}, [](PersonLimits& person) { person.force_cap = 3.0; },
                        {{"limits.fingertip_force_n", "3"}}),
            protocol_of(kFree, {}));
  constexpr ExerciseMeasure kFelt = ExerciseMeasure::kFeelAndFind;
  EXPECT_NE(protocol_of(kFelt, {}, [](PersonLimits& person) { person.stable_stiffness = 800.0; }),
            protocol_of(kFelt, {}));
}

TEST(ExerciseKeys, AreWrittenWithRangeDefaultAndMeaning) {
  const std::string table = exercise_keys_markdown();
  EXPECT_THAT(table,
              testing::HasSubstr("| `trial_s` | number | s | >= 1, <= 60 | `10` | length of a trial |"));
  std::set<std::string> paths;
  for (const ExerciseKey& key : exercise_keys()) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path;
    EXPECT_FALSE(key.meaning.empty()) << key.path;
  }
}

TEST(ExerciseKeys, AreTheTableOfTheDocuments) {
  std::ifstream file(PHALANX_SOURCE_DIR "/docs/exercises.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(page.find(exercise_keys_markdown()), std::string::npos)
      << "replace the table in docs/exercises.md by:\n"
      << exercise_keys_markdown();
}

}  // namespace
}  // namespace phalanx
