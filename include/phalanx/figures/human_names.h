// SPDX-License-Identifier: Apache-2.0
// Joint and segment names in words, for tables and plots; files use joint_name() and segment_name().
#pragma once

#include <string>

namespace phalanx {

/// @returns "index MCP flexion", for example. Hinges only flex, so the word is left out: "index PIP".
[[nodiscard]] std::string human_joint_name(int joint);
/// @returns "index proximal", "thumb metacarpal" or "palm", for example.
[[nodiscard]] std::string human_segment_name(int segment);

}  // namespace phalanx
