// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "phalanx/scene/scene_error.h"

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

}  // namespace phalanx
