// SPDX-License-Identifier: Apache-2.0
// What a therapist takes away from the page of patients: export, report, FHIR bundle; and the templates of
// prescriptions. docs/cockpit.md lists the addresses.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "phalanx/serve/web_server.h"
#include "serve/people_routes.h"

namespace phalanx::people {

/// Answers GET below a patient's address: "export", "report" and "fhir". The registry checks the role and
/// writes the audit log. Nothing is written to the station's disk.
/// @param part  of the path, after the record id
/// @returns none if it is another address
/// @throws RegistryError; std::invalid_argument if the query is wrong
[[nodiscard]] std::optional<WebResponse> report_part(const RouteContext& context, const Actor& actor,
                                                     const WebRequest& request, const std::string& record,
                                                     std::string_view part);

/// Answers GET /people/templates: the templates in assets/prescriptions.
[[nodiscard]] WebResponse templates_response(const WebRequest& request);

}  // namespace phalanx::people
