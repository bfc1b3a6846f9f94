// SPDX-License-Identifier: Apache-2.0
#include "serve/web/names.h"

#include "phalanx/serve/reach.h"
#include "serve/web/boost.h"

namespace phalanx::web {

bool is_loopback(const std::string& address) {
  if (address == "localhost") return true;
  error_code error;
  const net::ip::address parsed = net::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

std::set<std::string> names_of_server(const std::string& address) {
  std::set<std::string> names{"localhost", "127.0.0.1", "::1", address};
  for (std::string& name : machine_names()) names.insert(std::move(name));
  error_code error;
  const net::ip::address parsed = net::ip::make_address(address, error);
  if (error || !parsed.is_unspecified()) return names;
  for (std::string& name : machine_addresses()) names.insert(std::move(name));
  return names;
}

}  // namespace phalanx::web
