// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Handling of a scene's problems: the first is thrown, or all are collected.
class SceneProblems {
 public:
  /// @param all  list that collects them; null: the first is thrown
  explicit SceneProblems(std::vector<std::string>* all) : all_(all) {}

  /// Runs a check whose problem hides none of another check. @returns true if it found none
  /// @throws SceneError with its problem, if problems are not collected
  template <class Check>
  bool run(const Check& check) {
    if (all_ == nullptr) {
      check();
      return true;
    }
    try {
      check();
      return true;
    } catch (const SceneError& problem) {
      all_->emplace_back(problem.what());
      return false;
    }
  }

 private:
  std::vector<std::string>* all_;
};

}  // namespace phalanx
