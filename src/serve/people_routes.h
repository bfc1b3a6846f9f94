// SPDX-License-Identifier: Apache-2.0
// The addresses below /people for a session that is signed in. Each calls the registry, which checks the role
// and writes the audit log.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/registry/registry.h"
#include "phalanx/serve/web_server.h"
#include "serve/people_json.h"

namespace phalanx::people {

using ListExercises = std::function<std::vector<ListedExercise>()>;

/// What the routes need beside the request.
struct RouteContext {
  Registry& registry;
  const ListExercises& exercises;
  std::string today;             ///< UTC, "2026-05-04"
  ExerciseHost* host = nullptr;  ///< carries out exercises; null: none
};

/// Answers a request for patients or exercises.
/// @throws RegistryError or std::invalid_argument with a refusal in words
[[nodiscard]] WebResponse route(const RouteContext& context, const Actor& actor, const WebRequest& request);

/// @returns a response of JSON
[[nodiscard]] WebResponse json_response(const nlohmann::json& value);
/// @returns a response of one line of text
[[nodiscard]] WebResponse words_response(int status, const std::string& text);
/// @returns the status and the text of a refusal
[[nodiscard]] WebResponse refusal_response(const RegistryError& refused);

}  // namespace phalanx::people
