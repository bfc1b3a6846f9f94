// SPDX-License-Identifier: Apache-2.0
// Replaces the global allocation functions with ones that measure. The counters lie in memory that a forked
// child shares.
#include "mesh/import/measured_heap.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

struct Counters {
  std::atomic<std::size_t> peak{0};
  std::atomic<std::size_t> largest{0};
};
struct Shared {
  Counters parent;
  Counters children;
  pid_t owner = 0;
};

Shared* shared() {
  static Shared* const page = [] {
    void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) std::abort();
    auto* made = new (memory) Shared;
    made->owner = ::getpid();
    return made;
  }();
  return page;
}

std::atomic<std::ptrdiff_t> in_use{0};  // each process has its own

void raise(std::atomic<std::size_t>& most, std::size_t value) {
  std::size_t now = most.load();
  while (now < value && !most.compare_exchange_weak(now, value)) {
  }
}

void* allocate(std::size_t size, std::size_t alignment) {
  void* p = alignment <= alignof(std::max_align_t)
                ? std::malloc(size > 0 ? size : 1)
                : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  const std::ptrdiff_t now = in_use += static_cast<std::ptrdiff_t>(::malloc_usable_size(p));
  Counters& counters = ::getpid() == shared()->owner ? shared()->parent : shared()->children;
  raise(counters.peak, static_cast<std::size_t>(std::max<std::ptrdiff_t>(now, 0)));
  raise(counters.largest, size);
  return p;
}

void release(void* p) noexcept {
  if (p != nullptr) in_use -= static_cast<std::ptrdiff_t>(::malloc_usable_size(p));
  std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 0); }
void* operator new[](std::size_t size) { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) {
  return allocate(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return allocate(size, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }

namespace phalanx::test {

void reset_heap() {
  in_use = 0;  // a child starts from its parent's; what is freed of that counts below zero
  for (Counters* c : {&shared()->parent, &shared()->children}) {
    c->peak = 0;
    c->largest = 0;
  }
}
Heap heap_of_this_process() { return {shared()->parent.peak, shared()->parent.largest}; }
Heap heap_of_children() { return {shared()->children.peak, shared()->children.largest}; }

}  // namespace phalanx::test
