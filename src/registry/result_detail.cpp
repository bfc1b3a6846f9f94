// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/result_detail.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace phalanx {
namespace {

using DetailJson = nlohmann::json;

/// @returns the list of this name; an empty one if there is none
DetailJson detail_list(const DetailJson& detail, const char* name) {
  const auto found = detail.find(name);
  return found != detail.end() && found->is_array() ? *found : DetailJson::array();
}

/// @returns the text of this name; empty if there is none
std::string detail_text(const DetailJson& object, const char* name) {
  if (!object.is_object()) return {};
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void add_rating(ResultDetail& read, const DetailJson& rating) {
  if (!rating.is_object() || !rating.contains("value") || !rating["value"].is_number_integer()) return;
  const int value = rating["value"].get<int>();
  const std::string kind = detail_text(rating, "kind");
  if (kind == "pain") read.pain = std::max(read.pain, value);
  if (kind == "fatigue") read.fatigue = std::max(read.fatigue, value);
}

}  // namespace

ResultDetail result_detail(const ResultRow& row) {
  ResultDetail read{.counted = row.repetitions, .pain = row.pain, .fatigue = row.fatigue};
  const DetailJson detail = DetailJson::parse(row.detail, nullptr, false);
  if (!detail.is_object()) return read;
  if (const auto counted = detail.find("counted"); counted != detail.end() && counted->is_number_integer())
    read.counted = counted->get<int>();
  read.ended = detail_text(detail, "ended");
  for (const DetailJson& rating : detail_list(detail, "ratings")) add_rating(read, rating);
  for (const DetailJson& trial : detail_list(detail, "trials")) {
    std::string reason = detail_text(trial, "invalid");
    if (reason.empty()) continue;
    ++read.invalid_trials;
    auto found = std::find_if(read.reasons.begin(), read.reasons.end(),
                              [&](const UnscoredTrials& each) { return each.reason == reason; });
    if (found == read.reasons.end())
      found = read.reasons.insert(read.reasons.end(), UnscoredTrials{.reason = std::move(reason)});
    ++found->trials;
  }
  return read;
}

int counted_trials(const ResultRow& row) { return result_detail(row).counted; }

}  // namespace phalanx
