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
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/serve/cockpit.h"
#include "phalanx/simulation/press_intent.h"
#include "phalanx/station/session.h"
#include "rounds.h"

namespace phalanx::bench {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kSettle = 0.5;  ///< after a change of load, not counted [s]

/// What one kind of load came to, round by round.
struct Phase {
  std::string name;
  Rounds step{};
  Rounds lateness{};
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
      : session_({.scene = "grasp_teapot",
                  .overrides = {{"rate_hz", "1000"}},
                  .device = "simulated",
                  .calibration = {},
                  .clinician = {},
                  .realtime = {},
                  .ask_for_realtime = true,
                  .write_calibration = {}},
                 clock_),
        cockpit_(session_, {}),
        server_(any_port(), cockpit_) {
    cockpit_.attach(server_);
    server_.start();
  }
  ~Bench() {
    server_.stop();
    session_.shut_down();
  }

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

  /// Runs for so long; nothing of it counts.
  void settle(double seconds) { run(seconds, nullptr); }
  /// Runs for so long, which is a round of `phase`.
  void measure(double seconds, Phase& phase) {
    phase.step.emplace_back();
    phase.lateness.emplace_back();
    run(seconds, &phase);
  }

  [[nodiscard]] std::string realtime() const { return session_.info()->realtime; }

 private:
  void run(double seconds, Phase* phase) {
    const auto end = std::chrono::steady_clock::now() + Seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      session_.poll();
      StepRecord record;
      std::vector<DeviceSample> samples;
      while (session_.next_record(record, samples)) {
        if (phase == nullptr) continue;
        phase->step.back().push_back(record.duration * 1e6);
        phase->lateness.back().push_back(record.lateness * 1e6);
        if (record.input.late) ++phase->overruns;
      }
    }
  }

  const Clock clock_;
  Session session_;
  Cockpit cockpit_;
  WebServer server_;
};

std::string text(const Ratio& ratio) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio.value, ratio.low, ratio.high);
}

void print(const Phase& phase, const Phase& quiet) {
  std::size_t steps = 0;
  for (const auto& round : phase.step) steps += round.size();
  fmt::print("| {} | {} | {:.1f} | {} | {:.1f} | {} | {:.1f} | {} | {} |\n", phase.name, steps,
             percentile(phase.step, 50.0), text(ratio(phase.step, quiet.step, 50.0)),
             percentile(phase.step, 99.9), text(ratio(phase.step, quiet.step, 99.9)),
             percentile(phase.lateness, 99.9), text(ratio(phase.lateness, quiet.lateness, 99.9)),
             phase.overruns);
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

/// A slice is whole squeezes of the simulated patient, or the slices would not hold the same work.
int run(double squeezes, int rounds) {
  const double seconds = squeezes * TrialSchedule{}.end;
  LoadProcess clients;  // both fork: before all threads
  const mesh::IsolationHelper helper;
  Bench bench;
  bench.settle(2.0);
  fmt::print("real time: {}\n\n", bench.realtime());
  Phase quiet{"no page"};
  Phase again{"no page, once more"};
  std::array<Phase, 4> loaded = {Phase{"20 viewers at 60 Hz"}, Phase{"a page that never reads"},
                                 Phase{"100 MB in one message, again and again"},
                                 Phase{"1,000 connections at once, again and again"}};
  Phase importing{"a mesh of 100,000 triangles, again and again"};
  constexpr std::array<Load, 4> kLoads = {Load::kViewers, Load::kStuck, Load::kHuge, Load::kConnections};
  std::uint64_t messages = 0;
  double viewed = 0.0;  // [s]
  int uploads = 0;
  for (int round = 0; round < rounds; ++round) {
    bench.settle(kSettle);
    bench.measure(seconds, quiet);
    for (std::size_t k = 0; k < kLoads.size(); ++k) {
      const auto begin = std::chrono::steady_clock::now();
      clients.begin(kLoads[k], bench.port());
      bench.settle(kSettle);
      bench.measure(seconds, loaded[k]);
      messages += clients.end();
      if (kLoads[k] != Load::kViewers) continue;
      viewed += Seconds(std::chrono::steady_clock::now() - begin).count();
      bench.settle(kSettle);
      bench.measure(seconds, again);
    }
    const Uploads imports;
    bench.settle(kSettle);
    bench.measure(seconds, importing);
    uploads += imports.done();
  }
  fmt::print(
      "| load | steps | step p50 [us] | ratio | p99.9 | ratio | woken late p99.9 [us] | ratio | overruns "
      "|\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  print(quiet, quiet);
  print(again, quiet);
  for (const Phase& each : loaded) print(each, quiet);
  print(importing, quiet);
  fmt::print("\nratios to the first line, with the middle 95 % of what rounds drawn anew give\n");
  const double rate = static_cast<double>(messages) / viewed / LoadProcess::kViewerCount;
  fmt::print("{:.1f} messages a second to each viewer; {} imports\n", rate, uploads);
  // 60 ticks a second and a few states, less a slice's ends. A slice too short to tell has to be served only.
  const double least = seconds < 1.0 ? 1.0 : 57.0;
  if (rate >= least) return 0;
  fmt::print(stderr, "the viewers were not served at 60 Hz: nothing is shown by this run\n");
  return 1;
}

}  // namespace phalanx::bench

int main(int argc, char** argv) {
  const double squeezes = argc > 1 ? std::strtod(argv[1], nullptr) : 1.0;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 12;
  if (!(squeezes > 0.0) || rounds < 1) {
    fmt::print(stderr, "usage: phalanx_bench_cockpit [SQUEEZES OF 5.3 s IN A SLICE [ROUNDS]]\n");
    return 2;
  }
  return phalanx::bench::run(squeezes, rounds);
}
