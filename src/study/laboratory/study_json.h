// SPDX-License-Identifier: Apache-2.0
// Study and results as JSON, for the journal: what is written reads back to the same bits.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

using OrderedJson = nlohmann::ordered_json;

/// A line of a journal. @throws nlohmann::json::exception or std::out_of_range if it is none.
[[nodiscard]] OrderedJson parse_json(const std::string& text);

/// Everything but the study's folder, which is not the same on every machine.
[[nodiscard]] OrderedJson study_to_json(const Study& study);
/// @throws nlohmann::json::exception or std::out_of_range if it is no study.
[[nodiscard]] Study study_from_json(const OrderedJson& json);

/// SI units, keys say them; NaN is null.
[[nodiscard]] OrderedJson result_to_json(const PointResult& result);
/// @throws as study_from_json.
[[nodiscard]] PointResult result_from_json(const OrderedJson& json);

/// null if it is not finite.
[[nodiscard]] OrderedJson number_or_null(double value);

}  // namespace phalanx
