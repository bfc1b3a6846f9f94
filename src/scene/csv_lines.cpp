// SPDX-License-Identifier: Apache-2.0
#include "scene/csv_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

constexpr std::size_t kMaxLine = 64U * 1024U;
constexpr std::string_view kBlank = " \t\r";

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

}  // namespace

CsvLines::CsvLines(std::string_view text, std::string origin) : rest_(text), origin_(std::move(origin)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.substr(0, 3) == kByteOrderMark) rest_.remove_prefix(3);
}

bool CsvLines::next(std::string_view& line) {
  while (!rest_.empty()) {
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    if (end > kMaxLine) {
      fail(fmt::format("the line has {} characters, more than {}; is this a CSV file with one row a line?",
                       end, kMaxLine));
    }
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.find_first_not_of(kBlank) != std::string_view::npos && !line.starts_with('#')) return true;
  }
  return false;
}

void CsvLines::fail(const std::string& problem) const {
  throw SceneError(number_ == 0 ? fmt::format("{}: {}", origin_, problem)
                                : fmt::format("{}:{}: {}", origin_, number_, problem));
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view cell = trim(line.substr(0, comma));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
      cell = trim(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> parse_number(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

std::string show_cell(std::string_view cell) {
  std::string text(cell.substr(0, 40));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return cell.size() > 40 ? text + "..." : text;
}

}  // namespace phalanx
