// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// The lines of a text one after another, without copying; skips a byte order mark, accepts \n and \r\n,
/// passes over blank lines.
class CsvLines {
 public:
  CsvLines(std::string_view text, std::string origin);

  /// The next line that is not blank. @throws SceneError if it is longer than 64 KiB.
  [[nodiscard]] bool next(std::string_view& line);
  /// Number of the line that next() gave, from 1.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  /// @throws SceneError "FILE:LINE: PROBLEM".
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string_view rest_;
  std::string origin_;
  std::size_t number_ = 0;
};

/// The cells of a line, without the blanks around them and the quotes of a quoted header. `cells` is reused.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// A whole cell as a number ("1", "-2.5e-3", "nan"); nothing if it is none.
[[nodiscard]] std::optional<double> parse_number(std::string_view cell);

/// A cell for a message, shortened, without control characters.
[[nodiscard]] std::string show_cell(std::string_view cell);

}  // namespace phalanx
