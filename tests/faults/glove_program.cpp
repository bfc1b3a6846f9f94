// SPDX-License-Identifier: Apache-2.0
// glove_program LOG WATCHDOG_MS: the firmware of a glove with force feedback as a program of its own. Its
// wearer closes the hand. LOG gets a row a loop: the time, and the stops that the servos hold. WATCHDOG_MS
// after the host's last byte the servos let go; 0: never, as LucidGloves' firmware does.
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

namespace {

constexpr double kPeriod = 0.01;                     // of a loop [s]
constexpr double kOpenUntil = 1.6, kClosedAt = 2.4;  // [s]
constexpr double kClosed = 0.9;                      // curl: beyond the object
constexpr int kFullScale = 4095;

volatile std::sig_atomic_t ended = 0;

double now() {
  static const auto kBegin = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - kBegin).count();
}

std::string line_at(double time) {
  const double closed = kClosed * std::clamp((time - kOpenUntil) / (kClosedAt - kOpenUntil), 0.0, 1.0);
  const std::string raw = std::to_string(static_cast<int>(kFullScale * closed));
  // The joystick at rest, F and G, says that 4095 is the full scale.
  return "A" + raw + "B" + raw + "C" + raw + "D" + raw + "E" + raw + "F2047G2047\n";
}

class Glove {
 public:
  Glove() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, port_.data(), port_.size()) != 0)
      std::exit(1);
    // Held open, so that the terminal lives without a host, too.
    const int slave = ::open(port_.data(), O_RDWR | O_NOCTTY);
    termios settings{};
    if (slave < 0 || ::tcgetattr(slave, &settings) != 0) std::exit(1);
    ::cfmakeraw(&settings);
    ::tcsetattr(slave, TCSANOW, &settings);
  }

  [[nodiscard]] const char* port() const { return port_.data(); }
  [[nodiscard]] const std::string& held() const { return held_; }

  /// A host that does not read loses lines.
  void say(const std::string& line) const {
    if (::write(master_, line.data(), line.size()) < 0) return;
  }
  void listen_until(double end) {
    for (double left = end - now(); left > 0.0 && ended == 0; left = end - now()) {
      pollfd input{.fd = master_, .events = POLLIN, .revents = 0};
      if (::poll(&input, 1, std::max(1, static_cast<int>(1e3 * left))) == 1) hear();
    }
  }
  void watch(double time_out) {
    if (time_out > 0.0 && now() - heard_ > time_out) held_ = kFree;
  }

 private:
  static constexpr const char* kFree = "A0B0C0D0E0";

  void hear() {
    std::array<char, 256> bytes;
    const ssize_t count = ::read(master_, bytes.data(), bytes.size());
    for (ssize_t i = 0; i < count; ++i) {
      heard_ = now();
      const char byte = bytes[static_cast<std::size_t>(i)];
      if (byte != '\n') {
        line_ += byte;
        continue;
      }
      if (!line_.empty()) held_ = line_;
      line_.clear();
    }
  }

  int master_;
  std::array<char, 64> port_{};
  std::string line_;          // that has not ended
  std::string held_ = kFree;  // what the servos do
  double heard_ = 0.0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  std::FILE* log = std::fopen(arguments[1], "w");
  if (log == nullptr) return 1;
  const double time_out = 1e-3 * std::atof(arguments[2]);
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, [](int) { ended = 1; });
  Glove glove;
  std::printf("listening on opengloves:%s\n", glove.port());
  std::fflush(stdout);
  std::fputs("time_s,held\n", log);
  for (double time = now(); ended == 0; time += kPeriod) {
    glove.say(line_at(time));
    glove.listen_until(time + kPeriod);
    glove.watch(time_out);
    std::fprintf(log, "%.4f,%s\n", now(), glove.held().c_str());
  }
  return std::fclose(log) == 0 ? 0 : 1;
}
