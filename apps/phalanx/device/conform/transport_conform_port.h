// SPDX-License-Identifier: Apache-2.0
// The wire of a conformance test: transports of the link and the process's clock.
#pragma once

#include <functional>
#include <memory>

#include "device/conform/conform_port.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {

/// Port over one transport, or over two of UDP: the other host has a socket of its own.
class TransportConformPort final : public ConformPort {
 public:
  /// @param other  of the other host; null: it shares `transport`, a serial line
  /// @param baud   of a serial line; 0: UDP
  TransportConformPort(std::unique_ptr<Transport> transport, std::unique_ptr<Transport> other, unsigned baud,
                       const Clock& clock);

  [[nodiscard]] double now() const override { return clock_.now(); }
  void send(std::span<const std::uint8_t> frame, ConformSender sender) override;
  void send_bytes(std::span<const std::uint8_t> bytes) override;
  /// @throws DeviceError if the port has failed; std::runtime_error once after `interrupted` returned true
  std::size_t receive(double until, std::span<std::uint8_t> out, ConformSender& to) override;
  [[nodiscard]] bool serial() const override { return baud_ > 0; }
  [[nodiscard]] double bytes_per_second() const override { return 0.1 * static_cast<double>(baud_); }

  std::function<bool()> interrupted;  ///< may be empty

 private:
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<Transport> other_;
  unsigned baud_;
  const Clock& clock_;
  bool interruption_thrown_ = false;
};

/// Opens the port of an address as open_transport() does. @throws as open_transport(); std::invalid_argument
/// if a serial line is too slow for the commands
[[nodiscard]] std::unique_ptr<TransportConformPort> open_conform_port(
    const std::string& spec, const std::function<std::unique_ptr<Transport>(const std::string&)>& open,
    const Clock& clock);

}  // namespace phalanx
