// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/patient.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using testing::example_patient;
using testing::example_result;
using ::testing::HasSubstr;

/// @returns the message of a refusal; empty: it was accepted
template <typename Function>
std::string refusal(const Function& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

std::string refusal_of_code(const std::string& code) {
  return refusal([&] { check_patient_fields(example_patient(code)); });
}

std::string refusal_with(const std::function<void(Patient&)>& change) {
  Patient patient = example_patient();
  change(patient);
  return refusal([&] { check_patient_fields(patient); });
}

TEST(PatientFields, TakeACodeOfCapitalsAndDigits) {
  for (const char* code : {"P07", "A", "0", "12345", "K-2026-17", "ABCDEFGHIJKLMNOP", "99999999", "450"})
    EXPECT_EQ(refusal_of_code(code), "") << code;
  for (const char* code : {"", "p07", "P 07", "ABCDEFGHIJKLMNOPQ", "P07\n", "Ä", "P@7"})
    EXPECT_THAT(refusal_of_code(code), HasSubstr("1 to 16 of A-Z")) << code;
}

TEST(PatientFields, RefuseACodeThatIsADate) {
  for (const char* code :
       {"1957-04-23", "19570423", "23-04-1957", "04-23-1957", "570423", "23-04-57", "042357"})
    EXPECT_THAT(refusal_of_code(code), HasSubstr("looks like a date")) << code;
}

TEST(PatientFields, RefuseWhatLooksLikeAPerson) {
  EXPECT_THAT(refusal_with([](Patient& p) { p.note = "mail ann@example.org"; }), HasSubstr("'@'"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.warnings = {"Born 1957"}; }), HasSubstr("born"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.contraindications = {"geb. 1957"}; }), HasSubstr("geb."));
  EXPECT_THAT(refusal_with([](Patient& p) { p.profile = "a@b"; }), HasSubstr("profile"));
}

TEST(PatientFields, RefuseNumbersOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_with([](Patient& p) { p.force_limit_n = 0.0; }), HasSubstr("force_limit_n"));
  EXPECT_THAT(refusal_with([&](Patient& p) { p.force_limit_n = nan; }), HasSubstr("force_limit_n"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.stiffness_limit_n_per_mm = 11.0; }), HasSubstr("stiffness"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.torque_limit_nm = -1.0; }), HasSubstr("torque"));
  EXPECT_THAT(refusal_with([&](Patient& p) { p.own_force_n[2] = nan; }), HasSubstr("own_force_n"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.own_range_deg["elbow"] = {0, 1}; }), HasSubstr("elbow"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.own_range_deg[std::string(joint_name(0))] = {10, 5}; }),
              HasSubstr("own_range_deg"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.calibration_expires = "31.12.2026"; }),
              HasSubstr("2026-05-04"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.consent_date = "2026-02-30"; }), HasSubstr("consent_date"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.symbol = "skull"; }), HasSubstr("sun, tree, boat"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.prescription[0].repetitions_per_day = -1; }),
              HasSubstr("repetitions"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.note = std::string("\xff"); }), HasSubstr("UTF-8"));
  EXPECT_THAT(refusal_with([](Patient& p) { p.note = std::string(4001, 'a'); }), HasSubstr("4000"));
}

TEST(PatientFields, ReadWhatTheyWrite) {
  Patient patient = example_patient();
  patient.own_range_deg[std::string(joint_name(3))] = {-5.0, 71.25};
  patient.torque_limit_nm = 0.1;
  EXPECT_EQ(patient_json(parse_patient_json(patient_json(patient))), patient_json(patient));
  EXPECT_EQ(patient_json(parse_patient_json(patient_json(Patient{}))), patient_json(Patient{}));
  EXPECT_THAT(refusal([] { static_cast<void>(parse_patient_json(R"({"name":"Ann"})")); }),
              HasSubstr("\"name\""));
  EXPECT_THAT(refusal([] { static_cast<void>(parse_patient_json(R"({"code":7})")); }), HasSubstr("\"code\""));
  for (const char* text :
       {"", "[]", "{", "null", R"({"prescription":{}})", R"({"entry":1})", R"({"side":"both"})"})
    EXPECT_NE(refusal([&] { static_cast<void>(parse_patient_json(text)); }), "") << text;
}

TEST(ResultFields, ReadWhatTheyWrite) {
  const ResultRow row = example_result("2026-05-04T09-46-40Z.mcap.enc", 2, 0.1 + 0.2);
  EXPECT_EQ(result_json(parse_result_json(result_json(row))), result_json(row));
  EXPECT_EQ(parse_result_json(result_json(row)).scores[0].value, 0.1 + 0.2);
  EXPECT_EQ(refusal([&] { check_result(row); }), "");
}

TEST(ResultFields, OfAnOlderResultHaveAnEmptyProtocol) {
  const ResultRow older = parse_result_json(R"({"recording":"a.mcap","conditions":{"rendering":"1"}})");
  EXPECT_EQ(older.conditions.rendering, "1");
  EXPECT_EQ(older.conditions.protocol, "");
  EXPECT_EQ(parse_result_json(result_json(example_result("a.mcap"))).conditions.protocol, "00c0ffee00c0ffee");
}

TEST(ResultFields, RefuseAScoreThatIsNotANumber) {
  ResultRow row = example_result("a.mcap");
  row.scores[0].value = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal([&] { check_result(row); }), HasSubstr("mean_n"));
  row.scores[0].invalid = "not measured";
  EXPECT_EQ(refusal([&] { check_result(row); }), "");
  row.recording = "../a.mcap";
  EXPECT_THAT(refusal([&] { check_result(row); }), HasSubstr("without a folder"));
  row = example_result("a.mcap");
  row.valid = false;
  EXPECT_THAT(refusal([&] { check_result(row); }), HasSubstr("states why"));
  row = example_result("a.mcap");
  row.successes = 6;
  EXPECT_THAT(refusal([&] { check_result(row); }), HasSubstr("successes"));
  row = example_result("a.mcap");
  row.pain = 11;
  EXPECT_THAT(refusal([&] { check_result(row); }), HasSubstr("pain"));
}

TEST(EnteredTests, AreCheckedByTheirKind) {
  const auto message = [](TestKind kind, double value, const char* date, const char* rater) {
    return refusal([&] {
      check_test({.kind = kind,
                  .value = value,
                  .side = TestSide::kMoreAffected,
                  .date = date,
                  .rater = rater,
                  .note = {}});
    });
  };
  EXPECT_EQ(message(TestKind::kBoxAndBlock, 38, "2026-05-04", "LW"), "");
  EXPECT_THAT(message(TestKind::kBoxAndBlock, 151, "2026-05-04", "LW"), HasSubstr("Box and Block"));
  EXPECT_THAT(message(TestKind::kFuglMeyerHand, 15, "2026-05-04", "LW"), HasSubstr("Fugl-Meyer"));
  EXPECT_THAT(message(TestKind::kGrip, std::nan(""), "2026-05-04", "LW"), HasSubstr("Grip"));
  EXPECT_THAT(message(TestKind::kAshworth, 1.5, "4.5.2026", "LW"), HasSubstr("date"));
  EXPECT_THAT(message(TestKind::kAshworth, 1.5, "2026-05-04", "Dr. Lena Weber"), HasSubstr("initials"));
  EXPECT_THAT(message(TestKind::kAshworth, 1.5, "2026-05-04", ""), HasSubstr("initials"));
  EXPECT_THROW(static_cast<void>(test_kind("barthel")), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
