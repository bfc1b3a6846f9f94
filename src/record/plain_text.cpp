// SPDX-License-Identifier: Apache-2.0
#include "record/plain_text.h"

namespace phalanx {
namespace {

constexpr std::string_view kInvalid = "\xEF\xBF\xBD";

unsigned at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Character of UTF-8 (RFC 3629).
struct Character {
  std::size_t length = 0;  ///< [bytes]; 0: no character begins here
  unsigned code = 0;
};

Character character_at(std::string_view text, std::size_t i) {
  const unsigned first = at(text, i);
  if (first < 0x80U) return {.length = 1, .code = first};
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || i + length > text.size()) return {};
  unsigned code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    const unsigned next = at(text, i + k);
    if ((next & 0xC0U) != 0x80U) return {};
    code = (code << 6U) | (next & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800U) || (length == 4 && code < 0x10000U);
  const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
  return overlong || surrogate || code > 0x10FFFFU ? Character{} : Character{.length = length, .code = code};
}

bool belongs_in_a_name(unsigned code) {
  const bool control = code < 0x20U || (code >= 0x7FU && code < 0xA0U);
  const bool direction = code == 0x061CU || code == 0x200EU || code == 0x200FU ||
                         (code >= 0x202AU && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U);
  const bool line = code == 0x2028U || code == 0x2029U;
  return !control && !direction && !line;
}

template <class Keep>
std::string filtered(std::string_view text, Keep&& keep) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    if (c.length == 0) {
      out += kInvalid;
      ++i;
      continue;
    }
    if (keep(c.code)) out += text.substr(i, c.length);
    i += c.length;
  }
  return out;
}

}  // namespace

std::string as_utf8(std::string_view text) {
  return filtered(text, [](unsigned) { return true; });
}

std::string one_line(std::string_view text) { return filtered(text, belongs_in_a_name); }

std::string shortened(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  std::size_t end = bytes - 3;
  while (end > 0 && (at(text, end) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  return text + "...";
}

std::string without_folder(std::string text, const std::filesystem::path& folder) {
  for (const std::string& written : {(folder / "").string(), (folder / "").lexically_normal().string()}) {
    for (auto at = text.find(written); at != std::string::npos; at = text.find(written, at))
      text.erase(at, written.size());
  }
  return text;
}

std::string without_option(std::string refusal) {
  constexpr std::string_view kOption = "--set ";
  if (refusal.starts_with(kOption)) refusal.erase(0, kOption.size());
  return refusal;
}

}  // namespace phalanx
