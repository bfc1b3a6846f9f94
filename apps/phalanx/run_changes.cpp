// SPDX-License-Identifier: Apache-2.0
#include "run_changes.h"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <utility>

namespace phalanx {

/// @throws std::invalid_argument or SceneError: a value that is refused, or one that needs a new station
LiveChanges::Change LiveChanges::make(const RunOptions& options, Overrides overrides,
                                      const std::string& text) {
  const auto key_and_value = parse_override(text);
  const ChangeKind kind = change_kind(key_and_value.first);
  if (kind == ChangeKind::kNewStation)
    throw std::invalid_argument(fmt::format(
        "{}: this cannot change while the station runs; end it and start it with --set {}", text, text));
  Change change;
  change.text = text;
  change.overrides = std::move(overrides);
  change.overrides.push_back(key_and_value);
  auto model = make_station_model(load_scene(options.scene, change.overrides), options.clinician).model;
  if (kind == ChangeKind::kAtZeroTorque) {
    change.exchanged = std::make_unique<LiveModel>(std::move(model));
  } else {
    change.blended = std::move(model);
  }
  return change;
}

std::vector<std::string> LiveChanges::go_on(Station& station) {
  std::vector<std::string> said;
  if (!making_.valid() && !waiting_.empty()) {
    making_ = std::async(std::launch::async, make, std::cref(options_), overrides_, waiting_.front());
    waiting_.pop_front();
  }
  if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return said;
  try {
    Change made = making_.get();
    if (made.exchanged) {
      station.replace(std::move(made.exchanged));
    } else {
      station.blend_to(blended_of(*made.blended));
    }
    overrides_ = std::move(made.overrides);
    said.push_back(fmt::format("changed: {}", made.text));
  } catch (const std::exception& error) {  // what is refused ends nothing
    said.push_back(fmt::format("refused: {}", error.what()));
  }
  return said;
}

}  // namespace phalanx
