// SPDX-License-Identifier: Apache-2.0
#include "device/conform/transport_conform_port.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "device/conform/conform_host.h"

namespace phalanx {
namespace {

constexpr double kLook = 1e-3;      ///< interval of looking at the other socket, and for a signal [s]
constexpr double kSlowLook = 0.05;  ///< with one transport [s]

/// Least baud rate. A third of the line then carries a command every 7 ms. A step that waits for the next one
/// much longer is older than 14 ms, and good firmware fades its torque.
constexpr unsigned kLeastBaud = 500'000;

void check_baud(const std::string& address, unsigned baud) {
  if (baud >= kLeastBaud) return;
  const double period = conform_command_period(0.1 * baud);
  throw std::invalid_argument(fmt::format(
      "{}: {} baud: a third of the line carries a command every {:.1f} ms, and steps fade from 14 ms "
      "of age on; set device and address to at least {} baud",
      address, baud, 1e3 * period, kLeastBaud));
}

}  // namespace

TransportConformPort::TransportConformPort(std::unique_ptr<Transport> transport,
                                           std::unique_ptr<Transport> other, unsigned baud,
                                           const Clock& clock)
    : transport_(std::move(transport)), other_(std::move(other)), baud_(baud), clock_(clock) {}

void TransportConformPort::send(std::span<const std::uint8_t> frame, ConformSender sender) {
  Transport& by = sender == ConformSender::kOtherHost && other_ ? *other_ : *transport_;
  static_cast<void>(by.send(frame, 0));
}

void TransportConformPort::send_bytes(std::span<const std::uint8_t> bytes) {
  if (!transport_->send_bytes(bytes)) throw DeviceError(transport_->address() + ": the port takes no bytes");
}

std::size_t TransportConformPort::receive(double until, std::span<std::uint8_t> out, ConformSender& to) {
  while (true) {
    if (interrupted && interrupted() && !std::exchange(interruption_thrown_, true))
      throw std::runtime_error("interrupted; no report was written");
    if (transport_->lost()) throw DeviceError(transport_->address() + ": the port has failed");
    Peer from = 0;
    to = ConformSender::kHost;
    if (const std::size_t size = transport_->receive(out, from); size > 0) return size;
    to = ConformSender::kOtherHost;
    if (other_) {
      if (const std::size_t size = other_->receive(out, from); size > 0) return size;
    }
    const double left = until - clock_.now();
    if (left <= 0.0) return 0;
    transport_->wait(std::min(left, other_ ? kLook : kSlowLook) * clock_.slowdown());
  }
}

std::unique_ptr<TransportConformPort> open_conform_port(
    const std::string& spec, const std::function<std::unique_ptr<Transport>(const std::string&)>& open,
    const Clock& clock) {
  std::unique_ptr<Transport> transport = open(spec);
  const std::string address = transport->address();
  std::unique_ptr<Transport> other;
  unsigned baud = 0;
  if (address.rfind("serial:", 0) == 0) {
    baud = static_cast<unsigned>(std::strtoul(address.substr(address.rfind(':') + 1).c_str(), nullptr, 10));
    check_baud(address, baud);
  } else {
    other = open(spec);
  }
  return std::make_unique<TransportConformPort>(std::move(transport), std::move(other), baud, clock);
}

}  // namespace phalanx
