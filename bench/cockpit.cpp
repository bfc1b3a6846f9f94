// SPDX-License-Identifier: Apache-2.0
// What pages, good ones and bad ones, cost the loop: the station at 1 kHz with its cockpit, in one process
// and one run, slices without pages between slices with them, so that what else the machine does meets all
// alike.
#include <fmt/format.h>

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "load_process.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/isolation_helper.h"
#include "phalanx/mesh/primitives.h"
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

/// A mesh of this many triangles imported again and again, as an upload is: in a process of its own, made by
/// a thread below the loop's.
constexpr int kUploadTriangles = 100'000;

std::string import_it(const std::string& file) {
  return std::to_string(import_and_check(file).report.triangles);
}

class Uploads {
 public:
  Uploads()
      : file_(std::filesystem::temp_directory_path() / fmt::format("phalanx_bench_{}.obj", ::getpid())) {
    write_obj(make_sphere(0.08, kUploadTriangles), file_, "ball");
    thread_ = std::jthread([this](const std::stop_token& stop) {
      ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 5);
      while (!stop.stop_requested()) {
        static_cast<void>(mesh::run_isolated_work(import_it, file_.string(), "ball", {.cpu_seconds = 60}));
        ++done_;
      }
    });
  }
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;
  ~Uploads() {
    thread_ = {};
    std::filesystem::remove(file_);
  }
  [[nodiscard]] int done() const noexcept { return done_; }

 private:
  std::filesystem::path file_;
  std::atomic<int> done_{0};
  std::jthread thread_;
};

}  // namespace

int run(double seconds, int rounds) {
  LoadProcess clients;  // both fork: before all threads
  const mesh::IsolationHelper helper;
  Bench bench;
  bench.run(2.0, nullptr);
  fmt::print("real time: {}\n\n", bench.realtime());
  std::array<Phase, 6> phase;
  phase[0].name = "no page";
  phase[1].name = "20 viewers at 60 Hz";
  phase[2].name = "a page that never reads";
  phase[3].name = "100 MB in one message, again and again";
  phase[4].name = "1,000 connections at once, again and again";
  phase[5].name = "a mesh of 100,000 triangles, again and again";
  constexpr std::array<Load, 4> kLoads = {Load::kViewers, Load::kStuck, Load::kHuge, Load::kConnections};
  std::uint64_t messages = 0;
  double viewed = 0.0;  // [s]
  int uploads = 0;
  for (int round = 0; round < rounds; ++round) {
    bench.run(kSettle, nullptr);
    bench.run(seconds, &phase[0]);
    for (std::size_t k = 0; k < kLoads.size(); ++k) {
      const auto begin = std::chrono::steady_clock::now();
      clients.begin(kLoads[k], bench.port());
      bench.run(kSettle, nullptr);
      bench.run(seconds, &phase[k + 1]);
      messages += clients.end();
      if (kLoads[k] == Load::kViewers) viewed += Seconds(std::chrono::steady_clock::now() - begin).count();
    }
    const Uploads imports;
    bench.run(kSettle, nullptr);
    bench.run(seconds, &phase[5]);
    uploads += imports.done();
  }
  fmt::print(
      "| load | steps | step p50 [us] | p99.9 | ratio | woken late p50 [us] | p99.9 | ratio | overruns |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const Phase& each : phase) print(each, phase[0]);
  const double rate = static_cast<double>(messages) / viewed / LoadProcess::kViewerCount;
  fmt::print("\n{:.1f} messages a second to each viewer; {} imports\n", rate, uploads);
  // 60 ticks a second and a few states, less a slice's ends. A slice too short to tell has to be served only.
  const double least = seconds < 1.0 ? 1.0 : 57.0;
  if (rate >= least) return 0;
  fmt::print(stderr, "the viewers were not served at 60 Hz: nothing is shown by this run\n");
  return 1;
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
