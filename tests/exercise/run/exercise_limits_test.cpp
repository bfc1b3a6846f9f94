// SPDX-License-Identifier: Apache-2.0
// Nothing that an exercise file says can raise a limit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "exercise/run/exercise_fixture.h"
#include "phalanx/core/random.h"
#include "phalanx/scene/exercise_file.h"

namespace phalanx {
namespace {

/// A number for a key, usually one that is allowed.
std::string drawn_number(const ExerciseKey& key, Random& random) {
  constexpr std::array<const char*, 8> kOdd = {"1e308", "-1",  "0",      "inf",
                                               "-inf",  "nan", "1e-300", "99999999999999"};
  if (random.uniform() < 0.03) return kOdd[static_cast<std::size_t>(random.between(0.0, 8.0))];
  double low = 0.0;
  double high = 1.0;
  if (const std::size_t at = key.range.find(">= "); at != std::string::npos)
    low = std::stod(key.range.substr(at + 3));
  if (const std::size_t at = key.range.find("<= "); at != std::string::npos)
    high = std::stod(key.range.substr(at + 3));
  const double value = random.between(low, high);
  return key.type == "integer" ? fmt::format("{}", static_cast<int>(std::round(value)))
                               : fmt::format("{}", value);
}

/// An exercise file drawn by a seed: each key with some probability, numbers that are odd at times.
std::string drawn_file(Random& random) {
  const bool training = random.uniform() < 0.4;
  const auto measure = static_cast<ExerciseMeasure>(static_cast<int>(random.between(0.0, kExerciseMeasures)));
  const bool fingers = measure == ExerciseMeasure::kPinch || measure == ExerciseMeasure::kOpposition;
  std::string text = fmt::format(
      "format = 1\ntitle = \"t\"\nkind = \"{}\"\nmeasure = \"{}\"\nscene = \"index_ball\"\ninstruction = "
      "\"i\"\n"
      "digits = \"{}index middle\"\n",
      training ? "training" : "assessment", exercise_measure_name(measure), fingers ? "" : "thumb ");
  std::string table;
  for (const ExerciseKey& key : exercise_keys()) {
    if (key.type != "number" && key.type != "integer" && key.type != "pair") continue;
    if (key.path == "format" || key.path.starts_with("objects") || key.path == "success.at_most") continue;
    const std::size_t dot = key.path.find('.');
    const std::string of = dot == std::string::npos ? "" : key.path.substr(0, dot);
    // A key that this kind or measure does not have is drawn rarely: it only makes the file refused.
    const std::string name(exercise_measure_name(measure));
    const std::string words =
        key.meaning.starts_with("(") ? key.meaning.substr(0, key.meaning.find(')')) : "";
    const bool kinds_fit = words.find("training") == std::string::npos || training;
    const bool fits =
        words.empty() || (kinds_fit && (words == "(training" || words.find(name) != std::string::npos));
    if (random.uniform() > (fits ? 0.5 : 0.002)) continue;
    if (of != table) {
      table = of;
      text.append(fmt::format("[{}]\n", of));
      if (of == "success") text.append("score = \"time_in_target_share\"\n");
    }
    text.append(dot == std::string::npos ? key.path : key.path.substr(dot + 1)).append(" = ");
    if (key.type == "pair")
      text.append(fmt::format("[{}, {}]\n", drawn_number(key, random), drawn_number(key, random)));
    else
      text.append(drawn_number(key, random)).append("\n");
  }
  if (measure == ExerciseMeasure::kObjectInHand)
    text.append(
        "[[objects]]\ntitle = \"a\"\nkind = \"box\"\n[[objects]]\ntitle = \"b\"\nkind = \"sphere\"\n");
  return text;
}

SceneDescription drawn_scene(Random& random) {
  SceneDescription scene;
  scene.parameters.force.stiffness = random.between(50.0, 2'000.0);
  scene.parameters.limits.fingertip_force = random.between(0.5, 10.0);
  scene.parameters.limits.joint_torque = random.between(0.05, 2.0);
  scene.parameters.limits.fingertip_force_enabled = random.uniform() < 0.9;
  scene.parameters.limits.joint_torque_enabled = random.uniform() < 0.9;
  return scene;
}

/// Sets every parameter that apply_exercise() may lower to the value of another scene.
void copy_lowered(const SceneDescription& from, SceneDescription& to) {
  to.parameters.force.stiffness = from.parameters.force.stiffness;
  to.parameters.limits.fingertip_force = from.parameters.limits.fingertip_force;
  to.parameters.limits.joint_torque = from.parameters.limits.joint_torque;
  to.parameters.limits.fingertip_force_enabled = from.parameters.limits.fingertip_force_enabled;
  to.parameters.limits.joint_torque_enabled = from.parameters.limits.joint_torque_enabled;
}

void expect_only_lowered(const SceneDescription& before, const SceneDescription& after) {
  const LimitParameters& old = before.parameters.limits;
  const LimitParameters& now = after.parameters.limits;
  EXPECT_LE(after.parameters.force.stiffness, before.parameters.force.stiffness);
  EXPECT_GE(after.parameters.force.stiffness, 0.0);
  if (old.fingertip_force_enabled) {
    EXPECT_LE(now.fingertip_force, old.fingertip_force);
  }
  if (old.joint_torque_enabled) {
    EXPECT_LE(now.joint_torque, old.joint_torque);
  }
  EXPECT_TRUE(now.fingertip_force_enabled) << "it may be turned on, never off";
  EXPECT_GE(now.joint_torque_enabled, old.joint_torque_enabled);
  EXPECT_EQ(now.torque_rate, old.torque_rate);
  EXPECT_EQ(now.torque_rate_enabled, old.torque_rate_enabled);
  EXPECT_EQ(now.joint_speed, old.joint_speed);
  const ForceLawParameters& law = before.parameters.force;
  EXPECT_EQ(after.parameters.force.law, law.law);
  EXPECT_EQ(after.parameters.force.cubic, law.cubic);
  EXPECT_EQ(after.parameters.force.damping, law.damping);
  EXPECT_EQ(after.parameters.stabiliser.method, before.parameters.stabiliser.method);
}

/// Plays a run shortly. No demand and no target may exceed the limits that apply_exercise() has returned.
void expect_demands_within(const ExerciseDescription& exercise, const PersonLimits& person,
                           std::uint64_t seed) {
  try {
    check_person(exercise, person);
    Bench bench(exercise, person, seed);
    bench.begin();
    for (int i = 0; i < 400; ++i) {
      if (i % 7 == 0) bench.input(ExerciseInput::Kind::kSkip);
      if (i % 90 == 0) bench.input(ExerciseInput::Kind::kDifficulty, 1.0);
      bench.step();
      EXPECT_LE(bench.run.demand().stiffness.value_or(0.0), person.stiffness_cap);
      EXPECT_LE(bench.run.demand().stiffness.value_or(0.0), person.stable_stiffness.value_or(0.0));
      const ExerciseTarget& target = bench.run.view().target;
      if (target.kind == ExerciseTarget::Kind::kForce) {
        for (const double force : target.force)
          if (std::isfinite(force)) {
            EXPECT_LE(force, person.force_cap);
          }
      }
    }
  } catch (const ExerciseError&) {  // refused: it demands nothing
  }
}

/// @returns how many of the drawn files were accepted
int check_drawn_files(std::uint64_t seed, int files) {
  Random random(seed);
  int accepted = 0;
  for (int i = 0; i < files; ++i) {
    SCOPED_TRACE(fmt::format("seed {}, file {}", seed, i));
    const std::string text = drawn_file(random);
    const SceneDescription before = drawn_scene(random);
    PersonLimits person = able_person();
    person.force_cap = random.between(0.5, 8.0);
    person.stiffness_cap = random.between(100.0, 3'000.0);
    person.stable_stiffness = random.between(100.0, 3'000.0);
    ExerciseDescription exercise;
    try {
      exercise = parse_exercise(text, "drawn.toml");
    } catch (const SceneError& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
      continue;
    }
    ++accepted;
    SceneDescription after = before;
    const PersonLimits lowered = apply_exercise(after, exercise, person);
    expect_only_lowered(before, after);
    EXPECT_LE(lowered.stiffness_cap, after.parameters.force.stiffness);
    EXPECT_LE(lowered.force_cap, after.parameters.limits.fingertip_force);
    EXPECT_LE(after.parameters.limits.fingertip_force, person.force_cap);
    SceneDescription rest = before;
    copy_lowered(after, rest);
    EXPECT_EQ(rest.description, after.description);
    EXPECT_EQ(rest.objects.size(), after.objects.size());
    if (i % 5 == 0) expect_demands_within(exercise, lowered, seed + static_cast<std::uint64_t>(i));
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << text;
      return accepted;
    }
  }
  return accepted;
}

TEST(ExerciseFiles, CannotRaiseAForceAStiffnessOrATorque) {
  const int accepted = check_drawn_files(41, 500);
  EXPECT_GT(accepted, 100) << "of 500 drawn files";
}

TEST(ManyExerciseFiles, CannotRaiseAForceAStiffnessOrATorque) {
  const int accepted = check_drawn_files(4242, 3000);
  EXPECT_GT(accepted, 600) << "of 3,000 drawn files";
}

}  // namespace
}  // namespace phalanx
