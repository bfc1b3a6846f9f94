// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// `act` throws a SceneError whose message holds all of `words`.
template <typename Act>
void expect_scene_error(Act&& act, const std::vector<std::string>& words) {
  try {
    act();
    ADD_FAILURE() << "accepted; expected a SceneError with: " << testing::PrintToString(words);
  } catch (const SceneError& error) {
    for (const std::string& word : words) EXPECT_THAT(std::string(error.what()), testing::HasSubstr(word));
  }
}

/// A key of a file and the numbers next to its bounds, on both sides of each.
struct KeyBounds {
  std::string key;
  const char* below;
  const char* least;
  const char* most;
  const char* above;
};

using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// A file whose first line says `key`; then come the others, but for that key.
inline std::string text_with(const std::string& key, const std::string& number, const KeyValues& others) {
  std::string text = key + " = " + number + "\n";
  for (const auto& [other, usual] : others)
    if (other != key) text.append(other).append(" = ").append(usual).append("\n");
  return text;
}

}  // namespace phalanx
