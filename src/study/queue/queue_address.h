// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace phalanx {

/// Turns the address of a queue into libpq's connection string, with the defaults of this program: certificate
/// checked over TCP, a server that does not answer noticed within 20 s.
/// @throws std::invalid_argument with the remedy for what is no address, holds a password, names no host, names a service or asks
/// for a weaker check; the message does not repeat the address
[[nodiscard]] std::string queue_connection(const std::string& url);

}  // namespace phalanx
