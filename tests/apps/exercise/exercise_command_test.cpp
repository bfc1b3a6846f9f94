// SPDX-License-Identifier: Apache-2.0
// phalanx exercise list | check | keys | run | results.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/exercise/changed_recording.h"
#include "apps/exercise/exercise_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

class CliExercise : public testing::ExerciseProgram {};

TEST_F(CliExercise, ListsChecksAndExplains) {
  const auto listed = run("exercise list");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_GE(std::count(listed.out.begin(), listed.out.end(), '\n'), 12);
  EXPECT_THAT(listed.out,
              AllOf(HasSubstr("range_of_motion"), HasSubstr("feel_and_find"), HasSubstr("training")));
  EXPECT_THAT(run("exercise list --markdown").out, StartsWith("| exercise | kind |"));
  EXPECT_THAT(said("exercise check press_and_hold"), StartsWith("0 press_and_hold: sound\n"));
  write_short();
  testing::write_file(folder / "broken.toml",
                      "format = 1\ntitle = \"x\"\nkind = \"assessment\"\nmeasure = \"telepathy\"\n");
  EXPECT_THAT(said("exercise check short.toml broken.toml"),
              AllOf(StartsWith("2 short.toml: sound\n"), HasSubstr("telepathy")));
  EXPECT_THAT(said("exercise keys"), AllOf(StartsWith("0 "), HasSubstr("trial_s")));
  EXPECT_THAT(said("exercise keys --markdown"), AllOf(StartsWith("0 "), HasSubstr("| `trial_s` |")));
}

TEST_F(CliExercise, RefusesWhatCannotBegin) {
  EXPECT_THAT(said("exercise run no_such"), AllOf(StartsWith("2 "), HasSubstr("no_such")));
  EXPECT_THAT(said("exercise run press_and_hold"), AllOf(StartsWith("2 "), HasSubstr("own_force")));
  EXPECT_THAT(said("exercise run range_of_motion --demo brilliant"),
              AllOf(StartsWith("2 "), HasSubstr("moderate")));
  EXPECT_THAT(said("exercise run range_of_motion --demo 1.5"),
              AllOf(StartsWith("2 "), HasSubstr("1 (healthy)")));
  EXPECT_THAT(said("exercise run range_of_motion --record off"),
              AllOf(StartsWith("2 "), HasSubstr("--record off")));
  EXPECT_THAT(said("exercise run range_of_motion --confirm P07"),
              AllOf(StartsWith("2 "), HasSubstr("--patient")));
  EXPECT_THAT(said("exercise run range_of_motion --patient P07"),
              AllOf(StartsWith("2 "), HasSubstr("no registry")));
  EXPECT_THAT(said("exercise results none.mcap"), AllOf(StartsWith("2 "), HasSubstr("none.mcap")));
  EXPECT_THAT(recordings(), IsEmpty());
}

TEST_F(CliExercise, ADemonstrationIsRecordedAndGivesTheSameResultAgain) {
  write_short();
  const auto shown = exercise("short.toml --demo 0.8 --seed 7");
  ASSERT_EQ(shown.exit_code, 0) << shown.err << shown.out;
  EXPECT_THAT(shown.out, AllOf(HasSubstr("by a simulated participant"), HasSubstr("byte for byte"),
                               HasSubstr("measured")));
  ASSERT_THAT(recordings(), SizeIs(1));
  const std::string file = recordings().front();
  const auto again = run("exercise results --quiet --trials " + file);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out,
              AllOf(StartsWith("short (assessment), "), HasSubstr("trial 2"), HasSubstr("byte for byte")));
  EXPECT_THAT(again.out, Not(HasSubstr("differs")));
  const std::string json = run("exercise results --json " + file).out;
  EXPECT_THAT(json, AllOf(StartsWith("{\"name\":\"short\""), EndsWith("}\n")));
  EXPECT_THAT(run("session export --quiet --parts events --out events " + file).exit_code, 0);
  EXPECT_THAT(testing::read_file(folder / "events/events.csv"), HasSubstr("exercise_result"));
}

TEST_F(CliExercise, AResultThatTheReplayDoesNotProveHasNoScores) {
  write_short();
  ASSERT_EQ(exercise("short.toml --demo 0.8 --seed 7").exit_code, 0);
  // The recorded result states other seconds than its steps give.
  ASSERT_EQ(testing::copy_changed(folder / recordings().front(), folder / "changed.mcap", "\"seconds\":12.",
                                  "\"seconds\":13."),
            1);
  EXPECT_THAT(
      said("exercise results --quiet changed.mcap"),
      AllOf(StartsWith("1 "), HasSubstr("not proven"), HasSubstr("differ"), Not(HasSubstr("measured"))));
  const auto json = run("exercise results --json changed.mcap");
  EXPECT_EQ(json.exit_code, 1);
  const auto result = nlohmann::json::parse(json.out);
  EXPECT_FALSE(result["scores"].empty());
  for (const auto& score : result["scores"]) {
    EXPECT_FALSE(score.contains("value")) << score;
    EXPECT_THAT(score["invalid"].get<std::string>(), HasSubstr("not proven")) << score;
  }
}

// Thumb and finger close through the grasp of the scene. By the way of a fist, the thumb slides off the ball.
TEST_F(CliExercise, AHealthyParticipantHoldsAPinchAndAWeakOneScoresLower) {
  testing::write_file(folder / "hold.toml",
                      "format = 1\ntitle = \"Hold\"\nkind = \"assessment\"\nmeasure = \"pinch\"\n"
                      "scene = \"pinch_slip\"\ndigits = \"index\"\ninstruction = \"Hold the ball.\"\n"
                      "trials = 5\ntrial_s = 6\nrest_s = 1\ntarget = 0.3\ntolerance = 0.3\n");
  const auto scores_of = [&](const std::string& skill) {
    const auto shown = exercise(fmt::format("hold.toml --demo {} --seed 5", skill));
    EXPECT_EQ(shown.exit_code, 0) << shown.err << shown.out;
    const auto result = nlohmann::json::parse(run("exercise results --json " + recordings().back()).out);
    int valid = 0;
    for (const auto& trial : result["trials"]) valid += trial.contains("invalid") ? 0 : 1;
    EXPECT_GE(valid, 4) << skill << ": " << result.dump();
    EXPECT_EQ(result["repetitions"], 5) << "no trial is repeated";
    std::map<std::string, double> scores;
    for (const auto& score : result["scores"])
      if (score.contains("value")) scores[score["name"]] = score["value"];
    std::filesystem::remove_all(folder / "rec");
    return scores;
  };
  auto healthy = scores_of("healthy");
  auto weak = scores_of("weak");
  EXPECT_GT(healthy["index_time_in_target_share"], 0.6);
  EXPECT_LT(weak["index_time_in_target_share"], healthy["index_time_in_target_share"]);
  EXPECT_GT(weak["index_grip_force_n"], 0.0);
  EXPECT_LT(weak["index_grip_force_n"], healthy["index_grip_force_n"]);
}

TEST_F(CliExercise, ObservationsHaveARowForEachStep) {
  write_short();
  ASSERT_EQ(exercise("short.toml --demo 0.8 --seed 7 --seconds 3").exit_code, 0);
  const std::string file = recordings().front();
  ASSERT_EQ(run("session export --quiet --parts steps,observations --out tables " + file).exit_code, 0);
  const auto rows = [&](const char* name) {
    const std::string text = testing::read_file(folder / "tables" / name);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_GT(rows("observations.csv"), 500);
  EXPECT_EQ(rows("observations.csv"), rows("steps.csv"));
  EXPECT_THAT(testing::read_file(folder / "tables/observations.csv"),
              StartsWith("time_s,station,tick,host_time_s,observation_fault,"));
  std::ofstream(folder / "tables/trials.json")
      << R"([{"measure":"range_of_motion","joints":["index_pip_flexion"],"calibration_independent":true},)"
         R"({"measure":"smoothness","digit":"index","least_speed":1e-9}])";
  const std::string scores = "cd '" + (folder / "tables").string() +
                             "' && /usr/bin/python3 '" PHALANX_SOURCE_DIR
                             "/tests/exercise/scores.py' observations.csv trials.json >scores.csv 2>&1";
  EXPECT_EQ(std::system(scores.c_str()), 0);  // NOLINT(cert-env33-c): the command is the test's own
  EXPECT_THAT(testing::read_file(folder / "tables/scores.csv"),
              AllOf(HasSubstr("0,0,rom_index_pip_flexion_deg,"), HasSubstr("0,1,sparc,")))
      << "scores.py reads the columns of the export";
  ASSERT_EQ(run("session export --quiet --out all " + file).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "all/observations.csv")) << "only if named";
}

TEST_F(CliExercise, APatientsResultIsKeptAndTheirCodeStandsInNoRecording) {
  write_short();
  done("patient add SIM1 --side right --symbol boat --consent yes");
  const auto run_it = exercise("short.toml --demo healthy --seed 3 --patient SIM1 --confirm SIM1");
  ASSERT_EQ(run_it.exit_code, 0) << run_it.err << run_it.out;
  EXPECT_THAT(run_it.err, HasSubstr("patient SIM1, right hand, symbol: boat"));
  EXPECT_THAT(run_it.out, HasSubstr("kept in the registry for SIM1"));
  ASSERT_THAT(recordings(), SizeIs(1));
  EXPECT_THAT(recordings().front(), EndsWith(".mcap.enc"));
  EXPECT_THAT(said("patient results SIM1"), AllOf(StartsWith("0 "), HasSubstr("short")));
  EXPECT_THAT(said("patient show SIM1"), HasSubstr("own range:")) << "the assessment has measured it";
  EXPECT_THAT(said("exercise results --quiet " + recordings().front()),
              AllOf(StartsWith("0 "), HasSubstr("byte for byte")));
  const auto plain =
      exercise("short.toml --demo healthy --seed 3 --patient SIM1 --confirm SIM1 --record-plain");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  ASSERT_THAT(recordings(), SizeIs(2));
  for (const std::string& file : files_with("SIM1")) EXPECT_THAT(file, Not(HasSubstr("rec/")));
  EXPECT_THAT(said("patient rebuild rec"), StartsWith("0 "));
  const std::string results = said("patient results SIM1");
  done("patient rebuild rec");
  EXPECT_EQ(said("patient results SIM1"), results) << "nothing is doubled";
  EXPECT_THAT(said("patient trend SIM1"),
              AllOf(StartsWith("0 "), HasSubstr("protocol "), Not(HasSubstr("not recorded")),
                    Not(HasSubstr("not joined"))));
}

TEST_F(CliExercise, TheDoseOfADayHoldsOverItsSessions) {
  testing::write_file(
      folder / "dose.toml",
      "format = 1\ntitle = \"Dose\"\nkind = \"assessment\"\nmeasure = \"range_of_motion\"\nscene = "
      "\"wave\"\ninstruction = \"Open, then close.\"\ntrials = 2\ntrial_s = 6\nrest_s = 0\n[dose]\n"
      "most_repetitions = 3\n");
  done("patient add SIM1 --side right --consent yes");
  const std::string again = "dose.toml --demo healthy --seed 3 --patient SIM1 --confirm SIM1";
  EXPECT_THAT(exercise(again).out, HasSubstr("all trials are done, 2 trials"));
  EXPECT_THAT(exercise(again).out, HasSubstr(", 1 trials")) << "the day's dose ends it while it runs";
  const auto third = exercise(again);
  EXPECT_EQ(third.exit_code, 2);
  EXPECT_THAT(third.err, HasSubstr("dose"));
}

TEST_F(CliExercise, AHandOfTheOtherSideIsRefusedBeforeThereIsAForce) {
  write_short();
  const auto write_profile = [this](const char* side) {
    testing::write_file(folder / "own.toml", fmt::format("name = \"own\"\nhandedness = \"{}\"\n", side));
  };
  write_profile("right");
  EXPECT_THAT(said("patient add SIM1 --side left --consent yes --profile ./own.toml"),
              AllOf(StartsWith("2 "), HasSubstr("it is of a right hand, and SIM1 exercises the left hand")));
  write_profile("left");
  done("patient add SIM1 --side left --consent yes --profile ./own.toml");
  write_profile("right");  // after it was bound
  const auto refused = exercise("short.toml --patient SIM1 --confirm SIM1 --demo healthy");
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_THAT(refused.err, AllOf(HasSubstr("the station has a right hand, and SIM1 exercises the left hand"),
                                 HasSubstr("--profile NAME")));
  EXPECT_THAT(recordings(), IsEmpty());
  EXPECT_THAT(said("patient edit SIM1 --side right"), HasSubstr("were of the other hand, and are gone"));
  EXPECT_THAT(said("patient show SIM1"), Not(HasSubstr("own.toml")));
}

TEST_F(CliExercise, AnEntryCheckIsJudgedByWhatTheDeviceNeedsWhateverItsFileAsksFor) {
  testing::write_file(
      folder / "lenient.toml",
      "format = 1\ntitle = \"Lenient\"\nkind = \"assessment\"\nmeasure = \"entry_check\"\nscene = "
      "\"wave\"\ndigits = \"index\"\ninstruction = \"Open, close, open.\"\ntrials = 1\ntrial_s = 3\nrest_s = "
      "0\n[entry]\nleast_flexion_deg = 0\nleast_release_deg = 0\n");
  done("patient add SIM1 --side right --consent yes");
  // A slow hand: in the last second of the trial it releases less than 20 degrees.
  const auto shown = exercise("lenient.toml --demo 0 --seed 3 --patient SIM1 --confirm SIM1");
  ASSERT_EQ(shown.exit_code, 0) << shown.err << shown.out;
  EXPECT_THAT(shown.out, HasSubstr("  suitable\n"));
  EXPECT_THAT(said("patient show SIM1"), HasSubstr("not suitable on this device"));
}

TEST_F(CliExercise, AWrongOrUnfitPatientIsRefusedBeforeThereIsAForce) {
  write_short();
  done("patient add P07 --side left --consent yes");
  done("patient add SIM1 --side left --consent yes");
  const auto refused = [&](const std::string& arguments) {
    const auto result = exercise(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.out;
    return result.err;
  };
  EXPECT_THAT(refused("short.toml --patient P07 --confirm P07 --demo healthy"),
              HasSubstr("never join those of a person"));
  EXPECT_THAT(refused("short.toml --patient P07 --confirm P07"), HasSubstr("never join those of a person"))
      << "the simulated device";
  EXPECT_THAT(refused("short.toml --patient SIM1 --demo healthy"), HasSubstr("--confirm CODE"));
  EXPECT_THAT(refused("short.toml --patient SIM1 --confirm P07 --demo healthy"),
              HasSubstr("'P07' is not the code"));
  for (const char* needs : {"train_press", "own_force", "squeeze_release", "object_in_hand"})
    EXPECT_THAT(refused(fmt::format("{} --patient SIM1 --confirm SIM1 --demo healthy", needs)),
                HasSubstr("phalanx exercise run entry_check"));
  for (const char* option : {"--calibration", "--range", "--profile"})
    EXPECT_THAT(
        refused(fmt::format("short.toml --patient SIM1 --confirm SIM1 --demo healthy {} o.toml", option)),
        HasSubstr(fmt::format("phalanx patient edit SIM1 {} o.toml", option)));
  done("patient edit SIM1 --entry-check 10,5");
  EXPECT_THAT(refused("short.toml --patient SIM1 --confirm SIM1 --demo healthy"),
              HasSubstr("not suitable on this device"));
  done("patient edit SIM1 --clear entry-check --contraindication 'open wound'");
  EXPECT_THAT(refused("short.toml --patient SIM1 --confirm SIM1 --demo healthy"), HasSubstr("open wound"));
  done("patient edit SIM1 --clear contraindications --consent no");
  EXPECT_THAT(refused("short.toml --patient SIM1 --confirm SIM1 --demo healthy"), HasSubstr("consent"));
  EXPECT_THAT(recordings(), IsEmpty());
}

}  // namespace
}  // namespace phalanx
