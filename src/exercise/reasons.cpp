// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/reasons.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace phalanx {
namespace {

/// Words of a format between its placeholders, and which of these are numbers.
struct ReasonPattern {
  std::vector<std::string_view> words = {};  ///< one more than placeholders
  std::vector<bool> number = {};
};

ReasonPattern pattern_of(std::string_view format) {
  ReasonPattern pattern;
  for (std::size_t open = format.find('{'); open != std::string_view::npos; open = format.find('{')) {
    const std::size_t close = format.find('}', open);
    pattern.words.push_back(format.substr(0, open));
    pattern.number.push_back(close > open + 1);
    format.remove_prefix(close + 1);
  }
  pattern.words.push_back(format);
  return pattern;
}

bool is_number_text(std::string_view text) {
  return !text.empty() && text.find_first_not_of("+-.0123456789") == std::string_view::npos &&
         text.find_first_of("0123456789") != std::string_view::npos &&
         std::count(text.begin(), text.end(), '.') <= 1;
}

/// @returns the texts at the placeholders, each as short as possible; nothing if the text is not of the format
std::optional<std::vector<std::string_view>> captured(const ReasonPattern& pattern, std::string_view text) {
  if (!text.starts_with(pattern.words.front())) return std::nullopt;
  text.remove_prefix(pattern.words.front().size());
  std::vector<std::string_view> found;
  for (std::size_t i = 0; i < pattern.number.size(); ++i) {
    const std::string_view next = pattern.words[i + 1];
    const bool last = i + 1 == pattern.number.size();
    if (last && !text.ends_with(next)) return std::nullopt;
    const std::size_t end = last ? text.size() - next.size() : text.find(next);
    if (end == std::string_view::npos) return std::nullopt;
    found.push_back(text.substr(0, end));
    if (pattern.number[i] && !is_number_text(found.back())) return std::nullopt;
    text.remove_prefix(end + next.size());
  }
  if (!text.empty()) return std::nullopt;
  return found;
}

std::string german_part(std::string_view text, const ReasonWord& word) {
  if (is_number_text(text)) {
    std::string number(text);
    std::replace(number.begin(), number.end(), '.', ',');
    return number;
  }
  std::string reason = german_reason(text, word);
  return reason.empty() ? word(text) : reason;
}

/// @returns the text with {0}, {1}, ... replaced
std::string filled(std::string_view format, const std::vector<std::string>& parts) {
  std::string out;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '{') {
      out.push_back(format[i]);
      continue;
    }
    out.append(parts.at(static_cast<std::size_t>(format[i + 1] - '0')));
    i += 2;
  }
  return out;
}

/// Reason of a text, and what stands at its placeholders.
struct FoundReason {
  std::size_t index = 0;
  std::vector<std::string_view> parts = {};
};

std::optional<FoundReason> find_with_parts(std::string_view english) {
  static const std::vector<ReasonPattern> kPatterns = [] {
    std::vector<ReasonPattern> patterns;
    for (const ReasonWords& each : kReasons) patterns.push_back(pattern_of(each.english));
    return patterns;
  }();
  for (std::size_t i = 0; i < kPatterns.size(); ++i)
    if (auto parts = captured(kPatterns[i], english)) return FoundReason{i, std::move(*parts)};
  return std::nullopt;
}

/// @returns the German text of one reason; empty if it is not in the table
std::string german_single(std::string_view english, const ReasonWord& word) {
  const auto found = find_with_parts(english);
  if (!found) return {};
  std::vector<std::string> parts;
  for (const std::string_view part : found->parts) parts.push_back(german_part(part, word));
  return filled(kReasons[found->index].german, parts);
}

}  // namespace

std::optional<Reason> find_reason(std::string_view english) {
  const auto found = find_with_parts(english);
  return found ? std::optional(kReasons[found->index].reason) : std::nullopt;
}

std::vector<Reason> find_reasons(std::string_view english) {
  if (const auto whole = find_reason(english)) return {*whole};
  for (std::size_t at = english.find("; "); at != std::string_view::npos; at = english.find("; ", at + 1)) {
    const auto first = find_reason(english.substr(0, at));
    if (!first) continue;
    std::vector<Reason> all = find_reasons(english.substr(at + 2));
    if (all.empty()) continue;
    all.insert(all.begin(), *first);
    return all;
  }
  return {};
}

std::string german_reason(std::string_view english, const ReasonWord& word) {
  if (std::string whole = german_single(english, word); !whole.empty()) return whole;
  for (std::size_t at = english.find("; "); at != std::string_view::npos; at = english.find("; ", at + 1)) {
    std::string first = german_single(english.substr(0, at), word);
    if (first.empty()) continue;
    const std::string rest = german_reason(english.substr(at + 2), word);
    if (!rest.empty()) return first.append("; ").append(rest);
  }
  return {};
}

}  // namespace phalanx
