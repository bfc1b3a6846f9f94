// SPDX-License-Identifier: Apache-2.0
#include "device/conform/conform_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "phalanx/core/xml_text.h"
#include "phalanx/device/link/messages.h"

namespace phalanx {
namespace {

constexpr double kHostMayDelay = 5e-3;  ///< a longer delay of this computer may be why a row failed [s]
constexpr int kTriesOfARow = 3;

ConformFinding finding_once(const ConformRow& row, ConformHost& host) {
  try {
    return row.check(host);
  } catch (const ConformTrouble& trouble) {
    return {ConformOutcome::kFail, trouble.what()};
  }
}

/// Tests a row. If it failed while this computer was late, its commands may have been too old, and it is
/// repeated.
ConformFinding finding_of(const ConformRow& row, ConformHost& host) {
  static_cast<void>(host.take_delay());
  for (int i = 1;; ++i) {
    ConformFinding finding = finding_once(row, host);
    const double delay = host.take_delay();
    if (finding.outcome != ConformOutcome::kFail || delay <= kHostMayDelay) return finding;
    if (i < kTriesOfARow) continue;
    finding.observed += fmt::format(" (this computer was up to {:.0f} ms late, in each of {} tries: free it)",
                                    1e3 * delay, i);
    return finding;
  }
}

/// Ends the session before an exception leaves the test: the motors must not stay enabled.
void give_up(ConformHost& host) noexcept {
  try {
    host.leave();
  } catch (const std::exception&) {
    // The first exception states the cause. Without a port the device's own age limit ends the torque.
  }
}

std::string facts(const ConformReport& report) {
  return fmt::format("{}; {}{}. Largest torque commanded: {:g} Nm. Duration: {:.0f} s.", report.address,
                     report.device.empty() ? "no device answered" : report.device,
                     report.date.empty() ? std::string() : "; tested on " + report.date, report.torque,
                     report.seconds);
}

constexpr const char* kScope =
    "The link carries no applied torque: without a TORQUE channel the rows see state and factor, not the "
    "motors. "
    "This report is a test of the link's protocol by a program without any assurance. It is no certificate.";

}  // namespace

int ConformReport::count(ConformOutcome outcome) const {
  return static_cast<int>(
      std::count_if(results.begin(), results.end(),
                    [outcome](const ConformResult& result) { return result.finding.outcome == outcome; }));
}

std::string ConformReport::verdict() const {
  return fmt::format("{}: {} rows passed, {} failed, {} not applicable.",
                     conforms() ? "The device conforms" : "The device does NOT conform",
                     count(ConformOutcome::kPass), count(ConformOutcome::kFail),
                     count(ConformOutcome::kNotApplicable));
}

ConformReport run_conformance(ConformPort& port, const ConformSettings& settings,
                              const std::function<void(const ConformResult&)>& on_result) {
  ConformHost host(port, settings);
  ConformReport report;
  report.torque = settings.torque;
  const double begin = host.now();
  try {
    for (const ConformRow& row : conform_rows()) {
      const bool tried = row.id == "ping" || row.id == "hello";
      ConformResult result{.row = &row, .finding = {}};
      result.finding = tried || host.welcome()
                           ? finding_of(row, host)
                           : ConformFinding{ConformOutcome::kNotApplicable, "no session was granted"};
      if (on_result) on_result(result);
      report.results.push_back(std::move(result));
    }
    host.leave();
  } catch (...) {
    give_up(host);
    throw;
  }
  report.seconds = host.now() - begin;
  if (const auto& welcome = host.welcome())
    report.device = fmt::format("serial number {}, {} Hz, {} channels{}", read_serial(welcome->serial),
                                welcome->rate_hz, welcome->channel_count,
                                (welcome->flags & PHX_WELCOME_SIMULATED) != 0 ? ", simulated" : "");
  return report;
}

std::string_view conform_outcome_name(ConformOutcome outcome) {
  switch (outcome) {
    case ConformOutcome::kPass:
      return "pass";
    case ConformOutcome::kFail:
      return "FAIL";
    case ConformOutcome::kNotApplicable:
      break;
  }
  return "not applicable";
}

std::string conform_markdown(const ConformReport& report) {
  std::string text =
      fmt::format("# Conformance with the Phalanx link\n\n**{}**\n\n{} Tested with {}.\n\n{}\n\n",
                  report.verdict(), facts(report), report.program, kScope);
  text +=
      "| row | result | requirement | stimulus | expected | observed |\n| --- | --- | --- | --- | --- | --- "
      "|\n";
  for (const ConformResult& result : report.results) {
    std::string observed = result.finding.observed;
    std::replace(observed.begin(), observed.end(), '|', '/');
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", result.row->id,
                        conform_outcome_name(result.finding.outcome), result.row->requirement,
                        result.row->stimulus, result.row->expected, observed);
  }
  return text;
}

std::string conform_html(const ConformReport& report) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Conformance with the Phalanx "
      "link</title>\n"
      "<style>body{{font:16px/1.4 sans-serif;margin:2em;max-width:80em}}table{{border-collapse:collapse}}"
      "th,td{{border:1px solid #888;padding:.3em .6em;text-align:left;vertical-align:top}}"
      ".FAIL{{background:#fdd;font-weight:bold}}.pass{{background:#dfd}}</style>\n"
      "<h1>Conformance with the Phalanx link</h1>\n<p><strong>{}</strong></p>\n<p>{} Tested with "
      "{}.</p>\n<p>{}</p>\n"
      "<table>\n<tr><th>row<th>result<th>requirement<th>stimulus<th>expected<th>observed</tr>\n",
      xml_escaped(report.verdict()), xml_escaped(facts(report)), xml_escaped(report.program), kScope);
  for (const ConformResult& result : report.results) {
    const std::string_view name = conform_outcome_name(result.finding.outcome);
    const bool plain = result.finding.outcome == ConformOutcome::kNotApplicable;
    text += fmt::format("<tr><td>{}<td{}>{}<td>{}<td>{}<td>{}<td>{}</tr>\n", result.row->id,
                        plain ? std::string() : fmt::format(" class=\"{}\"", name), name,
                        xml_escaped(result.row->requirement), xml_escaped(result.row->stimulus),
                        xml_escaped(result.row->expected), xml_escaped(result.finding.observed));
  }
  return text + "</table>\n</html>\n";
}

std::string conform_json(const ConformReport& report) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ConformResult& result : report.results) {
    rows.push_back({{"row", result.row->id},
                    {"result", conform_outcome_name(result.finding.outcome)},
                    {"section", result.row->section},
                    {"requirement", result.row->requirement},
                    {"stimulus", result.row->stimulus},
                    {"expected", result.row->expected},
                    {"observed", result.finding.observed}});
  }
  const nlohmann::ordered_json json = {{"conforms", report.conforms()},
                                       {"passed", report.count(ConformOutcome::kPass)},
                                       {"failed", report.count(ConformOutcome::kFail)},
                                       {"not_applicable", report.count(ConformOutcome::kNotApplicable)},
                                       {"address", report.address},
                                       {"device", report.device},
                                       {"program", report.program},
                                       {"date", report.date},
                                       {"largest_torque_nm", report.torque},
                                       {"seconds", report.seconds},
                                       {"rows", rows}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace phalanx
