// SPDX-License-Identifier: Apache-2.0
// Replaces the global allocation functions with ones that count. Eigen's own heap use goes through malloc,
// which is counted too where the linker lets us wrap it (see tests/step/CMakeLists.txt).
#include "support/count_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __real_malloc(size);
}
}

void* operator new(std::size_t size) {
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;  // counted there
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace phalanx::test {
std::size_t allocations() noexcept { return count.load(std::memory_order_relaxed); }
}  // namespace phalanx::test
