// SPDX-License-Identifier: Apache-2.0
// The report's page: its head, what to note, and the patient; the chapters between are in *_sections.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/xml_text.h"
#include "phalanx/hand/joints.h"
#include "report/date_axis.h"
#include "report/dose.h"
#include "report/report_sections.h"
#include "report/score_names.h"

namespace phalanx {
namespace report {
namespace {

constexpr const char* kEnDash = " \u2013 ";

std::string period_of(const ReportContext& context) {
  if (context.of_one_day())
    return fmt::format(fmt::runtime(context.words.of_day), day_label(context.input.day, context.language));
  std::vector<std::string> days;
  for (const ResultRow* row : context.rows) days.push_back(iso_day(row->date));
  for (const EnteredTest* test : context.tests) days.push_back(test->date);
  if (days.empty()) return {};
  const auto [first, last] = std::minmax_element(days.begin(), days.end());
  const std::string from = day_label(*first, context.language);
  return *first == *last ? from : fmt::format("{}{}{}", from, kEnDash, day_label(*last, context.language));
}

std::string kind_of(const ReportContext& context) {
  const char* kind = context.of_one_day() ? context.words.session_report : context.words.report;
  const std::string period = period_of(context);
  return period.empty() ? kind : fmt::format("{}{}{}", kind, context.of_one_day() ? " " : " \u00B7 ", period);
}

const char* hand_of(const ReportContext& context) {
  return context.input.patient.side == Handedness::kLeft ? context.words.left_hand : context.words.right_hand;
}

/// @returns true if a simulated participant did at least one of the exercises
bool is_simulated_report(const ReportContext& context) {
  return context.is_simulated({}) ||
         std::any_of(context.conditions.begin(), context.conditions.end(),
                     [&](const ResultConditions& each) { return context.is_simulated(each); });
}

void add_head(ReportPage& page, const ReportContext& context) {
  const Patient& patient = context.input.patient;
  page.raw("<header><div>");
  page.paragraph(kind_of(context), "kind");
  page.raw(fmt::format("<h1>{} <small>{} \u00B7 {}</small></h1></div>", xml_escaped(patient.code),
                       hand_of(context), xml_escaped(symbol_label(patient.symbol, context.language))));
  page.element("div",
               fmt::format("{}\n{} {}\nPhalanx {}",
                           fmt::format(fmt::runtime(context.words.made_on),
                                       day_label(context.input.today, context.language)),
                           context.words.record, patient.record, context.input.version),
               "made");
  page.raw("</header>");
  if (is_simulated_report(context)) page.paragraph(context.words.simulated, "note");
  page.paragraph(context.words.no_device, "plain");
}

void add_tiles(ReportPage& page, const ReportContext& context) {
  if (context.rows.empty()) return;
  const Dose whole = whole_dose(context.rows, context.details);
  page.raw(R"(<div class="tiles">)");
  const auto tile = [&](const char* name, const std::string& shown, const std::string& exact,
                        const char* label) {
    page.raw(fmt::format("<div><b{}>{}</b><span>{}</span></div>",
                         data_attributes({{"sum", name}, {"value", exact}}), shown, label));
  };
  const auto count = [&](const char* name, int value, const char* label) {
    tile(name, fmt::format("{}", value), fmt::format("{}", value), label);
  };
  count("days", whole.days, context.words.days_done);
  count("exercises", whole.exercises, context.words.exercises_done);
  tile("seconds", minutes_label(whole.seconds, context.language), exact_text(whole.seconds),
       context.words.minutes_done);
  count("trials", whole.trials, context.words.trials_done);
  page.raw("</div>");
}

/// @returns the words with the day of the patient's fields: they are today's, also in a report of an earlier day
std::string as_of_today(const char* what, const ReportContext& context) {
  if (context.input.today.empty()) return what;
  return fmt::format(fmt::runtime(context.words.as_of), what,
                     day_label(context.input.today, context.language));
}

void add_to_note(ReportPage& page, const ReportContext& context) {
  const Words& words = context.words;
  const Patient& patient = context.input.patient;
  std::vector<std::string> items;
  for (const std::string& text : patient.contraindications)
    items.push_back(fmt::format("{}: {}", words.contraindication, text));
  if (patient.entry && !patient.entry->suitable) items.emplace_back(words.not_suitable);
  for (const std::string& text : patient.warnings)
    items.push_back(fmt::format("{}: {}", words.warning, text));
  if (!patient.consent) items.emplace_back(words.no_consent);
  if (!patient.calibration_expires.empty() && patient.calibration_expires < context.input.today)
    items.push_back(fmt::format(fmt::runtime(words.calibration_expired),
                                day_label(patient.calibration_expires, context.language)));
  const auto incomplete = std::count_if(context.rows.begin(), context.rows.end(),
                                        [](const ResultRow* row) { return !is_complete(*row); });
  if (incomplete == 1) items.emplace_back(words.incomplete_one);
  if (incomplete > 1) items.push_back(fmt::format(fmt::runtime(words.incomplete_done), incomplete));
  for (const ReportedExercise& exercise : context.input.exercises)
    if (exercise.needs_attention && !context.of_one_day())  // it is judged over sessions of several days
      items.push_back(
          fmt::format("{}: {}", context.title_of(exercise.name), success_words(exercise, context.language)));
  if (items.empty()) return;
  page.raw(R"(<div class="note">)");
  page.element("b", as_of_today(words.to_note, context));
  page.list(items);
  page.raw("</div>");
}

void add_proven(ReportPage& page, const ReportContext& context) {
  if (context.input.trends.empty() || context.of_one_day()) return;
  std::vector<std::string> better;
  std::vector<std::string> worse;
  for (const Trend& trend : context.input.trends) {
    if (!trend.proven) continue;
    const std::string_view name(trend.name);
    const std::string_view kind = name.substr(0, name.find('/'));
    const std::string_view rest = name.substr(name.find('/') + 1);
    const std::string title =
        trend.origin
            ? fmt::format("{}: {}", context.title_of(std::string(kind)), score_label(rest, context.language))
            : fmt::format("{}, {}", test_label(test_kind(kind).kind, context.language),
                          rest == test_side_name(TestSide::kMoreAffected) ? context.words.more_affected
                                                                          : context.words.less_affected);
    (is_better(trend) ? better : worse)
        .push_back(fmt::format("{}: {}", title, trend_verdict(trend, context)));
  }
  const auto box = [&](const char* css_class, const char* heading, const std::vector<std::string>& items) {
    page.raw(fmt::format(R"(<div class="note {}">)", css_class));
    page.element("b", heading);
    if (items.empty()) page.paragraph(context.words.nothing_proven);
    page.list(items);
    page.raw("</div>");
  };
  if (better.empty() && worse.empty()) box("plainly", context.words.proven_title, {});
  if (!worse.empty()) box("bad", context.words.proven_worse, worse);
  if (!better.empty()) box("good", context.words.proven_better, better);
}

Cell field_cell(const std::string& text, const std::string& field, double value) {
  return {.text = text, .data = data_attributes({{"field", field}, {"value", exact_text(value)}})};
}

std::vector<Cell> limit_cells(const ReportContext& context) {
  const Patient& patient = context.input.patient;
  const Words& words = context.words;
  std::vector<Cell> parts;
  const auto add = [&](const std::optional<double>& limit, const char* format, const char* field) {
    if (!limit) return;
    const std::string number = number_label(*limit, context.language);
    parts.push_back(field_cell(fmt::format(fmt::runtime(format), number), field, *limit));
  };
  add(patient.force_limit_n, words.force_limit, "force_limit_n");
  add(patient.stiffness_limit_n_per_mm, words.stiffness_limit, "stiffness_limit_n_per_mm");
  add(patient.torque_limit_nm, words.torque_limit, "torque_limit_nm");
  if (parts.empty()) parts.push_back({.text = words.none});
  return parts;
}

std::vector<Cell> entry_cells(const EntryCheck& entry, const ReportContext& context) {
  const Words& words = context.words;
  const auto angle = [&](const char* format, double value) {
    return fmt::format(fmt::runtime(format), number_label(value, context.language));
  };
  return {field_cell(angle(words.entry_flexion, entry.flexion_deg), "entry/flexion_deg", entry.flexion_deg),
          field_cell(angle(words.entry_release, entry.release_deg), "entry/release_deg", entry.release_deg),
          {.text = entry.suitable ? words.suitable : words.not_suitable},
          {.text = day_label(entry.date, context.language)}};
}

std::vector<Cell> own_force_cells(const ReportContext& context) {
  std::vector<Cell> parts;
  for (int digit = 0; digit < kDigits; ++digit) {
    const double force = context.input.patient.own_force_n.at(static_cast<std::size_t>(digit));
    if (force <= 0.0) continue;
    parts.push_back(field_cell(fmt::format("{} {}", digit_label(digit_name(digit), context.language),
                                           value_label(force, "N", context.language)),
                               fmt::format("own_force_n/{}", digit_name(digit)), force));
  }
  return parts;
}

std::string prescription_text_of(const ReportContext& context) {
  std::vector<std::string> lines;
  for (const PrescribedExercise& each : context.input.patient.prescription) {
    std::vector<std::string> parts;
    if (each.repetitions_per_day > 0)
      parts.push_back(fmt::format(fmt::runtime(context.words.trials_a_day), each.repetitions_per_day));
    if (each.minutes_per_day > 0.0)
      parts.push_back(fmt::format(fmt::runtime(context.words.most_minutes_a_day),
                                  number_label(each.minutes_per_day, context.language)));
    for (const auto& [key, value] : each.overrides) {
      std::string number = value;
      if (context.language == ReportLanguage::kGerman) std::replace(number.begin(), number.end(), '.', ',');
      parts.push_back(fmt::format("{} {}", prescription_key_label(key, context.language), number));
    }
    if (!each.note.empty()) parts.push_back(each.note);
    lines.push_back(parts.empty()
                        ? context.title_of(each.exercise)
                        : fmt::format("{} ({})", context.title_of(each.exercise), fmt::join(parts, ", ")));
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

void add_patient(ReportPage& page, const ReportContext& context) {
  const Words& words = context.words;
  const Patient& patient = context.input.patient;
  std::vector<Definition> all = {{.name = words.limits, .parts = limit_cells(context)}};
  const auto add = [&](const char* name, const std::string& text) {
    all.push_back({.name = name, .parts = {{.text = text}}});
  };
  if (patient.entry)
    all.push_back({.name = words.entry_check, .parts = entry_cells(*patient.entry, context)});
  std::string calibration = words.none;
  if (!patient.calibration_device.empty()) {
    calibration = fmt::format("{} {}, {}", patient.calibration_device, patient.calibration_serial,
                              condition_label(patient.calibration_method, context.language));
    if (!patient.calibration_expires.empty())
      calibration.append(", ").append(
          fmt::format(fmt::runtime(words.until), day_label(patient.calibration_expires, context.language)));
  }
  add(words.calibration, calibration);
  if (std::vector<Cell> forces = own_force_cells(context); !forces.empty())
    all.push_back({.name = words.own_force, .parts = std::move(forces)});
  if (!patient.prescription.empty()) add(words.prescription, prescription_text_of(context));
  add(words.consent, patient.consent_date.empty()
                         ? std::string(patient.consent ? words.yes : words.no)
                         : fmt::format("{}, {}", patient.consent ? words.yes : words.no,
                                       day_label(patient.consent_date, context.language)));
  if (!patient.note.empty()) add(words.note, patient.note);
  page.heading(as_of_today(words.patient, context));
  page.definitions(all);
}

void add_notes(ReportPage& page, const ReportContext& context) {
  if (context.notes.empty()) return;
  page.heading(context.words.notes);
  std::vector<Definition> all;
  for (const PatientNote* note : context.notes)
    all.push_back(
        {.name = fmt::format("{} \u00B7 {}", day_label(note->date, context.language), note->account),
         .parts = {{.text = note->text}}});
  page.definitions(all);
}

void add_end(ReportPage& page, const ReportContext& context) {
  const Words& words = context.words;
  page.heading(words.how_to_read);
  page.list({words.how_measured, words.how_proven, words.how_trained, words.how_dose}, "small");
}

}  // namespace
}  // namespace report

std::string report_html(const ReportInput& input, ReportLanguage language) {
  using namespace report;
  const ReportContext context = report_context(input, language);
  ReportPage page;
  add_head(page, context);
  add_tiles(page, context);
  add_to_note(page, context);
  add_proven(page, context);
  if (context.of_one_day()) {
    add_session(page, context);
    add_tests(page, context);
  } else {
    add_tests(page, context);
    add_assessments(page, context);
    add_trainings(page, context);
    add_days(page, context);
  }
  add_faults(page, context);
  add_not_measured(page, context);
  add_notes(page, context);
  add_patient(page, context);
  add_conditions(page, context);
  add_end(page, context);
  const std::string title = fmt::format("{} \u2013 {}", input.patient.code, kind_of(context));
  return page.document(context.words.language, title, fmt::format("Phalanx \u00B7 {}", title));
}

}  // namespace phalanx
