// SPDX-License-Identifier: Apache-2.0
#include "study/queue/queue_address.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <libpq-fe.h>
#include <netinet/in.h>

#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace phalanx {
namespace {

using Settings = std::map<std::string, std::string>;

constexpr const char* kForm =
    "write postgresql://USER@HOST/DATABASE, or postgresql:///DATABASE?host=/FOLDER for a server's socket";

Settings settings_of(const std::string& url) {
  if (!url.starts_with("postgresql://") && !url.starts_with("postgres://"))
    throw std::invalid_argument(fmt::format("the queue's address is no URL of PostgreSQL; {}", kForm));
  char* problem = nullptr;  // not shown: it repeats parts of the address, which may hold a password
  const std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)> options(
      PQconninfoParse(url.c_str(), &problem), &PQconninfoFree);
  PQfreemem(problem);
  if (!options)
    throw std::invalid_argument(fmt::format("the queue's address cannot be read as a URL; {}", kForm));
  Settings settings;
  for (const PQconninfoOption* option = options.get(); option->keyword != nullptr; ++option) {
    if (option->val != nullptr && *option->val != '\0') settings[option->keyword] = option->val;
  }
  return settings;
}

bool is_loopback(const std::string& host) {
  in_addr address{};
  if (::inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr) >> 24 == IN_LOOPBACKNET;
  return host == "localhost" || host == "::1";
}

/// @returns true if all hosts are sockets in the file system or addresses of the loopback interface.
bool on_this_machine(const Settings& settings) {
  for (const char* key : {"host", "hostaddr"}) {
    if (!settings.contains(key)) continue;
    std::istringstream list(settings.at(key));
    for (std::string host; std::getline(list, host, ',');) {
      if (!host.starts_with('/') && !host.starts_with('@') && !is_loopback(host)) return false;
    }
  }
  return true;
}

/// libpq ignores sslmode on a socket in the file system.
void check_certificate(Settings& settings) {
  const auto [mode, is_new] = settings.emplace("sslmode", "verify-full");
  if (is_new || mode->second == "verify-full" || on_this_machine(settings)) return;
  throw std::invalid_argument(fmt::format(
      "the queue's address asks for sslmode={}, with which another server could answer; leave sslmode "
      "out, and give the certificate of the authority that signed the server's in "
      "~/.postgresql/root.crt or by sslrootcert=FILE",
      mode->second));
}

std::string quoted(const std::string& value) {
  std::string text = "'";
  for (const char c : value) {
    if (c == '\'' || c == '\\') text += '\\';
    text += c;
  }
  return text + '\'';
}

}  // namespace

std::string queue_connection(const std::string& url) {
  Settings settings = settings_of(url);
  for (const char* secret : {"password", "sslpassword"}) {
    if (settings.contains(secret))
      throw std::invalid_argument(
          "the queue's address holds a password, which every user of this machine could read; write it into "
          "~/.pgpass (HOST:PORT:DATABASE:USER:PASSWORD, readable by you alone) and leave it out");
  }
  if (settings.contains("service"))
    throw std::invalid_argument(
        fmt::format("the queue's address names a service, whose file could name another host; {}", kForm));
  if (!settings.contains("host"))
    throw std::invalid_argument(fmt::format("the queue's address names no host; {}", kForm));
  check_certificate(settings);
  const Settings defaults = {
      {"connect_timeout", "10"}, {"keepalives_idle", "10"},     {"keepalives_interval", "5"},
      {"keepalives_count", "2"}, {"tcp_user_timeout", "20000"}, {"application_name", "phalanx study"},
      {"hostaddr", ""}};  // not that of PGHOSTADDR
  settings.insert(defaults.begin(), defaults.end());
  settings["client_encoding"] = "UTF8";
  settings["gssencmode"] = "disable";  // with it, sslmode would not count
  // The server notices a client that is gone, and ends its transaction; what it confirms is on its disk.
  settings["options"] +=
      " -c client_min_messages=warning -c DateStyle=ISO -c synchronous_commit=on -c lock_timeout=30s"
      " -c idle_in_transaction_session_timeout=60s -c tcp_keepalives_idle=10 -c tcp_keepalives_interval=5"
      " -c tcp_keepalives_count=2";
  std::string text;
  for (const auto& [key, value] : settings) text += fmt::format("{}={} ", key, quoted(value));
  return text;
}

}  // namespace phalanx
