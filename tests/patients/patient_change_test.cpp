// SPDX-License-Identifier: Apache-2.0
// The rules of a change of a patient, with calibration and range files.
#include "phalanx/patients/patient_change.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kToday = "2026-06-01";
const std::string kLastDay = "2026-12-31";

class PatientChange : public ::testing::Test {
 protected:
  PatientChange() { known_.code = "P07"; }

  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_ / name;
    std::ofstream(file) << text;
    return file.string();
  }
  [[nodiscard]] std::string calibration(const std::string& name, const std::string& date) const {
    return write(name,
                 fmt::format("format = 2\ndevice = \"glove\"\nserial = \"0001\"\ndate = \"{}\"\n"
                             "phalanx = \"0.1.0\"\n[[channel]]\nkind = \"angle\"\n"
                             "joint = \"index_pip_flexion\"\ngain = 0.00042\noffset = -0.21\n"
                             "residual_rad = 0.011\nmethod = \"goniometer\"\n"
                             "poses = [ {{ name = \"a\", raw = 500, value = 0.0, residual_rad = 0.0 }}, "
                             "{{ name = \"b\", raw = 3021.5, value = 1.05, residual_rad = 0.002 }} ]\n",
                             date));
  }
  [[nodiscard]] std::string range(const std::string& name, const std::string& date) const {
    return write(name, fmt::format("format = 1\ndevice = \"glove\"\nserial = \"0001\"\ncalibration = \"{}\"\n"
                                   "patient = \"P07\"\ndate = \"2026-05-04T09:45:00Z\"\n"
                                   "phalanx = \"0.1.0\"\n[joints]\nindex_pip_flexion = [2.5, 40.25]\n",
                                   date));
  }
  static PrescribedExercise line(const std::string& exercise) {
    PrescribedExercise made;
    made.exercise = exercise;
    return made;
  }
  /// Changes known_. @returns what was said
  std::vector<std::string> change(const Patient& wanted) {
    ChangedPatient made = changed_patient(known_, wanted, kToday);
    known_ = std::move(made.patient);
    return made.said;
  }
  void refused(const Patient& wanted, const std::string& why) {
    try {
      static_cast<void>(changed_patient(known_, wanted, kToday));
      ADD_FAILURE() << "not refused: " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
  /// Binds a calibration and a range to known_.
  void bind() {
    Patient wanted = known_;
    wanted.calibration = calibration("c.toml", "2026-05-04T09:30:00Z");
    wanted.calibration_expires = kLastDay;
    wanted.range = range("r.toml", "2026-05-04T09:30:00Z");
    EXPECT_THAT(change(wanted), IsEmpty());
  }

  const testing::TemporaryFolder folder_;
  Patient known_;
};

TEST_F(PatientChange, TakesDeviceMethodAndOwnRangeFromTheFiles) {
  bind();
  EXPECT_EQ(known_.calibration_device, "glove");
  EXPECT_EQ(known_.calibration_serial, "0001");
  EXPECT_EQ(known_.calibration_method, "goniometer");
  ASSERT_THAT(known_.own_range_deg, SizeIs(1));
  EXPECT_NEAR(known_.own_range_deg.at("index_pip_flexion").second, 40.25, 1e-9);
  Patient wanted = known_;
  wanted.calibration_device = "another";
  refused(wanted, "calibration_device");
  wanted = known_;
  wanted.calibration_expires = "2020-01-01";
  refused(wanted, "2020-01-01");
  wanted = known_;
  wanted.range = range("other.toml", "2026-05-05T09:30:00Z");
  refused(wanted, "measured with the calibration of 2026-05-05T09:30:00Z");
}

TEST_F(PatientChange, ForgetsTheRangeOfAnotherCalibration) {
  bind();
  Patient wanted = known_;
  wanted.calibration_expires = "2027-01-31";
  EXPECT_THAT(change(wanted), IsEmpty()) << "the same file with another last day";
  EXPECT_THAT(known_.own_range_deg, SizeIs(1));
  wanted = known_;
  wanted.calibration = calibration("c2.toml", "2026-06-01T09:30:00Z");
  EXPECT_THAT(change(wanted), SizeIs(1));
  EXPECT_THAT(known_.range, IsEmpty());
  EXPECT_THAT(known_.own_range_deg, IsEmpty());
}

TEST_F(PatientChange, ForgetsDeviceDayAndRangesWithTheCalibration) {
  bind();
  Patient wanted = known_;
  wanted.calibration.clear();
  change(wanted);
  EXPECT_THAT(known_.calibration_device + known_.calibration_serial + known_.calibration_method +
                  known_.calibration_expires + known_.range,
              IsEmpty());
  EXPECT_THAT(known_.own_range_deg, IsEmpty());
}

TEST_F(PatientChange, OfTheSideClearsTheOtherHandAndKeepsWhatTheSameChangeStates) {
  bind();
  known_.own_force_n[1] = 12.0;
  known_.entry = EntryCheck{.flexion_deg = 60.0, .release_deg = 40.0, .date = kToday, .suitable = true};
  Patient wanted = known_;
  wanted.side = Handedness::kLeft;
  wanted.own_force_n[1] = 7.0;
  const auto said = change(wanted);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("measure the left hand"));
  EXPECT_THAT(known_.calibration + known_.calibration_device + known_.range, IsEmpty());
  EXPECT_THAT(known_.own_range_deg, IsEmpty());
  EXPECT_FALSE(known_.entry.has_value());
  EXPECT_EQ(known_.own_force_n[1], 7.0) << "stated with the side";
}

TEST_F(PatientChange, KeepsAProfileOfThePatientsSideOnly) {
  const auto profile = [this](const std::string& side) {
    return write(side + ".toml", fmt::format("name = \"{}\"\nhandedness = \"{}\"\n", side, side));
  };
  Patient wanted = known_;
  wanted.profile = profile("left");
  refused(wanted, "it is of a left hand, and P07 exercises the right hand");
  wanted.profile = profile("right");
  EXPECT_THAT(change(wanted), IsEmpty());
  wanted = known_;
  wanted.side = Handedness::kLeft;
  EXPECT_THAT(change(wanted), SizeIs(1)) << "it tells that the profile is gone";
  EXPECT_THAT(known_.profile, IsEmpty());
  wanted = known_;
  wanted.side = Handedness::kRight;
  wanted.profile = profile("left");
  refused(wanted, "name a profile of this side");
  wanted.profile = profile("right");
  EXPECT_THAT(change(wanted), IsEmpty()) << "stated with the side";
  EXPECT_THAT(known_.profile, HasSubstr("right.toml"));
}

TEST_F(PatientChange, JudgesAnEntryCheckByItself) {
  Patient wanted = known_;
  wanted.entry = EntryCheck{.flexion_deg = 0.5, .release_deg = 0.5, .date = kToday, .suitable = true};
  change(wanted);
  ASSERT_TRUE(known_.entry.has_value());
  EXPECT_FALSE(known_.entry->suitable);
}

TEST_F(PatientChange, ChecksNewLinesOfThePrescription) {
  Patient wanted = known_;
  wanted.prescription = {line("train_press")};
  wanted.prescription[0].overrides = {{"trials", "8"}};
  EXPECT_THAT(change(wanted), IsEmpty());
  wanted.prescription.push_back(line("train_press"));
  refused(wanted, "two lines");
  wanted.prescription = {line("train_press")};
  wanted.prescription[0].minutes_per_day = 119.0;
  refused(wanted, "most_minutes");
  wanted.prescription = {line("tran_press")};
  const auto said = change(wanted);
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("train_press"));
}

}  // namespace
}  // namespace phalanx
