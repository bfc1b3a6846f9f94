// SPDX-License-Identifier: Apache-2.0
// Suggestions ("did you mean ...?") for messages about unknown names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// Returns the Levenshtein distance: the least number of inserted, deleted and replaced characters that turns
/// `a` into `b`. Set-up only.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above + 1, row[j - 1] + 1, replaced});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// Returns how far a known name is from the written one. Set-up only. It is the smallest of
/// - the edit distance;
/// - 1 + the distance to the known name's beginning of the same length as `written`, which finds
///   "torque_rate_nm_per_s" for "torque_rate";
/// - 1 + the smaller of these two for the part of the known name after its last dot.
[[nodiscard]] inline std::size_t name_distance(std::string_view written, std::string_view known) {
  const auto with_beginning = [&](std::string_view name) {
    return std::min(edit_distance(written, name), 1 + edit_distance(written, name.substr(0, written.size())));
  };
  const std::size_t whole = with_beginning(known);
  const std::size_t dot = known.rfind('.');
  return dot == std::string_view::npos ? whole : std::min(whole, 1 + with_beginning(known.substr(dot + 1)));
}

/// Returns the member of `known` with the smallest name_distance() to `name`: the first of several, or an
/// empty string if `known` is empty. Only the first 200 characters of `name` are compared, which bounds the
/// time for hostile input. Set-up only.
template <typename Names>
[[nodiscard]] std::string nearest_name(std::string_view name, const Names& known) {
  std::string best;
  std::size_t best_distance = static_cast<std::size_t>(-1);
  for (const auto& candidate : known) {
    const std::size_t distance = name_distance(name.substr(0, 200), std::string_view(candidate));
    if (distance < best_distance) {
      best_distance = distance;
      best = std::string(candidate);
    }
  }
  return best;
}

/// Returns nearest_name(), or an empty string if its distance exceeds half the length of `name`: such a
/// suggestion would mislead. Set-up only.
template <typename Names>
[[nodiscard]] std::string near_name(std::string_view name, const Names& known) {
  std::string best = nearest_name(name, known);
  if (2 * name_distance(name.substr(0, 200), best) > name.size()) best.clear();
  return best;
}

/// Returns a suggestion such as `did you mean "wave"? ` with a trailing blank, to be followed by more text.
/// Returns an empty string if no name is near. Set-up only.
template <typename Names>
[[nodiscard]] std::string did_you_mean(std::string_view name, const Names& known) {
  const std::string near = near_name(name, known);
  return near.empty() ? near : "did you mean \"" + near + "\"? ";
}

}  // namespace phalanx
