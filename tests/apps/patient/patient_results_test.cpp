// SPDX-License-Identifier: Apache-2.0
// phalanx patient results | trend | show, with results that a registry has already.
#include "apps/patient/registry_program.h"
#include "phalanx/registry/registry.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kDay = 86400.0;            // [s]
constexpr double kFirstDay = 1777852800.0;  // 2026-05-04T00:00:00Z [s]

class CliPatientResults : public testing::RegistryProgram {
 protected:
  void SetUp() override { done("patient add P07 --side left"); }

  /// Adds results to the registry of the commands.
  void add(const std::vector<ResultRow>& rows) const {
    RegistrySettings settings;
    settings.folder = folder / "data";
    Registry registry(settings, KeyStore::open(folder / "keys/patients"));
    const Patient patient = registry.patient(Actor::owner(), "P07");
    for (const ResultRow& row : rows) registry.add_result(Actor::owner(), patient.record, row);
  }
  /// @returns an assessment on a day after the first one, with one score
  static ResultRow assessment(const std::string& name, int day, const Score& score) {
    ResultRow row;
    row.recording = fmt::format("{}-{}.mcap.enc", name, day);
    row.exercise = name;
    row.assessment = true;
    row.date = kFirstDay + day * kDay;
    row.scores = {score};
    row.conditions.device = "glove";
    row.conditions.serial = "0001";
    row.repetitions = 3;
    row.seconds = 40.0;
    return row;
  }
  /// @returns sessions of a training with 10 counted trials each
  static std::vector<ResultRow> trainings(int sessions, int successes) {
    std::vector<ResultRow> rows;
    for (int session = 0; session < sessions; ++session) {
      ResultRow row =
          assessment("train_press", session, {.name = "mean_n", .unit = "N", .value = 2.0, .invalid = {}});
      row.assessment = false;
      row.repetitions = 10;
      row.successes = successes;
      row.detail = "{\"counted\":10}";
      rows.push_back(row);
    }
    return rows;
  }
};

TEST_F(CliPatientResults, StateTheOriginOfEachScoreOrWhyItHasNoValue) {
  ResultRow row =
      assessment("press_and_hold", 0, {.name = "mean_n", .unit = "N", .value = 2.25, .invalid = {}});
  row.scores[0].origin = ScoreOrigin::kRendered;
  row.scores.push_back({.name = "tam_index_deg", .unit = "deg", .value = 231.5, .invalid = {}});
  row.scores.push_back({.name = "tam_ring_deg",
                        .unit = "deg",
                        .invalid = "not measured: the ring finger copies the index finger"});
  ResultRow broken = assessment("pinch", 1, {.name = "hold_s", .unit = "s", .invalid = "steps are missing"});
  broken.valid = false;
  broken.invalid = "steps are missing";
  add({row, broken});
  const std::string results = said("patient results P07");
  EXPECT_THAT(results,
              AllOf(StartsWith("0 2026-05-04  press_and_hold (assessment), complete, 3 trials, 40 s"),
                    HasSubstr("    mean_n = 2.25 N (rendered)\n"),
                    HasSubstr("    tam_index_deg = 231.5 deg (measured)\n"),
                    HasSubstr("    tam_ring_deg: not measured: the ring finger copies the index finger\n"),
                    HasSubstr("pinch (assessment), not valid: steps are missing")));
  EXPECT_THAT(said("patient results P07 --exercise pinch"), Not(HasSubstr("press_and_hold")));
  EXPECT_THAT(said("patient results P07 --json"),
              AllOf(StartsWith("0 [{"), HasSubstr("\"origin\":\"rendered\"")));
}

TEST_F(CliPatientResults, MakeTrendsOfEqualConditionsThatProveNothingWithoutADifference) {
  const Score first{.name = "mean_n", .unit = "N", .value = 2.0, .invalid = {}};
  const Score second{.name = "mean_n", .unit = "N", .value = 9.0, .invalid = {}};
  ResultRow other = assessment("press_and_hold", 60, second);
  other.conditions.serial = "0002";
  add({assessment("press_and_hold", 0, first), assessment("press_and_hold", 28, second), other});
  const std::string trends = said("patient trend P07");
  EXPECT_THAT(trends,
              HasSubstr("press_and_hold/mean_n: change not proven: +7 N from 2026-05-04 to 2026-06-01"));
  EXPECT_THAT(trends, HasSubstr("not joined with the earlier values: another serial number"));
  EXPECT_THAT(trends, HasSubstr("measured; device glove 0002"));
  EXPECT_THAT(trends, Not(HasSubstr("improved")));
}

TEST_F(CliPatientResults, TellWhenATrainingIsOutOfItsRangeAfterTenSessions) {
  add(trainings(9, 2));
  EXPECT_THAT(said("patient trend P07"),
              HasSubstr("train_press, training: not judged: 9 of 10 sessions were done\n"));
  EXPECT_THAT(said("patient show P07"), Not(HasSubstr("attention:")));
  add(trainings(10, 2));  // nine of them are known
  EXPECT_THAT(said("patient trend P07"),
              HasSubstr("train_press, training: out of range after 10 sessions: success in "
                        "6 of 30 trials (20 %"));
  EXPECT_THAT(
      said("patient show P07"),
      AllOf(HasSubstr("attention:         train_press: out of range after 10"), HasSubstr("10 results")));
  EXPECT_THAT(said("patient trend P07"), Not(HasSubstr("train_press/"))) << "a training makes no trend";
}

TEST_F(CliPatientResults, ShowTheMeasuredEntryCheckBesideTheOneOfTheHand) {
  done("patient edit P07 --entry-check 20,10 --entry-date 2026-05-04");
  ResultRow row = assessment(
      "entry_check", 3, {.name = "entry_flexion_index_deg", .unit = "deg", .value = 50.0, .invalid = {}});
  row.scores.push_back({.name = "entry_flexion_ring_deg", .unit = "deg", .value = 41.0, .invalid = {}});
  row.scores.push_back({.name = "entry_release_index_deg", .unit = "deg", .value = 33.0, .invalid = {}});
  add({row});
  EXPECT_THAT(
      said("patient show P07"),
      AllOf(
          HasSubstr("entry check:       flexion 41.0 deg, release 33.0 deg: suitable (measured, 2026-05-07, "
                    "entry_check-3.mcap.enc)\n"),
          HasSubstr("entry check:       flexion 20.0 deg, release 10.0 deg: not suitable on this device (it "
                    "resists, it does not assist) (entered by hand, 2026-05-04)\n")));
}

TEST_F(CliPatientResults, MakeAReportAndAFhirBundleAsFilesOfTheirOwner) {
  Score score{.name = "mean_force_n", .unit = "N", .value = 3.0625, .invalid = {}};
  add({assessment("press_and_hold", 0, score), assessment("press_and_hold", 7, score)});
  testing::write_file(folder / "report.html", "an earlier report that all may read");
  std::filesystem::permissions(folder / "report.html", std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  done("patient report P07 --lang de --output report.html");
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html.partial"));
  const std::string page = testing::read_file(folder / "report.html");
  EXPECT_THAT(page, AllOf(StartsWith("<!DOCTYPE html>"), HasSubstr("P07"), HasSubstr("data-value=\"3.0625\""),
                          HasSubstr("kein Medizinprodukt")));
  const auto mode = std::filesystem::status(folder / "report.html").permissions();
  EXPECT_EQ(mode, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  EXPECT_THAT(said("patient report P07 --day 2026-05-04"),
              AllOf(StartsWith("0 <!DOCTYPE"), HasSubstr("Session report")));
  EXPECT_THAT(said("patient fhir P07"),
              AllOf(StartsWith("0 {"), HasSubstr("\"Bundle\""), HasSubstr("3.0625")));
}

TEST_F(CliPatientResults, ReportsOfUnknownPatientsDaysAndPlacesAreRefusedInWords) {
  for (const std::string command : {"report", "fhir"}) {
    EXPECT_THAT(said("patient " + command + " P99"), AllOf(StartsWith("2 "), HasSubstr("P99")));
    EXPECT_THAT(said("patient " + command + " P07 --day 2026-05-04"),
                AllOf(StartsWith("2 "), HasSubstr("nothing was done")));
    EXPECT_THAT(said("patient " + command + " P07 --day monday"),
                AllOf(StartsWith("2 "), HasSubstr("a date")));
    EXPECT_THAT(said("patient " + command + " P07 --output nowhere/x"),
                AllOf(StartsWith("2 "), HasSubstr("nowhere/x")));
    EXPECT_THAT(said("patient " + command + " P07 --output data/x"),
                AllOf(StartsWith("2 "), HasSubstr("data/x"), HasSubstr("data folder")));
    EXPECT_THAT(said("patient " + command + " P07 --output keys"),
                AllOf(StartsWith("2 "), HasSubstr("no file")));
  }
  EXPECT_THAT(said("patient report P07 --lang fr"), StartsWith("2 "));
}

TEST_F(CliPatientResults, ATemplateIsPrescribedAndAnUnknownOneIsRefused) {
  done("patient edit P07 --prescribe 'feel_and_find most_minutes=5' --template severe");
  EXPECT_THAT(said("patient show P07"),
              AllOf(HasSubstr("feel_and_find"), HasSubstr("train_press"), HasSubstr("pain_limit=3")));
  EXPECT_THAT(said("patient edit P07 --template sever"), AllOf(StartsWith("2 "), HasSubstr("severe")));
}

}  // namespace
}  // namespace phalanx
