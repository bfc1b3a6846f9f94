// SPDX-License-Identifier: Apache-2.0
// Pieces of a HTML page that is also well-formed XML, so that one check serves both.
#pragma once

#include <string>
#include <vector>

#include "phalanx/record/made.h"

namespace phalanx {

class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title);

  void heading(const std::string& text);     ///< of a chapter
  void subheading(const std::string& text);  ///< within a chapter
  void paragraph(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// A coloured box; nothing without items.
  void warnings(const std::vector<std::string>& items);
  /// Columns that hold nothing but numbers are aligned to the right and not broken. Short rows are filled up.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Figures beside each other as far as the page is wide, below them the caption. Whole SVG documents: their
  /// ids are made unique in the page. Nothing without figures.
  void figures(const std::vector<std::string>& svgs, const std::string& caption);
  /// Commit, CPU, compiler, build type, date and, unless empty, the seeds.
  void made(const Made& made, const std::string& seeds);

  [[nodiscard]] std::string document() const;

 private:
  std::string title_;
  std::string body_;
  int figures_ = 0;
};

}  // namespace phalanx
