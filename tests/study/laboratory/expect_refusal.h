// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "record/temporary_folder.h"  // for GoogleTest's namespace in this one

namespace phalanx::testing {

/// `act` throws a std::invalid_argument (a SceneError is one) whose message holds all of `words`.
template <class Act>
void expect_refusal(Act&& act, const std::vector<std::string>& words) {
  try {
    act();
    ADD_FAILURE() << "accepted; expected words: " << ::testing::PrintToString(words);
  } catch (const std::invalid_argument& error) {
    for (const std::string& word : words) EXPECT_THAT(std::string(error.what()), ::testing::HasSubstr(word));
  }
}

}  // namespace phalanx::testing
