// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace phalanx {

/// Error of a scene, hand, mapping or motion file that cannot be used. what() names the file and line (or the
/// override), the key or column, the value and the remedy.
class SceneError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace phalanx
