// SPDX-License-Identifier: Apache-2.0
// Names and addresses of this machine, tokens and QR codes.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <openssl/rand.h>
#include <pwd.h>
#include <qrencode.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <climits>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "phalanx/serve/reach.h"

namespace phalanx {
namespace {

std::string text_of(int family, const void* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(family, address, text.data(), static_cast<socklen_t>(text.size())) != nullptr
             ? text.data()
             : "";
}

/// @returns the address as text; empty if it is link-local or of another family
std::string routable_address(const sockaddr* address) {
  if (address->sa_family == AF_INET) {
    const in_addr& v4 = reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
    const std::uint32_t bits = ntohl(v4.s_addr);
    const bool link_local = (bits >> 16U) == 0xA9FEU;  // 169.254/16
    return link_local ? "" : text_of(AF_INET, &v4);
  }
  if (address->sa_family == AF_INET6) {
    const in6_addr& v6 = reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
    return IN6_IS_ADDR_LINKLOCAL(&v6) ? "" : text_of(AF_INET6, &v6);
  }
  return "";
}

bool is_v6(const std::string& address) { return address.find(':') != std::string::npos; }

std::string user_name() {
  const passwd* entry = ::getpwuid(::geteuid());
  return entry != nullptr ? entry->pw_name : std::to_string(::geteuid());
}

constexpr int kQuietZone = 4;  // [modules]

/// QR code with its quiet zone.
class QrCode {
 public:
  explicit QrCode(const std::string& text)
      : code_(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_M), &QRcode_free) {
    if (!code_) throw std::runtime_error("this text cannot be shown as a QR code: it is empty or too long");
  }
  [[nodiscard]] int begin() const noexcept { return -kQuietZone; }
  [[nodiscard]] int end() const noexcept { return code_->width + kQuietZone; }
  [[nodiscard]] bool dark(int row, int column) const noexcept {
    const int width = code_->width;
    if (row < 0 || column < 0 || row >= width || column >= width) return false;
    return (code_->data[static_cast<std::size_t>(row * width + column)] & 1U) != 0;
  }

 private:
  std::unique_ptr<QRcode, decltype(&QRcode_free)> code_;
};

/// @returns the character that shows two modules, one above the other; true is dark
const char* half_blocks(bool upper, bool lower) noexcept {
  if (upper) return lower ? "\u2588" : "\u2580";
  return lower ? "\u2584" : " ";
}

}  // namespace

std::vector<std::string> machine_names() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name.front() == '\0') return {};
  std::string full(name.data());
  for (char& c : full) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::string first = full.substr(0, full.find('.'));
  std::vector<std::string> names{full};
  for (const std::string& other : {first, first + ".local"}) {
    if (std::find(names.begin(), names.end(), other) == names.end()) names.push_back(other);
  }
  return names;
}

std::vector<std::string> machine_addresses() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> list(first, &::freeifaddrs);
  std::vector<std::string> v4;
  std::vector<std::string> v6;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    const bool up = (at->ifa_flags & IFF_UP) != 0 && (at->ifa_flags & IFF_LOOPBACK) == 0;
    if (!up || at->ifa_addr == nullptr) continue;
    std::string address = routable_address(at->ifa_addr);
    if (!address.empty()) (is_v6(address) ? v6 : v4).push_back(std::move(address));
  }
  v4.insert(v4.end(), v6.begin(), v6.end());
  return v4;
}

bool is_loopback(const std::string& address) {
  in_addr v4{};
  if (::inet_pton(AF_INET, address.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24U == IN_LOOPBACKNET;
  in6_addr v6{};
  if (::inet_pton(AF_INET6, address.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6);
  return address == "localhost";
}

std::vector<std::string> reachable_addresses(const std::string& address) {
  in_addr v4{};
  in6_addr v6{};
  const bool all_v4 = ::inet_pton(AF_INET, address.c_str(), &v4) == 1 && v4.s_addr == INADDR_ANY;
  const bool all = ::inet_pton(AF_INET6, address.c_str(), &v6) == 1 && IN6_IS_ADDR_UNSPECIFIED(&v6);
  if (!all_v4 && !all) return {address};
  std::vector<std::string> addresses = machine_addresses();
  if (all_v4) std::erase_if(addresses, is_v6);
  return addresses;
}

std::vector<std::string> lan_urls(const std::string& address, std::uint16_t port, const std::string& token) {
  std::vector<std::string> urls;
  for (const std::string& reached : reachable_addresses(address)) {
    const std::string host = is_v6(reached) ? "[" + reached + "]" : reached;
    urls.push_back(fmt::format("https://{}:{}/{}", host, port, token.empty() ? "" : "?token=" + token));
  }
  return urls;
}

std::string ssh_line(std::uint16_t port) {
  const char* connection = std::getenv("SSH_CONNECTION");  // "client port server port"
  if (connection == nullptr) return "";
  std::istringstream words(connection);
  std::string client;
  std::string client_port;
  std::string server;
  std::string server_port;
  if (!(words >> client >> client_port >> server >> server_port)) return "";
  const std::string other_port = server_port == "22" ? "" : " -p " + server_port;
  return fmt::format("ssh{} -L {}:127.0.0.1:{} {}@{}", other_port, port, port, user_name(), server);
}

std::string random_token() {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  constexpr std::size_t kBits = 128;
  std::array<unsigned char, kBits / 8> random{};
  if (RAND_bytes(random.data(), static_cast<int>(random.size())) != 1) {
    throw std::runtime_error("the system has no random numbers, so that no token can be made");
  }
  std::string token;
  for (std::size_t bit = 0; bit < kBits; bit += 6) {
    unsigned value = 0;
    for (std::size_t i = bit; i < bit + 6; ++i) {
      value <<= 1U;
      if (i < kBits) value |= (random[i / 8] >> (7 - i % 8)) & 1U;
    }
    token += kDigits[value];
  }
  return token;
}

std::string qr_text(const std::string& text) {
  // Black and white of the 256 colours. The terminal's theme may replace the first 16.
  constexpr const char* kBlackOnWhite = "\x1b[38;5;16;48;5;231m";
  constexpr const char* kReset = "\x1b[0m";
  const QrCode code(text);
  std::string out;
  for (int row = code.begin(); row < code.end(); row += 2) {
    out += kBlackOnWhite;
    for (int column = code.begin(); column < code.end(); ++column) {
      out += half_blocks(code.dark(row, column), code.dark(row + 1, column));
    }
    out += kReset;
    out += '\n';
  }
  return out;
}

}  // namespace phalanx
