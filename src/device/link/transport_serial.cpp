// SPDX-License-Identifier: Apache-2.0
// The link over a serial port (Boost.Asio opens and configures it) and over a pseudo-terminal.
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <utility>  // Boost 1.74's Asio needs it in C++20 and does not say so

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <cerrno>
#include <cstdlib>  // grantpt and its kin
#include <cstring>

#include "device/descriptor.h"
#include "device/link/serial_line.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

[[noreturn]] void fail(const std::string& port, const std::string& what, const char* remedy) {
  throw DeviceError(fmt::format("serial:{}: {}; {}", port, what, remedy));
}

constexpr const char* kInUse = "end the other program that uses it";

const char* remedy_of_open(int error) noexcept {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "plug the device in and see `ls /dev/serial/by-id` for its name";
    case EACCES:
    case EPERM:
      return "add yourself to the group dialout (`sudo usermod -aG dialout $USER`) and log in again";
    case EBUSY:
      return kInUse;
    default:
      return "is it a serial port?";
  }
}

/// @returns true for a pseudo-terminal. Its controller keeps it open: the exclusive mode would outlive a host
/// that was killed, but the lock does not.
bool is_pseudo_terminal(int descriptor) noexcept {
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return false;
  const unsigned number = major(status.st_rdev);
  return number >= 136 && number <= 143;  // UNIX98 slaves, Documentation/admin-guide/devices.txt
}

/// Requests low latency: USB adapters otherwise collect bytes for up to 16 ms. Not every driver
/// can: no error.
void ask_for_low_latency(int descriptor) noexcept {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
  ::ioctl(descriptor, TIOCSSERIAL, &settings);
}

class SerialPort final : public SerialLine {
 public:
  SerialPort(const std::string& port, unsigned baud) : port_(io_), name_(port), baud_(baud) {
    error_code error;
    port_.open(port, error);  // raw, non-blocking
    if (error) fail(port, "cannot open: " + error.message(), remedy_of_open(error.value()));
    const int descriptor = port_.native_handle();
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) fail(port, "in use by another program", kInUse);
    if (!is_pseudo_terminal(descriptor) && ::ioctl(descriptor, TIOCEXCL) != 0)
      fail(port, fmt::format("cannot be had alone: {}", std::strerror(errno)), kInUse);
    configure();
    ask_for_low_latency(descriptor);
    ::tcflush(descriptor, TCIOFLUSH);  // bytes from before this session
    use(descriptor);
  }

  [[nodiscard]] std::string address() const override { return fmt::format("serial:{}:{}", name_, baud_); }

 private:
  void configure() {
    using port = asio::serial_port;
    error_code error;
    port_.set_option(port::baud_rate(baud_), error);
    if (error) {
      fail(name_, fmt::format("cannot run at {} baud: {}", baud_, error.message()),
           "choose a rate that the port has, for example 2000000, 1000000 or 115200");
    }
    port_.set_option(port::character_size(8), error);
    if (!error) port_.set_option(port::parity(port::parity::none), error);
    if (!error) port_.set_option(port::stop_bits(port::stop_bits::one), error);
    if (!error) port_.set_option(port::flow_control(port::flow_control::none), error);
    if (error) fail(name_, "cannot be set to 8N1: " + error.message(), "is it a serial port?");
  }

  asio::io_context io_;
  asio::serial_port port_;
  std::string name_;
  unsigned baud_;
};

[[noreturn]] void no_pseudo_terminal() {
  throw DeviceError(fmt::format(
      "no pseudo-terminal: {}; is /dev/pts mounted, and are fewer open than /proc/sys/kernel/pty/max?",
      std::strerror(errno)));
}

std::string name_of_slave(int master) {
  std::array<char, 64> name{};
  if (::grantpt(master) != 0 || ::unlockpt(master) != 0 || ::ptsname_r(master, name.data(), name.size()) != 0)
    no_pseudo_terminal();
  return name.data();
}

/// Pseudo-terminal. It keeps the host's end open too: without a host, the controller's end would fail.
class PseudoTerminal final : public SerialLine {
 public:
  PseudoTerminal()
      : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)),
        name_(master_.value() < 0 ? std::string() : name_of_slave(master_.value())),
        slave_(name_.empty() ? -1 : ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    termios settings{};
    if (slave_.value() < 0 || ::tcgetattr(slave_.value(), &settings) != 0) no_pseudo_terminal();
    ::cfmakeraw(&settings);
    if (::tcsetattr(slave_.value(), TCSANOW, &settings) != 0) no_pseudo_terminal();
    use(master_.value());
  }

  [[nodiscard]] std::string address() const override { return "serial:" + name_; }

 private:
  Descriptor master_;
  std::string name_;
  Descriptor slave_;
};

}  // namespace

std::unique_ptr<Transport> open_serial(const std::string& port, unsigned baud) {
  return std::make_unique<SerialPort>(port, baud);
}

std::unique_ptr<Transport> open_pseudo_terminal() { return std::make_unique<PseudoTerminal>(); }

}  // namespace phalanx
