// SPDX-License-Identifier: Apache-2.0
#include "serve/people_report.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "phalanx/patients/patient_report.h"
#include "phalanx/patients/prescription_template.h"
#include "phalanx/report/report.h"
#include "record/plain_text.h"
#include "serve/people_json.h"

namespace phalanx::people {
namespace {

using nlohmann::json;

WebResponse only_read() { return words_response(405, "this address does not allow this method"); }

WebResponse document_response(const char* type, std::string text) {
  WebResponse response;
  response.type = type;
  response.body = std::make_shared<const std::string>(std::move(text));
  return response;
}

/// Query of a report.
struct Query {
  std::string language = "en";
  std::string day = {};
};

/// Reads "lang=de&day=2026-05-04".
/// @param page  the language is permitted
/// @throws std::invalid_argument for another query
Query read_query(std::string_view text, bool page) {
  Query query;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (page && part.starts_with("lang=")) {
      query.language = part.substr(5);
    } else if (part.starts_with("day=")) {
      query.day = part.substr(4);
    } else {
      throw std::invalid_argument(page ? "the query of a report is 'lang=en' or 'lang=de', and 'day=DATE'"
                                       : "the query of a FHIR bundle is 'day=DATE', or none");
    }
  }
  return query;
}

WebResponse exported(const RouteContext& context, const Actor& actor, const std::string& record) {
  json files = json::array();
  for (const ExportText& file : context.registry.export_texts(actor, record))
    files.push_back({{"name", file.name}, {"type", file.type}, {"text", as_utf8(file.text)}});
  return json_response({{"files", std::move(files)}});
}

json template_json(const PrescriptionTemplate& one) {
  json lines = json::array();
  for (const PrescribedExercise& line : one.lines)
    lines.push_back({{"exercise", line.exercise},
                     {"repetitions_per_day", line.repetitions_per_day},
                     {"minutes_per_day", line.minutes_per_day},
                     {"overrides", line.overrides},
                     {"note", as_utf8(line.note)}});
  json notes = json::object();
  for (const auto& [exercise, note] : one.notes_de) notes[exercise] = as_utf8(note);
  return {{"name", as_utf8(one.name)},
          {"title", as_utf8(one.title)},
          {"title_de", as_utf8(one.title_de)},
          {"notes_de", std::move(notes)},
          {"lines", std::move(lines)}};
}

}  // namespace

std::optional<WebResponse> report_part(const RouteContext& context, const Actor& actor,
                                       const WebRequest& request, const std::string& record,
                                       std::string_view part) {
  if (part != "export" && part != "report" && part != "fhir") return std::nullopt;
  if (request.method == "POST") return only_read();
  if (part == "export") return exported(context, actor, record);
  const bool page = part == "report";
  const Query query = read_query(request.query, page);
  const ReportInput input = read_report_input(context.registry, actor, record, query.day, context.today);
  return page ? document_response("text/html; charset=utf-8",
                                  report_html(input, report_language(query.language)))
              : document_response("application/fhir+json", report_fhir(input));
}

WebResponse templates_response(const WebRequest& request) {
  if (request.method == "POST") return only_read();
  json all = json::array();
  for (const PrescriptionTemplate& one : list_prescription_templates()) all.push_back(template_json(one));
  return json_response({{"templates", std::move(all)}});
}

}  // namespace phalanx::people
