// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace phalanx::test {

/// What the global operator new has handed out since reset_heap(), in a program that links measured_heap.cpp.
struct Heap {
  std::size_t peak = 0;     ///< most at once beyond what there was at the reset [bytes]
  std::size_t largest = 0;  ///< single allocation [bytes]
};
void reset_heap();
[[nodiscard]] Heap heap_of_this_process();
/// Of the processes forked since: the largest of each.
[[nodiscard]] Heap heap_of_children();

}  // namespace phalanx::test
