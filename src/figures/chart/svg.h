// SPDX-License-Identifier: Apache-2.0
// Builder of an SVG document. Lengths are in points (1/72 inch); text is 8 points high.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace phalanx {

inline constexpr double kPointsPerMm = 72.0 / 25.4;

/// @returns the width of `text` at 8 points, estimated a little too large, since the font is
/// unknown here [pt].
[[nodiscard]] double text_width(const std::string& text);
/// @returns the width of the widest of `texts` at 8 points [pt]; 0 if there is none.
[[nodiscard]] double text_width(const std::vector<std::string>& texts);
/// @returns `text`, cut with an ellipsis to fit into `width`.
[[nodiscard]] std::string cut_to(const std::string& text, double width);
/// @returns `text` in lines no wider than `width`, broken at spaces if possible. The last of at most `most`
/// lines is cut.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, double width, std::size_t most);
/// @returns three significant digits for readers, without an exponent if that is short: "1.6", "0.0125",
/// "1250". It has a real minus sign, and an en dash for a number that is not finite.
[[nodiscard]] std::string number_text(double value);

enum class Anchor { kStart, kMiddle, kEnd };

/// An SVG document.
class Svg {
 public:
  explicit Svg(double width) : width_(width) {}

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    body_ += fmt::format(format, std::forward<Args>(args)...);
    body_ += '\n';
  }

  /// Adds text, escaped. @param more  further attributes, with a space before each: ` fill="#444"`
  void text(double x, double y, const std::string& text, Anchor anchor = Anchor::kStart,
            const std::string& more = "");
  /// Adds text, turned a quarter to the left.
  void text_upwards(double x, double y, const std::string& text, Anchor anchor = Anchor::kMiddle);
  /// Adds a bold title at the top of the page, and the lines below it. Empty ones have no height.
  /// @returns the height of all, 0 if there is none
  double heading(const std::string& title, const std::vector<std::string>& subtitles = {});
  /// Defines the hatching for "no value"; used as `fill="url(#hatch)"`.
  void define_hatch();

  /// @returns the document. @param title  for readers who cannot see it
  [[nodiscard]] std::string document(double height, const std::string& title) const;

 private:
  double width_;
  std::string body_;
};

}  // namespace phalanx
