// SPDX-License-Identifier: Apache-2.0
// The program, with one of its calls made to fail.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "record/temporary_folder.h"
#include "support/injected_failures/page.h"

namespace phalanx::testing {

/// The first call from one call stack.
struct Failure {
  std::uint64_t stack = 0;  ///< test::CallStack::hash; 0: no call fails
  test::FailingCall call{};
  bool running = false;
  bool child = false;
  std::uint32_t number = 0;

  /// For people: which call, when, and its stack's hash.
  [[nodiscard]] std::string text() const;
};

/// How the program ended.
struct Outcome {
  static constexpr int kHangs = -1;

  int exit = kHangs;  ///< its exit code, 128 + N after signal N
  std::string out;
  std::string err;
  bool failed = false;  ///< the call has been made, and failed
  std::string stack;    ///< from which it was made, as `addr2line` takes it
};

class FailingProgram {
 public:
  /// @param arguments  of the program, which runs in the test's folder
  /// @param runs_from  name of the thread with which its run phase begins; empty: there is none. A program
  /// with a
  ///                   run phase is under a held clock
  /// @param typed      a line on its standard input; empty: none
  FailingProgram(std::vector<std::string> arguments, std::string runs_from, std::string typed);

  /// Runs it whole. @returns every call stack from which a call was made that could fail, by their hashes
  [[nodiscard]] std::vector<Failure> record(const TemporaryFolder& folder) const;
  [[nodiscard]] Outcome run(const TemporaryFolder& folder, const Failure& failure = {}) const;
  /// std::terminate() ends it after so long [s].
  /// @param reads_errors_at  its standard error is a full pipe until then [s]; 0: it is not
  [[nodiscard]] Outcome terminate(const TemporaryFolder& folder, double after,
                                  double reads_errors_at = 0.0) const;

 private:
  /// @param reads_errors_at  its standard error is a full pipe until then [s of the held clock]; 0: it is not
  Outcome run(const TemporaryFolder& folder, test::FailurePage& page, double reads_errors_at = 0.0) const;

  std::vector<std::string> arguments_;
  std::string runs_from_;
  std::string typed_;
};

/// What is in a folder, but for what run() adds: name below it, content.
[[nodiscard]] std::map<std::string, std::string> files_in(const TemporaryFolder& folder);

}  // namespace phalanx::testing
