// SPDX-License-Identifier: Apache-2.0
#include "serve/web/request_path.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace phalanx::web {
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

/// How many bytes follow the first one of a character; -1: none begins so.
int continuation(unsigned char first) noexcept {
  if (first < 0x80) return 0;
  if (first >= 0xC2 && first <= 0xDF) return 1;
  if (first >= 0xE0 && first <= 0xEF) return 2;
  if (first >= 0xF0 && first <= 0xF4) return 3;
  return -1;
}

/// Shortest forms only, no surrogates, nothing above U+10FFFF.
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

bool has_odd_characters(std::string_view path) noexcept {
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F || c == '\\') return true;
  }
  return false;
}

bool has_odd_segments(std::string_view path) noexcept {
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
  if (!path || has_odd_characters(*path) || has_odd_segments(*path) || !is_utf8(*path)) return std::nullopt;
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

/// Calls `use(pair)` for each until it says true.
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
    // "q=0", "q=0.0": not at any price.
    accepted = weight.find_first_not_of("q=0. ") != std::string_view::npos || weight.empty();
    return true;
  });
  return accepted;
}

}  // namespace phalanx::web
