// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/patient_file.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scene/expect_error.h"

namespace phalanx {
namespace {

const std::string kPatientJoint = "[joints.index_mcp_flexion]\nstiffness_nm_per_rad = 10\n";

PatientParameters parse_toml(const std::string& text) { return parse_patient(text, "p.toml"); }

void expect_patient_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_toml(text)); }, words);
}

TEST(PatientFile, StatesImpedanceIntentAndDisturbancesInItsUnits) {
  const PatientParameters p = parse_toml(R"(description = "somebody"
press_n = 4
press_spread = 0.2
approach_min_mm_per_s = 10
approach_max_mm_per_s = 20
tremor_um = 50
tremor_min_hz = 4
tremor_max_hz = 6
bump_n = 1
bump_start_s = 2
bump_duration_ms = 50
[joints.index_mcp_flexion]
stiffness_nm_per_rad = 11
damping_nms_per_rad = 0.05
)");
  EXPECT_EQ(p.name, "p");
  EXPECT_EQ(p.description, "somebody");
  EXPECT_EQ(p.stiffness[4], 11.0);
  EXPECT_EQ(p.damping[4], 0.05);
  EXPECT_EQ(p.stiffness[5], 0.0);
  EXPECT_EQ(p.press, 4.0);
  EXPECT_EQ(p.press_spread, 0.2);
  EXPECT_DOUBLE_EQ(p.approach_min, 0.01);
  EXPECT_DOUBLE_EQ(p.approach_max, 0.02);
  EXPECT_DOUBLE_EQ(p.tremor, 50e-6);
  EXPECT_EQ(p.tremor_min_hz, 4.0);
  EXPECT_EQ(p.tremor_max_hz, 6.0);
  EXPECT_EQ(p.bump, 1.0);
  EXPECT_EQ(p.bump_start, 2.0);
  EXPECT_DOUBLE_EQ(p.bump_duration, 0.05);
}

TEST(PatientFile, ScalesWhatItNames) {
  const std::string text = "tremor_um = 10\nbump_n = 3\n" + kPatientJoint + "damping_nms_per_rad = 1\n";
  const PatientParameters p =
      parse_toml(text + "[scale]\nstiffness = 2\ndamping = 3\ntremor = 4\nbump = 0\n");
  EXPECT_EQ(p.stiffness[4], 20.0);
  EXPECT_EQ(p.damping[4], 3.0);
  EXPECT_DOUBLE_EQ(p.tremor, 40e-6);
  EXPECT_EQ(p.bump, 0.0);
}

// Each scale doubles, and only doubles, what it names.
TEST(PatientFile, ScalesNothingElse) {
  const std::string text = "tremor_um = 10\nbump_n = 3\n" + kPatientJoint + "damping_nms_per_rad = 1\n";
  const auto values = [](const PatientParameters& p) {
    return std::array<double, 4>{p.stiffness[4], p.damping[4], p.tremor, p.bump};
  };
  const std::array<const char*, 4> names = {"stiffness", "damping", "tremor", "bump"};
  const auto plain = values(parse_toml(text));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto scaled = values(parse_toml(text + "[scale]\n" + names[i] + " = 2\n"));
    for (std::size_t k = 0; k < names.size(); ++k)
      EXPECT_EQ(scaled[k], plain[k] * (k == i ? 2.0 : 1.0)) << names[k] << " with a scale of " << names[i];
  }
}

TEST(PatientFile, RefusesWhatItCannotUseWithLineKeyValueAndRemedy) {
  expect_patient_refused("", {"p.toml", "joints", "is missing"});
  expect_patient_refused("pres_n = 3\n" + kPatientJoint,
                         {"p.toml:1: pres_n = 3", "nearest known one is press_n"});
  expect_patient_refused("press_spread = 1.5\n" + kPatientJoint, {"p.toml:1: press_spread = 1.5", "<= 1"});
  expect_patient_refused("[joints.index_mcp_flexion]\nstiffness_nm_per_rad = nan\n",
                         {"p.toml:2", "= nan", "must be >= 0"});
  expect_patient_refused("approach_max_mm_per_s = 1\n" + kPatientJoint,
                         {"p.toml: ", "approach_max", "at least approach_min"});
  expect_patient_refused(kPatientJoint + "[scale]\nstifness = 2\n",
                         {"p.toml:4: scale.stifness = 2", "scale.stiffness"});
}

// The number in question stands in the first line. The others leave room for it: what is to be the lesser of
// two is as small, and the greater one as large, as it may be.
TEST(PatientFile, TakesEachNumberUpToItsBoundAndNoFurther) {
  const std::string joint = "joints.index_mcp_flexion.";
  const KeyValues others = {{joint + "stiffness_nm_per_rad", "10"},
                            {"approach_min_mm_per_s", "1e-9"},
                            {"approach_max_mm_per_s", "10000"},
                            {"tremor_min_hz", "1e-9"},
                            {"tremor_max_hz", "100"}};
  for (const KeyBounds& b : {KeyBounds{joint + "stiffness_nm_per_rad", "-1e-9", "0", "10000", "10000.1"},
                             KeyBounds{joint + "damping_nms_per_rad", "-1e-9", "0", "1000", "1000.1"},
                             KeyBounds{"press_n", "-1e-9", "0", "100", "100.1"},
                             KeyBounds{"press_spread", "-1e-9", "0", "1", "1.001"},
                             KeyBounds{"approach_min_mm_per_s", "0", "1e-9", "10000", "10000.1"},
                             KeyBounds{"approach_max_mm_per_s", "0", "1e-9", "10000", "10000.1"},
                             KeyBounds{"tremor_um", "-1e-9", "0", "100000", "100000.1"},
                             KeyBounds{"tremor_min_hz", "0", "1e-9", "100", "100.1"},
                             KeyBounds{"tremor_max_hz", "0", "1e-9", "100", "100.1"},
                             KeyBounds{"bump_n", "-1e-9", "0", "100", "100.1"},
                             KeyBounds{"bump_start_s", "-1e-9", "0", "86400", "86400.1"},
                             KeyBounds{"bump_duration_ms", "-1e-9", "0", "1000000", "1000000.1"},
                             KeyBounds{"scale.stiffness", "-1e-9", "0", "1000", "1000.1"},
                             KeyBounds{"scale.damping", "-1e-9", "0", "1000", "1000.1"},
                             KeyBounds{"scale.tremor", "-1e-9", "0", "1000", "1000.1"},
                             KeyBounds{"scale.bump", "-1e-9", "0", "1000", "1000.1"}}) {
    for (const char* good : {b.least, b.most})
      EXPECT_NO_THROW(static_cast<void>(parse_toml(text_with(b.key, good, others))))
          << b.key << " = " << good;
    for (const char* bad : {b.below, b.above})
      expect_patient_refused(text_with(b.key, bad, others), {"p.toml:1: " + b.key + " = ", "must be"});
  }
}

TEST(PatientInAScene, IsOverlaidByTheScenesOwnKeys) {
  const SceneDescription s =
      parse_scene("patient.press_n = 4", "s.toml", ".", {{"patient.scale.stiffness", "0.5"}});
  const PatientParameters adult = load_patient_file("adult");
  const PatientParameters p = load_patient(s);
  EXPECT_EQ(p.name, "adult");
  EXPECT_EQ(p.press, 4.0);
  EXPECT_EQ(adult.press, 3.0);
  EXPECT_EQ(p.stiffness[4], 0.5 * adult.stiffness[4]);
  EXPECT_NE(patient_text(s), patient_text(adult));
  EXPECT_EQ(patient_text(parse_scene("", "s.toml", ".")), patient_text(adult));
}

TEST(PatientInAScene, IsCheckedWhenTheSceneIsRead) {
  expect_scene_error([] { static_cast<void>(parse_scene("\npatient.pres_n = 4", "s.toml", ".")); },
                     {"s.toml:2: patient.pres_n = 4", "nearest known one is patient.press_n"});
  expect_scene_error([] { static_cast<void>(parse_scene("", "s.toml", ".", {{"patient.bump_n", "-1"}})); },
                     {"--set patient.bump_n=-1: patient.bump_n = -1: must be >= 0"});
  expect_scene_error([] { static_cast<void>(parse_scene("patient.file = \"adutl\"", "s.toml", ".")); },
                     {"s.toml:1: patient.file", "did you mean \"adult\"?"});
}

TEST(PatientText, HoldsEveryNumber) {
  const std::string text = patient_text(parse_toml(kPatientJoint));
  for (const char* change :
       {"press_n = 1\n", "press_spread = 0.1\n", "approach_min_mm_per_s = 29\n",
        "approach_max_mm_per_s = 91\n", "tremor_um = 1\n", "tremor_min_hz = 4\n", "tremor_max_hz = 13\n",
        "bump_n = 1\n", "bump_start_s = 1\n", "bump_duration_ms = 1\n"})
    EXPECT_NE(text, patient_text(parse_toml(change + kPatientJoint))) << change;
  const std::string joint = "[joints.index_mcp_flexion]\nstiffness_nm_per_rad = ";
  for (const char* change : {"11\n", "10\ndamping_nms_per_rad = 0.05\n"})
    EXPECT_NE(text, patient_text(parse_toml(joint + change))) << change;
}

}  // namespace
}  // namespace phalanx
