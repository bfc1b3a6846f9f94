// SPDX-License-Identifier: Apache-2.0
// The FHIR bundle: the required fields and value sets of R4 that it uses, and each value as in the registry.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "phalanx/exercise/reasons.h"
#include "phalanx/report/report.h"
#include "report/date_axis.h"
#include "report/kept_registry.h"

namespace phalanx {
namespace {

using nlohmann::json;
using testing::generated_patient;
using testing::GeneratedPatient;
using ::testing::HasSubstr;

constexpr std::uint64_t kFhirSeed = 20261129;

// hl7.org/fhir/R4/valueset-observation-status.html, -observation-category.html, -data-absent-reason.html
const std::set<std::string> kStatus = {"registered", "preliminary",      "final",  "amended", "corrected",
                                       "cancelled",  "entered-in-error", "unknown"};
const std::set<std::string> kCategory = {"social-history", "vital-signs", "imaging",
                                         "laboratory",     "procedure",   "survey",
                                         "exam",           "therapy",     "activity"};
const std::set<std::string> kAbsent = {
    "unknown",      "asked-unknown",     "temp-unknown",      "not-asked",     "asked-declined",
    "masked",       "not-applicable",    "unsupported",       "as-text",       "error",
    "not-a-number", "negative-infinity", "positive-infinity", "not-performed", "not-permitted"};
const std::set<std::string> kUcumCodes = {"N", "deg", "mm", "s", "1", "kg", "{blocks}/min", "{score}"};

/// Checks of FHIR R4 that this bundle must pass.
class Checker {
 public:
  void bundle(const json& value) {
    only(value, {"resourceType", "type", "timestamp", "entry"});
    EXPECT_EQ(value.at("resourceType"), "Bundle");
    EXPECT_EQ(value.at("type"), "collection");
    if (value.contains("timestamp")) instant(value["timestamp"]);
    for (const json& entry : value.value("entry", json::array())) {
      only(entry, {"fullUrl", "resource"});
      const std::string url = entry.at("fullUrl").get<std::string>();
      static const std::regex uuid("urn:uuid:[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}");
      EXPECT_TRUE(std::regex_match(url, uuid)) << url;
      EXPECT_TRUE(urls_.emplace(url, entry["resource"]["resourceType"]).second) << "twice: " << url;
      EXPECT_EQ("urn:uuid:" + entry["resource"].at("id").get<std::string>(), url);
    }
    for (const json& entry : value.value("entry", json::array()))
      entry["resource"]["resourceType"] == "Device" ? device(entry["resource"])
                                                    : observation(entry["resource"]);
  }

 private:
  static void only(const json& value, const std::set<std::string>& fields) {
    ASSERT_TRUE(value.is_object());
    for (const auto& [name, field] : value.items()) {
      EXPECT_TRUE(fields.contains(name)) << name << " is no field of this element";
      EXPECT_FALSE(field.is_null() || (field.is_string() && field.get<std::string>().empty()) ||
                   ((field.is_array() || field.is_object()) && field.empty()))
          << name << " is empty";
    }
  }
  static void instant(const json& value) {
    static const std::regex form(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d))");
    EXPECT_TRUE(std::regex_match(value.get<std::string>(), form)) << value;
  }
  static void date_time(const json& value) {
    static const std::regex form(R"(\d{4}-\d\d-\d\d(T\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d))?)");
    EXPECT_TRUE(std::regex_match(value.get<std::string>(), form)) << value;
  }
  /// @returns the codes of a CodeableConcept
  static std::set<std::string> concept_codes(const json& value) {
    only(value, {"coding", "text"});
    std::set<std::string> codes;
    EXPECT_TRUE(value.contains("coding") || value.contains("text"));
    for (const json& coding : value.value("coding", json::array())) {
      only(coding, {"system", "code", "display"});
      static const std::regex uri("(urn|http):[^ ]+");
      static const std::regex code(R"([^\s]+(\s[^\s]+)*)");
      EXPECT_TRUE(std::regex_match(coding.at("system").get<std::string>(), uri)) << coding;
      EXPECT_TRUE(std::regex_match(coding.at("code").get<std::string>(), code)) << coding;
      codes.insert(coding["code"].get<std::string>());
    }
    return codes;
  }
  /// One coding is of the value set; others may have codes of this program (an extensible binding).
  static void from(const json& value, const std::set<std::string>& allowed) {
    int known = 0;
    for (const std::string& code : concept_codes(value)) known += allowed.contains(code) ? 1 : 0;
    EXPECT_EQ(known, 1) << value;
    for (const json& coding : value["coding"])
      EXPECT_TRUE(allowed.contains(coding["code"].get<std::string>()) ||
                  coding["system"] == "urn:phalanx:code-system:reason")
          << coding;
  }
  static void quantity(const json& value) {
    only(value, {"value", "unit", "system", "code"});
    EXPECT_TRUE(value.at("value").is_number());
    EXPECT_EQ(value.at("system"), "http://unitsofmeasure.org");
    EXPECT_TRUE(kUcumCodes.contains(value.at("code").get<std::string>())) << value;
  }
  /// At most one value[x], and a reason exactly if there is none (obs-6).
  static void value_or_reason(const json& value, bool whole) {
    int values = 0;
    for (const char* name :
         {"valueQuantity", "valueInteger", "valueString", "valueBoolean", "valueCodeableConcept"})
      if (value.contains(name)) ++values;
    EXPECT_LE(values, 1);
    if (value.contains("dataAbsentReason")) {
      EXPECT_EQ(values, 0) << value;
      from(value["dataAbsentReason"], kAbsent);
    } else if (!whole) {
      EXPECT_EQ(values, 1) << value;
    }
    if (value.contains("valueQuantity")) quantity(value["valueQuantity"]);
    EXPECT_TRUE(!value.contains("valueInteger") || value["valueInteger"].is_number_integer());
    if (value.contains("valueCodeableConcept")) concept_codes(value["valueCodeableConcept"]);
  }
  void reference(const json& value, const std::string& type) {
    only(value, {"reference"});
    const auto found = urls_.find(value.at("reference").get<std::string>());
    ASSERT_NE(found, urls_.end()) << value;
    EXPECT_EQ(found->second, type);
  }
  static void device(const json& value) {
    only(value, {"resourceType", "id", "serialNumber", "deviceName", "note"});
    for (const json& name : value.at("deviceName")) {
      only(name, {"name", "type"});
      EXPECT_EQ(name.at("type"), "model-name");
      EXPECT_TRUE(name.contains("name"));
    }
    for (const json& note : value.at("note")) only(note, {"text"});
  }
  void observation(const json& value) {
    only(value, {"resourceType", "id", "status", "category", "code", "subject", "effectiveDateTime",
                 "performer", "valueQuantity", "valueInteger", "valueCodeableConcept", "dataAbsentReason",
                 "note", "bodySite", "device", "hasMember", "component"});
    EXPECT_EQ(value.at("resourceType"), "Observation");
    EXPECT_TRUE(kStatus.contains(value.at("status").get<std::string>()));
    for (const json& category : value.at("category")) from(category, kCategory);
    EXPECT_FALSE(concept_codes(value.at("code")).empty());
    only(value.at("subject"), {"type", "identifier"});
    only(value["subject"]["identifier"], {"system", "value"});
    date_time(value.at("effectiveDateTime"));
    value_or_reason(value, value.contains("hasMember") || value.contains("component"));
    if (value.contains("device")) reference(value["device"], "Device");
    for (const json& member : value.value("hasMember", json::array())) reference(member, "Observation");
    for (const json& component : value.value("component", json::array())) {
      only(component, {"code", "valueQuantity", "valueInteger", "valueString", "valueBoolean",
                       "valueCodeableConcept", "dataAbsentReason"});
      // An unknown reason of a fault has its text only.
      const std::string system = value["code"]["coding"][0]["system"];
      const bool fault = system.ends_with(":fault");
      EXPECT_TRUE(fault || !concept_codes(component.at("code")).empty());
      value_or_reason(component, false);
    }
  }

  std::map<std::string, json> urls_;
};

class ReportFhir : public ::testing::Test {
 protected:
  ReportFhir() { RecordProperty("seed", static_cast<int>(kFhirSeed)); }
  [[nodiscard]] static std::string code_of(const json& resource) {
    return resource["code"]["coding"][0]["code"].get<std::string>();
  }
  /// @returns the component with this code; null if there is none
  [[nodiscard]] static json field(const json& resource, const std::string& code) {
    for (const json& component : resource.value("component", json::array()))
      if (component["code"].contains("coding") && code_of(component) == code) return component;
    return {};
  }
  /// @returns the Observations by id
  [[nodiscard]] static std::map<std::string, json> observations(const ReportInput& input) {
    std::map<std::string, json> found;
    const json bundle = json::parse(report_fhir(input));
    for (const json& entry : bundle.value("entry", json::array()))
      if (entry["resource"]["resourceType"] == "Observation")
        found[entry["resource"]["id"].get<std::string>()] = entry["resource"];
    return found;
  }
  static const GeneratedPatient& made() {
    static const GeneratedPatient made = generated_patient(40, kFhirSeed);
    return made;
  }
  const GeneratedPatient& made_ = made();
  static const ReportInput& kept() {
    static const ReportInput input = testing::read_back(made());
    return input;
  }
  ReportInput input_ = kept();
};

TEST_F(ReportFhir, HasTheRequiredFieldsAndValueSetsOfR4) {
  Checker().bundle(json::parse(report_fhir(input_)));
  input_.day = report::iso_day(made_.results.front().date);
  Checker().bundle(json::parse(report_fhir(input_)));
}

TEST_F(ReportFhir, HasEachScoreWithItsUnitDateOriginAndConditions) {
  std::map<std::string, json> scores;  // "code|date" -> Observation
  const json bundle = json::parse(report_fhir(input_));
  for (const json& entry : bundle["entry"])
    if (entry["resource"]["resourceType"] == "Observation")
      scores[code_of(entry["resource"]) + "|" + entry["resource"]["effectiveDateTime"].get<std::string>()] =
          entry["resource"];
  std::size_t found = 0;
  for (const ResultRow& row : made_.results) {
    const std::string date = fmt::format("{}T{}", report::iso_day(row.date), report::time_label(row.date));
    const auto of = [&](const std::string& code) -> const json& {
      const auto at = scores.lower_bound(code + "|" + date);
      EXPECT_TRUE(at != scores.end() && at->first.starts_with(code + "|" + date)) << code << " " << date;
      return at->second;
    };
    const json& whole = of(row.exercise);
    EXPECT_EQ(whole["status"], "final") << "its dose is a value";
    const testing::GeneratedDetail& detail = made_.details.at(row.recording);
    EXPECT_EQ(field(whole, "seconds")["valueQuantity"]["value"], row.seconds);
    EXPECT_EQ(field(whole, "repetitions")["valueInteger"], row.repetitions);
    if (!row.assessment) {
      EXPECT_EQ(field(whole, "counted")["valueInteger"], detail.counted);
      EXPECT_EQ(field(whole, "successes")["valueInteger"], row.successes);
      EXPECT_EQ(field(whole, "difficulty")["valueQuantity"]["value"], row.difficulty);
    }
    for (const auto& [name, rating] :
         {std::pair{"pain", detail.pain}, std::pair{"fatigue", detail.fatigue}}) {
      if (rating >= 0) {
        EXPECT_EQ(field(whole, name)["valueInteger"], rating) << name;
      }
      EXPECT_EQ(field(whole, name).contains("dataAbsentReason"), rating < 0) << name;
    }
    EXPECT_EQ(field(whole, "interrupted")["valueBoolean"], row.interrupted);
    if (!row.valid) {
      EXPECT_THAT(whole["note"][0]["text"].get<std::string>(), HasSubstr(row.invalid));
    }
    for (const Score& score : row.scores) {
      ++found;
      const json& one = of(row.exercise + "/" + score.name);
      EXPECT_EQ(one["status"], score.valid() || (row.valid && !row.interrupted) ? "final" : "cancelled");
      EXPECT_EQ(field(one, "simulated")["valueBoolean"], true);
      EXPECT_EQ(field(one, "interrupted")["valueBoolean"], row.interrupted);
      if (!score.valid()) {
        EXPECT_EQ(one["dataAbsentReason"]["coding"][0]["code"], "not-performed");
        EXPECT_EQ(one["dataAbsentReason"]["coding"][1]["code"], "no-force-of-digit-alone");
        EXPECT_EQ(one["dataAbsentReason"]["text"], score.invalid);
        EXPECT_TRUE(field(one, "origin").is_null()) << "without a value there is no origin";
        continue;
      }
      EXPECT_EQ(one["valueQuantity"]["value"], score.value);
      EXPECT_EQ(one["valueQuantity"]["code"], ucum_of(score.unit));
      EXPECT_EQ(one["category"][0]["coding"][0]["code"], row.assessment ? "exam" : "therapy");
      EXPECT_EQ(field(one, "origin")["valueCodeableConcept"]["coding"][0]["code"],
                score_origin_name(score.origin));
      EXPECT_EQ(field(one, "calibration_method")["valueString"], row.conditions.calibration_method);
      if (row.conditions.protocol.empty()) {
        EXPECT_EQ(field(one, "protocol")["dataAbsentReason"]["coding"][0]["code"], "unknown");
      } else {
        EXPECT_EQ(field(one, "protocol")["valueString"], row.conditions.protocol);
      }
    }
  }
  EXPECT_GT(found, 250U);
}

TEST_F(ReportFhir, HasEachFaultOfTheRegistryWithItsReasonAsAMemberOfItsExercise) {
  std::map<std::string, json> faults;  // "code|date" -> Observation
  std::set<std::string> members;
  for (const auto& [id, one] : observations(input_)) {
    if (one["code"]["coding"][0]["system"] == "urn:phalanx:code-system:fault") {
      EXPECT_EQ(one["status"], "final");
      EXPECT_TRUE(
          faults.emplace(code_of(one) + "|" + one["effectiveDateTime"].get<std::string>(), one).second);
    }
    if (one["code"]["coding"][0]["system"] == "urn:phalanx:code-system:exercise")
      for (const json& member : one.value("hasMember", json::array()))
        members.insert(member["reference"].get<std::string>());
  }
  std::map<std::string, int> kinds;
  for (const ResultRow& row : made_.results) {
    const std::string date = fmt::format("{}T{}", report::iso_day(row.date), report::time_label(row.date));
    const auto fault = [&](const std::string& kind) -> json {
      ++kinds[kind];
      const auto at = faults.lower_bound(kind + "|" + date);
      if (at == faults.end() || !at->first.starts_with(kind + "|" + date)) {
        ADD_FAILURE() << kind << " of " << date << " is not in the bundle";
        return {};
      }
      EXPECT_TRUE(members.contains("urn:uuid:" + at->second["id"].get<std::string>()));
      json found = at->second;
      faults.erase(at);
      return found;
    };
    if (!row.valid) {
      const json one = fault("not_valid");
      EXPECT_EQ(one["valueCodeableConcept"]["text"], row.invalid);
      EXPECT_EQ(one["valueCodeableConcept"]["coding"][0]["code"], "steps-missing-in-recording");
    }
    if (row.interrupted) {
      EXPECT_EQ(fault("interrupted")["valueCodeableConcept"]["coding"][0]["code"], "person-ended");
    }
    if (const int unscored = made_.details.at(row.recording).unscored; unscored > 0) {
      const json one = fault("trials_not_scored");
      EXPECT_EQ(one["valueInteger"], unscored);
      EXPECT_EQ(field(one, "no-sample")["valueInteger"], unscored);
    }
  }
  EXPECT_TRUE(faults.empty()) << faults.begin()->first << " is not in the registry";
  EXPECT_EQ(kinds.size(), 3U) << "the generated patient has every kind of fault";
}

TEST_F(ReportFhir, KeepsAReasonThatThisProgramDoesNotKnowAsText) {
  ResultRow& row = input_.results.front();
  row.interrupted = true;
  row.detail = R"({"ended": "an older text", "trials": [{"invalid": "another one"}]})";
  row.scores = {{.name = "rmse_n", .unit = "N", .invalid = "not measured: an older text"}};
  input_.day = report::iso_day(row.date);
  Checker().bundle(json::parse(report_fhir(input_)));
  int found = 0;
  for (const auto& [id, one] : observations(input_)) {
    const json value = one.value("valueCodeableConcept", json::object());
    if (value.value("text", "") == "an older text" && !value.contains("coding")) ++found;
    if (one["code"]["coding"][0]["code"] == "trials_not_scored" &&
        one["component"][0]["code"] == json{{"text", "another one"}})
      ++found;
    const json absent = one.value("dataAbsentReason", json::object());
    if (absent.value("text", "") == "not measured: an older text" && absent.at("coding").size() == 1U)
      ++found;
  }
  EXPECT_EQ(found, 3);
}

TEST_F(ReportFhir, HasACodeForEachJoinedReasonAndOneCountForAReasonAtTwoTimes) {
  ResultRow& row = input_.results.front();
  row.interrupted = true;
  row.detail =
      json{{"ended", reason_text<Reason::kAllTrialsDone>() + "; " + reason_text<Reason::kPainLimit>(6, 5)},
           {"trials", json::array({{{"invalid", reason_text<Reason::kTorquesOffAt>(1.2)}},
                                   {{"invalid", reason_text<Reason::kTorquesOffAt>(3.4)}},
                                   {{"invalid", "another one"}}})}}
          .dump();
  input_.day = report::iso_day(row.date);
  Checker().bundle(json::parse(report_fhir(input_)));
  int found = 0;
  for (const auto& [id, one] : observations(input_)) {
    if (one["code"]["coding"][0]["code"] == "interrupted" && one.contains("valueCodeableConcept")) {
      const json codings = one["valueCodeableConcept"].value("coding", json::array());
      ASSERT_EQ(codings.size(), 2U);
      EXPECT_EQ(codings[0]["code"], reason_code(Reason::kAllTrialsDone));
      EXPECT_EQ(codings[1]["code"], reason_code(Reason::kPainLimit));
      ++found;
    }
    if (one["code"]["coding"][0]["code"] != "trials_not_scored" || one["valueInteger"] != 3) continue;
    EXPECT_EQ(one["component"][0]["code"]["coding"][0]["code"], reason_code(Reason::kTorquesOffAt));
    EXPECT_EQ(one["component"][0]["valueInteger"], 2);
    EXPECT_EQ(one["component"][1]["code"], (json{{"text", "another one"}}));
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST_F(ReportFhir, HasNoCodeOfAForeignSystemAndNoPatientButAPseudonym) {
  const std::string text = report_fhir(input_);
  std::set<std::string> loinc;
  const json bundle = json::parse(text);
  const std::function<void(const json&)> walk = [&](const json& value) {
    if (value.is_object() && value.contains("system") && value["system"] == "http://loinc.org")
      loinc.insert(value["code"].get<std::string>());
    if (value.is_structured())
      for (const json& each : value) walk(each);
  };
  walk(bundle);
  EXPECT_TRUE(loinc.empty()) << *loinc.begin();
  EXPECT_THAT(text, ::testing::Not(HasSubstr("\"resourceType\":\"Patient\"")));
  EXPECT_THAT(text,
              HasSubstr(R"("identifier":{"system":"urn:phalanx:identifier:patient-code","value":"SIM07"})"));
}

TEST_F(ReportFhir, OfOneDayHasOnlyThatDayAndEqualDataMakeEqualBytes) {
  input_.day = report::iso_day(made_.results.front().date);
  const json bundle = json::parse(report_fhir(input_));
  for (const json& entry : bundle["entry"]) {
    const json& resource = entry["resource"];
    EXPECT_TRUE(resource["resourceType"] == "Device" ||
                resource["effectiveDateTime"].get<std::string>().starts_with(input_.day))
        << resource;
  }
  EXPECT_EQ(report_fhir(input_), report_fhir(input_));
}

TEST_F(ReportFhir, HasEachEnteredTestWithItsValueUnitSideDateAndRater) {
  std::vector<std::string> expected;
  for (const EnteredTest& test : made_.tests)
    expected.push_back(fmt::format("{} {} {} {} {} {}", test_kind(test.kind).name, test.value,
                                   ucum_of(test_kind(test.kind).unit), test.date, test.rater,
                                   test.side == TestSide::kMoreAffected ? "more" : "less"));
  std::vector<std::string> found;
  for (const auto& [id, one] : observations(input_)) {
    if (one["code"]["coding"][0]["system"] != "urn:phalanx:code-system:entered-test") continue;
    EXPECT_EQ(field(one, "origin")["valueCodeableConcept"]["coding"][0]["code"], "entered");
    EXPECT_EQ(field(one, "simulated")["valueBoolean"], true);
    found.push_back(fmt::format(
        "{} {} {} {} {} {}", code_of(one), one["valueQuantity"]["value"].get<double>(),
        one["valueQuantity"]["code"].get<std::string>(), one["effectiveDateTime"].get<std::string>(),
        one["performer"][0]["display"].get<std::string>(),
        one["bodySite"]["text"].get<std::string>().substr(0, 4)));
  }
  EXPECT_THAT(found, ::testing::UnorderedElementsAreArray(expected));
}

TEST_F(ReportFhir, OfOneDayHasTheIdsOfTheWholeCourse) {
  input_.tests.push_back(input_.tests.back());  // a test that was made twice on a day
  input_.tests.back().value += 1.0;
  const std::map<std::string, json> whole = observations(input_);
  input_.day = input_.tests.back().date;
  const std::map<std::string, json> day = observations(input_);
  EXPECT_GT(day.size(), 5U);
  for (const auto& [id, one] : day) {
    ASSERT_TRUE(whole.contains(id)) << one;
    EXPECT_EQ(whole.at(id), one);
  }
}

TEST_F(ReportFhir, OfAPatientWithoutResultsHasNoEmptyList) {
  ReportInput empty;
  empty.patient.code = "P01";
  empty.today = "2026-11-29";
  const json bundle = json::parse(report_fhir(empty));
  Checker().bundle(bundle);
  EXPECT_FALSE(bundle.contains("entry"));
}

TEST_F(ReportFhir, NamesTheDeviceByItsModelAndMarksWhatIsSimulated) {
  for (const bool simulated : {true, false}) {
    if (!simulated) {
      input_.patient.code = "P07";
      for (ResultRow& row : input_.results) row.conditions.device = "beihang";
    }
    const json bundle = json::parse(report_fhir(input_));
    for (const json& entry : bundle["entry"])
      if (entry["resource"]["resourceType"] == "Device") {
        EXPECT_EQ(entry["resource"]["deviceName"][0]["name"], "beihang");
      }
    for (const auto& [id, one] : observations(input_))
      ASSERT_EQ(!field(one, "simulated").is_null(), simulated) << one;
  }
}

TEST_F(ReportFhir, UnitsAreUcum) {
  for (const auto& [ours, ucum] : std::map<std::string, std::string>{{"-", "1"},
                                                                     {"N", "N"},
                                                                     {"deg", "deg"},
                                                                     {"deg/s", "deg/s"},
                                                                     {"N/mm", "N/mm"},
                                                                     {"bit", "bit"},
                                                                     {"%", "%"},
                                                                     {"Nm", "N.m"},
                                                                     {"points", "{score}"},
                                                                     {"blocks/min", "{blocks}/min"}})
    EXPECT_EQ(ucum_of(ours), ucum);
}

}  // namespace
}  // namespace phalanx
