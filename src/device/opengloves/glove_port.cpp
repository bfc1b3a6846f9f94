// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "device/descriptor.h"
#include "phalanx/device/device.h"

namespace phalanx {
namespace {

constexpr std::array<std::pair<unsigned, speed_t>, 10> kBaudRates = {{{9600, B9600},
                                                                      {19200, B19200},
                                                                      {38400, B38400},
                                                                      {57600, B57600},
                                                                      {115200, B115200},
                                                                      {230400, B230400},
                                                                      {460800, B460800},
                                                                      {921600, B921600},
                                                                      {1000000, B1000000},
                                                                      {2000000, B2000000}}};

speed_t speed_of(const std::string& port, unsigned baud) {
  const auto* const found = std::find_if(kBaudRates.begin(), kBaudRates.end(),
                                         [&](const auto& rate) { return rate.first == baud; });
  if (found == kBaudRates.end()) {
    throw DeviceError(fmt::format(
        "opengloves:{}: {} baud is not a rate of serial ports; most gloves have 115200", port, baud));
  }
  return found->second;
}

const char* remedy_of_open(int error) noexcept {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "plug the glove in and see `ls /dev/serial/by-id` for its name";
    case EACCES:
    case EPERM:
      return "add yourself to the group dialout (`sudo usermod -aG dialout $USER`) and log in again";
    case EBUSY:
      return "end the other program that uses it (SteamVR's OpenGloves driver?)";
    default:
      return "is it a serial port?";
  }
}

[[noreturn]] void fail(const std::string& port, const char* what, int error) {
  throw DeviceError(
      fmt::format("opengloves:{}: {}: {}; {}", port, what, std::strerror(error), remedy_of_open(error)));
}

}  // namespace

int open_glove_port(const std::string& port, unsigned baud) {
  const speed_t speed = speed_of(port, baud);
  Descriptor descriptor(::open(port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (descriptor.value() < 0) fail(port, "cannot open", errno);
  if (::flock(descriptor.value(), LOCK_EX | LOCK_NB) != 0) fail(port, "in use by another program", EBUSY);
  termios settings{};
  if (::tcgetattr(descriptor.value(), &settings) != 0) fail(port, "cannot be set up", errno);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  if (::cfsetspeed(&settings, speed) != 0 || ::tcsetattr(descriptor.value(), TCSANOW, &settings) != 0)
    fail(port, "cannot be set up", errno);
  ::tcflush(descriptor.value(), TCIOFLUSH);  // bytes from before this session
  return descriptor.give_away();
}

std::string usb_serial_number(const std::string& port) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path tty = fs::canonical(port, error);
  if (error) return {};
  fs::path folder = fs::canonical(fs::path("/sys/class/tty") / tty.filename() / "device", error);
  if (error) return {};
  // The USB device is a few folders above its port.
  for (int up = 0; up < 4 && folder.has_relative_path(); ++up, folder = folder.parent_path()) {
    std::string serial;
    if (std::getline(std::ifstream(folder / "serial"), serial)) return serial;
  }
  return {};
}

}  // namespace phalanx
