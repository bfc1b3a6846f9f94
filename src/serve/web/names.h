// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace phalanx::web {

[[nodiscard]] bool is_loopback(const std::string& address);
/// What browsers may call a server that listens on this address: localhost, the machine's names, the address;
/// all of the machine's addresses if it stands for all.
[[nodiscard]] std::set<std::string> names_of_server(const std::string& address);

}  // namespace phalanx::web
