// SPDX-License-Identifier: Apache-2.0
// A person's limits as TOML text, in SI units so that every number reads back exactly.
#include <fmt/format.h>

#include "phalanx/core/index.h"
#include "phalanx/scene/exercise_file.h"
#include "scene/exercise/exercise_rows.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr NumberRange kOwnForce = between(0.0, 1'000.0);
constexpr NumberRange kOwnAngle = between(-kPi, kPi);
constexpr NumberRange kCap = above(0.0, 1e6);
constexpr NumberRange kCount = between(0.0, 1e6);

void read_own_force(TomlTable table, PersonLimits& person) {
  for (int digit = 0; digit < kDigits; ++digit)
    if (table.has(digit_name(digit)))
      person.own_force[idx(digit)] = table.number(digit_name(digit), kOwnForce);
  table.finish();
}

void read_own_range(TomlTable table, PersonLimits& person) {
  for (int joint = 0; joint < kJoints; ++joint) {
    if (!table.has(joint_name(joint))) continue;
    const auto [min, max] = table.pair(joint_name(joint), kOwnAngle);
    if (min > max) table.fail(joint_name(joint), "the smallest angle is above the largest; swap them");
    person.own_range[idx(joint)] = OwnRange{.min = min, .max = max};
  }
  table.finish();
}

}  // namespace

PersonLimits parse_person_limits(const std::string& text, const std::string& origin) {
  const toml::table tree = parse_toml(text, origin);
  TomlTable root(tree, origin, "");
  if (root.number("format", {}) != kExerciseFormat)
    root.fail("format", fmt::format("this program reads format {}", kExerciseFormat));
  PersonLimits person;
  person.felt = read_digits(root, "felt");
  person.calibration_independent = root.flag("calibration_independent");
  person.force_cap = root.number("force_cap_n", kCap);
  person.stiffness_cap = root.number("stiffness_cap_n_per_m", kCap);
  if (root.has("stable_stiffness_n_per_m"))
    person.stable_stiffness = root.number("stable_stiffness_n_per_m", kCap);
  person.detects_slips = root.flag("detects_slips");
  person.repetitions_today = static_cast<int>(root.number("repetitions_today", kCount));
  person.minutes_today = root.number("minutes_today", kCount);
  if (root.has("difficulty")) person.difficulty = root.number("difficulty", exercise_ranges::kDifficulty);
  if (root.has("own_force_n")) read_own_force(root.table("own_force_n"), person);
  if (root.has("own_range_rad")) read_own_range(root.table("own_range_rad"), person);
  root.finish();
  return person;
}

std::string person_limits_text(const PersonLimits& person) {
  std::string text = fmt::format(
      "format = {}\nfelt = {}\ncalibration_independent = {}\nforce_cap_n = {}\nstiffness_cap_n_per_m = {}\n"
      "detects_slips = {}\nrepetitions_today = {}\nminutes_today = {}\n",
      kExerciseFormat, digits_text(person.felt), person.calibration_independent,
      shortest_text(person.force_cap), shortest_text(person.stiffness_cap), person.detects_slips,
      person.repetitions_today, shortest_text(person.minutes_today));
  if (person.stable_stiffness)
    text.append(fmt::format("stable_stiffness_n_per_m = {}\n", shortest_text(*person.stable_stiffness)));
  if (person.difficulty) text.append(fmt::format("difficulty = {}\n", shortest_text(*person.difficulty)));
  std::string forces;
  for (int digit = 0; digit < kDigits; ++digit)
    if (const auto& force = person.own_force[idx(digit)])
      forces.append(fmt::format("{} = {}\n", digit_name(digit), shortest_text(*force)));
  if (!forces.empty()) text.append("\n[own_force_n]\n").append(forces);
  std::string ranges;
  for (int joint = 0; joint < kJoints; ++joint)
    if (const auto& range = person.own_range[idx(joint)])
      ranges.append(fmt::format("{} = [{}, {}]\n", joint_name(joint), shortest_text(range->min),
                                shortest_text(range->max)));
  if (!ranges.empty()) text.append("\n[own_range_rad]\n").append(ranges);
  return text;
}

}  // namespace phalanx
