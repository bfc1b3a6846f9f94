// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace phalanx {

/// A scene, hand, mapping or motion file cannot be used as it stands. what() names the file and line (or the
/// override), the key or column, the value and the remedy.
class SceneError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace phalanx
