// SPDX-License-Identifier: Apache-2.0
#include "apps/run/starved_thread.h"

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace phalanx::testing {
namespace {

using Name = std::array<char, 16>;

Name starving_name{};
std::atomic<bool> starving{false};

Name own_name() noexcept {
  Name name{};
  ::pthread_getname_np(::pthread_self(), name.data(), name.size());
  return name;
}

}  // namespace

StarvedThread::StarvedThread(const char* name) {
  starving_name = own_name();
  if (name != nullptr) std::strncpy(starving_name.data(), name, starving_name.size() - 1);
  starving = true;
}

StarvedThread::~StarvedThread() { starving = false; }

}  // namespace phalanx::testing

// Of the whole program.
void* operator new(std::size_t bytes) {
  using namespace phalanx::testing;
  if (starving && std::strcmp(own_name().data(), starving_name.data()) == 0) throw std::bad_alloc();
  if (void* const memory = std::malloc(bytes != 0 ? bytes : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
