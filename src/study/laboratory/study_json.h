// SPDX-License-Identifier: Apache-2.0
// Study and results as JSON, for the journal: written values are read back with the same bits.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Ordered JSON. Begin every value as object() or array(): if there is no memory to turn a null into one, the
/// library cannot destroy it.
using OrderedJson = nlohmann::ordered_json;

/// Reads a line of a journal.
/// @throws nlohmann::json::exception or std::out_of_range if it is not one.
[[nodiscard]] OrderedJson parse_json(const std::string& text);

/// Writes everything except the study's folder, which differs between machines.
[[nodiscard]] OrderedJson study_to_json(const Study& study);
/// Reads a study.
/// @throws nlohmann::json::exception or std::out_of_range if it is not one.
[[nodiscard]] Study study_from_json(const OrderedJson& json);

/// Writes a result in SI units, named in the keys; NaN becomes null.
[[nodiscard]] OrderedJson result_to_json(const PointResult& result);
/// Reads a result.
/// @throws as study_from_json.
[[nodiscard]] PointResult result_from_json(const OrderedJson& json);

/// @returns the number; null if it is not finite.
[[nodiscard]] OrderedJson number_or_null(double value);

}  // namespace phalanx
