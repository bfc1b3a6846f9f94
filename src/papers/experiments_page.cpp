// SPDX-License-Identifier: Apache-2.0
#include "phalanx/papers/experiments.h"

#include "figures/html.h"

namespace phalanx {
namespace {

std::string or_else(const std::string& text, const char* other) { return text.empty() ? other : text; }

void add_rows(HtmlPage& page, const std::vector<PaperRow>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const PaperRow& row : rows) {
    cells.push_back({row.experiment, row.quantity, or_else(row.paper, "not printed"),
                     or_else(row.ours, "not run"), row.unit, row.difference, row_kind_name(row.kind),
                     row.note});
  }
  page.heading("The papers' numbers and ours");
  page.paragraph(
      "Fitted: a parameter was chosen so that this number agrees, and agreement proves nothing. Predicted: "
      "computed with "
      "all parameters frozen, then compared. Measured: a property of the program itself, such as a time.");
  if (cells.empty()) {
    page.paragraph("No number was compared.");
    return;
  }
  page.table({"experiment", "quantity", "paper", "ours", "unit", "difference", "kind", "note"}, cells);
}

void add_section(HtmlPage& page, const ReportSection& section) {
  page.heading(section.title);
  for (const std::string& paragraph : section.text) page.paragraph(paragraph);
  page.figures(section.svg, "");
  if (!section.table.header.empty() || !section.table.rows.empty())
    page.table(section.table.header, section.table.rows);
}

}  // namespace

const char* row_kind_name(RowKind kind) noexcept {
  switch (kind) {
    case RowKind::kFitted:
      return "fitted";
    case RowKind::kPredicted:
      return "predicted";
    case RowKind::kMeasured:
      return "measured";
  }
  return "";
}

std::string experiments_html(const std::vector<PaperRow>& rows, const std::vector<ReportSection>& sections,
                             const Made& made, const std::string& seeds) {
  HtmlPage page("Phalanx: the papers' experiments");
  add_rows(page, rows);
  for (const ReportSection& section : sections) add_section(page, section);
  page.made(made, seeds);
  return page.document();
}

}  // namespace phalanx
