// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "phalanx/study/queue.h"
#include "study/laboratory/journal.h"
#include "study/queue/pace.h"
#include "study/queue/study_queue.h"

namespace phalanx {
namespace {

using Clock = std::chrono::steady_clock;
using Results = std::map<int, PointResult>;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::vector<PointResult> in_order(const Results& results) {
  std::vector<PointResult> list;
  for (const auto& [index, result] : results) list.push_back(result);
  return list;
}

/// @returns the results of a journal that the queue lacks.
/// @throws std::invalid_argument if the journal and the queue have different results of a point
std::vector<MeasuredPoint> missing_of(const std::vector<PointResult>& journal, const Results& stored) {
  std::vector<MeasuredPoint> missing;
  for (const PointResult& result : journal) {
    std::string line = result_line(result);
    if (const auto known = stored.find(result.index); known != stored.end()) {
      if (result_line(known->second) == line) continue;
      throw std::invalid_argument(fmt::format(
          "point {} has different results in the journal and in the queue; use another --out folder, "
          "or measure the study again (--restart)",
          result.index));
    }
    line.pop_back();
    missing.push_back({.index = result.index, .seconds = 0.0, .result = std::move(line)});
  }
  return missing;
}

/// Stores results of a journal, in portions that one statement takes.
/// @param libm  of the machine that measured them
/// @throws std::invalid_argument if points in the queue were measured with mathematical functions that round differently
void store(StudyQueue& queue, const std::vector<MeasuredPoint>& missing, const std::string& libm) {
  constexpr std::ptrdiff_t kPortion = 500;
  if (missing.empty()) return;
  queue.claim_for_journal(libm);
  for (auto begin = missing.begin(); begin != missing.end();) {
    const auto end = begin + std::min(kPortion, std::distance(begin, missing.end()));
    queue.finish({begin, end});
    begin = end;
  }
}

/// Watches the queue until nothing is left to measure.
class Watch {
 public:
  Watch(StudyQueue& queue, const Study& study, const QueueServer& server, const QueueRunOptions& options)
      : queue_(queue), server_(server), options_(options) {
    progress_.total = point_count(study);
    progress_.in_queue = true;
  }

  /// @returns the quarantined points when run() returned.
  [[nodiscard]] int quarantined() const { return progress_.quarantined; }

  void run(Results& results) {
    constexpr double kPause = 1.0;   // [s]
    constexpr double kShare = 20.0;  // a look at the queue takes at most about 1 / kShare of the time
    constexpr double kLongest = 30.0;
    progress_.resumed = static_cast<int>(results.size());
    for (;;) {
      const auto began = Clock::now();
      const QueueState state = queue_.state();
      queue_.collect(results);
      if (state.unfinished == 0 && static_cast<int>(results.size()) + state.quarantined < progress_.total) {
        queue_.collect_all();
        queue_.collect(results);
      }
      tell(state, static_cast<int>(results.size()));
      if (state.unfinished == 0) return;
      const double pause_s = std::clamp(kShare * seconds_since(began), kPause, kLongest);
      write_page(results);
      if (pause(pause_s)) return;
    }
  }

 private:
  /// @returns whether the caller asks to stop
  [[nodiscard]] bool pause(double seconds) const {
    constexpr auto kStep = std::chrono::milliseconds(50);
    const auto begin = Clock::now();
    while (seconds_since(begin) < seconds) {
      if (server_.stopped && server_.stopped()) return true;
      std::this_thread::sleep_for(kStep);
    }
    return false;
  }

  void tell(const QueueState& state, int done) {
    pace_.add(Clock::now(), done);
    progress_.done = done;
    progress_.quarantined = state.quarantined;
    progress_.workers = state.workers;
    progress_.elapsed_s = seconds_since(begin_);
    progress_.points_per_s = pace_.per_s();
    progress_.remaining_s = state.unfinished / progress_.points_per_s;
    if (options_.progress) options_.progress(progress_);
  }

  void write_page(const Results& results) {
    constexpr double kPause = 5.0;  // [s]
    constexpr double kShare = 20.0;
    if (!options_.page || progress_.done == done_on_page_ ||
        seconds_since(last_page_) < std::max(kPause, kShare * page_s_))
      return;
    const auto begin = Clock::now();
    options_.page(in_order(results), progress_);
    page_s_ = seconds_since(begin);
    last_page_ = Clock::now();
    done_on_page_ = progress_.done;
  }

  StudyQueue& queue_;
  const QueueServer& server_;
  const QueueRunOptions& options_;
  StudyProgress progress_;
  Pace pace_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_page_;
  double page_s_ = 0.0;
  int done_on_page_ = -1;
};

}  // namespace

QueuedResults run_on_queue(const Study& study, const StudyCheck& check, const std::filesystem::path& out,
                           const QueueServer& server, const QueueRunOptions& options) {
  StudyQueue queue(server);  // first: an address or tables that are refused must not change a file
  try {
    queue.prepare(options.lease_s);
  } catch (const QueueStopped&) {
    throw std::runtime_error("stopped while the server is away; nothing was begun");
  }
  JournalHeader header{.study = study, .inputs = check_study(study, check), .commit = options.commit};
  prepare_output_folder(out);
  const auto file = out / journal_name(1, 1);
  Journal journal(file);  // no other process may write the file
  if (!options.restart) journal.begin(header, false);
  Results results;
  for (const PointResult& result : journal.finished()) results.emplace(result.index, result);
  QueuedResults queued;
  std::exception_ptr failure;
  bool begun = !options.restart;
  bool taken_up = false;  // the queue has the journal's points
  try {
    queue.create(header, options.lease_s, options.restart);
    if (options.restart) journal.begin(header, true);  // not before: the server may refuse to begin again
    begun = true;
    Results stored;
    queue.collect(stored);
    store(queue, missing_of(journal.finished(), stored), journal.libm());
    taken_up = true;
    results.merge(stored);  // not before: points that the queue refuses must not be mixed with its own
    if (options.retry) queue.retry_quarantined();
    remove_study_outputs(out);
    Watch watch(queue, study, server, options);
    watch.run(results);
    queued.quarantined_points = watch.quarantined();
    queued.quarantined = queue.quarantined();
    queued.processors = queue.processors();
  } catch (const QueueStopped&) {  // while the server is away
    if (!begun)
      throw std::runtime_error(
          "stopped while the server is away: it may have begun the study again or not, what the journal has "
          "is kept. Type the same command again");
  } catch (...) {
    failure = std::current_exception();
  }
  header.libm = taken_up && !queue.collected_libm().empty() ? queue.collected_libm() : journal.libm();
  queued.results = in_order(results);
  queued.whole = static_cast<int>(results.size()) == point_count(study);
  try {
    if (begun) replace_journal(file, {.header = header, .points = queued.results});
  } catch (...) {
    if (!failure) throw;
  }
  if (failure) std::rethrow_exception(failure);
  return queued;
}

}  // namespace phalanx
