// SPDX-License-Identifier: Apache-2.0
// phalanx patient add | edit | list | show | test | trend | note.
#include <fmt/format.h>

#include "apps/patient/registry_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class CliPatient : public testing::RegistryProgram {
 protected:
  /// Writes a calibration of the device `glove 0001`, and a range that was measured with it.
  void write_calibration() const {
    testing::write_file(folder / "c.toml", calibration("0001", "2026-05-04T09:30:00Z"));
    testing::write_file(folder / "r.toml", range("0001", "2026-05-04T09:30:00Z", "P07"));
  }
  static std::string calibration(const std::string& serial, const std::string& date) {
    return fmt::format(
        "format = 2\ndevice = \"glove\"\nserial = \"{}\"\ndate = \"{}\"\nphalanx = "
        "\"0.1.0\"\n[[channel]]\nkind = "
        "\"angle\"\njoint = \"index_pip_flexion\"\ngain = 0.00042\noffset = -0.21\nresidual_rad = "
        "0.011\nmethod = "
        "\"goniometer\"\nposes = [ {{ name = \"a\", raw = 500, value = 0.0, residual_rad = 0.0 }}, {{ name = "
        "\"b\", "
        "raw = 3021.5, value = 1.05, residual_rad = 0.002 }} ]\n",
        serial, date);
  }
  static std::string range(const std::string& serial, const std::string& calibration_date,
                           const std::string& patient) {
    return fmt::format(
        "format = 1\ndevice = \"glove\"\nserial = \"{}\"\ncalibration = \"{}\"\npatient = \"{}\"\ndate = "
        "\"2026-05-04T09:45:00Z\"\nphalanx = \"0.1.0\"\n[joints]\nindex_pip_flexion = [2.5, 40.25]\n",
        serial, calibration_date, patient);
  }
};

TEST_F(CliPatient, AddsEditsShowsAndListsPatients) {
  EXPECT_THAT(said("patient list"), AllOf(StartsWith("2 phalanx: there is no registry of patients in data"),
                                          HasSubstr("`phalanx patient add` makes one")));
  EXPECT_FALSE(std::filesystem::exists(folder / "data"));
  EXPECT_THAT(said("patient add P07 --side left --symbol boat --consent yes --consent-date 2026-05-04"),
              AllOf(StartsWith("0 P07\n"), HasSubstr("hand:              left\n"),
                    HasSubstr("symbol:            boat\n"), HasSubstr("consent:           yes, 2026-05-04\n"),
                    HasSubstr("new key file: "), HasSubstr("new registry of patients: data")));
  done("patient add P03 --side right --warning 'rests often' --contraindication 'open wound'");
  EXPECT_THAT(
      said("patient edit P07 --force-limit-n 2.5 --own-force index=12.5 --own-range index_pip_flexion=2,80 "
           "--prescribe 'train_press trials=12 most_minutes=10' --note 'likes music'"),
      AllOf(HasSubstr("force limit:       2.5 N\n"), HasSubstr("own force:         index 12.5 N\n"),
            HasSubstr("own range:         index_pip_flexion 2.0 to 80.0 deg\n"),
            HasSubstr("prescribed:        train_press trials=12 most_minutes=10\n"),
            HasSubstr("note:              likes music\n")));
  EXPECT_THAT(
      said("patient edit P07 --clear own-force --clear note --prescribe 'train_press trials=8' --new-code "
           "P08"),
      AllOf(StartsWith("0 P08\n"), Not(HasSubstr("own force")), Not(HasSubstr("likes music")),
            HasSubstr("prescribed:        train_press trials=8\n"), HasSubstr("force limit:       2.5 N\n")));
  EXPECT_THAT(said("patient edit P08 --prescribe 'tran_press trials=8'"),
              AllOf(StartsWith("0 "),
                    HasSubstr("no such exercise in assets/exercises; did you mean \"train_press\"?")));
  EXPECT_THAT(said("patient show P07"), StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient list"),
              AllOf(HasSubstr("P03              right"), HasSubstr("P08              left   boat"),
                    HasSubstr("1 contraindications, no consent, 1 warnings")));
  EXPECT_THAT(said("patient show P08 --json"), AllOf(StartsWith("0 {"), HasSubstr("\"code\":\"P08\"")));
}

TEST_F(CliPatient, AddsNothingThatLooksLikeAPersonOrIsOutOfRange) {
  testing::write_file(folder / "c.toml", "");
  const auto refused = [&](const std::string& options, const std::string& reason) {
    EXPECT_THAT(said("patient add " + options), AllOf(StartsWith("2 phalanx"), HasSubstr(reason))) << options;
  };
  refused("P07", "--side");
  refused("P07 --side middle", "--side");
  refused("'Ada Miller' --side left", "must be 1 to 16 of A-Z, 0-9 and '-'");
  refused("1948-03-07 --side left", "looks like a date");
  refused("P07 --side left --note a@b.org", "'@'");
  refused("P07 --side left --note 'born in May'", "date of birth");
  refused("P07 --side left --force-limit-n -1", "force_limit_n is -1");
  refused("P07 --side left --force-limit-n 5N", "write its digits alone");
  refused("P07 --side left --own-force pinky=3", "'pinky' is no digit");
  refused("P07 --side left --own-force index", "write NAME=VALUE");
  refused("P07 --side left --own-force index=nan", "'nan' is not a number");
  refused("P07 --side left --own-range index_pip_flexion=2", "write JOINT=LEAST,LARGEST");
  refused("P07 --side left --prescribe 'train_press trails=3'", "trails");
  refused("P07 --side left --prescribe 'train_press most_minutes=119'", "most_minutes");
  refused("P07 --side left --prescribe 'press_and_hold trials=3'", "trials");
  refused("P07 --side left --data c.toml", "c.toml: this is a file");
  refused("P07 --side left --keys data/keys", "it lies in the data folder data");
  EXPECT_FALSE(std::filesystem::exists(folder / "data")) << "nothing is made for what is refused";
  EXPECT_FALSE(std::filesystem::exists(folder / "keys"));
  refused("P07 --side left --consent-date 2026-05-04", "belongs to --consent");
  refused("P07 --side left --entry-date 2026-05-04", "belongs to --entry-check");
  refused("P07 --side left --entry-check 200,3", "entry: flexion_deg is 200");
  refused("P07 --side left --note ''", "the value is empty");
  done("patient add P07 --side left");
  refused("P07 --side right", "P07");  // in use
  EXPECT_THAT(said("patient list --json"), HasSubstr("\"code\":\"P07\""));
}

TEST_F(CliPatient, IsBoundToACalibrationOfOneDeviceAndSideUntilItsLastDay) {
  write_calibration();
  done("patient add P07 --side left");
  EXPECT_THAT(said("patient edit P07 --range r.toml"), HasSubstr("P07 has no calibration"));
  EXPECT_THAT(said("patient edit P07 --calibration c.toml"),
              HasSubstr("state its last day with --expires DATE"));
  EXPECT_THAT(said("patient edit P07 --calibration c.toml --expires 2020-01-01"),
              HasSubstr("write a day from today ("));
  EXPECT_THAT(said("patient edit P07 --calibration c.toml --expires tomorrow"),
              StartsWith("2 phalanx: --expires"));
  EXPECT_THAT(said("patient edit P07 --calibration c.toml --expires 2199-02-30"), StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient edit P07 --expires 2199-01-01"), HasSubstr("state --calibration FILE, too"));
  EXPECT_THAT(said("patient edit P07 --calibration nope.toml --expires 2199-01-01"), HasSubstr("nope.toml"));
  EXPECT_THAT(said("patient edit P07 --calibration c.toml --expires 2199-01-01 --range r.toml"),
              AllOf(HasSubstr("c.toml (glove 0001, goniometer), until 2199-01-01\n"),
                    HasSubstr("own range:         index_pip_flexion 2.5 to 40.2 deg\n")));

  testing::write_file(folder / "other.toml", range("0002", "2026-05-04T09:30:00Z", ""));
  EXPECT_THAT(said("patient edit P07 --range other.toml"),
              HasSubstr("it was measured on glove 0002, the calibration of P07 is for glove 0001"));
  testing::write_file(folder / "other.toml", range("0001", "2026-05-05T09:30:00Z", ""));
  EXPECT_THAT(said("patient edit P07 --range other.toml"),
              HasSubstr("measured with the calibration of 2026-05-05T09:30:00Z"));
  testing::write_file(folder / "other.toml", range("0001", "2026-05-04T09:30:00Z", "P08"));
  EXPECT_THAT(said("patient edit P07 --range other.toml"), HasSubstr("it is of patient P08, not of P07"));

  testing::write_file(folder / "c2.toml", calibration("0001", "2026-06-01T09:30:00Z"));
  EXPECT_THAT(
      said("patient edit P07 --calibration c2.toml --expires 2199-01-01"),
      AllOf(HasSubstr("the range was measured with the calibration before"), Not(HasSubstr("own range:"))));
  done("patient edit P07 --calibration c.toml --expires 2199-01-01 --range r.toml --own-force index=9");
  EXPECT_THAT(said("patient edit P07 --side right"),
              AllOf(HasSubstr("calibration:       none\n"), Not(HasSubstr("own range:")),
                    Not(HasSubstr("own force:")),
                    HasSubstr("were of the other hand, and are gone: measure the right hand")));
}

TEST_F(CliPatient, ShowsTheOriginOfAnEntryCheckAndItsVerdict) {
  EXPECT_THAT(
      said("patient add P07 --side left --entry-check 45,20 --entry-date 2026-05-04"),
      HasSubstr(
          "entry check:       flexion 45.0 deg, release 20.0 deg: suitable (entered by hand, 2026-05-04)\n"));
  EXPECT_THAT(
      said("patient edit P07 --entry-check 45,19.5 --entry-date 2026-05-05"),
      HasSubstr("release 19.5 deg: not suitable on this device (it resists, it does not assist) (entered by "
                "hand, 2026-05-05)\n"));
  EXPECT_THAT(said("patient list"), HasSubstr("not suitable on this device"));
}

TEST_F(CliPatient, EntersTestsAndSaysWhatIsProven) {
  done("patient add P07 --side left");
  EXPECT_THAT(said("patient trend P07"), HasSubstr("no trends"));
  done("patient test P07 --kind grip --value 10 --rater AB --date 2026-05-04");
  EXPECT_THAT(
      said("patient test P07 --kind grip --value 12.9 --rater AB --date 2026-06-01 --note 'after lunch'"),
      HasSubstr("2026-06-01  Grip"));
  done("patient test P07 --kind box_and_block --value 20 --rater AB --date 2026-05-04");
  done("patient test P07 --kind box_and_block --value 25 --rater AB --date 2026-06-01");
  // Chen et al. 2009: 2.9 kg, 5.5 blocks a minute on the more affected side.
  const std::string trends = said("patient trend P07");
  EXPECT_THAT(trends, HasSubstr("grip/more_affected: improved: +2.9 kg from 2026-05-04 to 2026-06-01"));
  EXPECT_THAT(trends, HasSubstr("box_and_block/more_affected: change not proven: +5 blocks/min"));
  EXPECT_THAT(said("patient trend P07 --exercise grip"), Not(HasSubstr("box_and_block")));
  EXPECT_THAT(said("patient show P07"), HasSubstr("0 results, 4 entered tests, 0 notes"));
  EXPECT_THAT(said("patient test P07 --kind grip --value 9 --rater AB --side both"), StartsWith("2 phalanx"));
  EXPECT_THAT(said("patient test P07 --kind guess --value 9 --rater AB"), HasSubstr("box_and_block"));
  EXPECT_THAT(said("patient test P07 --kind grip --value 9"), HasSubstr("--rater"));
  EXPECT_THAT(said("patient test P07 --kind grip --value -9 --rater AB"), StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient test P07 --kind grip --value 9 --rater AB --date 2026-13-01"),
              StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient results P07"), HasSubstr("no results"));
}

TEST_F(CliPatient, KeepsNotesWithDateAndAuthorAndPrintsNoControlCharacters) {
  done("patient add P07 --side left");
  EXPECT_THAT(said("patient note P07 \"$(printf 'good day\\n\\tsecond line')\""), StartsWith("0 noted\n"));
  EXPECT_THAT(said("patient show P07"), HasSubstr("owner: good day  second line\n"));
  EXPECT_THAT(said("patient note P07 \"$(printf 'red \\033[31m')\""), HasSubstr("control character"));
  EXPECT_THAT(said("patient note P99 text"), StartsWith("2 phalanx: "));
}

}  // namespace
}  // namespace phalanx
