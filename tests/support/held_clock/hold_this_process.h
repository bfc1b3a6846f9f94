// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::test {

/// Lets time pass although a thread of this program computes, for what has to happen meanwhile. For programs
/// under HELD_CLOCK (cmake/tests.cmake).
/// @param seconds  > 0
void pass_time(double seconds);

}  // namespace phalanx::test
