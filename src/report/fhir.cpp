// SPDX-License-Identifier: Apache-2.0
// FHIR R4 (https://hl7.org/fhir/R4): a Bundle of Observations and of the devices that they name.
#include <fmt/format.h>
#include <algorithm>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "phalanx/exercise/reasons.h"
#include "registry/field_checks.h"
#include "report/report_sections.h"
#include "report/score_names.h"

namespace phalanx {
namespace report {
namespace {

using Fhir = nlohmann::ordered_json;

constexpr const char* kScoreSystem = "urn:phalanx:code-system:score";
constexpr const char* kExerciseSystem = "urn:phalanx:code-system:exercise";
constexpr const char* kFieldSystem = "urn:phalanx:code-system:result-field";
constexpr const char* kOriginSystem = "urn:phalanx:code-system:origin";
constexpr const char* kFaultSystem = "urn:phalanx:code-system:fault";
constexpr const char* kReasonSystem = "urn:phalanx:code-system:reason";
constexpr const char* kTestSystem = "urn:phalanx:code-system:entered-test";
constexpr const char* kPatientSystem = "urn:phalanx:identifier:patient-code";
constexpr const char* kCategorySystem = "http://terminology.hl7.org/CodeSystem/observation-category";
constexpr const char* kAbsentSystem = "http://terminology.hl7.org/CodeSystem/data-absent-reason";
constexpr const char* kUcum = "http://unitsofmeasure.org";

/// @returns a UUID of version 8 (RFC 9562): equal texts have equal ones. FNV-1a with two offsets; not for
/// cryptography
std::string uuid_of(const std::string& text) {
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  std::array<std::uint64_t, 2> hash = {14695981039346656037ULL, 0x9e3779b97f4a7c15ULL};
  for (std::uint64_t& each : hash)
    for (const char c : text) each = (each ^ static_cast<unsigned char>(c)) * kPrime;
  const std::uint64_t high = (hash[0] & 0xffffffffffff0fffULL) | 0x8000ULL;
  const std::uint64_t low = (hash[1] & 0x3fffffffffffffffULL) | 0x8000000000000000ULL;
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, (high >> 16U) & 0xffffU,
                     high & 0xffffU, low >> 48U, low & 0xffffffffffffULL);
}

Fhir coding(const char* system, const std::string& code, const std::string& display) {
  Fhir made = {{"system", system}, {"code", code}};
  if (!display.empty()) made["display"] = display;
  return made;
}

Fhir concept_of(const char* system, const std::string& code, const std::string& display) {
  Fhir made;
  made["coding"] = Fhir::array({coding(system, code, display)});
  if (!display.empty()) made["text"] = display;
  return made;
}

Fhir quantity(double value, std::string_view unit) {
  const std::string code = ucum_of(unit);
  return {
      {"value", value}, {"unit", unit == "-" ? "1" : std::string(unit)}, {"system", kUcum}, {"code", code}};
}

/// @returns a reason with a code for each reason of this program that it states
Fhir reason_concept(const std::string& reason) {
  Fhir made;
  for (const Reason known : find_reasons(reason))
    made["coding"].push_back(coding(kReasonSystem, std::string(reason_code(known)), ""));
  made["text"] = reason;
  return made;
}

Fhir absent_reason(const std::string& reason) {
  const bool not_measured = reason.starts_with("not measured");
  Fhir made = concept_of(kAbsentSystem, not_measured ? "not-performed" : "error",
                         not_measured ? "Not Performed" : "Error");
  for (const Reason known : find_reasons(reason))
    made["coding"].push_back(coding(kReasonSystem, std::string(reason_code(known)), ""));
  made["text"] = reason.empty() ? "not valid" : reason;
  return made;
}

/// Makes the entries of one bundle.
class BundleMaker {
 public:
  explicit BundleMaker(const ReportContext& context) : context_(context) {}

  void add_row(const ResultRow& row) {
    const std::string base =
        fmt::format("{}\n{}\n{}", context_.input.patient.record, row.recording, row.number);
    const std::string device = device_of(row.conditions);
    Fhir members = Fhir::array();
    for (const Score& score : row.scores) {
      const bool has_value = score.valid() && std::isfinite(score.value);
      Fhir made = observation(fmt::format("{}\n{}", base, score.name),
                              has_value || is_complete(row) ? "final" : "cancelled",
                              row.assessment ? "exam" : "therapy");
      made["code"] = concept_of(kScoreSystem, fmt::format("{}/{}", row.exercise, score.name),
                                fmt::format("{}: {}", context_.title_of(row.exercise),
                                            score_label(score.name, ReportLanguage::kEnglish)));
      add_subject(made, registry::utc_text(row.date));
      if (has_value) {
        made["valueQuantity"] = quantity(score.value, score.unit);
      } else {
        made["dataAbsentReason"] = absent_reason(score.invalid);
      }
      finish_row(made, row, device);
      made["component"] = components_of(row, score);
      members.push_back({{"reference", "urn:uuid:" + made["id"].get<std::string>()}});
      add(std::move(made));
    }
    add_faults(row, base, device, members);
    add_whole_row(row, base, device, std::move(members));
  }

  void add_test(const EnteredTest& test) {
    const TestKindInfo& kind = test_kind(test.kind);
    // Tests of one kind, side and day are numbered: all of them are in a bundle of the day, too.
    const std::string same = fmt::format("{}\ntest\n{}\n{}\n{}", context_.input.patient.record, kind.name,
                                         test_side_name(test.side), test.date);
    Fhir made = observation(fmt::format("{}\n{}", same, ordinals_[same]++), "final", "exam");
    made["code"] = concept_of(kTestSystem, std::string(kind.name), std::string(kind.title));
    add_subject(made, test.date);
    made["performer"] = Fhir::array({{{"display", test.rater}}});
    made["valueQuantity"] = quantity(test.value, kind.unit);
    if (!test.note.empty()) made["note"] = Fhir::array({{{"text", test.note}}});
    made["bodySite"] = {
        {"text", test.side == TestSide::kMoreAffected ? "more affected hand" : "less affected hand"}};
    made["component"] = Fhir::array({origin_component("entered", "entered by hand")});
    if (context_.is_simulated({})) add_flag(made["component"], "simulated", kSimulatedText, true);
    add(std::move(made));
  }

  [[nodiscard]] Fhir bundle() && {
    Fhir made = {{"resourceType", "Bundle"}, {"type", "collection"}};
    if (!context_.input.today.empty()) made["timestamp"] = context_.input.today + "T00:00:00Z";
    if (!entries_.empty()) made["entry"] = std::move(entries_);
    return made;
  }

 private:
  static constexpr const char* kSimulatedText = "a simulated participant did it, no person";

  static Fhir observation(const std::string& identity, const char* status, const char* category) {
    Fhir made = {{"resourceType", "Observation"}, {"id", uuid_of(identity)}, {"status", status}};
    made["category"] =
        Fhir::array({{{"coding", Fhir::array({{{"system", kCategorySystem}, {"code", category}}})}}});
    return made;
  }

  void add_subject(Fhir& made, const std::string& date) const {
    made["subject"] = {{"type", "Patient"},
                       {"identifier", {{"system", kPatientSystem}, {"value", context_.input.patient.code}}}};
    made["effectiveDateTime"] = date;
  }

  void finish_row(Fhir& made, const ResultRow& row, const std::string& device) const {
    std::vector<std::string> notes;
    if (!row.valid) notes.emplace_back("the exercise is not valid");
    if (row.interrupted) notes.emplace_back("the exercise was interrupted");
    if (const std::string remark = fault_remark(row, context_); !remark.empty()) notes.push_back(remark);
    if (!notes.empty()) made["note"] = Fhir::array({{{"text", fmt::format("{}", fmt::join(notes, ": "))}}});
    made["bodySite"] = {{"text", fmt::format("{} hand", side_name(context_.input.patient.side))}};
    made["device"] = {{"reference", "urn:uuid:" + device}};
  }

  static Fhir component(const char* system, const char* code, const char* display) {
    return {{"code", concept_of(system, code, display)}};
  }
  static void add_flag(Fhir& components, const char* code, const char* display, bool value) {
    Fhir made = component(kFieldSystem, code, display);
    made["valueBoolean"] = value;
    components.push_back(std::move(made));
  }
  /// Adds how the exercise ended, and whether a simulated participant did it.
  void add_state(Fhir& components, const ResultRow& row) const {
    add_flag(components, "interrupted", "the exercise did not come to its end", row.interrupted);
    if (context_.is_simulated(row.conditions)) add_flag(components, "simulated", kSimulatedText, true);
  }
  static Fhir origin_component(const char* code, const char* display) {
    Fhir made = component(kFieldSystem, "origin", "origin of the value");
    made["valueCodeableConcept"] = concept_of(kOriginSystem, code, display);
    return made;
  }
  static void add_text(Fhir& components, const char* code, const char* display, const std::string& text) {
    Fhir made = component(kFieldSystem, code, display);
    if (text.empty()) {
      made["dataAbsentReason"] = concept_of(kAbsentSystem, "unknown", "Unknown");
    } else {
      made["valueString"] = text;
    }
    components.push_back(std::move(made));
  }
  static void add_count(Fhir& components, const char* code, const char* display, int count) {
    Fhir made = component(kFieldSystem, code, display);
    if (count < 0) {
      made["dataAbsentReason"] = concept_of(kAbsentSystem, "not-asked", "Not Asked");
    } else {
      made["valueInteger"] = count;
    }
    components.push_back(std::move(made));
  }

  [[nodiscard]] Fhir components_of(const ResultRow& row, const Score& score) const {
    const ResultConditions& conditions = row.conditions;
    const bool measured = score.origin == ScoreOrigin::kMeasured;
    Fhir made = Fhir::array();
    if (score.valid())
      made.push_back(origin_component(
          measured ? "measured" : "rendered",
          measured ? "measured by sensors of the device" : "computed and sent to the device, not measured"));
    add_text(made, "calibration_method", "method of calibration", conditions.calibration_method);
    add_text(made, "contact_mode", "mode of contacts", conditions.contact_mode);
    add_text(made, "stabiliser", "stabiliser of forces", conditions.stabiliser);
    add_text(made, "rendering", "version of the rendering", conditions.rendering);
    add_text(made, "protocol", "protocol of the assessment", conditions.protocol);
    add_state(made, row);
    return made;
  }

  /// Makes the Observation of a fault of an exercise, without its value.
  Fhir fault_of(const ResultRow& row, const std::string& base, const std::string& device, const char* code,
                const char* display) const {
    Fhir made =
        observation(fmt::format("{}\nfault\n{}", base, code), "final", row.assessment ? "exam" : "therapy");
    made["code"] = concept_of(kFaultSystem, code, display);
    add_subject(made, registry::utc_text(row.date));
    made["bodySite"] = {{"text", fmt::format("{} hand", side_name(context_.input.patient.side))}};
    made["device"] = {{"reference", "urn:uuid:" + device}};
    return made;
  }

  /// Adds what the report's chapter of faults states: an exercise that is not valid or was interrupted, and
  /// trials that were not scored. Their references go to `members`.
  void add_faults(const ResultRow& row, const std::string& base, const std::string& device, Fhir& members) {
    const ResultDetail& detail = context_.details.at(&row);
    const auto add_fault = [&](Fhir made, Fhir components) {
      if (context_.is_simulated(row.conditions)) add_flag(components, "simulated", kSimulatedText, true);
      if (!components.empty()) made["component"] = std::move(components);
      members.push_back({{"reference", "urn:uuid:" + made["id"].get<std::string>()}});
      add(std::move(made));
    };
    const auto add_end = [&](const char* code, const char* display, const std::string& reason) {
      Fhir made = fault_of(row, base, device, code, display);
      if (reason.empty()) {
        made["dataAbsentReason"] = concept_of(kAbsentSystem, "unknown", "Unknown");
      } else {
        made["valueCodeableConcept"] = reason_concept(reason);
      }
      add_fault(std::move(made), Fhir::array());
    };
    if (!row.valid) add_end("not_valid", "the exercise is not valid", row.invalid);
    if (row.interrupted) add_end("interrupted", "the exercise was interrupted", detail.ended);
    if (detail.invalid_trials == 0) return;
    Fhir made = fault_of(row, base, device, "trials_not_scored", "trials that were not scored");
    made["valueInteger"] = detail.invalid_trials;
    Fhir components = Fhir::array();
    for (const UnscoredTrials& each : detail.reasons) {
      const Fhir reason = reason_concept(each.reason);
      // The same reason at another time, or with other numbers, is counted with the first one.
      const auto same = std::find_if(components.begin(), components.end(), [&](const Fhir& before) {
        return reason.contains("coding") && before["code"].value("coding", Fhir()) == reason["coding"];
      });
      if (same == components.end())
        components.push_back({{"code", reason}, {"valueInteger", each.trials}});
      else
        (*same)["valueInteger"] = (*same)["valueInteger"].get<int>() + each.trials;
    }
    add_fault(std::move(made), std::move(components));
  }

  void add_whole_row(const ResultRow& row, const std::string& base, const std::string& device, Fhir members) {
    const ResultDetail& detail = context_.details.at(&row);
    // `final` also if it was interrupted or is not valid: its dose is a value, and its note states the rest.
    Fhir made = observation(base, "final", row.assessment ? "exam" : "therapy");
    made["code"] = concept_of(kExerciseSystem, row.exercise, context_.title_of(row.exercise));
    add_subject(made, registry::utc_text(row.date));
    finish_row(made, row, device);
    if (!members.empty()) made["hasMember"] = std::move(members);
    Fhir components = Fhir::array();
    Fhir seconds = component(kFieldSystem, "seconds", "active time");
    seconds["valueQuantity"] = quantity(row.seconds, "s");
    components.push_back(std::move(seconds));
    add_count(components, "repetitions", "trials that were carried out", row.repetitions);
    if (!row.assessment) {
      add_count(components, "counted", "trials that were scored", detail.counted);
      add_count(components, "successes", "successful trials", row.successes);
      Fhir difficulty = component(kFieldSystem, "difficulty", "difficulty, from 0 to 1");
      difficulty["valueQuantity"] = quantity(row.difficulty, "-");
      components.push_back(std::move(difficulty));
    }
    add_count(components, "pain", "largest pain, from 0 to 10", detail.pain);
    add_count(components, "fatigue", "largest fatigue, from 0 to 10", detail.fatigue);
    add_state(components, row);
    made["component"] = std::move(components);
    add(std::move(made));
  }

  /// @returns the id of the device's entry, which it adds once
  std::string device_of(const ResultConditions& conditions) {
    std::string name = conditions.device;
    if (name.ends_with(kSimulatedDevice)) name.resize(name.size() - kSimulatedDevice.size());
    const std::string id = uuid_of(fmt::format("device\n{}\n{}", name, conditions.serial));
    for (const std::string& known : devices_)
      if (known == id) return id;
    devices_.push_back(id);
    Fhir made = {{"resourceType", "Device"}, {"id", id}};
    if (!conditions.serial.empty()) made["serialNumber"] = conditions.serial;
    made["deviceName"] = Fhir::array({{{"name", name.empty() ? "unknown" : name}, {"type", "model-name"}}});
    made["note"] =
        Fhir::array({{{"text", "No medical device. It resists a movement and does not assist it."}}});
    add(std::move(made));
    return id;
  }

  void add(Fhir resource) {
    const std::string url = "urn:uuid:" + resource["id"].get<std::string>();
    entries_.push_back({{"fullUrl", url}, {"resource", std::move(resource)}});
  }

  const ReportContext& context_;
  Fhir entries_ = Fhir::array();
  std::vector<std::string> devices_ = {};
  std::map<std::string, int> ordinals_ = {};  ///< number of tests of equal kind, side and date
};

}  // namespace
}  // namespace report

std::string ucum_of(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kOther = {{
      {"-", "1"},
      {"", "1"},
      {"blocks/min", "{blocks}/min"},
      {"points", "{score}"},
      {"Nm", "N.m"},
      {"counts", "{count}"},
  }};
  for (const auto& [ours, ucum] : kOther)
    if (unit == ours) return std::string(ucum);
  return std::string(unit);  // "N", "deg", "deg/s", "s", "mm", "N/mm", "N/m", "%", "bit", "kg" are UCUM
}

std::string report_fhir(const ReportInput& input) {
  using namespace report;
  const ReportContext context = report_context(input, ReportLanguage::kEnglish);
  BundleMaker maker(context);
  for (const ResultRow* row : context.rows) maker.add_row(*row);
  for (const EnteredTest* test : context.tests) maker.add_test(*test);
  return std::move(maker).bundle().dump(-1, ' ', false, Fhir::error_handler_t::replace);
}

}  // namespace phalanx
