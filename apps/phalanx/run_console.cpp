// SPDX-License-Identifier: Apache-2.0
#include "run_console.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>

namespace phalanx {

std::string status_line(const StationView& view, const DeadlineStatistics& deadlines, double seconds) {
  std::string line = fmt::format("{:7.1f} s  {:<8}", seconds, safety_state_name(view.state));
  if (view.state == SafetyState::kFault) {
    line += fmt::format("  {}{}: {} Type `reset` when it is mended.", fault_name(view.fault.fault),
                        view.fault.channel >= 0 ? fmt::format(" (channel {})", view.fault.channel) : "",
                        fault_meaning(view.fault.fault));
    return line;
  }
  bool any = false;
  for (int digit = 0; digit < kDigits; ++digit) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force += view.snapshot.segment[static_cast<std::size_t>(segment_index(digit, k))].force;
    force *= view.factor;  // what is sent, not what the step would send
    if (force < 0.005) continue;
    line += fmt::format("  {} {:.1f} N", digit_name(digit), force);
    any = true;
  }
  if (!any) line += "  no contact";
  line += fmt::format("   step {:.0f} us (p99.9 {:.0f})   woken {:.0f} us late (p99.9 {:.0f})   overruns {}",
                      deadlines.step.percentile_us(50), deadlines.step.percentile_us(99.9),
                      deadlines.lateness.percentile_us(50), deadlines.lateness.percentile_us(99.9),
                      deadlines.overruns);
  if (view.link.lost + view.link.corrupt > 0)
    line += fmt::format("   lost {}  corrupt {}", view.link.lost, view.link.corrupt);
  if (view.degraded) line += "   DEGRADED: steps end too late";
  if (has(view.snapshot.status, Status::kOscillating)) line += "   OSCILLATING";
  return line;
}

bool TypedLines::next(std::string& line) {
  for (;;) {
    const auto end = pending_.find('\n');
    if (end != std::string::npos) {
      line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      line.erase(line.find_last_not_of(" \t\r") + 1);
      return true;
    }
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (ended_ || poll(&input, 1, 0) <= 0) return false;
    std::array<char, 4096> read_in;
    const ssize_t count = read(STDIN_FILENO, read_in.data(), read_in.size());
    if (count <= 0) {
      ended_ = true;
      return false;
    }
    if (pending_.size() > 65536) pending_.clear();  // no line of ours is so long
    pending_.append(read_in.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace phalanx
