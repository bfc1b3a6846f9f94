// SPDX-License-Identifier: Apache-2.0
#include "serve/web/names.h"

#include "phalanx/serve/reach.h"

namespace phalanx::web {

std::set<std::string> names_of_server(const std::string& address) {
  std::set<std::string> names{"localhost", "127.0.0.1", "::1", address};
  if (is_loopback(address)) return names;
  for (std::string& name : machine_names()) names.insert(std::move(name));
  for (std::string& name : reachable_addresses(address)) names.insert(std::move(name));
  return names;
}

}  // namespace phalanx::web
