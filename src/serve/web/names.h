// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace phalanx::web {

/// What browsers may call a server that listens on this address: localhost and the address. One that other
/// machines reach also has the machine's names and its reachable_addresses(). A server on loopback has not:
/// another machine may answer to a name of the local network, and lead a page of its own here.
[[nodiscard]] std::set<std::string> names_of_server(const std::string& address);

}  // namespace phalanx::web
