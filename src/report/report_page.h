// SPDX-License-Identifier: Apache-2.0
// Builder of a report's HTML. All text is escaped; the page is also well-formed XML.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace phalanx::report {

/// Cell of a table.
struct Cell {
  std::string text = {};
  std::string data = {};  ///< attributes, as data_attributes() makes them
  bool number = false;    ///< aligned to the right
};

/// Value or values beside a name.
struct Definition {
  std::string name = {};
  std::vector<Cell> parts = {};  ///< parted by commas
};

/// @returns ` data-score="..." data-value="..."` of pairs without "data-"; values are escaped
[[nodiscard]] std::string data_attributes(const std::vector<std::pair<const char*, std::string>>& pairs);

/// An HTML page that is built from top to bottom.
class ReportPage {
 public:
  void raw(const std::string& html) { body_.append(html).append("\n"); }
  void element(const char* name, const std::string& text, const char* css_class = "");
  void heading(const std::string& text) { element("h2", text); }
  void subheading(const std::string& text) { element("h3", text); }
  void paragraph(const std::string& text, const char* css_class = "") { element("p", text, css_class); }
  void list(const std::vector<std::string>& items, const char* css_class = "");
  /// Adds a table; the header repeats on each printed page. @param css_class  of the table
  void table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows,
             const char* css_class = "");
  /// Adds names with values beside them. Without any, nothing.
  void definitions(const std::vector<Definition>& all);

  /// @returns the document. @param running  text at the foot of each printed page, beside its number
  [[nodiscard]] std::string document(const char* language, const std::string& title,
                                     const std::string& running) const;

 private:
  std::string body_;
};

/// @returns the style sheet; `running` is the text at the foot of each printed page
[[nodiscard]] std::string report_style(const std::string& running);

}  // namespace phalanx::report
