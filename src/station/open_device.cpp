// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/open_device.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "phalanx/device/opengloves/opengloves_device.h"

namespace phalanx {
namespace {

constexpr unsigned kSerialBaud = 2000000;
constexpr unsigned kGloveBaud = 115200;

struct Spec {
  std::string kind;
  std::string place;  ///< text after the first colon
};

constexpr const char* kLinkAddresses = "udp:HOST:PORT and serial:PORT[:BAUD]";
constexpr const char* kDeviceAddresses = "udp:HOST:PORT, serial:PORT[:BAUD] and opengloves:PORT[:BAUD]";

[[noreturn]] void refuse(const std::string& spec, const std::string& why,
                         const char* possible = kDeviceAddresses) {
  throw std::invalid_argument(fmt::format("device '{}': {}; possible are {}", spec, why, possible));
}

Spec split(const std::string& spec, const char* possible = kDeviceAddresses) {
  const std::size_t colon = spec.find(':');
  if (colon == std::string::npos || colon + 1 == spec.size()) refuse(spec, "not an address", possible);
  return {.kind = spec.substr(0, colon), .place = spec.substr(colon + 1)};
}

struct SerialPlace {
  std::string port;
  unsigned baud = 0;
};

/// Splits a port and its baud rate. Names in /dev/serial/by-path contain colons: a path that exists has no
/// rate behind it.
SerialPlace serial_place(const std::string& spec, const std::string& place, unsigned usual_baud) {
  const std::size_t colon = place.rfind(':');
  std::error_code ignored;
  if (colon == std::string::npos || std::filesystem::exists(place, ignored))
    return {.port = place, .baud = usual_baud};
  unsigned baud = 0;
  const char* const begin = place.data() + colon + 1;
  const char* const end = place.data() + place.size();
  const auto [stopped, error] = std::from_chars(begin, end, baud);
  if (begin == end || error != std::errc() || stopped != end || baud == 0)
    refuse(spec, fmt::format("'{}' is no baud rate", std::string(begin, end)));
  if (colon == 0) refuse(spec, "no port");
  return {.port = place.substr(0, colon), .baud = baud};
}

std::unique_ptr<Transport> transport_of(const std::string& spec, const Spec& parts) {
  if (parts.kind == "udp") return connect_udp(parts.place);
  if (parts.kind == "serial") {
    const SerialPlace at = serial_place(spec, parts.place, kSerialBaud);
    return open_serial(at.port, at.baud);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<Transport> open_transport(const std::string& spec) {
  auto transport = transport_of(spec, split(spec, kLinkAddresses));
  if (!transport) refuse(spec, "it does not speak the Phalanx link", kLinkAddresses);
  return transport;
}

std::unique_ptr<Device> open_device(const std::string& spec, const Clock& clock,
                                    const LinkSettings& settings) {
  const Spec parts = split(spec);
  if (parts.kind == "opengloves") {
    const SerialPlace at = serial_place(spec, parts.place, kGloveBaud);
    OpenGlovesSettings glove;
    glove.hello_timeout = settings.hello_timeout;
    return make_opengloves_device(at.port, at.baud, clock, glove);
  }
  auto transport = transport_of(spec, parts);
  if (!transport) refuse(spec, fmt::format("no kind of device is called '{}'", parts.kind));
  return make_link_device(std::move(transport), clock, settings);
}

}  // namespace phalanx
