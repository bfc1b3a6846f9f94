// SPDX-License-Identifier: Apache-2.0
#include "run/status_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace phalanx {
namespace {

struct Part {
  std::string text;
  std::string brief = {};  ///< shorter form, if that does not fit
};

/// Formats "thumb 1.1 index 3.2 N": the forces sent, not those that the step would send.
Part forces(const StationView& view) {
  std::string text;
  double largest = 0.0;
  for (int digit = 0; digit < kDigits; ++digit) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force += view.snapshot.segment[static_cast<std::size_t>(segment_index(digit, k))].force;
    force *= view.factor;
    largest = std::max(largest, force);
    if (force >= 0.005) text += fmt::format("{} {:.1f} ", digit_name(digit), force);
  }
  if (text.empty()) return {"no contact"};
  return {text + "N", fmt::format("up to {:.1f} N", largest)};
}

std::string of_fault(const FaultEvent& fault) {
  return fmt::format("{}{}: {} Type `reset` when it is mended.", fault_name(fault.fault),
                     fault.channel >= 0 ? fmt::format(" (channel {})", fault.channel) : "",
                     fault_words(fault));
}

std::vector<Part> parts_of(const StationView& view, const DeadlineStatistics& deadlines) {
  if (view.state == SafetyState::kFault)
    return {{of_fault(view.fault), std::string(fault_name(view.fault.fault))}};
  std::vector<Part> parts;
  if (view.degraded) parts.push_back({"DEGRADED: steps end too late", "DEGRADED"});
  if (has(view.snapshot.status, Status::kOscillating)) parts.push_back({"OSCILLATING"});
  parts.push_back(forces(view));
  if (view.link.lost + view.link.corrupt > 0)
    parts.push_back({fmt::format("lost {}  corrupt {}", view.link.lost, view.link.corrupt)});
  parts.push_back({fmt::format("overruns {}", deadlines.overruns)});
  parts.push_back({fmt::format("late p99.9 {:.0f} us", deadlines.lateness.percentile_us(99.9))});
  parts.push_back({fmt::format("step p99.9 {:.0f} us", deadlines.step.percentile_us(99.9))});
  return parts;
}

}  // namespace

std::string status_line(const StationView& view, const DeadlineStatistics& deadlines, double seconds,
                        std::size_t width) {
  std::string line = fmt::format("{:7.1f} s  {:<8}", seconds, safety_state_name(view.state));
  for (const Part& part : parts_of(view, deadlines)) {
    const bool fits = line.size() + 2 + part.text.size() <= width;
    const std::string& shown = fits ? part.text : part.brief;
    if (shown.empty()) break;
    line += "  " + shown;
  }
  return line.substr(0, width);
}

}  // namespace phalanx
