// SPDX-License-Identifier: Apache-2.0
// JSON of the page of patients: what the registry holds, as the page reads it, and what the page sends.
// docs/cockpit.md lists the addresses. Nothing here reads a clock, a disk or a network.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/registry/accounts.h"
#include "phalanx/registry/backup.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"
#include "phalanx/registry/trends.h"
#include "phalanx/serve/cockpit.h"

namespace phalanx::people {

inline constexpr std::size_t kDeepestJson = 8;  ///< objects and lists within each other

/// @returns what a patient lacks for an exercise on this device, in the order of this list: "unchecked" or
/// "unsuitable" (the entry check), "no_consent", "expired" (the calibration), "contraindication"
/// @param today  UTC, "2026-05-04"
[[nodiscard]] std::vector<std::string> obstacles(const Patient& patient, const std::string& today);

/// @returns what a page may know before its user signs in: the words of the symbols and the kinds of tests
/// @param accounts  accounts exist, so that a password is needed
[[nodiscard]] nlohmann::json status_json(bool accounts);
/// @returns the list of patients: record id, code, side, symbol and obstacles of each, no other field
[[nodiscard]] nlohmann::json list_json(std::span<const Patient> patients, const std::string& today);
/// @returns all fields as in patient_json(), "obstacles", and patient_revision() as "revision"
[[nodiscard]] nlohmann::json one_json(const Patient& patient, const std::string& today);
/// @returns the names of scores for people by language: {"index_peak_force_n": {"en": .., "de": ..}}
[[nodiscard]] nlohmann::json score_names_json(std::span<const Score> scores);
/// @returns results, tests, notes and trends of one patient, and the "names" of their scores
[[nodiscard]] nlohmann::json course_json(std::span<const ResultRow> results,
                                         std::span<const EnteredTest> tests,
                                         std::span<const PatientNote> notes, std::span<const Trend> trends);
[[nodiscard]] nlohmann::json exercises_json(std::span<const ListedExercise> exercises);
/// @returns what a deletion could not reach, for a person to remove
[[nodiscard]] nlohmann::json deleted_json(const DeleteReport& report);

/// Reads the body of a request: one JSON object.
/// @throws std::invalid_argument if it is none, or deeper than kDeepestJson
[[nodiscard]] nlohmann::json read_object(std::string_view body);
/// @returns a text of the object; empty if it is absent
/// @throws std::invalid_argument naming the field if it is no text, or longer than `longest` bytes
[[nodiscard]] std::string text_of(const nlohmann::json& object, const char* field, std::size_t longest);
/// Replaces the stated fields of a patient (JSON Merge Patch, RFC 7396: null removes one). The record id
/// stays. "obstacles" and "revision" are not fields.
/// @throws std::invalid_argument naming the field, as parse_patient_json()
[[nodiscard]] Patient with_fields(const Patient& patient, const nlohmann::json& fields);
/// @throws std::invalid_argument naming the field
[[nodiscard]] EnteredTest test_of(const nlohmann::json& object);

}  // namespace phalanx::people
