// SPDX-License-Identifier: Apache-2.0
// The exercise of a patient on the page of patients: its state as JSON, its begin, and what the therapist enters.
// docs/cockpit.md lists the addresses.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/serve/web_server.h"
#include "serve/people_routes.h"

namespace phalanx::people {

/// Address of the exercise that runs.
inline constexpr std::string_view kExercise = "/people/exercise";
/// Address of the same exercise without its patient, for a page that is locked.
inline constexpr std::string_view kWatchedExercise = "/people/exercise/watched";

/// @returns the state of an exercise. While its scene is hidden, it has no forces.
[[nodiscard]] nlohmann::json exercise_json(const ExerciseStatus& status);

/// @returns the state without what tells whose exercise it is: record, code, symbol, side, recording and result
[[nodiscard]] nlohmann::json watched_exercise_json(const ExerciseStatus& status);

/// Reads {"kind":"pain","value":3}. "reset" is not an input of ExerciseInput.
/// @throws std::invalid_argument naming the field, if the value is missing, superfluous or out of its range
[[nodiscard]] ExerciseInput exercise_input_of(const nlohmann::json& object);

/// Pauses the exercise if the request is a pause, an end, or a rating at its limit, and so stops the torque now: the
/// request itself may wait for a password or the disk. It needs no sign-in, as no stop does. Any thread.
void stop_at_once(ExerciseHost& host, const WebRequest& request) noexcept;

/// Answers kExercise: GET with the state, POST with an input. An input names the exercise by "number", and a resume the
/// stops that its person has seen by "stops": it is refused if there is another exercise, or another stop, since that state.
/// @throws std::invalid_argument with a refusal in words
[[nodiscard]] WebResponse exercise_response(const RouteContext& context, const Actor& actor,
                                            const WebRequest& request);

/// Answers kWatchedExercise, for a session that is signed in or locked: GET with the state, POST with a pause or a rating.
/// All other inputs need an open session.
/// @throws std::invalid_argument with a refusal in words
[[nodiscard]] WebResponse watched_exercise_response(ExerciseHost* host, const Actor& actor,
                                                    const WebRequest& request);

/// Answers POST "exercise" below a patient's address: begins one.
/// @param part  of the path, after the record id
/// @returns none if it is another address
/// @throws RegistryError or std::invalid_argument with a refusal in words
[[nodiscard]] std::optional<WebResponse> exercise_part(const RouteContext& context, const Actor& actor,
                                                       const WebRequest& request, const std::string& record,
                                                       std::string_view part);

}  // namespace phalanx::people
