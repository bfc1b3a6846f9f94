// SPDX-License-Identifier: Apache-2.0
#include "run/terminate.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "commands.h"

namespace phalanx {
namespace {

constexpr double kRamp = 5.0;     ///< longest wait for zero torque [s]
constexpr double kLook = 0.01;    ///< interval of checking it [s]
constexpr double kWritten = 0.6;  ///< time for the recorder to write the steps until then [s]
constexpr unsigned kGiveUp = 30;  ///< [s]; the ending thread may hold a lock that is needed

std::atomic<LetsGoAtTerminate*> holding{nullptr};
std::atomic<bool> ending{false};
thread_local bool ending_here = false;

/// Writes the exception. @returns true if memory has run out
bool say_why() noexcept {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    std::fputs("phalanx: ended by an error of the program\n", stderr);
  } catch (const std::bad_alloc&) {
    std::fputs("phalanx: out of memory\n", stderr);
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "phalanx: ended by an error of the program: %s\n", error.what());
  } catch (...) {
    std::fputs("phalanx: ended by an error of the program\n", stderr);
  }
  return false;
}

[[noreturn]] void wait_for_the_end() noexcept {
  for (;;) ::pause();
}

}  // namespace

void end_at_once() {
  if (ending_here) std::abort();
  if (ending.exchange(true)) wait_for_the_end();  // another thread ends the program already
  ending_here = true;
  ::alarm(kGiveUp);
  if (LetsGoAtTerminate* const hand = holding.load()) hand->let_go();
  const bool no_memory = say_why();  // last: a terminal that takes nothing blocks it
  if (no_memory) ::_exit(kFailed);
  std::abort();
}

LetsGoAtTerminate::LetsGoAtTerminate(Session& session, const Clock& clock) noexcept
    : session_(session), clock_(clock) {
  holding = this;
}

LetsGoAtTerminate::~LetsGoAtTerminate() {
  holding = nullptr;
  if (ending) wait_for_the_end();
}

void LetsGoAtTerminate::let_go() noexcept {
  session_.stop();
  for (double waited = 0.0; waited < kRamp && !session_.view().at_rest; waited += kLook)
    clock_.sleep_until(clock_.now() + kLook);
  clock_.sleep_until(clock_.now() + kWritten);
}

}  // namespace phalanx
