// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/obj_reduce.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace phalanx::mesh {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Returns the next word of `rest` and advances `rest` past it. Returns an empty string at the end.
std::string_view next_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

/// Returns a word for use in a message: short and printable.
std::string quoted(std::string_view word) {
  std::string out = "'";
  for (const char c : word.substr(0, 40)) out += c >= 0x20 && c < 0x7f ? c : '?';
  return out + (word.size() > 40 ? "...'" : "'");
}

class ObjReducer {
 public:
  explicit ObjReducer(std::string_view origin) : origin_(origin) {}

  void line(std::string_view text, std::int64_t number) {
    line_ = number;
    text = text.substr(0, text.find('#'));
    const std::string_view keyword = next_word(text);
    if (keyword == "v") position(text);
    if (keyword == "f") face(text);
  }

  ReducedObj take() {
    if (polygons_ == 0)
      throw std::invalid_argument(
          std::string(origin_) + ": no triangle in " + std::to_string(line_) +
          " lines; check that it is a .obj file and export a surface, not points or lines");
    const auto used = static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
    return {std::move(out_), used_.size() - used};
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(std::string(origin_) + ": line " + std::to_string(line_) + ": " + what);
  }

  [[noreturn]] void no_such_vertex(const std::string& index) const {
    refuse("the face names vertex " + index + ", but the file has " + std::to_string(positions_) +
           " up to here; repair the mesh or export it again");
  }

  void position(std::string_view rest) {
    out_ += 'v';
    for (int i = 0; i < 3; ++i) {
      std::string_view word = next_word(rest);
      const std::string_view whole = word;
      if (word.empty()) refuse("the vertex has " + std::to_string(i) + " coordinates; give 3");
      if (word.starts_with('+')) word.remove_prefix(1);
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      // A value out of range is either so small that it is 0, or so large that Assimp makes it infinite.
      if (error == std::errc::invalid_argument || end != word.data() + word.size())
        refuse("the coordinate " + quoted(whole) + " is not a number; repair the mesh or export it again");
      if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        refuse("the coordinate " + quoted(whole) + " is not finite; repair the mesh or export it again");
      // Assimp does not accept a number that starts with a point.
      if (whole.starts_with('.')) {
        out_.append(" 0").append(whole);
      } else if (whole.starts_with("-.") || whole.starts_with("+.")) {
        out_.append(" ").append(whole.substr(0, 1)).append("0").append(whole.substr(1));
      } else {
        out_.append(" ").append(whole);
      }
    }
    // A single fourth number is a weight, which divides; three further numbers are a colour.
    const std::string_view weight = next_word(rest);
    if (!weight.empty() && next_word(rest).empty()) out_.append(" ").append(weight);
    out_ += '\n';
    ++positions_;
    used_.push_back(false);
  }

  void face(std::string_view rest) {
    std::string polygon = "f";
    int corners = 0;
    named_.clear();
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::string_view digits = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
      if (error != std::errc{} || end != digits.data() + digits.size())
        refuse("the face's corner " + quoted(word) +
               " does not start with a vertex number; export the mesh again");
      // Assimp also accepts only vertices defined before the face.
      if (index == 0 || index < -positions_ || index > positions_) no_such_vertex(std::to_string(index));
      const std::int64_t number = index > 0 ? index : positions_ + 1 + index;
      polygon.append(" ").append(std::to_string(number));
      named_.push_back(static_cast<std::size_t>(number - 1));
      ++corners;
    }
    if (corners < 3) return;
    out_.append(polygon).append("\n");
    for (const std::size_t i : named_) used_[i] = true;
    ++polygons_;
  }

  std::string_view origin_;
  std::int64_t line_ = 0;
  std::int64_t positions_ = 0;
  std::int64_t polygons_ = 0;
  std::string out_;
  std::vector<bool> used_;          ///< per position: used by a face
  std::vector<std::size_t> named_;  ///< positions of the current face
};

}  // namespace

ReducedObj reduce_obj(std::string_view text, std::string_view origin) {
  if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE"))
    throw std::invalid_argument(std::string(origin) + ": the file is UTF-16 text; save it as UTF-8 or ASCII");
  ObjReducer reducer(origin);
  std::int64_t number = 0;
  std::string joined;  // joined lines that end with a backslash
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    if (line.ends_with('\\')) {
      line.remove_suffix(1);
      joined.append(line).append(" ");
      continue;
    }
    if (joined.empty()) {
      reducer.line(line, number);
    } else {
      reducer.line(joined.append(line), number);
      joined.clear();
    }
  }
  if (!joined.empty()) reducer.line(joined, number);
  return reducer.take();
}

std::size_t count_obj_positions(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (next_word(line) == "v") ++count;
  }
  return count;
}

}  // namespace phalanx::mesh
