// SPDX-License-Identifier: Apache-2.0
#include "figures/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/xml_text.h"

namespace phalanx {
namespace {

constexpr const char* kStyle = R"css(
body { max-width: 184mm; margin: 8mm auto; padding: 0 4mm; font: 10.5pt/1.45 Helvetica, Arial, "DejaVu Sans", sans-serif; color: #111; background: #FFF; }
h1 { font-size: 18pt; line-height: 1.2; margin: 0 0 3mm; }
h2 { font-size: 13.5pt; margin: 9mm 0 2mm; border-bottom: 0.3mm solid #BBB; break-after: avoid; }
h3 { font-size: 11pt; margin: 5mm 0 1mm; break-after: avoid; }
p { margin: 1.5mm 0; }
ul { margin: 1.5mm 0; padding-left: 6mm; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 8pt; line-height: 1.3; margin: 2mm 0; }
thead { display: table-header-group; }
tr { break-inside: avoid; }
th, td { padding: 0.6mm 1.2mm; text-align: left; vertical-align: top; border-bottom: 0.2mm solid #DDD; }
th { vertical-align: bottom; border-bottom: 0.4mm solid #555; }
td:first-child { min-width: 24mm; }
.n { text-align: right; font-variant-numeric: tabular-nums; }
td.n { white-space: nowrap; }
.warnings { border-left: 1.2mm solid #D55E00; background: #FDF3EC; padding: 1mm 3mm; margin: 3mm 0; }
figure { margin: 3mm 0; }
.row { display: flex; flex-wrap: wrap; gap: 3mm; align-items: flex-start; }
.row > svg { max-width: 100%; height: auto; break-inside: avoid; }
figcaption { font-size: 9pt; color: #444; margin-top: 1mm; }
.made { font-size: 9pt; color: #333; }
@page { margin: 12mm; }
@media print { body { margin: 0; padding: 0; max-width: none; } .wide { overflow: visible; } }
)css";

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// @returns true if a cell is a number, a missing one, or a number with words in brackets.
bool is_number(const std::string& text) {
  for (const char* sign : {"\u2212", "\u2265 ", "\u2265", "\u2013", "< ", "+", "-"}) {
    if (text.starts_with(sign)) return true;
  }
  return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

bool all_numbers(const std::vector<std::vector<std::string>>& rows, std::size_t column) {
  constexpr std::size_t kLongest = 24;
  bool any = false;
  for (const std::vector<std::string>& cells : rows) {
    if (column >= cells.size() || cells[column].empty()) continue;
    if (!is_number(cells[column]) || cells[column].size() > kLongest) return false;
    any = true;
  }
  return any;
}

/// @returns the SVG without its XML declaration, which is not allowed within a page. Quotes in text are
/// escaped, so that the patterns match attributes only.
std::string embedded(const std::string& svg, int number) {
  const std::size_t begin = svg.find("<svg");
  std::string result = begin == std::string::npos ? "" : svg.substr(begin);
  replace_all(result, " id=\"", fmt::format(" id=\"f{}-", number));
  replace_all(result, "=\"url(#", fmt::format("=\"url(#f{}-", number));
  return result;
}

}  // namespace

HtmlPage::HtmlPage(const std::string& title) : title_(xml_escaped(title)) {
  body_ = fmt::format("<h1>{}</h1>\n", title_);
}

void HtmlPage::heading(const std::string& text) { body_ += fmt::format("<h2>{}</h2>\n", xml_escaped(text)); }
void HtmlPage::subheading(const std::string& text) {
  body_ += fmt::format("<h3>{}</h3>\n", xml_escaped(text));
}
void HtmlPage::paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", xml_escaped(text)); }

void HtmlPage::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", xml_escaped(item));
  body_ += "</ul>\n";
}

void HtmlPage::warnings(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<div class=\"warnings\"><p><strong>To note</strong></p>\n";
  list(items);
  body_ += "</div>\n";
}

void HtmlPage::table(const std::vector<std::string>& header,
                     const std::vector<std::vector<std::string>>& rows) {
  std::size_t columns = header.size();
  for (const auto& cells : rows) columns = std::max(columns, cells.size());
  std::vector<const char*> look(columns);
  for (std::size_t i = 0; i < columns; ++i) look[i] = all_numbers(rows, i) ? " class=\"n\"" : "";
  const auto row = [&](const std::vector<std::string>& cells, const char* element) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < columns; ++i)
      body_ +=
          fmt::format("<{0}{1}>{2}</{0}>", element, look[i], i < cells.size() ? xml_escaped(cells[i]) : "");
    body_ += "</tr>\n";
  };
  body_ += "<div class=\"wide\"><table>\n";
  if (!header.empty()) {
    body_ += "<thead>\n";
    row(header, "th");
    body_ += "</thead>\n";
  }
  body_ += "<tbody>\n";
  for (const std::vector<std::string>& cells : rows) row(cells, "td");
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlPage::figures(const std::vector<std::string>& svgs, const std::string& caption) {
  if (svgs.empty()) return;
  body_ += "<figure><div class=\"row\">\n";
  for (const std::string& svg : svgs) body_ += embedded(svg, ++figures_);
  body_ += "</div>\n";
  if (!caption.empty()) body_ += fmt::format("<figcaption>{}</figcaption>\n", xml_escaped(caption));
  body_ += "</figure>\n";
}

void HtmlPage::made(const Made& made, const std::string& seeds) {
  std::vector<std::vector<std::string>> rows = {{"commit", made.commit},
                                                {"CPU", made.cpu},
                                                {"compiler", made.compiler},
                                                {"build type", made.build_type},
                                                {"date (UTC)", made.date}};
  if (!seeds.empty()) rows.push_back({"seeds", seeds});
  heading("Where this was made");
  table({}, rows);
}

std::string HtmlPage::document() const {
  const std::string reload =
      reload_s_ > 0 ? fmt::format("<meta http-equiv=\"refresh\" content=\"{}\"/>\n", reload_s_) : "";
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n"
      "{}<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      title_, reload, kStyle, body_);
}

}  // namespace phalanx
