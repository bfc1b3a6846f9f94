// SPDX-License-Identifier: Apache-2.0
// Replaces the global allocation functions with ones that count, and fail where a test asks for it. Eigen's
// own heap use goes through malloc, which is counted too where the linker lets us wrap it (see
// tests/step/CMakeLists.txt).
#include "support/count_allocations.h"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0};
constinit thread_local std::size_t count_of_this_thread = 0;
constinit thread_local std::size_t bytes_asked_by_this_thread = 0;
constinit thread_local std::size_t until_failure = 0;  ///< allocations of this thread; 0: none fails

/// @returns true if it is to fail
bool count_one(std::size_t bytes) noexcept {
  count.fetch_add(1, std::memory_order_relaxed);
  ++count_of_this_thread;
  bytes_asked_by_this_thread += bytes;
  return until_failure > 0 && --until_failure == 0;
}

}  // namespace

// Weak, since a program names to the linker only those that it wants to be wrapped.
extern "C" {
void* __real_malloc(std::size_t size);
[[gnu::weak]] void* __real_calloc(std::size_t count, std::size_t size);
[[gnu::weak]] void* __real_realloc(void* old, std::size_t size);
[[gnu::weak]] void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
[[gnu::weak]] int __real_posix_memalign(void** out, std::size_t alignment, std::size_t size);
void* __wrap_malloc(std::size_t size);
void* __wrap_calloc(std::size_t count, std::size_t size);
void* __wrap_realloc(void* old, std::size_t size);
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size);
int __wrap_posix_memalign(void** out, std::size_t alignment, std::size_t size);

void* __wrap_malloc(std::size_t size) { return count_one(size) ? nullptr : __real_malloc(size); }
void* __wrap_calloc(std::size_t members, std::size_t size) {
  return count_one(members * size) ? nullptr : __real_calloc(members, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  return count_one(size) ? nullptr : __real_realloc(old, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return count_one(size) ? nullptr : __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  return count_one(size) ? ENOMEM : __real_posix_memalign(out, alignment, size);
}
}

#ifndef PHALANX_THREAD_SANITIZER

namespace {

std::size_t at_least_one(std::size_t size) noexcept { return size > 0 ? size : 1; }

/// By way of memalign(), which is not wrapped, so that one call counts once.
void* aligned(std::size_t size, std::align_val_t alignment) noexcept {
  return count_one(size) ? nullptr : memalign(static_cast<std::size_t>(alignment), at_least_one(size));
}

}  // namespace

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(at_least_one(size));  // counted there
}
void* operator new(std::size_t size) {
  if (void* p = operator new(size, std::nothrow)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return aligned(size, alignment);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (void* p = aligned(size, alignment)) return p;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new[](std::size_t size, const std::nothrow_t& t) noexcept { return operator new(size, t); }
void* operator new[](std::size_t size, std::align_val_t a) { return operator new(size, a); }
void* operator new[](std::size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return aligned(size, a);
}

void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t, const std::nothrow_t&) noexcept { std::free(p); }

#endif

namespace phalanx::test {
std::size_t allocations() noexcept { return count.load(std::memory_order_relaxed); }
std::size_t allocations_of_this_thread() noexcept { return count_of_this_thread; }
std::size_t bytes_of_this_thread() noexcept { return bytes_asked_by_this_thread; }

FailingAllocation::FailingAllocation(std::size_t number) noexcept { until_failure = number; }
FailingAllocation::~FailingAllocation() { until_failure = 0; }
}  // namespace phalanx::test
