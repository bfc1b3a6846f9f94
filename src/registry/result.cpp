// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "registry/field_checks.h"

namespace phalanx {
namespace {

constexpr double kUnpublished = std::numeric_limits<double>::quiet_NaN();

/// Smallest real differences: Chen, Chen, Wu, Wu, Chang 2009, Neurorehabil Neural Repair 23(5), 435-440.
constexpr std::array<TestKindInfo, 5> kKinds = {{
    {.kind = TestKind::kFuglMeyerHand,
     .name = "fugl_meyer_hand",
     .title = "Fugl-Meyer Assessment, hand",
     .unit = "points",
     .least = 0.0,
     .largest = 14.0,
     .larger_is_better = true,
     .difference_more_affected = kUnpublished,
     .difference_less_affected = kUnpublished},
    {.kind = TestKind::kBoxAndBlock,
     .name = "box_and_block",
     .title = "Box and Block Test",
     .unit = "blocks/min",
     .least = 0.0,
     .largest = 150.0,
     .larger_is_better = true,
     .difference_more_affected = 5.5,
     .difference_less_affected = 7.8},
    {.kind = TestKind::kNineHolePeg,
     .name = "nine_hole_peg",
     .title = "Nine-Hole Peg Test",
     .unit = "s",
     .least = 1.0,
     .largest = 600.0,
     .larger_is_better = false,
     .difference_more_affected = 32.8,
     .difference_less_affected = 6.2},
    {.kind = TestKind::kGrip,
     .name = "grip",
     .title = "Grip strength by dynamometer",
     .unit = "kg",
     .least = 0.0,
     .largest = 120.0,
     .larger_is_better = true,
     .difference_more_affected = 2.9,
     .difference_less_affected = 4.7},
    {.kind = TestKind::kAshworth,
     .name = "ashworth",
     .title = "Modified Ashworth Scale (1+ is entered as 1.5)",
     .unit = "points",
     .least = 0.0,
     .largest = 4.0,
     .larger_is_better = false,
     .difference_more_affected = kUnpublished,
     .difference_less_affected = kUnpublished},
}};

constexpr double kLastUtc = 7258118400.0;  ///< 2200-01-01
constexpr std::size_t kMostScores = 500;

void check_score(const Score& score) {
  if (!registry::has_only(score.name, "a-zA-Z0-9_.", 80))
    throw std::invalid_argument(fmt::format("scores: \"{}\" is no name of a score", score.name));
  registry::check_text("scores: unit", score.unit, 20);
  registry::check_text("scores: invalid", score.invalid, 400);
  if (score.valid() && !std::isfinite(score.value))
    throw std::invalid_argument(
        fmt::format("the score {} is not a finite number; state why it is invalid", score.name));
}

void check_conditions(const ResultConditions& conditions) {
  for (const std::string* text :
       {&conditions.device, &conditions.serial, &conditions.calibration_method, &conditions.contact_mode,
        &conditions.stabiliser, &conditions.rendering, &conditions.protocol})
    registry::check_text("conditions", *text, 200);
}

void check_rating(std::string_view field, int value) {
  if (value < -1 || value > 10)
    throw std::invalid_argument(
        fmt::format("{} is {}; it must be in 0 .. 10, or -1: not asked", field, value));
}

}  // namespace

std::span<const TestKindInfo> test_kinds() noexcept { return kKinds; }

const TestKindInfo& test_kind(TestKind kind) noexcept { return kKinds[static_cast<std::size_t>(kind)]; }

const TestKindInfo& test_kind(std::string_view name) {
  for (const TestKindInfo& each : kKinds)
    if (each.name == name) return each;
  std::string known;
  for (const TestKindInfo& each : kKinds) known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
  throw std::invalid_argument(fmt::format("there is no test \"{}\"; the tests are {}", name, known));
}

std::string_view test_side_name(TestSide side) noexcept {
  return side == TestSide::kMoreAffected ? "more_affected" : "less_affected";
}

void check_result(const ResultRow& row) {
  registry::check_text("recording", row.recording, 255);
  if (row.recording.empty() || row.recording.find('/') != std::string::npos)
    throw std::invalid_argument(
        fmt::format("the recording \"{}\" must be a file name without a folder", row.recording));
  if (row.number < 1)
    throw std::invalid_argument(fmt::format("number is {}; it must be at least 1", row.number));
  if (!registry::has_only(row.exercise, "a-z0-9_", 64))
    throw std::invalid_argument(
        fmt::format("the exercise \"{}\" must be 1 to 64 of a-z, 0-9 and '_'", row.exercise));
  registry::check_number("date", row.date, 0.0, kLastUtc);
  if (row.scores.size() > kMostScores)
    throw std::invalid_argument(
        fmt::format("{} scores; at most {} are possible", row.scores.size(), kMostScores));
  for (const Score& score : row.scores) check_score(score);
  check_conditions(row.conditions);
  registry::check_text("invalid", row.invalid, 400);
  if (row.valid != row.invalid.empty())
    throw std::invalid_argument("a result that is not valid states why in `invalid`; a valid one does not");
  registry::check_number("seconds", row.seconds, 0.0, 86400.0);
  registry::check_number("repetitions", row.repetitions, 0, 1e6);
  registry::check_number("successes", row.successes, 0, row.repetitions);
  if (!std::isfinite(row.difficulty)) throw std::invalid_argument("difficulty is not a finite number");
  check_rating("pain", row.pain);
  check_rating("fatigue", row.fatigue);
  registry::check_text("detail", row.detail, 4U << 20U);
}

void check_test(const EnteredTest& test) {
  if (static_cast<std::size_t>(test.kind) >= kKinds.size())
    throw std::invalid_argument("there is no such test");
  const TestKindInfo& kind = test_kind(test.kind);
  registry::check_number(fmt::format("{} [{}]", kind.title, kind.unit), test.value, kind.least, kind.largest);
  registry::check_date("date", test.date, false);
  if (!registry::has_only(test.rater, "A-Za-z0-9.-", 16))
    throw std::invalid_argument(
        fmt::format("the rater \"{}\" must be initials or a role's code: 1 to 16 of A-Z, a-z, 0-9, '.', '-'",
                    test.rater));
  registry::check_anonymous("note", test.note, 1000);
}

}  // namespace phalanx
