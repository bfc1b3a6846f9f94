// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/scene_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "phalanx/record/output_file.h"
#include "phalanx/scene/data_paths.h"
#include "record/temporary_folder.h"
#include "study/laboratory/expect_refusal.h"
#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using testing::expect_refusal;
using testing::study_of;
using testing::TemporaryFolder;

bool names(const StudyInputs& inputs, const std::string& file) {
  return std::any_of(inputs.files.begin(), inputs.files.end(),
                     [&](const std::filesystem::path& path) { return path.filename() == file; });
}

TEST(SceneInputs, NameTheFilesOfSceneAndHand) {
  const Study study = study_of("scene = \"press_teapot\"");
  const StudyInputs inputs = scene_check(study)({});
  EXPECT_TRUE(names(inputs, "press_teapot.toml"));
  EXPECT_TRUE(names(inputs, "adult.toml"));
  for (const char* segment : {"thumb-metacarpal.obj", "index-finger-phalanx-distal.obj", "wrist.obj"})
    EXPECT_TRUE(names(inputs, segment)) << segment;
  for (const auto& file : inputs.files) EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
  const StudyInputs capsules = scene_check(study)({{"hand.meshes", "\"capsules\""}});
  EXPECT_FALSE(names(capsules, "index-finger-phalanx-distal.obj"));
}

TEST(SceneInputs, NameTheProfile) {
  const StudyInputs inputs =
      scene_check(study_of("scene = \"press_teapot\""))({{"hand.profile", "\"large-man\""}});
  EXPECT_TRUE(names(inputs, "large-man.toml"));
  EXPECT_TRUE(names(inputs, "adult.toml")) << "the hand that the profile is of";
}

TEST(SceneInputs, AreTheFilesOfObjectAndMotionTooAndWhatIsInThem) {
  const TemporaryFolder folder;
  write_text_file(folder / "mine.toml",
                  "[[objects]]\nkind = \"file\"\nfile = \"t.obj\"\nsize_mm = 40\n"
                  "[motion]\nfile = \"walk.csv\"\nmapping = \"cyberglove\"\n");
  write_text_file(folder / "t.obj", "v 0 0 0\n");
  write_text_file(folder / "walk.csv", "time_s\n");
  const Study study = parse_study("scene = \"./mine.toml\"", "s.toml", folder.path());
  const StudyInputs inputs = scene_check(study)({});
  EXPECT_TRUE(names(inputs, "t.obj"));
  EXPECT_TRUE(names(inputs, "walk.csv"));
  EXPECT_TRUE(names(inputs, "cyberglove.toml"));
  const std::string before = check_study(study, scene_check(study));
  write_text_file(folder / "t.obj", "v 0 0 1\n");
  const std::string other_object = check_study(study, scene_check(study));
  EXPECT_NE(other_object, before);
  write_text_file(folder / "walk.csv", "time_s,\n");
  EXPECT_NE(check_study(study, scene_check(study)), other_object);
}

TEST(SceneInputs, NameTheFilesOfDeviceAndPatientWithTheirBases) {
  StudyInputs inputs = scene_check(study_of("scene = \"press_teapot\""))({{"device.file", "\"light\""}});
  std::vector<std::string> read;
  for (const auto& file : inputs.read) read.push_back(file.filename().string());
  EXPECT_THAT(read, ::testing::ElementsAre("light.toml", "beihang.toml", "adult.toml"));
}

TEST(SceneInputs, DependOnDeviceAndPatient) {
  const StudyCheck check = scene_check(study_of("scene = \"press_teapot\""));
  const std::string as_it_is = check({}).text;
  EXPECT_EQ(check({}).text, as_it_is);
  EXPECT_NE(check({{"device.scale.sheath_friction", "0.5"}}).text, as_it_is);
  EXPECT_NE(check({{"patient.press_n", "4"}}).text, as_it_is);
}

TEST(SceneInputs, RefuseAKeyThatNobodyKnows) {
  const Study study =
      study_of("scene = \"press_teapot\"\n[[axis]]\nkey = \"force.lw\"\nvalues = [\"hooke\"]");
  expect_refusal([&] { static_cast<void>(check_study(study, scene_check(study))); },
                 {"study synthetic, point 0 (force.lw hooke)", "force.law"});
}

TEST(SceneInputs, ChangeTheFingerprintWhenTheSceneChanges) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(data_folder() / "scenes/press_teapot.toml", folder / "mine.toml");
  const Study study = parse_study("scene = \"./mine.toml\"", "s.toml", folder.path());
  const std::string before = check_study(study, scene_check(study));
  EXPECT_EQ(check_study(study, scene_check(study)), before);
  write_text_file(folder / "mine.toml", testing::read_file(folder / "mine.toml") + "\n# changed\n");
  EXPECT_NE(check_study(study, scene_check(study)), before);
}

}  // namespace
}  // namespace phalanx
