// SPDX-License-Identifier: Apache-2.0
#include "apps/run/failing_program.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <utility>

#include "faults/child_process.h"
#include "support/held_clock/held_clock.h"

namespace phalanx::testing {
namespace {

constexpr double kRealHang = 240.0;  ///< real seconds, against hangs only
constexpr double kHeldHang = 60.0;   ///< of the held clock [s]
constexpr const char* kPage = "page";
constexpr const char* kOutput = "output";
constexpr const char* kErrors = "errors";

using test::FailurePage;

/// A page in a file, for this process and the program.
class PageFile {
 public:
  explicit PageFile(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const bool sized = descriptor >= 0 && ::ftruncate(descriptor, sizeof(FailurePage)) == 0;
    void* const memory =
        sized ? ::mmap(nullptr, sizeof(FailurePage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0)
              : MAP_FAILED;
    if (descriptor >= 0) ::close(descriptor);
    if (memory == MAP_FAILED) throw std::runtime_error(file.string() + ": no page for injected failures");
    page_ = static_cast<FailurePage*>(memory);
  }
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;
  ~PageFile() { ::munmap(page_, sizeof(FailurePage)); }

  [[nodiscard]] FailurePage& page() const { return *page_; }

 private:
  FailurePage* page_ = nullptr;
};

/// A pipe with a name, full.
class FullPipe {
 public:
  explicit FullPipe(const std::filesystem::path& name) {
    if (::mkfifo(name.c_str(), 0600) == 0)
      descriptor_ = ::open(name.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) throw std::runtime_error(name.string() + ": no pipe");
    const std::array<char, 4096> filling{};
    while (::write(descriptor_, filling.data(), filling.size()) > 0) continue;
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  ~FullPipe() { ::close(descriptor_); }

  /// What has come beside the filling, as far as it has come.
  const std::string& read() {
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = ::read(descriptor_, part.data(), part.size())) > 0;)
      for (ssize_t i = 0; i < got; ++i)
        if (part[static_cast<std::size_t>(i)] != 0) text_ += part[static_cast<std::size_t>(i)];
    return text_;
  }

 private:
  int descriptor_ = -1;
  std::string text_;
};

/// Looking at each call's stack takes more time than the program. Threads change a call's number a little.
std::uint32_t some_before(std::uint32_t number) { return number - number / 32; }

}  // namespace

std::string Failure::text() const {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%s%s%s, call %u, stack %016llx",
                test::kFailingCallNames[static_cast<std::size_t>(call)], running ? " while running" : "",
                child ? " in a process that it forked" : "", number, static_cast<unsigned long long>(stack));
  return text.data();
}

FailingProgram::FailingProgram(std::vector<std::string> arguments, std::string runs_from, std::string typed)
    : arguments_(std::move(arguments)), runs_from_(std::move(runs_from)), typed_(std::move(typed)) {}

std::vector<Failure> FailingProgram::record(const TemporaryFolder& folder) const {
  const PageFile file(folder / kPage);
  const FailurePage& page = file.page();
  const Outcome whole = run(folder, file.page());
  if (whole.exit != 0) throw std::runtime_error("it does not even run undisturbed: " + whole.err);
  std::vector<Failure> failures;
  for (const test::CallStack& stack : page.stack) {
    if (stack.hash.load() == 0) continue;
    failures.push_back({.stack = stack.hash.load(),
                        .call = stack.call,
                        .running = stack.running,
                        .child = stack.child,
                        .number = stack.number});
  }
  if (page.left_out.load() > 0) throw std::runtime_error("more call stacks than a page has places for");
  std::ranges::sort(failures, {}, &Failure::stack);
  return failures;
}

Outcome FailingProgram::run(const TemporaryFolder& folder, const Failure& failure) const {
  const PageFile file(folder / kPage);
  file.page().fails = failure.stack;
  file.page().from = some_before(failure.number);
  return run(folder, file.page());
}

Outcome FailingProgram::terminate(const TemporaryFolder& folder, double after, double reads_errors_at) const {
  const PageFile file(folder / kPage);
  file.page().terminates_after = static_cast<std::int64_t>(1e9 * after);
  return run(folder, file.page(), reads_errors_at);
}

Outcome FailingProgram::run(const TemporaryFolder& folder, FailurePage& page, double reads_errors_at) const {
  std::copy(runs_from_.begin(), runs_from_.end(), page.runs_from.begin());
  const bool held = !runs_from_.empty();
  std::string preloaded = PHALANX_INJECTED_FAILURES_LIBRARY;
  std::vector<std::string> command{"/usr/bin/env", "-C", folder.path().string()};
  test::HeldClock clock;
  if (held) {
    for (const std::string& variable : clock.environment(PHALANX_HELD_CLOCK_LIBRARY)) {
      if (variable.starts_with("LD_PRELOAD=")) continue;
      command.push_back(variable);
    }
    preloaded = PHALANX_HELD_CLOCK_LIBRARY ":" + preloaded;
  }
  command.insert(command.end(), {"LD_PRELOAD=" + preloaded,
                                 std::string(test::kFailuresVariable) + "=" + (folder / kPage).string(),
                                 "PHALANX_DATA_DIR=" PHALANX_SOURCE_DIR, "TERM=dumb", "SSH_CONNECTION=",
                                 "XDG_CONFIG_HOME=" + folder.path().string(), PHALANX_PROGRAM});
  command.insert(command.end(), arguments_.begin(), arguments_.end());

  std::optional<FullPipe> errors;
  if (reads_errors_at > 0.0) {
    errors.emplace(folder / kErrors);
    const std::string script = "exec \"$@\" 2>'" + (folder / kErrors).string() + "'";
    command.insert(command.begin(), {"/bin/sh", "-c", script, "sh"});
  }
  ChildProcess process(command, folder / kOutput);
  if (!typed_.empty()) process.type(typed_);
  const double give_up = wall_seconds() + kRealHang;
  if (held) {
    clock.run([&] {
      if (errors && clock.now() >= reads_errors_at) errors->read();
      return process.ended() || clock.now() > kHeldHang || wall_seconds() > give_up;
    });
  }
  return {.exit = process.wait(held ? 0.0 : kRealHang).value_or(Outcome::kHangs),
          .out = process.output(),
          .err = errors ? errors->read() : process.errors(),
          .failed = page.failed.load() != 0,
          .stack = read_file(folder / (std::string(kPage) + ".stack"))};
}

std::map<std::string, std::string> files_in(const TemporaryFolder& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    const std::string name = entry.path().lexically_relative(folder.path()).string();
    if (entry.is_regular_file() && !name.starts_with(kPage) && !name.starts_with(kOutput))
      files.emplace(name, read_file(entry.path()));
  }
  return files;
}

}  // namespace phalanx::testing
