// SPDX-License-Identifier: Apache-2.0
#include "serve/web/doors.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "serve/web/request_path.h"

namespace phalanx::web {
namespace {

bool is_port(std::string_view text) noexcept {
  return text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_name_character(char c) noexcept {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.' || c == '_';
}

bool is_address_character(char c) noexcept {
  return std::isxdigit(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '.';
}

std::string small(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

std::optional<std::string> host_name(std::string_view host) {
  const bool bracketed = !host.empty() && host.front() == '[';
  const std::size_t end = bracketed ? host.find(']') : std::min(host.find(':'), host.size());
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view name = bracketed ? host.substr(1, end - 1) : host.substr(0, end);
  std::string_view port = host.substr(bracketed ? end + 1 : end);
  if (!port.empty() && (port.front() != ':' || !is_port(port.substr(1)))) return std::nullopt;
  if (!bracketed && name.size() > 1 && name.back() == '.') name.remove_suffix(1);
  const auto good = bracketed ? is_address_character : is_name_character;
  if (name.empty() || !std::all_of(name.begin(), name.end(), good)) return std::nullopt;
  return small(name);
}

std::optional<Reply> HostDoor::refusal(std::string_view host, const std::string& reached) const {
  const std::optional<std::string> name = host_name(host);
  if (name && (names_.contains(*name) || *name == reached)) return std::nullopt;
  return sentence(421,
                  "This is not the machine that your browser asked for. Open the page by the address that "
                  "the station printed.");
}

bool same_secret(std::string_view a, std::string_view b) {
  // Of digests, which are as long whatever the texts are.
  std::array<unsigned char, SHA256_DIGEST_LENGTH> of_a{};
  std::array<unsigned char, SHA256_DIGEST_LENGTH> of_b{};
  SHA256(reinterpret_cast<const unsigned char*>(a.data()), a.size(), of_a.data());
  SHA256(reinterpret_cast<const unsigned char*>(b.data()), b.size(), of_b.data());
  return CRYPTO_memcmp(of_a.data(), of_b.data(), of_a.size()) == 0;
}

TokenDoor::TokenDoor(std::string operator_token, std::string viewer_token, std::uint16_t port, bool tls)
    : operator_token_(std::move(operator_token)),
      viewer_token_(std::move(viewer_token)),
      cookie_(fmt::format("phalanx-{}", port)),
      tls_(tls) {}

std::optional<TokenDoor::Entry> TokenDoor::entry(std::string_view token) const {
  // Both are always compared.
  const bool operates = same_secret(token, operator_token_);
  const bool views = !viewer_token_.empty() && same_secret(token, viewer_token_);
  if (operates) return Entry{true};
  if (views) return Entry{false};
  return std::nullopt;
}

TokenDoor::Verdict TokenDoor::judge(std::string_view query, std::string_view cookies) const {
  if (operator_token_.empty()) return Entry{true};
  if (const auto token = value_of(query, '&', "token")) {
    const std::optional<Entry> by_address = entry(*token);
    if (!by_address) {
      return sentence(403,
                      "The token in this address is not (or no longer) right. Open the address that the "
                      "station printed when it started.");
    }
    return Cookie{by_address->may_operate, fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}", cookie_,
                                                       *token, tls_ ? "; Secure" : "")};
  }
  if (const auto token = value_of(cookies, ';', cookie_)) {
    if (const std::optional<Entry> known = entry(*token)) return *known;
  }
  return sentence(403,
                  "This station lets in only those who come by its address with a token: open the one that "
                  "it printed when it started, or scan its code. If you just did, reload this page.");
}

bool is_websocket_key(std::string_view key) noexcept {
  constexpr std::size_t kDigits = 22;  // of 6 bits each; the last one holds 2 bits of the key
  constexpr std::string_view kPadding = "==";
  const auto is_digit = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '/';
  };
  return key.size() == kDigits + kPadding.size() && key.ends_with(kPadding) &&
         std::all_of(key.begin(), key.begin() + kDigits, is_digit);
}

std::optional<Reply> origin_refusal(std::string_view origin, std::string_view host, bool tls) {
  if (origin == fmt::format("{}://{}", tls ? "https" : "http", host)) return std::nullopt;
  return sentence(403,
                  "This was asked by a page that is not the station's own. Open the station's own page.");
}

}  // namespace phalanx::web
