// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace phalanx::web {

struct RequestTarget {
  std::string path;   ///< decoded, begins with '/', no segment is empty (but the last), "." or ".."
  std::string query;  ///< behind '?', as it came
};

/// The target of a request line. @returns none for anything that could be read in two ways: not beginning
/// with
/// '/', "//", ".", "..", '\', encoded '/' or '\', control characters, '%' without two digits, broken UTF-8.
[[nodiscard]] std::optional<RequestTarget> read_target(std::string_view target);

/// The value of a name in a query or (with ';') in a Cookie field. Not decoded. @returns none: not there
[[nodiscard]] std::optional<std::string_view> value_of(std::string_view list, char separator,
                                                       std::string_view name);
/// The query without the pairs of that name.
[[nodiscard]] std::string without(std::string_view query, std::string_view name);
/// Whether an Accept-Encoding field takes gzip.
[[nodiscard]] bool accepts_gzip(std::string_view field);

}  // namespace phalanx::web
