// SPDX-License-Identifier: Apache-2.0
// The style sheet of a report: one column on the screen, A4 on paper.
#include "report/report_page.h"

namespace phalanx::report {
namespace {

constexpr const char* kStyleSheet = R"css(
:root { --ink: #17222b; --soft: #55636d; --line: #d5dce1; --blue: #0b5d8f; --wash: #f4f7f9; }
* { box-sizing: border-box; }
html { background: #e9eef1; }
body { margin: 0; font: 10.5pt/1.45 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; color: var(--ink); -webkit-print-color-adjust: exact; print-color-adjust: exact; }
main { max-width: 200mm; margin: 8mm auto; padding: 12mm 10mm; background: #fff; border-radius: 2mm; box-shadow: 0 1mm 6mm rgba(20, 40, 60, 0.14); }
header { display: flex; justify-content: space-between; gap: 8mm; align-items: flex-end; border-bottom: 0.6mm solid var(--blue); padding-bottom: 3mm; }
header .kind { margin: 0; color: var(--blue); font-weight: 600; letter-spacing: 0.03em; }
h1 { margin: 0; font-size: 25pt; line-height: 1.15; }
h1 small { font-size: 12pt; font-weight: 400; color: var(--soft); margin-left: 2mm; }
header .made { text-align: right; font-size: 8.5pt; color: var(--soft); line-height: 1.5; overflow-wrap: anywhere; }
h2 { font-size: 14pt; margin: 9mm 0 1mm; break-after: avoid; }
h3 { font-size: 11pt; margin: 5mm 0 1mm; break-after: avoid; }
h3 small { font-weight: 400; font-size: 9pt; color: var(--soft); }
p { margin: 1mm 0 2mm; }
.lead, .small { color: var(--soft); font-size: 9pt; }
.plain { font-size: 9pt; background: var(--wash); border-radius: 1.5mm; padding: 2.5mm 3.5mm; margin: 4mm 0; }
.tiles { display: grid; grid-template-columns: repeat(4, 1fr); gap: 3mm; margin: 4mm 0; }
.tiles div { border: 0.25mm solid var(--line); border-radius: 1.5mm; padding: 2mm 3mm; }
.tiles b { display: block; font-size: 17pt; line-height: 1.2; color: var(--blue); font-variant-numeric: tabular-nums; }
.tiles span { font-size: 8.5pt; color: var(--soft); }
.note { border-left: 1.2mm solid #c2500a; background: #fdf4ee; padding: 2mm 4mm; margin: 4mm 0; break-inside: avoid; }
.good { border-left-color: #1b7a4b; background: #eff7f2; }
.note b { display: block; }
ul { margin: 1mm 0; padding-left: 5mm; }
.charts { display: grid; gap: 3mm 4mm; margin: 2mm 0; }
.two { grid-template-columns: repeat(2, 1fr); }
.three { grid-template-columns: repeat(3, 1fr); }
figure { margin: 0; break-inside: avoid; min-width: 0; }
figure h4 { margin: 0; font-size: 9pt; font-weight: 600; line-height: 1.25; }
figure p { margin: 0; font-size: 8pt; line-height: 1.3; color: var(--soft); }
.three figure h4 { font-size: 8pt; }
.three figure p { font-size: 7.5pt; }
svg { display: block; width: 100%; height: auto; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 8.5pt; line-height: 1.3; margin: 1.5mm 0; font-variant-numeric: tabular-nums; }
thead { display: table-header-group; }
tr { break-inside: avoid; }
th { text-align: left; vertical-align: bottom; color: var(--soft); font-weight: 600; border-bottom: 0.4mm solid var(--line); padding: 0.8mm 1.6mm; }
td { vertical-align: top; border-bottom: 0.2mm solid var(--line); padding: 0.7mm 1.6mm; overflow-wrap: break-word; }
.n { text-align: right; white-space: nowrap; }
.days td:first-child { white-space: nowrap; }
.days { font-size: 8pt; }
.days td, .days th { padding-top: 0.35mm; padding-bottom: 0.35mm; }
.facts { font-size: 9pt; color: var(--soft); }
.facts b { color: var(--ink); }
.facts span { margin-left: 4mm; white-space: nowrap; }
.scores { width: auto; min-width: 60%; }
.scores td, .scores th { padding-right: 6mm; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.8mm 5mm; font-size: 9pt; margin: 1.5mm 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
ol.key { columns: 2; column-gap: 8mm; font-size: 8.5pt; margin: 1mm 0 2mm; padding-left: 6mm; }
footer { margin-top: 8mm; border-top: 0.25mm solid var(--line); padding-top: 2mm; }
@media (max-width: 640px) {
  main { margin: 0; padding: 5mm; border-radius: 0; }
  header { display: block; }
  header .made { text-align: left; }
  .tiles { grid-template-columns: repeat(2, 1fr); }
  .two, .three { grid-template-columns: 1fr; }
  ol.key { columns: 1; }
}
@media print {
  html { background: none; }
  body { font-size: 9.5pt; }
  main { max-width: none; margin: 0; padding: 0; border-radius: 0; box-shadow: none; }
  .wide { overflow: visible; }
  h2 { margin-top: 6mm; }
}
)css";

}  // namespace

std::string report_style(const std::string& running) {
  // Patients' codes have no character that would end a string of CSS; the version is this program's.
  std::string text;
  for (const char c : running)
    if (c != '"' && c != '\\' && c != '<' && c != '\n') text.push_back(c);
  std::string style = kStyleSheet;
  style.append("@page { size: A4; margin: 14mm 14mm 16mm; @bottom-left { content: \"")
      .append(text)
      .append(
          "\"; font: 7.5pt Helvetica, Arial, sans-serif; color: #55636d; } @bottom-right { content: "
          "counter(page) "
          "\" / \" counter(pages); font: 7.5pt Helvetica, Arial, sans-serif; color: #55636d; } }\n");
  return style;
}

}  // namespace phalanx::report
