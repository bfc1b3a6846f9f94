// SPDX-License-Identifier: Apache-2.0
#include "serve/web/request_checks.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

#include "phalanx/serve/reach.h"

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

std::string lower_case(std::string_view text) {
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
  return lower_case(name);
}

std::set<std::string> server_names(const std::string& address) {
  std::set<std::string> names{"localhost", "127.0.0.1", "::1", address};
  if (is_loopback(address)) return names;
  for (std::string& name : machine_names()) names.insert(std::move(name));
  for (std::string& name : reachable_addresses(address)) names.insert(std::move(name));
  return names;
}

std::optional<Reply> HostCheck::refusal(std::string_view host, const std::string& local_address) const {
  const std::optional<std::string> name = host_name(host);
  if (name && (names_.contains(*name) || *name == local_address)) return std::nullopt;
  return text_reply(421,
                    "This computer does not have the name that your browser asked for. Open the page by the "
                    "address that the station printed.");
}

bool equal_secrets(std::string_view a, std::string_view b) {
  // Compares digests: they have one length, so that the time does not depend on the texts.
  std::array<unsigned char, SHA256_DIGEST_LENGTH> of_a{};
  std::array<unsigned char, SHA256_DIGEST_LENGTH> of_b{};
  SHA256(reinterpret_cast<const unsigned char*>(a.data()), a.size(), of_a.data());
  SHA256(reinterpret_cast<const unsigned char*>(b.data()), b.size(), of_b.data());
  return CRYPTO_memcmp(of_a.data(), of_b.data(), of_a.size()) == 0;
}

TokenCheck::TokenCheck(std::string operator_token, std::string viewer_token, std::uint16_t port, bool tls)
    : operator_token_(std::move(operator_token)),
      viewer_token_(std::move(viewer_token)),
      cookie_name_(fmt::format("phalanx-{}", port)),
      tls_(tls) {}

std::optional<TokenCheck::Accepted> TokenCheck::role_of(std::string_view token) const {
  // Always compares both, so that the time does not depend on which one is right.
  const bool operates = equal_secrets(token, operator_token_);
  const bool views = !viewer_token_.empty() && equal_secrets(token, viewer_token_);
  if (operates) return Accepted{true};
  if (views) return Accepted{false};
  return std::nullopt;
}

TokenCheck::Result TokenCheck::check(std::string_view query, std::string_view cookies) const {
  if (operator_token_.empty()) return Accepted{true};
  if (const auto token = value_of(query, '&', "token")) {
    const std::optional<Accepted> role = role_of(*token);
    if (!role) {
      return text_reply(
          403,
          "The token in this address is wrong or out of date. Open the address that the station "
          "printed when it started.");
    }
    return AcceptedByAddress{role->may_operate, fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}",
                                                            cookie_name_, *token, tls_ ? "; Secure" : "")};
  }
  if (const auto token = value_of(cookies, ';', cookie_name_)) {
    if (const std::optional<Accepted> role = role_of(*token)) return *role;
  }
  return text_reply(
      403,
      "This station needs a token. Open the address that it printed when it started, or scan its "
      "code. If you just did so, reload this page.");
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
  return text_reply(
      403, "This request comes from a page that is not the station's own. Open the station's own page.");
}

// ---- target, query and fields ----

namespace {

int digit_of(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = digit_of(text[i + 1]);
    const int low = digit_of(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    const char c = static_cast<char>(high * 16 + low);
    if (c == '/') return std::nullopt;
    out += c;
    i += 2;
  }
  return out;
}

/// @returns how many bytes of the character follow its first one; -1 if no character begins with this byte
int continuation(unsigned char first) noexcept {
  if (first < 0x80) return 0;
  if (first >= 0xC2 && first <= 0xDF) return 1;
  if (first >= 0xE0 && first <= 0xEF) return 2;
  if (first >= 0xF0 && first <= 0xF4) return 3;
  return -1;
}

/// @returns true if all characters have their shortest form, are no surrogates and not above U+10FFFF
bool is_utf8(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto first = static_cast<unsigned char>(text[i]);
    const int more = continuation(first);
    if (more < 0 || i + static_cast<std::size_t>(more) >= text.size()) return false;
    for (int k = 1; k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      if ((next & 0xC0U) != 0x80U) return false;
      if (k > 1) continue;
      if ((first == 0xE0 && next < 0xA0) || (first == 0xED && next > 0x9F)) return false;
      if ((first == 0xF0 && next < 0x90) || (first == 0xF4 && next > 0x8F)) return false;
    }
    i += static_cast<std::size_t>(more);
  }
  return true;
}

bool has_control_characters(std::string_view path) noexcept {
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F || c == '\\') return true;
  }
  return false;
}

bool has_ambiguous_segments(std::string_view path) noexcept {
  std::size_t begin = 1;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view segment = path.substr(begin, end - begin);
    const bool last = end == path.size();
    if (segment == "." || segment == ".." || (segment.empty() && !last)) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::optional<RequestTarget> read_target(std::string_view target) {
  if (target.empty() || target.front() != '/') return std::nullopt;
  const std::size_t mark = std::min(target.find('?'), target.size());
  std::optional<std::string> path = percent_decoded(target.substr(0, mark));
  if (!path || has_control_characters(*path) || has_ambiguous_segments(*path) || !is_utf8(*path))
    return std::nullopt;
  std::string query(mark < target.size() ? target.substr(mark + 1) : std::string_view{});
  return RequestTarget{std::move(*path), std::move(query)};
}

namespace {

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string_view name_of(std::string_view pair) noexcept { return pair.substr(0, pair.find('=')); }

/// Calls `use(pair)` for each pair until it returns true.
template <class Use>
void for_each_pair(std::string_view list, char separator, const Use& use) {
  std::size_t begin = 0;
  while (begin < list.size()) {
    const std::size_t end = std::min(list.find(separator, begin), list.size());
    if (use(trimmed(list.substr(begin, end - begin)))) return;
    begin = end + 1;
  }
}

}  // namespace

std::optional<std::string_view> value_of(std::string_view list, char separator, std::string_view name) {
  std::optional<std::string_view> found;
  for_each_pair(list, separator, [&](std::string_view pair) {
    if (name_of(pair) != name) return false;
    found = pair.size() > name.size() ? pair.substr(name.size() + 1) : std::string_view{};
    return true;
  });
  return found;
}

std::string without(std::string_view query, std::string_view name) {
  std::string rest;
  for_each_pair(query, '&', [&](std::string_view pair) {
    if (name_of(pair) == name) return false;
    if (!rest.empty()) rest += '&';
    rest += pair;
    return false;
  });
  return rest;
}

bool accepts_gzip(std::string_view field) {
  bool accepted = false;
  for_each_pair(field, ',', [&](std::string_view coding) {
    const std::size_t mark = std::min(coding.find(';'), coding.size());
    if (trimmed(coding.substr(0, mark)) != "gzip") return false;
    const std::string_view weight = trimmed(coding.substr(std::min(mark + 1, coding.size())));
    // A weight of 0 ("q=0", "q=0.0") refuses the coding.
    accepted = weight.find_first_not_of("q=0. ") != std::string_view::npos || weight.empty();
    return true;
  });
  return accepted;
}

}  // namespace phalanx::web
