// SPDX-License-Identifier: Apache-2.0
// Results of exercises, tests that are entered by hand, and notes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/score.h"

namespace phalanx {

/// Conditions of a result. A trend joins only results whose conditions are equal.
struct ResultConditions {
  std::string device;
  std::string serial;
  std::string calibration_method;
  std::string contact_mode;
  std::string stabiliser;
  std::string rendering;  ///< version of the rendering
  /// Hash of the assessment's fixed conditions: assessment_protocol(); empty: not recorded
  std::string protocol;

  [[nodiscard]] bool operator==(const ResultConditions&) const = default;
};

/// One carried-out exercise. (recording, number) is its identity within a patient.
struct ResultRow {
  std::string recording;    ///< file name of the recording, without a folder
  int number = 1;           ///< of the exercise in that recording, from 1
  std::string exercise;     ///< name of the exercise
  bool assessment = false;  ///< only an assessment's scores make a trend
  double date = 0.0;        ///< begin, UTC [s since 1970]
  std::vector<Score> scores;
  ResultConditions conditions;
  bool interrupted = false;  ///< the exercise did not come to its end
  bool valid = true;
  std::string invalid;   ///< why it is not valid
  double seconds = 0.0;  ///< duration, for the dose [s]
  int repetitions = 0;   ///< trials that were carried out, for the dose
  int successes = 0;     ///< of these
  double difficulty = 0.0;
  int pain = -1;       ///< 0 .. 10; -1: not asked
  int fatigue = -1;    ///< 0 .. 10; -1: not asked
  std::string detail;  ///< canonical JSON of the whole result, as recorded; may be empty
};

/// Clinical test that needs real objects or a rater.
enum class TestKind : std::uint8_t { kFuglMeyerHand, kBoxAndBlock, kNineHolePeg, kGrip, kAshworth };

/// Side of a test, relative to the impairment: published differences depend on it.
enum class TestSide : std::uint8_t { kMoreAffected, kLessAffected };

/// Result of a clinical test, entered by hand.
struct EnteredTest {
  TestKind kind = TestKind::kGrip;
  double value = 0.0;  ///< in the unit of test_kinds()
  TestSide side = TestSide::kMoreAffected;
  std::string date;   ///< UTC, "2026-05-04"
  std::string rater;  ///< initials or a role's code, 1 .. 16 of A-Z, a-z, 0-9, '-', '.'
  std::string note;
};

/// Properties of a kind of test.
struct TestKindInfo {
  TestKind kind;
  std::string_view name;   ///< in files and commands: "box_and_block"
  std::string_view title;  ///< for people: "Box and Block Test"
  std::string_view unit;   ///< "blocks/min"
  double least;
  double largest;
  bool larger_is_better;
  double difference_more_affected;  ///< smallest real difference; NaN: none is published
  double difference_less_affected;  ///< likewise
};
/// @returns all kinds of tests; source of the smallest real differences: Chen et al. 2009,
/// Neurorehabil Neural Repair
[[nodiscard]] std::span<const TestKindInfo> test_kinds() noexcept;
[[nodiscard]] const TestKindInfo& test_kind(TestKind kind) noexcept;
/// @throws std::invalid_argument naming the known kinds
[[nodiscard]] const TestKindInfo& test_kind(std::string_view name);
/// @returns "more_affected" or "less_affected"
[[nodiscard]] std::string_view test_side_name(TestSide side) noexcept;

/// Note on a patient.
struct PatientNote {
  double date = 0.0;    ///< UTC [s since 1970]; add_note() sets it
  std::string account;  ///< author; add_note() sets it
  std::string text;     ///< 1 .. 4000 bytes
};

/// Checks ranges, lengths and UTF-8; NaN or infinity in a valid score is refused.
/// @throws std::invalid_argument naming field, value and remedy
void check_result(const ResultRow& row);
/// Likewise. @throws likewise
void check_test(const EnteredTest& test);

/// @returns one JSON object with the fields' names as above
[[nodiscard]] std::string result_json(const ResultRow& row);
[[nodiscard]] std::string test_json(const EnteredTest& test);
[[nodiscard]] std::string note_json(const PatientNote& note);
/// Reads what result_json() writes. @throws std::invalid_argument naming the field
[[nodiscard]] ResultRow parse_result_json(std::string_view text);
[[nodiscard]] EnteredTest parse_test_json(std::string_view text);
[[nodiscard]] PatientNote parse_note_json(std::string_view text);

}  // namespace phalanx
