// SPDX-License-Identifier: Apache-2.0
// Packets that are lost, doubled, overtaken or late: the station runs on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "faults/fault_suite.h"
#include "faults/reactions.h"

namespace phalanx::testing {
namespace {

struct Tracking {
  double error = 0.0;        ///< largest |controller's torque - host's newest command| [Nm]
  double of_bound = 0.0;     ///< largest error / what is allowed there
  std::uint64_t missed = 0;  ///< most consecutive steps
  std::int64_t age = 0;      ///< largest [us]
  std::size_t active = 0;    ///< rows
  std::size_t fading = 0;    ///< rows with a step of more than 14 ms
};

double difference(const ControllerRow& row, const HostRow& host) {
  double error = 0.0;
  for (std::size_t j = 0; j < row.torque.size(); ++j)
    error = std::max(error, std::abs(row.torque[j] - host.torque[j]));
  return error;
}

/// Beside the controller's torque stands the newest step of the host that could have begun by then. Between
/// both lie `missed` steps, each at most rate limit x period, and the one that the controller is moving to.
/// What a fade by age has taken comes back at the rate limit.
Tracking track(const StationLogs& logs) {
  Tracking out;
  std::size_t newest = 0;
  double taken = 0.0;  // by the last fade, less what has come back [Nm]
  std::int64_t before = 0;
  for (const ControllerRow& row : logs.controller) {
    while (newest + 1 < logs.host.size() && logs.host[newest + 1].sample_time_us <= row.time_us) ++newest;
    const double dt = 1e-6 * static_cast<double>(row.time_us - before);
    before = row.time_us;
    if (newest >= logs.host.size() || logs.host[newest].tick < row.acted_tick)
      continue;  // the ramp at the end
    const HostRow& host = logs.host[newest];
    const double error = difference(row, host);
    if (row.state == "fading") {
      ++out.fading;
      taken = error;
      out.error = std::max(out.error, error);
    }
    if (row.state != "active") continue;
    ++out.active;
    taken = std::max(0.0, taken - kTorqueRate * dt);
    const std::uint64_t missed = host.tick - row.acted_tick;
    const double bound = taken + kTorqueRate * kHostPeriod * static_cast<double>(missed + 1);
    out.error = std::max(out.error, error);
    out.of_bound = std::max(out.of_bound, (error - kFloat) / bound);
    out.missed = std::max(out.missed, missed);
    out.age = std::max(out.age, row.age_us);
  }
  return out;
}

std::uint64_t of_link(const Outcome& outcome, const char* name) {
  return nlohmann::json::parse(outcome.summary).at("link").at(name).get<std::uint64_t>();
}

void expect_tracked(const Outcome& outcome, const std::string& fault, const std::string& counted) {
  expect_runs_on(outcome);
  const Tracking seen = track(outcome.logs);
  EXPECT_GT(seen.active, 1500U);
  EXPECT_LE(seen.of_bound, 1.0);
  print_row(fault, "runs on; torque error at most rate limit x missed steps; nothing older is applied",
            fmt::format(
                "no fault; largest error {:.1f} mNm, {:.0f} % of what is allowed; at most {} steps missed in "
                "a row, oldest step at full torque {:.0f} ms, {} ticks faded by age; {}",
                1e3 * seen.error, 100.0 * seen.of_bound, seen.missed, 1e-3 * static_cast<double>(seen.age),
                seen.fading, counted));
}

const Registered kClean("WithoutFaultsTheTorqueFollows", "", {});
TEST(Faults, WithoutFaultsTheTorqueFollows) {
  const Outcome& o = outcome("WithoutFaultsTheTorqueFollows");
  expect_tracked(o, "none (for comparison)", fmt::format("{} lost", of_link(o, "lost")));
}

const Registered kDrop1("LossOf1PercentIsBridged", "", {.controller = {"--fault", "drop=0.01"}});
TEST(Faults, LossOf1PercentIsBridged) {
  const Outcome& o = outcome("LossOf1PercentIsBridged");
  EXPECT_GT(of_link(o, "lost"), 0U);
  expect_tracked(o, "1 % random loss, both ways",
                 fmt::format("{} samples reported lost", of_link(o, "lost")));
}

const Registered kDrop10("LossOf10PercentIsBridged", "", {.controller = {"--fault", "drop=0.1"}});
TEST(Faults, LossOf10PercentIsBridged) {
  const Outcome& o = outcome("LossOf10PercentIsBridged");
  EXPECT_GT(of_link(o, "lost"), 100U);
  expect_tracked(o, "10 % random loss, both ways",
                 fmt::format("{} samples reported lost", of_link(o, "lost")));
}

const Registered kDuplicate("DuplicatesAreDropped", "", {.controller = {"--fault", "duplicate=0.2"}});
TEST(Faults, DuplicatesAreDropped) {
  const Outcome& o = outcome("DuplicatesAreDropped");
  EXPECT_GT(of_link(o, "outdated"), 100U);
  expect_tracked(o, "20 % duplicates, both ways",
                 fmt::format("{} samples reported outdated", of_link(o, "outdated")));
}

const Registered kReorder("ReorderingIsSortedOut", "", {.controller = {"--fault", "reorder=0.2"}});
TEST(Faults, ReorderingIsSortedOut) {
  const Outcome& o = outcome("ReorderingIsSortedOut");
  EXPECT_GT(of_link(o, "outdated"), 100U);
  expect_tracked(o, "20 % reordered, both ways",
                 fmt::format("{} samples and {} commands reported outdated", of_link(o, "outdated"),
                             of_link(o, "device_outdated")));
}

const Registered kJitter("JitterOf5MsIsBridged", "", {.controller = {"--fault", "jitter=0.005"}});
TEST(Faults, JitterOf5MsIsBridged) {
  const Outcome& o = outcome("JitterOf5MsIsBridged");
  expect_tracked(o, "5 ms jitter, both ways",
                 fmt::format("{} samples and {} commands reported outdated", of_link(o, "outdated"),
                             of_link(o, "device_outdated")));
}

}  // namespace
}  // namespace phalanx::testing
