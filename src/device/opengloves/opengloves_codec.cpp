// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/opengloves/opengloves_codec.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace phalanx {
namespace {

constexpr std::int32_t kTooLarge = 1000000;  // larger numbers are clamped here

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) noexcept { return c >= 'A' && c <= 'Z'; }

// Finds the index in GloveLine for a key without its parentheses; none: a key that is skipped.
std::optional<std::size_t> find_key(std::string_view key) noexcept {
  if (key.empty() || key[0] < 'A' || key[0] >= 'A' + kDigits) return std::nullopt;
  const int digit = key[0] - 'A';
  if (key.size() == 1) return glove_curl_key(digit);
  if (key.size() == 2 && key[1] == 'B') return glove_splay_key(digit);
  if (key.size() == 3 && key[1] == 'A' && key[2] >= 'A' && key[2] < 'A' + kGloveJoints)
    return glove_joint_key(digit, key[2] - 'A');
  return std::nullopt;
}

// Scanner over a line; each take_...() moves the position behind what it returns.
class Scanner {
 public:
  explicit Scanner(std::string_view text) noexcept : text_(text) {}

  [[nodiscard]] bool done() const noexcept { return at_ >= text_.size(); }
  [[nodiscard]] char peek() const noexcept { return text_[at_]; }
  void skip() noexcept { ++at_; }

  // Takes a letter, or letters in parentheses. Empty: a parenthesis does not close.
  std::string_view take_key() noexcept {
    if (peek() != '(') return text_.substr(at_++, 1);
    const std::size_t begin = ++at_;
    while (!done() && is_letter(peek())) skip();
    const std::string_view key = text_.substr(begin, at_ - begin);
    if (done() || peek() != ')') return {};
    skip();
    return key;
  }

  // Takes digits, with an optional minus.
  std::optional<std::int32_t> take_number() noexcept {
    const std::size_t begin = at_;
    const bool negative = !done() && peek() == '-';
    if (negative) skip();
    if (done() || !is_digit(peek())) {
      at_ = begin;
      return std::nullopt;
    }
    std::int32_t number = 0;
    for (; !done() && is_digit(peek()); skip()) number = std::min(10 * number + (peek() - '0'), kTooLarge);
    return negative ? -number : number;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

void store(GloveLine& line, std::size_t key, std::int32_t number) noexcept {
  if (line.has[key]) line.damaged = true;
  line.has[key] = true;
  line.value[key] = std::clamp(number, 0, kGloveWide);
  if (line.value[key] != number) ++line.clamped;
}

}  // namespace

bool GloveLine::usable() const noexcept {
  return !damaged && std::any_of(has.begin(), has.end(), [](bool there) { return there; });
}

GloveLine parse_glove_line(std::string_view text) noexcept {
  GloveLine line;
  Scanner scanner(text);
  while (!scanner.done()) {
    if (scanner.peek() != '(' && !is_letter(scanner.peek())) {
      scanner.skip();
      continue;
    }
    const std::string_view key = scanner.take_key();
    if (key.empty()) line.damaged = true;
    const auto number = scanner.take_number();
    if (!number) continue;
    line.largest = std::max(line.largest, *number);
    if (const auto place = find_key(key)) store(line, *place, *number);
  }
  return line;
}

std::size_t format_glove_answer(const GloveStops& stops, std::array<char, kGloveAnswerSize>& out) noexcept {
  char* at = out.data();
  char* const end = at + out.size();
  for (std::size_t d = 0; d < stops.size(); ++d) {
    *at++ = static_cast<char>('A' + d);
    at = std::to_chars(at, end, std::clamp(stops[d], 0, 1000)).ptr;
  }
  *at++ = '\n';
  return static_cast<std::size_t>(at - out.data());
}

}  // namespace phalanx
