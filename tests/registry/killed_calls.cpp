// SPDX-License-Identifier: Apache-2.0
// The C library's functions of these names, in this program and in the libraries that it loads.
#include "registry/killed_calls.h"

#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>

namespace phalanx::testing {
namespace {

std::atomic<bool> armed{false};
std::atomic<std::uint64_t> calls{0};
std::atomic<std::uint64_t> last_call{0};
std::atomic<bool> only_fails{false};
std::atomic<bool> links_refused{false};

/// @returns the next definition of a function: the C library's, or a sanitizer's
template <typename Function>
Function* next_of(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// @returns true if this call is the one at which the process dies
bool is_last_call() {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const std::uint64_t number = calls.fetch_add(1) + 1;
  return number == last_call.load();
}

/// Ends the process, or sets the reason of a failed call. @returns -1
int die() {
  if (!only_fails.load()) {
    for (;;) ::kill(::getpid(), SIGKILL);
  }
  errno = ENOSPC;
  return -1;
}

}  // namespace

void kill_at_call(std::uint64_t call) {
  calls = 0;
  last_call = call;
  only_fails = false;
  armed = true;
}

void fail_at_call(std::uint64_t call) {
  kill_at_call(call);
  only_fails = true;
}

void refuse_links(bool refused) { links_refused = refused; }

std::uint64_t counted_calls() { return calls.load(); }

}  // namespace phalanx::testing

using phalanx::testing::die;
using phalanx::testing::is_last_call;
using phalanx::testing::links_refused;
using phalanx::testing::next_of;

// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name)
extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  static auto* const real = next_of<ssize_t(int, const void*, size_t)>("write");
  if (!is_last_call()) return real(file, bytes, count);
  static_cast<void>(real(file, bytes, count / 2));
  return die();
}

ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t place) {
  static auto* const real = next_of<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  if (!is_last_call()) return real(file, bytes, count, place);
  static_cast<void>(real(file, bytes, count / 2, place));
  return die();
}

int fsync(int file) {
  static auto* const real = next_of<int(int)>("fsync");
  if (is_last_call()) return die();
  return real(file);
}

int fdatasync(int file) {
  static auto* const real = next_of<int(int)>("fdatasync");
  if (is_last_call()) return die();
  return real(file);
}

int ftruncate64(int file, off64_t length) noexcept {
  static auto* const real = next_of<int(int, off64_t)>("ftruncate64");
  if (is_last_call()) return die();
  return real(file, length);
}

int ftruncate(int file, off_t length) noexcept {
  static auto* const real = next_of<int(int, off_t)>("ftruncate");
  if (is_last_call()) return die();
  return real(file, length);
}

int rename(const char* from, const char* to) noexcept {
  static auto* const real = next_of<int(const char*, const char*)>("rename");
  if (is_last_call()) return die();
  return real(from, to);
}

int link(const char* from, const char* to) noexcept {
  static auto* const real = next_of<int(const char*, const char*)>("link");
  if (!links_refused.load()) return real(from, to);
  errno = EPERM;
  return -1;
}

int unlink(const char* name) noexcept {
  static auto* const real = next_of<int(const char*)>("unlink");
  if (is_last_call()) return die();
  return real(name);
}

int mkdir(const char* name, mode_t mode) noexcept {
  static auto* const real = next_of<int(const char*, mode_t)>("mkdir");
  if (is_last_call()) return die();
  return real(name, mode);
}

}  // extern "C"
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
