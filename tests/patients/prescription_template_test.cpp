// SPDX-License-Identifier: Apache-2.0
// The shipped templates of prescriptions, and what a file of one may state.
#include "phalanx/patients/prescription_template.h"

#include <gmock/gmock.h>

#include <string>

#include "phalanx/exercise/exercise.h"
#include "phalanx/patients/prescribed_line.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kHead = "format = 1\ntitle = \"x\"\n";

void template_refused(const std::string& text, const std::string& place, const std::string& why) {
  try {
    static_cast<void>(parse_prescription_template(text, "mine.toml"));
    ADD_FAILURE() << "not refused: " << text;
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr(place)) << text;
    EXPECT_THAT(error.what(), HasSubstr(why)) << text;
  }
}

TEST(PrescriptionTemplates, AreFourAndEachLineIsPermittedByItsExercise) {
  EXPECT_THAT(prescription_template_names(), ElementsAre("assessment_day", "mild", "moderate", "severe"));
  const std::vector<PrescriptionTemplate> all = list_prescription_templates();
  ASSERT_THAT(all, SizeIs(4));
  for (const PrescriptionTemplate& each : all) {
    EXPECT_FALSE(each.lines.empty()) << each.name;
    for (const PrescribedExercise& line : each.lines) {
      EXPECT_EQ(check_prescribed(line), "") << each.name;
      const bool training = load_exercise(line.exercise).kind == ExerciseKind::kTraining;
      EXPECT_EQ(training, each.name != "assessment_day") << each.name << ": " << line.exercise;
    }
  }
}

TEST(PrescriptionTemplates, GetMoreCarefulFromMildToSevere) {
  const auto minutes = [](const char* name) {
    double sum = 0.0;
    for (const PrescribedExercise& line : load_prescription_template(name).lines) sum += line.minutes_per_day;
    return sum;
  };
  EXPECT_EQ(minutes("mild"), 40.0);
  EXPECT_EQ(minutes("moderate"), 25.0);
  EXPECT_EQ(minutes("severe"), 10.0);
}

TEST(PrescriptionTemplates, HaveTheKeysOfAPrescription) {
  const PrescriptionTemplate made = parse_prescription_template(
      kHead +
          "[[line]]\nexercise = \"train_press\"\nrepetitions_per_day = 20\nminutes_per_day = 7.5\n"
          "trials = 12\ntarget_success = 0.6\ndifficulty = 0.25\npain_limit = 3\nfatigue_limit = 6\nnote = "
          "\"slowly\"\n",
      "folder/mine.toml");
  EXPECT_EQ(made.name, "mine");
  ASSERT_THAT(made.lines, SizeIs(1));
  EXPECT_EQ(prescribed_exercise_line(made.lines[0]),
            "train_press difficulty=0.25 fatigue_limit=6 pain_limit=3 target_success=0.6 trials=12 "
            "most_repetitions=20 most_minutes=7.5");
  EXPECT_EQ(made.lines[0].note, "slowly");
}

TEST(PrescriptionTemplates, AreRefusedWithFileLineAndRemedy) {
  template_refused("format = 2\ntitle = \"x\"\n", "mine.toml:1", "format 1");
  template_refused(kHead + "[[line]]\nexercise = \"train_press\"\nrepetitons_per_day = 3\n", "mine.toml:5",
                   "repetitions_per_day");
  template_refused(kHead + "[[line]]\nexercise = \"train_press\"\nrepetitions_per_day = 3.5\n", "mine.toml:5",
                   "whole number");
  template_refused(kHead + "[[line]]\nexercise = \"train_pres\"\n", "mine.toml:4", "train_press");
  template_refused(kHead + "[[line]]\nexercise = \"train_press\"\nminutes_per_day = 200\n", "mine.toml:4",
                   "most_minutes");
  template_refused(kHead + "[[line]]\nexercise = \"press_and_hold\"\ntrials = 3\n", "mine.toml:4", "trials");
  template_refused(kHead + "[[line]]\nexercise = \"train_press\"\n[[line]]\nexercise = \"train_press\"\n",
                   "mine.toml:6", "one line");
  template_refused("title", "mine.toml:1", "");
}

TEST(PrescriptionTemplates, ReplaceTheLinesOfTheirExercisesAndLeaveTheOthers) {
  Patient patient;
  for (const char* line : {"feel_and_find most_minutes=5", "train_press most_minutes=1"})
    patient.prescription.push_back(prescribed_exercise_of_line(line));
  const PrescriptionTemplate severe = load_prescription_template("severe");
  take_prescription_template(patient, severe);
  take_prescription_template(patient, severe);
  ASSERT_THAT(patient.prescription, SizeIs(3));
  EXPECT_EQ(patient.prescription[0].exercise, "feel_and_find");
  EXPECT_EQ(patient.prescription[1].minutes_per_day, 5.0);
  EXPECT_EQ(patient.prescription[2].exercise, "train_opposition");
}

}  // namespace
}  // namespace phalanx
