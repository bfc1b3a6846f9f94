// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// Reader of a text's lines, without copying. It skips a byte order mark, accepts \n and \r\n, and
/// skips blank lines and comments: lines whose first character is #.
class CsvLines {
 public:
  CsvLines(std::string_view text, std::string origin);

  /// Reads the next line that is neither blank nor a comment. @throws SceneError if it is longer than 64 KiB.
  [[nodiscard]] bool next(std::string_view& line);
  /// @returns the number of the last line read, from 1.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  /// Throws SceneError "FILE:LINE: PROBLEM".
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string_view rest_;
  std::string origin_;
  std::size_t number_ = 0;
};

/// Splits a line into cells, without the blanks around them and the quotes of a quoted header.
/// `cells` is reused.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// Parses a whole cell as a number ("1", "-2.5e-3", "nan"). @returns nothing if it is not one
[[nodiscard]] std::optional<double> parse_number(std::string_view cell);

/// @returns a cell for a message, shortened, without control characters.
[[nodiscard]] std::string show_cell(std::string_view cell);

}  // namespace phalanx
