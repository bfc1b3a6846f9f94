// SPDX-License-Identifier: Apache-2.0
#include "run/run_console.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <exception>
#include <utility>

namespace phalanx {
namespace {

bool are_the_same(int a, int b) {
  struct stat of_a{};
  struct stat of_b{};
  return ::fstat(a, &of_a) == 0 && ::fstat(b, &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
         of_a.st_ino == of_b.st_ino;
}

}  // namespace

RunConsole::RunConsole(std::string command) : command_(std::move(command)), out_(STDOUT_FILENO) {
  if (!are_the_same(STDOUT_FILENO, STDERR_FILENO)) err_.emplace(STDERR_FILENO);
}

void RunConsole::say(const std::string& line, Emphasis emphasis) noexcept {
  try {
    out_.line(emphasised(emphasis, line, takes_colour(STDOUT_FILENO)));
  } catch (const std::exception&) {  // no memory
  }
}

void RunConsole::complain(const std::string& what, Emphasis emphasis) noexcept {
  try {
    (err_ ? *err_ : out_)
        .line(emphasised(emphasis, fmt::format("{}: {}", command_, what), takes_colour(STDERR_FILENO)));
  } catch (const std::exception&) {  // no memory
  }
}

}  // namespace phalanx
