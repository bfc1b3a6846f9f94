// SPDX-License-Identifier: Apache-2.0
// Bad scenes, one test for each kind: the message names place, key, value and remedy.
#include <string>
#include <utility>

#include "phalanx/scene/scene.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

void expect_scene_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_scene(text, "bad.toml", ".")); }, words);
}

TEST(SceneErrors, UnknownKeyIsAnsweredWithTheNearestOne) {
  expect_scene_refused("\n[force]\nstifness_n_per_mm = 0.9",
                       {"bad.toml:3", "force.stifness_n_per_mm = 0.9", "force.stiffness_n_per_mm"});
  expect_scene_refused("rate_hx = 200", {"bad.toml:1", "rate_hx", "nearest known one is rate_hz"});
  expect_scene_refused("[[objects]]\nkind = \"sphere\"\ndiametre_mm = 3",
                       {"bad.toml:3", "objects.0.diametre_mm", "objects[].diameter_mm"});
}

TEST(SceneErrors, KeyWithoutItsUnitOrItsTableIsAnsweredWithTheWholeKey) {
  expect_scene_refused("limits.torque_rate = \"off\"", {"nearest known one is limits.torque_rate_nm_per_s"});
  expect_scene_refused("stiffness = 1", {"nearest known one is force.stiffness_n_per_mm"});
  expect_scene_refused("[objects.x]", {"[[objects]]"});
}

TEST(SceneErrors, UnknownTable) {
  expect_scene_refused("[forces]\nlaw = \"hooke\"", {"bad.toml:1", "forces", "nearest known one is"});
}

TEST(SceneErrors, NotToml) { expect_scene_refused("rate_hz = = 3", {"bad.toml:1", "not valid TOML"}); }

TEST(SceneErrors, SameKeyTwice) {
  expect_scene_refused("rate_hz = 3\nrate_hz = 4", {"bad.toml:2", "not valid TOML"});
}

TEST(SceneErrors, RateOfZeroNegativeOrTooFast) {
  for (const std::string rate : {"0", "-200", "4001", "nan", "inf"}) {
    expect_scene_refused("rate_hz = " + rate,
                         {"bad.toml:1", "rate_hz", ">= 1, <= 4000", "Hz", "default is 200"});
  }
}

TEST(SceneErrors, NegativeStiffness) {
  expect_scene_refused("[force]\nstiffness_n_per_mm = -0.5",
                       {"bad.toml:2", "force.stiffness_n_per_mm = -0.5", ">= 0", "N/mm"});
}

TEST(SceneErrors, NumberThatIsNotFinite) {
  expect_scene_refused("force.stiffness_n_per_mm = nan", {"force.stiffness_n_per_mm = nan", "must be"});
  expect_scene_refused("force.damping_ns_per_m = inf", {"force.damping_ns_per_m = inf", "must be"});
  expect_scene_refused("hand.position_mm = [0, nan, 0]", {"hand.position_mm", "must be"});
  expect_scene_refused("smoothing.max_n = inf", {"smoothing.max_n", "must be"});
}

TEST(SceneErrors, WrongType) {
  expect_scene_refused("rate_hz = \"fast\"", {"rate_hz", "is a string; write a number"});
  expect_scene_refused("mirror = 1", {"mirror", "write true or false"});
  expect_scene_refused("seed = 1.5", {"seed", "write a whole number"});
  expect_scene_refused("hand.position_mm = [1, 2]", {"hand.position_mm", "three numbers"});
  expect_scene_refused("hand.position_mm = [1, 2, \"x\"]", {"hand.position_mm", "three numbers"});
  expect_scene_refused("description = 3", {"description", "write a string in quotes"});
  expect_scene_refused("force = 3", {"force = 3", "is a table"});
  expect_scene_refused("[objects]\nkind = \"sphere\"", {"objects", "[[objects]]"});
  expect_scene_refused("objects = [3]", {"objects.0", "is a table"});
}

TEST(SceneErrors, WrongTypeIsCalledByItsName) {
  for (const auto& [value, type] : {std::pair<const char*, const char*>{"3", "an integer"},
                                    {"3.5", "a number"},
                                    {"true", "true or false"},
                                    {"[1]", "an array"},
                                    {"{}", "a table"},
                                    {"1979-05-27", "a date or time"}})
    expect_scene_refused(
        std::string("description = ") + value,
        {"bad.toml:1: description", "is " + std::string(type) + "; write a string in quotes"});
}

// 80 characters are shown, two of them the quotes; of what is longer the first 77.
TEST(SceneErrors, LongValueIsShownShortened) {
  expect_scene_refused("rate_hz = \"" + std::string(78, 'x') + "\"",
                       {"rate_hz = '" + std::string(78, 'x') + "': is a string"});
  expect_scene_refused("rate_hz = \"" + std::string(79, 'x') + "\"",
                       {"rate_hz = '" + std::string(76, 'x') + "...: is a string"});
}

TEST(SceneErrors, UnknownChoice) {
  expect_scene_refused("force.law = \"hook\"",
                       {"bad.toml:1", "force.law = ", "hook", "did you mean \"hooke\"?", "duffing"});
  expect_scene_refused("[[objects]]\nkind = \"spere\"", {"objects.0.kind", "did you mean \"sphere\"?"});
}

TEST(SceneErrors, SizeThatTheKindDoesNotHave) {
  expect_scene_refused(
      "[[objects]]\nkind = \"teapot\"\ndiameter_mm = 50",
      {"bad.toml:3", "objects.0.diameter_mm = 50", "a teapot has no such key", "sphere cylinder mug"});
}

TEST(SceneErrors, SizeOfZero) {
  expect_scene_refused("[[objects]]\nkind = \"teapot\"\nsize_mm = 0", {"objects.0.size_mm = 0", "> 0"});
  expect_scene_refused("[[objects]]\nkind = \"sphere\"\ndiameter_mm = 0",
                       {"objects.0.diameter_mm = 0", "> 0"});
  expect_scene_refused("[[objects]]\nkind = \"box\"\nextent_mm = [1, 0, 1]", {"objects.0.extent_mm", "> 0"});
}

TEST(SceneErrors, FileObjectWithoutAFile) {
  expect_scene_refused("[[objects]]\nkind = \"file\"", {"objects.0", "file", "is missing"});
}

TEST(SceneErrors, TorusWithATubeThickerThanItsRing) {
  expect_scene_refused("[[objects]]\nkind = \"torus\"\nring_diameter_mm = 20\ntube_diameter_mm = 30",
                       {"tube_diameter_mm = 30", "thinner"});
}

TEST(SceneErrors, BothFormsOfTheSmoothingBounds) {
  expect_scene_refused("[smoothing]\nmin_n = -0.1\nmin_n_per_s = -20",
                       {"bad.toml:2", "smoothing.min_n", "bad.toml:3", "per tick"});
  expect_scene_refused("[smoothing]\nmin_n = -0.1\nmax_n_per_s = 20", {"smoothing.max_n_per_s"});
}

TEST(SceneErrors, SmoothingBoundOfTheWrongSign) {
  expect_scene_refused("smoothing.min_n = 0.1", {"smoothing.min_n = 0.1", "< 0"});
  expect_scene_refused("smoothing.min_n_per_s = 0", {"smoothing.min_n_per_s = 0", "< 0"});
  expect_scene_refused("smoothing.max_n = -0.1", {"smoothing.max_n = -0.1", "> 0"});
}

TEST(SceneErrors, FingertipForceOutOfItsRange) {
  for (const std::string force : {"0", "-1", "15.1", "\"on\"", "inf"}) {
    expect_scene_refused("limits.fingertip_force_n = " + force,
                         {"limits.fingertip_force_n", "> 0, <= 15", "or \"off\""});
  }
}

TEST(SceneErrors, LimitCannotBeTurnedOffByAFlagOrANumber) {
  expect_scene_refused("limits.torque_rate_nm_per_s = false", {"limits.torque_rate_nm_per_s", "\"off\""});
  expect_scene_refused("limits.torque_rate_nm_per_s = 0", {"limits.torque_rate_nm_per_s", "\"off\""});
}

TEST(SceneErrors, TrialOfZero) { expect_scene_refused("motion.trial = 0", {"motion.trial = 0", ">= 1"}); }

TEST(SceneErrors, MissingSceneIsAnsweredWithTheNearestOne) {
  expect_scene_error([] { static_cast<void>(load_scene("grasp_teapott")); },
                     {"grasp_teapott", "did you mean \"grasp_teapot\"?"});
  expect_scene_error([] { static_cast<void>(load_scene("./none.toml")); }, {"none.toml", "there is no file"});
}

TEST(SceneErrors, SceneThatIsAFolder) {
  expect_scene_error([] { static_cast<void>(load_scene(PHALANX_SOURCE_DIR "/scenes")); }, {"is a folder"});
}

}  // namespace
}  // namespace phalanx
