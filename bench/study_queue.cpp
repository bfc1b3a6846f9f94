// SPDX-License-Identifier: Apache-2.0
// phalanx_bench_queue URL [POINTS [WORKERS]]: how many points a second pass through the queue of a study if they take
// no time. Results have the size of real ones: each point bisects a grid of 40 stiffnesses with 20 seeds.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study_file.h"
#include "phalanx/study/queue.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

constexpr int kMostOfAxis = 1000;

Study study_of(int points) {
  const int rows = std::max(1, points / kMostOfAxis);
  return parse_study(fmt::format(R"(
scene = "press_teapot"
seeds = 20
[stiffness]
min_n_per_mm = 0.1
max_n_per_mm = 4.0
step_n_per_mm = 0.1
search = "trace"
[[axis]]
key = "bench.row"
from = 1
to = {}
step = 1
[[axis]]
key = "bench.column"
from = 1
to = {}
step = 1
)",
                                 rows, std::max(1, points / rows)),
                     "queue.toml", ".");
}

TrialResult trial_without_time(const Overrides& /*overrides*/, double stiffness, double /*press*/,
                               std::uint64_t seed) {
  TrialResult result;
  result.stable = stiffness < 1710.0 - static_cast<double>(seed);
  result.force_swing = 0.123456789 / static_cast<double>(seed);
  result.position_swing = 1e-6 * result.force_swing;
  return result;
}

StudyInputs no_inputs(const Overrides& /*overrides*/) { return {}; }

double seconds_of(const Study& study, const QueueServer& server, int workers) {
  const Stopwatch watch;
  std::vector<pid_t> processes;
  for (int i = 0; i < workers; ++i) {
    const pid_t process = ::fork();
    if (process < 0) throw std::runtime_error("no process for a worker");
    if (process > 0) {
      processes.push_back(process);
      continue;
    }
    try {
      static_cast<void>(work_on_queue(study, no_inputs, trial_without_time, server,
                                      {.commit = "bench", .jobs = 1, .finished = {}}));
      ::_exit(0);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
      ::_exit(1);
    }
  }
  int failed = 0;
  for (const pid_t process : processes) {
    int status = 0;
    ::waitpid(process, &status, 0);
    failed += status != 0 ? 1 : 0;
  }
  if (failed > 0) throw std::runtime_error("a worker failed");
  return 1e-6 * watch.us();
}

void run(const std::string& url, int points, int workers) {
  const Study study = study_of(points);
  const std::filesystem::path out =
      std::filesystem::temp_directory_path() / fmt::format("bench-queue-{}", ::getpid());
  bool filled = false;
  const QueueServer server{.url = url, .stopped = [&] { return filled; }, .tell = {}};
  QueueRunOptions options{.commit = "bench", .restart = true};
  options.progress = [&](const StudyProgress&) { filled = true; };
  const Stopwatch filling;
  static_cast<void>(run_on_queue(study, no_inputs, out, server, options));
  const double fill_s = 1e-6 * filling.us();
  const double seconds = seconds_of(study, {.url = url, .stopped = {}, .tell = {}}, workers);
  options.restart = false;
  filled = false;
  const Stopwatch collecting;
  const QueuedResults queued = run_on_queue(study, no_inputs, out, server, options);
  const double collect_s = 1e-6 * collecting.us();
  std::filesystem::remove_all(out);
  if (!queued.whole) throw std::runtime_error("not every point has a result");
  const Made made = made_here();
  const int count = point_count(study);
  fmt::print("phalanx_bench_queue {} on {}, {}\n", made.commit, made.cpu, made.build_type);
  fmt::print("{} points, {} workers: {:.0f} points/s; filled in {:.1f} s, collected in {:.1f} s\n", count,
             workers, count / seconds, fill_s, collect_s);
}

}  // namespace
}  // namespace phalanx::bench

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "phalanx_bench_queue URL [POINTS [WORKERS]]\n");
    return 2;
  }
  try {
    phalanx::bench::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 10'000, argc > 3 ? std::atoi(argv[3]) : 1);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "phalanx_bench_queue: {}\n", error.what());
    return 1;
  }
}
