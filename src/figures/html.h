// SPDX-License-Identifier: Apache-2.0
// Parts of an HTML page that is also well-formed XML, so that one check covers both.
#pragma once

#include <string>
#include <vector>

#include "phalanx/record/made.h"

namespace phalanx {

/// An HTML page that is built from top to bottom.
class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title);

  void heading(const std::string& text);     ///< heading of a chapter
  void subheading(const std::string& text);  ///< heading within a chapter
  void paragraph(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// Adds a coloured box; without items, nothing.
  void warnings(const std::vector<std::string>& items);
  /// Adds a table. Columns of numbers only are aligned to the right and not broken. Short rows are filled up.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Adds figures beside each other as far as the page is wide, and the caption below them. They are whole
  /// SVG documents, whose ids are made unique in the page. Without figures, it adds nothing.
  void figures(const std::vector<std::string>& svgs, const std::string& caption);
  /// Adds commit, CPU, compiler, build type, date and, unless empty, the seeds.
  void made(const Made& made, const std::string& seeds);

  /// Makes the browser load the page again after so many seconds.
  void reload_every(int seconds) { reload_s_ = seconds; }

  [[nodiscard]] std::string document() const;

 private:
  std::string title_;
  std::string body_;
  int figures_ = 0;
  int reload_s_ = 0;  ///< 0: never
};

}  // namespace phalanx
