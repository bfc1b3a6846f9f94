// SPDX-License-Identifier: Apache-2.0
// What pages, good ones and bad ones, cost the loop: the station at 1 kHz with its cockpit, in one process
// and one run, slices without pages between slices with them, so that what else the machine does meets all
// alike.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "cockpit_load.h"
#include "phalanx/serve/cockpit.h"
#include "phalanx/station/histogram.h"
#include "phalanx/station/station_host.h"

namespace phalanx::bench {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kSettle = 0.5;  ///< after a change of load, not counted [s]

/// Durations of one kind of slice.
struct Phase {
  std::string name;
  Histogram step{};
  Histogram lateness{};
  std::uint64_t steps = 0;
  std::uint64_t overruns = 0;
};

WebServerSettings any_port() {
  WebServerSettings settings;
  settings.port = 0;
  return settings;
}

class Bench {
 public:
  Bench()
      : host_({.scene = "grasp_teapot",
               .overrides = {{"rate_hz", "1000"}},
               .device = "simulated",
               .calibration = {},
               .clinician = {},
               .realtime = {},
               .ask_for_realtime = true,
               .write_calibration = {}},
              clock_),
        cockpit_(host_, {}),
        server_(any_port(), cockpit_) {
    cockpit_.attach(server_);
    server_.start();
  }
  ~Bench() {
    server_.stop();
    host_.shut_down();
  }

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

  /// Runs for so long; the steps count for `phase` (none: nowhere).
  void run(double seconds, Phase* phase) {
    const auto end = std::chrono::steady_clock::now() + Seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      host_.go_on();
      StepRecord record;
      while (host_.next_record(record)) {
        if (phase == nullptr) continue;
        phase->step.add(record.duration);
        phase->lateness.add(record.lateness);
        ++phase->steps;
        if (record.overrun) ++phase->overruns;
      }
    }
  }

  [[nodiscard]] std::string realtime() const { return host_.state()->realtime; }

 private:
  const Clock clock_;
  StationHost host_;
  Cockpit cockpit_;
  WebServer server_;
};

void print(const Phase& phase, const Phase& quiet) {
  const auto ratio = [](const Histogram& a, const Histogram& b, double percent) {
    return a.percentile_us(percent) / b.percentile_us(percent);
  };
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.1f} | {:.1f} | {:.2f} | {} |\n", phase.name,
             phase.steps, phase.step.percentile_us(50), phase.step.percentile_us(99.9),
             ratio(phase.step, quiet.step, 99.9), phase.lateness.percentile_us(50),
             phase.lateness.percentile_us(99.9), ratio(phase.lateness, quiet.lateness, 99.9), phase.overruns);
}

/// A slice with the load, which lives as long as what `begin` returns.
void slice(Bench& bench, double seconds, Phase& phase, const std::function<std::shared_ptr<void>()>& begin) {
  const std::shared_ptr<void> load = begin();
  bench.run(kSettle, nullptr);
  bench.run(seconds, &phase);
}

}  // namespace

int run(double seconds, int rounds) {
  Bench bench;
  bench.run(2.0, nullptr);
  fmt::print("real time: {}\n\n", bench.realtime());
  const std::uint16_t port = bench.port();
  std::array<Phase, 5> phase;
  phase[0].name = "no page";
  phase[1].name = "20 viewers at 60 Hz";
  phase[2].name = "a page that never reads";
  phase[3].name = "100 MB in one message, again and again";
  phase[4].name = "1,000 connections at once, again and again";
  std::uint64_t messages = 0;
  for (int round = 0; round < rounds; ++round) {
    slice(bench, seconds, phase[0], [] { return nullptr; });
    {
      auto viewers = std::make_shared<CockpitViewers>(port, 20);
      slice(bench, seconds, phase[1], [&] { return viewers; });
      messages += viewers->counts().messages;
    }
    slice(bench, seconds, phase[2], [&] { return std::make_shared<StuckViewer>(port); });
    const auto attack = [&](std::function<void()> once) {
      return std::make_shared<std::jthread>([once = std::move(once)](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          once();
          std::this_thread::sleep_for(std::chrono::milliseconds(500));
        }
      });
    };
    slice(bench, seconds, phase[3],
          [&] { return attack([port] { static_cast<void>(send_huge_message(port, 100'000'000)); }); });
    slice(bench, seconds, phase[4],
          [&] { return attack([port] { static_cast<void>(connect_often(port, 1000)); }); });
  }
  fmt::print(
      "| load | steps | step p50 [us] | p99.9 | ratio | woken late p50 [us] | p99.9 | ratio | overruns |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const Phase& each : phase) print(each, phase[0]);
  fmt::print("\n{} messages to the 20 viewers\n", messages);
  return messages > 0 ? 0 : 1;
}

}  // namespace phalanx::bench

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::strtod(argv[1], nullptr) : 5.0;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 12;
  if (!(seconds > 0.0) || rounds < 1) {
    fmt::print(stderr, "usage: phalanx_bench_cockpit [SECONDS OF A SLICE [ROUNDS]]\n");
    return 2;
  }
  return phalanx::bench::run(seconds, rounds);
}
