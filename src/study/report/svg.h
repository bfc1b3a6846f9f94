// SPDX-License-Identifier: Apache-2.0
// An SVG document in the making. Lengths in points (1/72 inch), text 8 points high.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace phalanx {

inline constexpr double kPointsPerMm = 72.0 / 25.4;

/// The width of `text` at 8 points, a little generously, since the font is not known here [pt].
[[nodiscard]] double text_width(const std::string& text);
/// `text`, cut with an ellipsis to what fits into `width`.
[[nodiscard]] std::string cut_to(const std::string& text, double width);
/// `text` in lines no wider than `width`, broken at spaces if possible; the last of at most `most` lines is
/// cut.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, double width, std::size_t most);
/// Three significant digits for people to read, without an exponent where that is short: "1.6", "0.0125",
/// "1250"; a real minus sign; an en dash for what is not finite.
[[nodiscard]] std::string number_text(double value);

enum class Anchor { kStart, kMiddle, kEnd };

class Svg {
 public:
  explicit Svg(double width) : width_(width) {}

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    body_ += fmt::format(format, std::forward<Args>(args)...);
    body_ += '\n';
  }

  /// Escapes `text`. @param more  further attributes, with a space before each: ` fill="#444"`
  void text(double x, double y, const std::string& text, Anchor anchor = Anchor::kStart,
            const std::string& more = "");
  /// The same, turned a quarter to the left.
  void text_upwards(double x, double y, const std::string& text, Anchor anchor = Anchor::kMiddle);
  /// Bold, on top of the page. @returns its height, 0 if both are empty
  double heading(const std::string& title, const std::string& subtitle);
  /// Definition of the hatching that stands for "no value"; used as `fill="url(#hatch)"`.
  void define_hatch();

  /// @param title  for readers who cannot see it
  [[nodiscard]] std::string document(double height, const std::string& title) const;

 private:
  double width_;
  std::string body_;
};

}  // namespace phalanx
