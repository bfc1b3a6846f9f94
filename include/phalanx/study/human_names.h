// SPDX-License-Identifier: Apache-2.0
// Joint and segment names as a person says them, for tables and plots; files use joint_name() and
// segment_name().
#pragma once

#include <string>

namespace phalanx {

/// "index MCP flexion"; hinges only flex, so they go without: "index PIP".
[[nodiscard]] std::string human_joint_name(int joint);
/// "index proximal", "thumb metacarpal", "palm".
[[nodiscard]] std::string human_segment_name(int segment);

}  // namespace phalanx
