// SPDX-License-Identifier: Apache-2.0
// phalanx patient results | trend | test | note.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "patient/patient_commands.h"
#include "patient/patient_fields.h"
#include "patient/patient_text.h"
#include "phalanx/patients/trainings.h"

namespace phalanx {
namespace {

struct PatientResultOptions : PatientOptions {
  std::string exercise = {};  ///< only results or trends whose name begins so
  bool json = false;
};

struct PatientTestOptions : PatientOptions {
  std::string kind = {};
  double value = 0.0;
  std::string side = "more_affected";
  std::string date = {};
  std::string rater = {};
  std::string note = {};
};

struct PatientNoteOptions : PatientOptions {
  std::string text = {};
};

int print_results(const PatientResultOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  std::vector<ResultRow> results = opened.registry.results(opened.actor, patient.record);
  std::erase_if(results, [&](const ResultRow& row) { return !row.exercise.starts_with(o.exercise); });
  if (o.json) {
    std::vector<std::string> objects;
    for (const ResultRow& row : results) objects.push_back(result_json(row));
    fmt::print("[{}]\n", fmt::join(objects, ",\n"));
    return kDone;
  }
  if (results.empty()) fmt::print("no results\n");
  for (const ResultRow& row : results) fmt::print("{}", result_text(row));
  return kDone;
}

/// Describes the conditions under which a trend's points are equal.
std::string trend_conditions(const Trend& trend) {
  if (!trend.origin) return "entered by hand";
  const ResultConditions& c = trend.conditions;
  return fmt::format("{}; device {} {}, calibration {}, contact {}, stabiliser {}, rendering {}, protocol {}",
                     score_origin_name(*trend.origin), c.device, c.serial, c.calibration_method,
                     c.contact_mode, c.stabiliser, c.rendering,
                     c.protocol.empty() ? "not recorded" : c.protocol);
}

int print_trends(const PatientResultOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  std::vector<Trend> trends = opened.registry.trends(opened.actor, patient.record);
  const std::vector<ResultRow> results = opened.registry.results(opened.actor, patient.record);
  std::erase_if(trends, [&](const Trend& trend) { return !trend.name.starts_with(o.exercise); });
  if (trends.empty()) fmt::print("no trends: only complete assessments and entered tests make them\n");
  for (const Trend& trend : trends) {
    fmt::print("{}: {}\n", printable(trend.name), printable(trend.verdict));
    fmt::print("  {}\n", printable(trend_conditions(trend)));
    for (const TrendPoint& point : trend.points)
      fmt::print("  {}  {:.6g} {}\n", utc_day(point.date), point.value, trend.unit);
  }
  for (const TrainingReport& report : training_reports(patient, results))
    if (report.exercise.starts_with(o.exercise))
      fmt::print("{}, training: {}\n", printable(report.exercise), printable(report.success.text));
  return kDone;
}

int enter_test(const PatientTestOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  EnteredTest test;
  test.kind = test_kind(o.kind).kind;
  test.value = o.value;
  test.side = o.side == "less_affected" ? TestSide::kLessAffected : TestSide::kMoreAffected;
  test.date = o.date.empty() ? utc_today() : o.date;
  test.rater = o.rater;
  test.note = o.note;
  opened.registry.add_test(opened.actor, patient.record, test);
  fmt::print("{}\n", test_text(test));
  return kDone;
}

int enter_note(const PatientNoteOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  opened.registry.add_note(opened.actor, patient.record, o.text);
  fmt::print("noted\n");
  return kDone;
}

/// Help on the kinds of tests, with range, unit and published differences.
std::string kinds_text() {
  std::string text = "the test; VALUE is in its unit:";
  for (const TestKindInfo& kind : test_kinds())
    text.append(
        fmt::format("\n{}: {}, {} to {} {}", kind.name, kind.title, kind.least, kind.largest, kind.unit));
  return text;
}

void add_test_command(CLI::App& patient, Job& job) {
  auto options = std::make_shared<PatientTestOptions>();
  CLI::App* test = add_patient_job(patient, "test", "Enter the result of a clinical test that a rater made",
                                   options, job, enter_test);
  add_code(*test, *options);
  std::vector<std::string> kinds;
  for (const TestKindInfo& kind : test_kinds()) kinds.emplace_back(kind.name);
  test->add_option("--kind", options->kind, kinds_text())
      ->required()
      ->check(CLI::IsMember(kinds))
      ->type_name("KIND");
  test->add_option("--value", options->value, "the result")->required()->type_name("VALUE");
  test->add_option("--side", options->side, "the hand that was tested: more_affected or less_affected")
      ->check(CLI::IsMember({"more_affected", "less_affected"}))
      ->capture_default_str()
      ->type_name("SIDE");
  test->add_option("--date", options->date, "day of the test, UTC [today]")->type_name("DATE");
  test->add_option("--rater", options->rater, "initials or a role's code of the person who rated it")
      ->required()
      ->type_name("RATER");
  test->add_option("--note", options->note, "a remark; no names, no dates of birth")->type_name("TEXT");
}

}  // namespace

void add_patient_result_commands(CLI::App& patient, Job& job) {
  auto listed = std::make_shared<PatientResultOptions>();
  CLI::App* results =
      add_patient_job(patient, "results", "Print the results of exercises", listed, job, print_results);
  add_code(*results, *listed);
  results
      ->add_option("--exercise", listed->exercise, "only of this exercise, or of those whose names begin so")
      ->type_name("NAME");
  results->add_flag("--json", listed->json, "all fields, as one JSON array");
  auto drawn = std::make_shared<PatientResultOptions>();
  CLI::App* trend =
      add_patient_job(patient, "trend", "Print how assessments and entered tests change, and what is proven",
                      drawn, job, print_trends);
  add_code(*trend, *drawn);
  trend
      ->add_option("--exercise", drawn->exercise,
                   "only trends whose names begin so: an exercise, EXERCISE/SCORE, or a kind of test")
      ->type_name("NAME");
  add_test_command(patient, job);
  auto noted = std::make_shared<PatientNoteOptions>();
  CLI::App* note = add_patient_job(patient, "note", "Add a dated note", noted, job, enter_note);
  add_code(*note, *noted);
  note->add_option("TEXT", noted->text, "the note; no names, no dates of birth")->required()->type_name("");
}

}  // namespace phalanx
