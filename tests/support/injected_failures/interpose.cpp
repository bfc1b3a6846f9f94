// SPDX-License-Identifier: Apache-2.0
// The C library's functions that can fail for want of something, replaced: each call is recorded by its call
// stack, or the first one from a chosen stack fails. A library that LD_PRELOAD puts before a program. What
// happens before main() is left alone, and so is what the held clock does.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdio_ext.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>
#include <unwind.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>

#include "support/injected_failures/page.h"

// The allocator itself, by the names under which the C library keeps it.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size);            // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier)
}

namespace phalanx::test {
namespace {

constexpr std::size_t kMostFrames = 96;
constexpr std::size_t kOwnFrames = 2;   ///< of this library, on top of each stack
constexpr int kStreamHasFailed = 0x20;  ///< bit of FILE::_flags that ferror() tells
constexpr const char* kHeldClock = "libheld_clock.so";

FailurePage* page = nullptr;
bool active = false;  ///< main() has begun
bool in_child = false;
std::int64_t began = 0;  ///< main() [ns]
std::array<char, 4096> stack_file{};
const void* held_clock = nullptr;  ///< where that library lies
[[gnu::tls_model("initial-exec")]] thread_local bool inside = false;

struct Frames {
  std::array<void*, kMostFrames> address;
  std::size_t count = 0;
};

_Unwind_Reason_Code add_frame(_Unwind_Context* context, void* to) {
  auto& frames = *static_cast<Frames*>(to);
  if (frames.count == kMostFrames) return _URC_END_OF_STACK;
  frames.address[frames.count++] = reinterpret_cast<void*>(_Unwind_GetIP(context));
  return _URC_NO_REASON;
}

/// The same stack is another one in the run phase. Addresses count from where their module lies, which is
/// told by its size. A place through which a recursion comes again counts once. @returns 0: a call of the
/// held clock
std::uint64_t hash_of(const Frames& frames, FailingCall call) {
  std::uint64_t hash = 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(call);
  const auto mix = [&](std::uint64_t value) {
    hash = (hash ^ value) * 0xff51afd7ed558ccdU;
    hash ^= hash >> 32U;
  };
  mix(page->running.load() ? 1 : 0);
  const auto* const begin = frames.address.data();
  for (const auto* at = begin + kOwnFrames; at < begin + frames.count; ++at) {
    if (std::find(begin, at, *at) != at) continue;
    dl_find_object module{};
    if (_dl_find_object(*at, &module) != 0) continue;
    if (module.dlfo_map_start == held_clock) return 0;
    const auto start = reinterpret_cast<std::uintptr_t>(module.dlfo_map_start);
    mix(reinterpret_cast<std::uintptr_t>(*at) - start);
    mix(reinterpret_cast<std::uintptr_t>(module.dlfo_map_end) - start);
  }
  return hash != 0 ? hash : 1;
}

void record(std::uint64_t hash, FailingCall call, std::uint32_t number) {
  for (std::size_t i = 0; i < FailurePage::kStacks; ++i) {
    CallStack& place = page->stack[(hash + i) % FailurePage::kStacks];
    std::uint64_t there = 0;
    if (place.hash.compare_exchange_strong(there, hash)) {
      place.call = call;
      place.running = page->running.load();
      place.child = in_child;
      place.number = number;
      return;
    }
    if (there == hash) return;
  }
  page->left_out.fetch_add(1);
}

/// For people: the call stack, as `addr2line` takes it.
void tell(const Frames& frames) {
  const long file = ::syscall(SYS_openat, AT_FDCWD, stack_file.data(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0) return;
  backtrace_symbols_fd(frames.address.data(), static_cast<int>(frames.count), static_cast<int>(file));
  ::syscall(SYS_close, file);
}

std::int64_t nanoseconds() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);  // the held one, where there is one
  return 1'000'000'000LL * t.tv_sec + t.tv_nsec;
}

bool in_main_thread() noexcept { return ::syscall(SYS_gettid) == ::getpid(); }

/// @returns true if this call is to fail
[[gnu::noinline]] bool fails(FailingCall call) noexcept {
  if (!active || inside) return false;
  const std::int64_t after = page->terminates_after.load();
  if (after != 0 && in_main_thread() && nanoseconds() - began >= after && page->failed.exchange(1) == 0)
    std::terminate();
  const std::uint32_t number = page->calls.fetch_add(1) + 1;
  const std::uint64_t wanted = page->fails.load();
  if (wanted != 0 && (number < page->from.load() || page->failed.load() != 0)) return false;
  inside = true;
  const int error = errno;
  Frames frames;
  _Unwind_Backtrace(add_frame, &frames);
  const std::uint64_t hash = hash_of(frames, call);
  bool result = false;
  if (wanted == 0 && hash != 0) record(hash, call, number);
  if (wanted != 0 && hash == wanted) result = page->failed.exchange(1) == 0;
  if (result) tell(frames);
  errno = error;
  inside = false;
  return result;
}

/// What a call that fails returns.
template <class Result>
Result failure(int error, Result result) noexcept {
  errno = error;
  return result;
}

/// The same of a C stream, which keeps that it has failed.
template <class Result>
Result stream_failure(FILE* stream, Result result) noexcept {
  stream->_flags |= kStreamHasFailed;
  return failure(ENOSPC, result);
}

/// A call whose failure is -1.
template <class... Arguments>
int call_or_fail(FailingCall call, int error, long number, Arguments... arguments) noexcept {
  return fails(call) ? failure(error, -1) : static_cast<int>(::syscall(number, arguments...));
}

int (*program_main)(int, char**, char**) = nullptr;

int main_that_may_fail(int count, char** arguments, char** environment) {
  began = nanoseconds();
  active = page != nullptr;
  return program_main(count, arguments, environment);
}

[[gnu::constructor]] void attach() {
  const char* file = std::getenv(kFailuresVariable);
  if (file == nullptr || *file == '\0') return;
  const int descriptor = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CLOEXEC));
  void* const memory = reinterpret_cast<void*>(
      ::syscall(SYS_mmap, nullptr, sizeof(FailurePage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0L));
  if (descriptor < 0 || memory == MAP_FAILED) {
    std::perror("injected failures: the page's file");
    std::abort();
  }
  ::syscall(SYS_close, descriptor);
  std::snprintf(stack_file.data(), stack_file.size(), "%s.stack", file);
  void* first = nullptr;
  backtrace(&first, 1);  // it allocates the first time
  dl_find_object module{};
  void* const sleep = ::dlsym(RTLD_DEFAULT, "clock_nanosleep");
  if (_dl_find_object(sleep, &module) == 0 &&
      std::strstr(module.dlfo_link_map->l_name, kHeldClock) != nullptr)
    held_clock = module.dlfo_map_start;
  pthread_atfork(nullptr, nullptr, [] { in_child = true; });
  page = static_cast<FailurePage*>(memory);
}

}  // namespace
}  // namespace phalanx::test

// ---- the C library's names ----

using phalanx::test::call_or_fail;
using phalanx::test::FailingCall;
using phalanx::test::fails;
using phalanx::test::failure;
using phalanx::test::stream_failure;

/// The C library's function of this name.
#define PHALANX_NEXT(name) \
  static const auto next = reinterpret_cast<decltype(&(name))>(::dlsym(RTLD_NEXT, #name))

extern "C" {

void* malloc(size_t size) noexcept {
  return fails(FailingCall::kMemory) ? failure<void*>(ENOMEM, nullptr) : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
  return fails(FailingCall::kMemory) ? failure<void*>(ENOMEM, nullptr) : __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) noexcept {
  const bool may_fail = size != 0;  // else it frees
  return may_fail && fails(FailingCall::kMemory) ? failure<void*>(ENOMEM, nullptr)
                                                 : __libc_realloc(memory, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return fails(FailingCall::kMemory) ? failure<void*>(ENOMEM, nullptr) : __libc_memalign(alignment, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  return fails(FailingCall::kMemory) ? failure<void*>(ENOMEM, nullptr) : __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) noexcept {
  void* const made = fails(FailingCall::kMemory) ? nullptr : __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
}

void* mmap(void* where, size_t size, int protection, int flags, int file, off_t offset) noexcept {
  if (fails(FailingCall::kMap)) return failure(ENOMEM, MAP_FAILED);
  return reinterpret_cast<void*>(::syscall(SYS_mmap, where, size, protection, flags, file, offset));
}
void* mmap64(void* where, size_t size, int protection, int flags, int file, off64_t offset) noexcept {
  if (fails(FailingCall::kMap)) return failure(ENOMEM, MAP_FAILED);
  return reinterpret_cast<void*>(::syscall(SYS_mmap, where, size, protection, flags, file, offset));
}

int openat(int folder, const char* name, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return call_or_fail(FailingCall::kOpen, EMFILE, SYS_openat, folder, name, flags, mode);
}
int open(const char* name, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return call_or_fail(FailingCall::kOpen, EMFILE, SYS_openat, AT_FDCWD, name, flags, mode);
}
int pipe2(int* ends, int flags) noexcept {
  return call_or_fail(FailingCall::kOpen, EMFILE, SYS_pipe2, ends, flags);
}
int socketpair(int domain, int type, int protocol, int* ends) noexcept {
  return call_or_fail(FailingCall::kOpen, EMFILE, SYS_socketpair, domain, type, protocol, ends);
}
int eventfd(unsigned value, int flags) noexcept {
  return call_or_fail(FailingCall::kOpen, EMFILE, SYS_eventfd2, value, flags);
}

ssize_t write(int file, const void* data, size_t size) {
  return fails(FailingCall::kWrite) ? failure<ssize_t>(ENOSPC, -1) : ::syscall(SYS_write, file, data, size);
}
ssize_t writev(int file, const iovec* parts, int count) {
  return fails(FailingCall::kWrite) ? failure<ssize_t>(ENOSPC, -1)
                                    : ::syscall(SYS_writev, file, parts, count);
}
ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  return fails(FailingCall::kWrite) ? failure<ssize_t>(ENOSPC, -1)
                                    : ::syscall(SYS_pwrite64, file, data, size, offset);
}
int fsync(int file) { return call_or_fail(FailingCall::kSync, EIO, SYS_fsync, file); }
int fdatasync(int file) { return call_or_fail(FailingCall::kSync, EIO, SYS_fdatasync, file); }
int rename(const char* from, const char* to) noexcept {
  return call_or_fail(FailingCall::kChange, EIO, SYS_rename, from, to);
}
int unlink(const char* name) noexcept { return call_or_fail(FailingCall::kChange, EIO, SYS_unlink, name); }
int mkdir(const char* name, mode_t mode) noexcept {
  return call_or_fail(FailingCall::kChange, EIO, SYS_mkdir, name, mode);
}
int ftruncate(int file, off_t size) noexcept {
  return call_or_fail(FailingCall::kChange, EIO, SYS_ftruncate, file, size);
}

FILE* fopen(const char* name, const char* mode) {
  PHALANX_NEXT(fopen);
  return fails(FailingCall::kOpen) ? failure<FILE*>(EMFILE, nullptr) : next(name, mode);
}
FILE* fopen64(const char* name, const char* mode) {
  PHALANX_NEXT(fopen64);
  return fails(FailingCall::kOpen) ? failure<FILE*>(EMFILE, nullptr) : next(name, mode);
}
size_t fwrite(const void* data, size_t size, size_t count, FILE* stream) {
  PHALANX_NEXT(fwrite);
  return fails(FailingCall::kWrite) ? stream_failure<size_t>(stream, 0) : next(data, size, count, stream);
}
int fputs(const char* text, FILE* stream) {
  PHALANX_NEXT(fputs);
  return fails(FailingCall::kWrite) ? stream_failure(stream, EOF) : next(text, stream);
}
int fflush(FILE* stream) {
  PHALANX_NEXT(fflush);
  const bool writes = stream != nullptr && __fpending(stream) > 0;
  return writes && fails(FailingCall::kWrite) ? stream_failure(stream, EOF) : next(stream);
}
int fclose(FILE* stream) {
  PHALANX_NEXT(fclose);
  const bool lost = __fpending(stream) > 0 && fails(FailingCall::kWrite);
  const int result = next(stream);
  return lost ? failure(ENOSPC, EOF) : result;
}

pid_t fork() noexcept {
  PHALANX_NEXT(fork);
  return fails(FailingCall::kProcess) ? failure(EAGAIN, -1) : next();
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                   void* argument) noexcept {
  PHALANX_NEXT(pthread_create);
  return fails(FailingCall::kThread) ? EAGAIN : next(thread, attributes, work, argument);
}
/// Tells where the run phase begins.
int pthread_setname_np(pthread_t thread, const char* name) noexcept {
  PHALANX_NEXT(pthread_setname_np);
  if (phalanx::test::active && std::strcmp(name, phalanx::test::page->runs_from.data()) == 0)
    phalanx::test::page->running.store(true);
  return next(thread, name);
}

// NOLINTNEXTLINE(bugprone-reserved-identifier): the C library's
int __libc_start_main(int (*main)(int, char**, char**), int count, char** arguments, void (*init)(),
                      void (*end)(), void (*loader_end)(), void* stack_end) {
  PHALANX_NEXT(__libc_start_main);
  phalanx::test::program_main = main;
  return next(phalanx::test::main_that_may_fail, count, arguments, init, end, loader_end, stack_end);
}

}  // extern "C"
