// SPDX-License-Identifier: Apache-2.0
#include "summary_table.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "phalanx/figures/human_names.h"
#include "terminal/emphasis.h"

namespace phalanx {
namespace {

std::string segments(const Summary& summary, const std::string& without_contact) {
  if (!touched(summary)) return "no segment touched the object" + without_contact + "\n";
  std::string rows;
  for (int s = 0; s < kSegments; ++s) {
    const auto i = static_cast<std::size_t>(s);
    if (summary.contact_ticks[i] == 0) continue;
    rows +=
        fmt::format("{:<20}{:>12}{:>16.3f}{:>16.2f}   {}\n", human_segment_name(s), summary.contact_ticks[i],
                    summary.peak_force[i], 1e3 * summary.peak_depth[i], segment_name(s));
  }
  return fmt::format("{:<20}{:>12}{:>16}{:>16}   {}\n", "segment", "contact", "peak force [N]",
                     "peak depth [mm]", "name in files") +
         rows;
}

std::string joints(const Summary& summary) {
  std::string rows;
  for (int j = 0; j < kJoints; ++j) {
    const double torque = summary.peak_torque[static_cast<std::size_t>(j)];
    if (torque > 0.0)
      rows += fmt::format("{:<20}{:>12}{:>16.4f}{:>16}   {}\n", human_joint_name(j), "", torque, "",
                          joint_name(j));
  }
  if (rows.empty()) return "no joint carried torque\n";
  return fmt::format("{:<20}{:>28}\n", "joint", "peak torque [Nm]") + rows;
}

}  // namespace

std::string warning_lines(const Summary& summary) {
  const bool colour = takes_colour(STDOUT_FILENO);
  std::string text;
  for (const std::string& warning : warnings(summary))
    text += emphasised(Emphasis::kWarning, "warning  " + warning, colour) + "\n";
  return text;
}

bool touched(const Summary& summary) {
  return std::any_of(summary.contact_ticks.begin(), summary.contact_ticks.end(),
                     [](std::uint64_t ticks) { return ticks > 0; });
}

std::string summary_table(const Summary& summary, const std::string& without_contact) {
  std::string text = fmt::format("{}: {} ticks, {:.6g} s at {:.6g} Hz; triangles: hand {}, object {}\n\n",
                                 summary.scene, summary.ticks, summary.seconds, summary.rate_hz,
                                 summary.hand_triangles, summary.object_triangles);
  text += segments(summary, without_contact) + "\n" + joints(summary) + "\n";
  for (const LimiterActivity& limiter : limiters(summary)) {
    if (limiter.ticks > 0) text += fmt::format("limit    {} acted in {} ticks\n", limiter.key, limiter.ticks);
  }
  text += warning_lines(summary);
  const StepTimes& t = summary.step_us;
  text +=
      fmt::format("step     p50 {:.1f} us, p90 {:.1f} us, p99 {:.1f} us, p99.9 {:.1f} us, max {:.1f} us\n",
                  t.p50, t.p90, t.p99, t.p999, t.max);
  return text;
}

}  // namespace phalanx
