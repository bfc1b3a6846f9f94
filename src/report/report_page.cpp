// SPDX-License-Identifier: Apache-2.0
#include "report/report_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/xml_text.h"

namespace phalanx::report {
namespace {

std::string class_attribute(const char* css_class) {
  return *css_class == '\0' ? std::string() : fmt::format(R"( class="{}")", css_class);
}

/// @returns escaped text, with its line breaks
std::string with_breaks(const std::string& text) {
  std::string html;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (begin > 0) html.append("<br/>");
    html.append(xml_escaped(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return html;
}

}  // namespace

std::string data_attributes(const std::vector<std::pair<const char*, std::string>>& pairs) {
  std::string text;
  for (const auto& [name, value] : pairs)
    text.append(fmt::format(R"( data-{}="{}")", name, xml_escaped(value)));
  return text;
}

void ReportPage::element(const char* name, const std::string& text, const char* css_class) {
  body_.append(fmt::format("<{0}{1}>{2}</{0}>\n", name, class_attribute(css_class), with_breaks(text)));
}

void ReportPage::list(const std::vector<std::string>& items, const char* css_class) {
  if (items.empty()) return;
  body_.append(fmt::format("<ul{}>\n", class_attribute(css_class)));
  for (const std::string& item : items) element("li", item);
  body_.append("</ul>\n");
}

void ReportPage::table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows,
                       const char* css_class) {
  if (rows.empty()) return;
  body_.append(fmt::format(R"(<div class="wide"><table{}><thead><tr>)", class_attribute(css_class)));
  for (std::size_t i = 0; i < header.size(); ++i) {
    const bool number = i < rows[0].size() && rows[0][i].number;
    body_.append(fmt::format("<th{}>{}</th>", number ? " class=\"n\"" : "", xml_escaped(header[i])));
  }
  body_.append("</tr></thead>\n<tbody>\n");
  for (const std::vector<Cell>& row : rows) {
    body_.append("<tr>");
    for (const Cell& cell : row)
      body_.append(fmt::format("<td{}{}>{}</td>", cell.number ? " class=\"n\"" : "", cell.data,
                               with_breaks(cell.text)));
    body_.append("</tr>\n");
  }
  body_.append("</tbody></table></div>\n");
}

void ReportPage::definitions(const std::vector<Definition>& all) {
  if (all.empty()) return;
  body_.append("<dl>\n");
  for (const Definition& each : all) {
    std::vector<std::string> parts;
    for (const Cell& part : each.parts)
      parts.push_back(part.data.empty()
                          ? with_breaks(part.text)
                          : fmt::format("<span{}>{}</span>", part.data, with_breaks(part.text)));
    body_.append(fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_escaped(each.name), fmt::join(parts, ", ")));
  }
  body_.append("</dl>\n");
}

std::string ReportPage::document(const char* language, const std::string& title,
                                 const std::string& running) const {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
      "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"referrer\" content=\"no-referrer\"/>\n<title>{}</title>\n<style>{}</style>\n</head>\n"
      "<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      language, xml_escaped(title), report_style(running), body_);
}

}  // namespace phalanx::report
