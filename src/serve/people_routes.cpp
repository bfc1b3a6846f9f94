// SPDX-License-Identifier: Apache-2.0
#include "serve/people_routes.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "phalanx/patients/patient_change.h"
#include "record/plain_text.h"
#include "serve/exercise_message.h"
#include "serve/people_exercise.h"
#include "serve/people_report.h"

namespace phalanx::people {
namespace {

constexpr std::string_view kPatients = "/people/patients";
constexpr std::string_view kExercises = "/people/exercises";
constexpr std::string_view kTemplates = "/people/templates";
constexpr std::size_t kLongestNote = 4000;    // [bytes]
constexpr std::size_t kLongestCode = 16;      // [bytes]
constexpr std::size_t kLongestRevision = 64;  // [bytes]

WebResponse nothing_here() {
  return words_response(404, "there is nothing at this address; reload the page");
}
WebResponse wrong_method() { return words_response(405, "this address does not allow this method"); }

/// @returns a text about options of a command in the words of the fields: "--calibration x"
/// is "calibration x"
std::string without_dashes(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.erase(at, 2);
  return text;
}

/// Makes a change by the rules that the commands follow, too.
ChangedPatient change(const Patient& before, const Patient& wanted, const std::string& today) {
  try {
    return changed_patient(before, wanted, today);
  } catch (const std::invalid_argument& refused) {
    throw std::invalid_argument(without_dashes(refused.what()));
  }
}

WebResponse changed_response(const Patient& patient, const std::vector<std::string>& said,
                             const std::string& today) {
  nlohmann::json answer = one_json(patient, today);
  answer["said"] = nlohmann::json::array();
  for (const std::string& line : said) answer["said"].push_back(as_utf8(without_dashes(line)));
  return json_response(answer);
}

WebResponse all_patients(const RouteContext& context, const Actor& actor, const WebRequest& request) {
  if (request.method != "POST") {
    nlohmann::json list = list_json(context.registry.patients(actor), context.today);
    list["damaged"] = context.registry.damaged_patients(actor);
    list["without_key"] = context.registry.patients_without_key(actor).size();
    return json_response(list);
  }
  const ChangedPatient made = change({}, with_fields({}, read_object(request.body)), context.today);
  return changed_response(context.registry.add_patient(actor, made.patient), made.said, context.today);
}

WebResponse one_patient(const RouteContext& context, const Actor& actor, const WebRequest& request,
                        const std::string& record) {
  const Patient patient = context.registry.patient(actor, record);
  if (request.method != "POST") return json_response(one_json(patient, context.today));
  const nlohmann::json fields = read_object(request.body);
  const std::string base = text_of(fields, "revision", kLongestRevision);
  if (base.empty()) throw std::invalid_argument("revision: is missing; reload the page");
  if (base != patient_revision(patient))
    return words_response(409,
                          "this patient was changed meanwhile; open the patient again and repeat the change");
  const Patient wanted = with_fields(patient, fields);
  if (patient_revision(wanted) == base) return json_response(one_json(patient, context.today));
  const ChangedPatient edited = change(patient, wanted, context.today);
  return changed_response(context.registry.edit_patient(actor, edited.patient, base), edited.said,
                          context.today);
}

WebResponse course(const RouteContext& context, const Actor& actor, const std::string& record) {
  Registry& registry = context.registry;
  const auto results = registry.results(actor, record);
  const auto tests = registry.tests(actor, record);
  const auto notes = registry.notes(actor, record);
  const auto trends = make_trends(results, tests);  // Registry::trends() would open all results again
  return json_response(course_json(results, tests, notes, trends));
}

/// Deletes a patient if the code was typed again.
WebResponse remove(const RouteContext& context, const Actor& actor, const WebRequest& request,
                   const std::string& record) {
  const std::string confirmed = text_of(read_object(request.body), "confirm", kLongestCode);
  const Patient patient = context.registry.patient(actor, record);
  if (patient.code != confirmed)
    throw std::invalid_argument("this is not the code of the patient; type it again to delete the patient");
  if (context.host != nullptr) {
    // Before the key is erased: what the station still records must not need it.
    try {
      context.host->release_key(record);
    } catch (const std::runtime_error& refused) {
      return words_response(409, refused.what());
    }
  }
  nlohmann::json report = deleted_json(context.registry.delete_patient(actor, record));
  // A deletion leaves these files where they are.
  report["bound_files"] = nlohmann::json::array();
  for (const std::string& file : {patient.calibration, patient.range})
    if (!file.empty()) report["bound_files"].push_back(as_utf8(file));
  return json_response(report);
}

WebResponse part_of_patient(const RouteContext& context, const Actor& actor, const WebRequest& request,
                            const std::string& record, std::string_view part) {
  const bool changes = request.method == "POST";
  if (part == "course") return changes ? wrong_method() : course(context, actor, record);
  if (std::optional<WebResponse> made = report_part(context, actor, request, record, part))
    return *std::move(made);
  if (std::optional<WebResponse> begun = exercise_part(context, actor, request, record, part))
    return *std::move(begun);
  if (part != "tests" && part != "notes" && part != "delete") return nothing_here();
  if (!changes) return wrong_method();
  if (part == "delete") return remove(context, actor, request, record);
  if (part == "tests") {
    context.registry.add_test(actor, record, test_of(read_object(request.body)));
  } else {
    context.registry.add_note(actor, record, text_of(read_object(request.body), "text", kLongestNote));
  }
  return json_response(nlohmann::json::object());
}

int status_of_fault(RegistryFault fault) noexcept {
  switch (fault) {
    case RegistryFault::kUnknown:
      return 404;
    case RegistryFault::kSignIn:
      return 401;
    case RegistryFault::kDelayed:
      return 429;
    case RegistryFault::kDenied:
      return 403;
    case RegistryFault::kDisk:
      return 507;
    case RegistryFault::kBusy:
      return 503;
    case RegistryFault::kConflict:
    case RegistryFault::kNewer:
    case RegistryFault::kNoKey:
    case RegistryFault::kDamaged:
      break;
  }
  return 409;
}

}  // namespace

WebResponse json_response(const nlohmann::json& value) {
  WebResponse response;
  response.type = "application/json";
  response.body = std::make_shared<const std::string>(
      value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return response;
}

WebResponse words_response(int status, const std::string& text) {
  WebResponse response;
  response.status = status;
  response.body = std::make_shared<const std::string>(as_utf8(text) + "\n");
  return response;
}

WebResponse refusal_response(const RegistryError& refused) {
  return words_response(status_of_fault(refused.fault()), refused.what());
}

WebResponse route(const RouteContext& context, const Actor& actor, const WebRequest& request) {
  std::string_view path = request.path;
  if (path == kExercises) {
    if (request.method == "POST") return wrong_method();
    return json_response(
        exercises_json(context.exercises ? context.exercises() : std::vector<ListedExercise>()));
  }
  if (path == kTemplates) return templates_response(request);
  if (path == kExercise) return exercise_response(context, actor, request);
  if (path == kPatients) return all_patients(context, actor, request);
  if (!path.starts_with(kPatients) || path[kPatients.size()] != '/') return nothing_here();
  path.remove_prefix(kPatients.size() + 1);
  const std::size_t slash = std::min(path.find('/'), path.size());
  const std::string record(path.substr(0, slash));
  // By the record id only: a code in an address could stay in the history or a log.
  if (!is_record_id(record)) return nothing_here();
  if (slash == path.size()) return one_patient(context, actor, request, record);
  return part_of_patient(context, actor, request, record, path.substr(slash + 1));
}

}  // namespace phalanx::people
