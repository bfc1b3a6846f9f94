// SPDX-License-Identifier: Apache-2.0
#include "patient/secret.h"

#include <fmt/format.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "terminal/error_line.h"

namespace phalanx {
namespace {

constexpr std::size_t kLongestSecret = 1000;  // [bytes]
constexpr char kControlC = '\x03';

/// Terminal without echo for as long as the object lives. Ctrl-C ends the question, so that echo
/// always comes back.
class WithoutEcho {
 public:
  WithoutEcho() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);
    changed_ = ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &silent) == 0;
  }
  WithoutEcho(const WithoutEcho&) = delete;
  WithoutEcho& operator=(const WithoutEcho&) = delete;
  ~WithoutEcho() {
    if (changed_) static_cast<void>(::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_));
  }
  [[nodiscard]] bool is_on() const { return changed_; }

 private:
  termios before_{};
  bool changed_ = false;
};

std::string ask(const std::string& question, const std::string& what) {
  const WithoutEcho silent;
  if (!silent.is_on())
    throw std::invalid_argument(fmt::format("{}: the terminal cannot hide what is typed", what));
  print_aside(question);
  std::string line;
  char c = '\0';
  while (true) {
    const ssize_t got = ::read(STDIN_FILENO, &c, 1);
    if (got != 1 || c == kControlC)
      throw std::invalid_argument(fmt::format("{}: the input ended; nothing was done", what));
    if (c == '\n') break;
    if (line.size() == kLongestSecret)
      throw std::invalid_argument(fmt::format("{}: more than {} bytes", what, kLongestSecret));
    line.push_back(c);
  }
  print_aside("\n");
  return line;
}

/// @returns true if the environment had it
bool in_environment(const SecretSource& source, std::string& secret) {
  const char* value = std::getenv(source.environment.c_str());
  if (value == nullptr) {
    if (::isatty(STDIN_FILENO) == 1) return false;
    throw std::invalid_argument(fmt::format("the {} is missing: standard input is no terminal; set {}",
                                            source.what, source.environment));
  }
  secret = value;
  if (secret.size() > kLongestSecret)
    throw std::invalid_argument(
        fmt::format("{}: the {} has more than {} bytes", source.environment, source.what, kLongestSecret));
  return true;
}

}  // namespace

std::string read_secret(const SecretSource& source) {
  std::string secret;
  if (in_environment(source, secret)) return secret;
  return ask(fmt::format("{}: ", source.what), source.what);
}

std::string read_new_secret(const SecretSource& source) {
  std::string secret;
  if (in_environment(source, secret)) return secret;
  secret = ask(fmt::format("{}: ", source.what), source.what);
  if (ask(fmt::format("{}, again: ", source.what), source.what) != secret)
    throw std::invalid_argument(fmt::format("{}: the two differ; nothing was done", source.what));
  return secret;
}

}  // namespace phalanx
