// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <deque>
#include <exception>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/study/laboratory/study_file.h"
#include "phalanx/study/queue.h"
#include "study/laboratory/checked_inputs.h"
#include "study/queue/pace.h"
#include "study/queue/point_process.h"
#include "study/queue/study_queue.h"

namespace phalanx {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kBatchSeconds = 5.0;  ///< of work that is taken at once [s]
constexpr int kMostTaken = 1000;
constexpr double kGivenSeconds = 0.1;  ///< of short points that one process has at once [s]
constexpr int kMostGiven = 64;
constexpr int kMostFailuresInARow = 20;
constexpr double kMostPassed = 1.0;              ///< between two looks at the processes [s]
constexpr auto kIdle = std::chrono::seconds(1);  ///< until the queue is asked again for points of others
constexpr auto kAwake = std::chrono::milliseconds(200);

/// Mean time of the last points [s].
class PointTime {
 public:
  void add(double seconds) { mean_ = std::isnan(mean_) ? seconds : mean_ + kWeight * (seconds - mean_); }
  /// @returns how many points take `seconds`, 1 .. most; 1 until the time is known
  [[nodiscard]] int points_in(double seconds, int most) const {
    if (std::isnan(mean_)) return 1;
    return static_cast<int>(
        std::clamp(std::ceil(seconds / std::max(mean_, 1e-9)), 1.0, static_cast<double>(most)));
  }

 private:
  static constexpr double kWeight = 0.1;
  double mean_ = std::nan("");
};

/// A worker: its processes, and the points that it has taken.
class Worker {
 public:
  Worker(StudyQueue& queue, const Study& study, const InputFiles& files, const TrialFunction& trial,
         const QueueServer& server, const QueueWorkOptions& options, int jobs)
      : queue_(queue),
        study_(study),
        files_(files),
        trial_(trial),
        server_(server),
        options_(options),
        limit_s_(options.limit_s > 0.0 ? options.limit_s : usual_point_limit(study)),
        processes_(static_cast<std::size_t>(jobs)) {}

  void run() {
    while (!stopped()) {
      const bool none_free = taken_.empty() && !take();
      for (auto& process : processes_) give(process);
      if (none_free && held_.empty() && !queue_.has_unfinished()) {
        work_.whole = true;
        return;
      }
      wait();
      read();
      give_back();
      store();
      renew();
    }
  }

  /// Stores what is measured and gives the other points back, or their leases end.
  /// @returns why the queue does not take what was measured though it is there; null: it does, or it is away
  [[nodiscard]] std::exception_ptr end() noexcept {
    std::exception_ptr refused;
    try {
      queue_.try_though_stopped();
      for (const Process& process : processes_) {
        if (!process) continue;
        for (PointAnswer& answer : process->read()) {
          if (!answer.failed) measured_.push_back(measured(answer));
        }
      }
      for (auto& process : processes_) process.reset();
      try {
        store();
      } catch (const QueueStopped&) {
        throw;
      } catch (...) {
        refused = std::current_exception();
      }
      queue_.leave({held_.begin(), held_.end()});
      work_.given_back = true;
    } catch (...) {
      work_.given_back = false;
    }
    return refused;
  }

  [[nodiscard]] const QueueWork& work() const { return work_; }

 private:
  using Process = std::unique_ptr<PointProcess>;

  [[nodiscard]] bool stopped() const { return server_.stopped && server_.stopped(); }

  /// Takes points if a process is idle. @returns false if it asked, and no point is free
  bool take() {
    if (Clock::now() < next_take_) return true;
    const int jobs = static_cast<int>(processes_.size());
    const auto busy =
        static_cast<int>(std::count_if(processes_.begin(), processes_.end(), [](const Process& process) {
          return process && !process->pending().empty();
        }));
    if (busy == jobs) return true;
    const int wanted = std::max(jobs - busy, time_.points_in(kBatchSeconds * jobs, kMostTaken));
    for (const int point : queue_.take(wanted)) {
      if (held_.insert(point).second)
        taken_.push_back(point);  // else its lease had ended while it is measured here
    }
    if (taken_.empty()) next_take_ = Clock::now() + kIdle;
    return !taken_.empty();
  }

  /// Gives back what was taken when points were quicker, so that idle workers can take it.
  void give_back() {
    const double seconds = 2.0 * kBatchSeconds * static_cast<double>(processes_.size());
    const auto kept = static_cast<std::size_t>(time_.points_in(seconds, kMostTaken));
    if (taken_.size() <= kept) return;
    const auto first = taken_.begin() + static_cast<std::ptrdiff_t>(kept);
    queue_.give_back({first, taken_.end()});
    for (auto point = first; point != taken_.end(); ++point) held_.erase(*point);
    taken_.erase(first, taken_.end());
  }

  void give(Process& process) {
    const auto most = static_cast<std::size_t>(time_.points_in(kGivenSeconds, kMostGiven));
    while (!taken_.empty() && (!process || process->pending().size() < most)) {
      if (!process) process = std::make_unique<PointProcess>(study_, trial_);
      process->give(taken_.front());
      taken_.pop_front();
    }
  }

  void wait() const {
    std::vector<pollfd> descriptors;
    for (const Process& process : processes_) {
      if (!process) continue;
      descriptors.push_back({.fd = process->answers(), .events = POLLIN, .revents = 0});
      descriptors.push_back({.fd = process->log(), .events = POLLIN, .revents = 0});
    }
    static_cast<void>(::poll(descriptors.data(), descriptors.size(), static_cast<int>(kAwake.count())));
  }

  void read() {
    const auto now = Clock::now();
    // A pause of the whole worker, and a wait for the server, are not time of its points.
    const double passed = std::min(std::chrono::duration<double>(now - last_read_).count(), kMostPassed);
    last_read_ = now;
    for (Process& process : processes_) {
      if (!process) continue;
      std::vector<PointAnswer> answers = process->read();
      for (PointAnswer& answer : answers) {
        if (answer.failed) continue;
        time_.add(answer.seconds);
        measured_.push_back(measured(answer));
      }
      for (const PointAnswer& answer : answers) {  // last: this may throw
        if (answer.inputs_changed) throw std::runtime_error(answer.text);
        if (answer.failed) {
          fail(answer.index, answer.text);
        } else {
          failures_in_a_row_ = 0;
        }
      }
      process->pass(passed, limit_s_);
      if (process->ended()) replace(process);
    }
  }

  static MeasuredPoint measured(PointAnswer& answer) {
    return {.index = answer.index, .seconds = answer.seconds, .result = std::move(answer.text)};
  }

  /// The process has ended: the point that it measured fails, the others are given to the next one.
  void replace(Process& process) {
    const std::deque<int> pending = process->pending();
    const bool for_nothing = process->ended_for_nothing();
    const std::string how = process->how_it_ended();
    process.reset();
    if (pending.empty()) return;
    // A signal to all processes of the worker is no failure of a point.
    const bool failed = !for_nothing && !stopped();
    taken_.insert(taken_.begin(), failed ? std::next(pending.begin()) : pending.begin(), pending.end());
    if (failed) fail(pending.front(), fmt::format("the process that measured it {}", how));
  }

  void fail(int index, const std::string& why) {
    files_.refuse_changed();  // it may be why: no failure of the point
    ++work_.failed;
    const std::string line = why.substr(0, why.find('\n'));
    if (server_.tell)
      server_.tell(fmt::format("point {} ({}) failed: {}", index,
                               point_text(study_, study_point(study_, index)), line));
    queue_.fail(index, why);
    held_.erase(index);
    if (++failures_in_a_row_ == kMostFailuresInARow)
      throw std::runtime_error(fmt::format(
          "{} failures without a result between them, the last of point {}: {}; this worker ends, "
          "see whether its machine has room, memory and the files of the study",
          kMostFailuresInARow, index, line));
  }

  void store() {
    if (measured_.empty()) return;
    files_.refuse_changed();
    queue_.finish(measured_);
    work_.finished += static_cast<int>(measured_.size());
    for (const MeasuredPoint& point : measured_) held_.erase(point.index);
    measured_.clear();
    pace_.add(Clock::now(), work_.finished);
    if (options_.finished) options_.finished(work_.finished, pace_.per_s());
  }

  void renew() {
    if (Clock::now() < next_renewal_) return;
    queue_.renew({held_.begin(), held_.end()});
    next_renewal_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(queue_.renewal_s()));
  }

  StudyQueue& queue_;
  const Study& study_;
  const InputFiles& files_;
  const TrialFunction& trial_;
  const QueueServer& server_;
  const QueueWorkOptions& options_;
  double limit_s_;
  std::vector<Process> processes_;
  std::set<int> held_;     ///< taken, neither stored nor failed
  std::deque<int> taken_;  ///< of them, those that no process has
  std::vector<MeasuredPoint> measured_;
  PointTime time_;
  Pace pace_;
  Clock::time_point last_read_ = Clock::now();
  Clock::time_point next_take_ = Clock::now();
  Clock::time_point next_renewal_ = Clock::now();
  int failures_in_a_row_ = 0;
  QueueWork work_;
};

}  // namespace

double usual_point_limit(const Study& study) {
  constexpr double kLeast = 3600.0;       // [s]
  constexpr double kTrialSeconds = 0.05;  // stability_press on one core
  constexpr double kSlower = 20.0;
  return std::max(kLeast, kSlower * kTrialSeconds * static_cast<double>(most_trials(study).per_point));
}

QueueWork work_on_queue(const Study& study, const StudyCheck& check, const TrialFunction& trial,
                        const QueueServer& server, const QueueWorkOptions& options) {
  if (!(options.limit_s >= 0.0))
    throw std::invalid_argument(
        fmt::format("a limit of {} s for a point is out of range; give one above 0, or 0 for the usual one",
                    options.limit_s));
  StudyQueue queue(server);
  const int jobs =
      options.jobs > 0 ? options.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const CheckedInputs inputs = check_inputs(study, check, jobs);
  try {
    queue.join({.study = study, .inputs = inputs.fingerprint, .commit = options.commit}, jobs);
  } catch (const QueueStopped&) {
    return {};
  }
  std::signal(SIGCHLD, SIG_DFL);  // one that ignores it hides how the processes of points ended
  const TrialFunction checked = checked_trial(trial, inputs.files);
  Worker worker(queue, study, inputs.files, checked, server, options, jobs);
  try {
    worker.run();
  } catch (const QueueStopped&) {  // while the server is away
  } catch (...) {
    static_cast<void>(worker.end());
    throw;
  }
  if (const std::exception_ptr refused = worker.end()) std::rethrow_exception(refused);
  return worker.work();
}

}  // namespace phalanx
