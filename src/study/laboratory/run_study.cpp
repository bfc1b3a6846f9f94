// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/run_study.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "phalanx/core/error_text.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "study/laboratory/checked_inputs.h"
#include "study/laboratory/fingerprint.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/measure_point.h"
#include "study/laboratory/study_json.h"

namespace phalanx {
namespace {

/// The finished points, and the progress callback. For one thread at a time.
class Progress {
 public:
  Progress(const StudyOptions& options, const InputFiles& files, int total,
           const std::vector<PointResult>& resumed)
      : options_(options), files_(files), total_(total), resumed_(static_cast<int>(resumed.size())) {
    for (const PointResult& result : resumed) results_.emplace(result.index, result);
    tell();
  }

  void finish(Journal& journal, const PointResult& result) {
    const std::lock_guard<std::mutex> guard(mutex_);
    files_.refuse_changed();
    journal.append(result);
    // As a later run would read it: the result must not depend on the run that measured it.
    results_.emplace(result.index, result_from_json(result_to_json(result)));
    tell();
  }

  [[nodiscard]] std::vector<PointResult> results() const {
    std::vector<PointResult> results;
    for (const auto& [index, result] : results_) results.push_back(result);
    return results;
  }

 private:
  void tell() const {
    if (!options_.progress) return;
    StudyProgress now{.done = static_cast<int>(results_.size()), .total = total_, .resumed = resumed_};
    now.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const int finished = now.done - resumed_;
    if (finished > 0) now.remaining_s = now.elapsed_s / finished * (total_ - now.done);
    options_.progress(now);
  }

  const StudyOptions& options_;
  const InputFiles& files_;
  int total_;
  int resumed_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::map<int, PointResult> results_;
};

/// The points whose trials threw.
class Failures {
 public:
  void add(int index, const std::string& reason) {
    const std::lock_guard<std::mutex> guard(mutex_);
    reasons_.emplace(index, reason);
  }
  void throw_if_any(const Study& study) const {
    if (reasons_.empty()) return;
    const auto& [index, reason] = *reasons_.begin();
    throw std::runtime_error(
        fmt::format("{} of the points failed, first point {} ({}): {}; the finished ones are kept, the same "
                    "command tries "
                    "the others again",
                    reasons_.size(), index, point_text(study, study_point(study, index)), reason));
  }

 private:
  std::mutex mutex_;
  std::map<int, std::string> reasons_;
};

std::vector<int> points_of(const Study& study, const Shard& shard) {
  std::vector<int> points;
  for (int index = shard.index - 1; index < point_count(study); index += shard.count) points.push_back(index);
  return points;
}

std::vector<int> without(std::vector<int> points, const std::vector<PointResult>& finished) {
  std::set<int> known;
  for (const PointResult& result : finished) known.insert(result.index);
  std::erase_if(points, [&](int index) { return known.contains(index); });
  return points;
}

/// Measures points. If the journal cannot be written, the run ends: further results would be lost.
void measure_points(const std::vector<int>& points, const Study& study, const TrialFunction& trial,
                    const InputFiles& files, Journal& journal, Progress& progress, Failures& failures) {
  const TrialFunction checked = checked_trial(trial, files);
  std::atomic<std::size_t> next{0};
  tbb::parallel_for_each(points, [&](int) {
    const int index = points[next++];  // in order, independent of oneTBB's order
    PointResult result;
    try {
      result = measure_point(study, index, checked);
    } catch (const InputsChanged&) {
      throw;  // ends the run: the trials may have kept what they read from another file
    } catch (const std::exception& error) {
      failures.add(index, error_text(error));
      return;
    } catch (...) {
      failures.add(index, "an exception of unknown type");
      return;
    }
    progress.finish(journal, result);
  });
}

void refuse_points_of_others(const Journal& journal, const Shard& shard) {
  for (const PointResult& result : journal.finished()) {
    if (result.index % shard.count == shard.index - 1) continue;
    throw std::invalid_argument(fmt::format(
        "the journal of shard {}/{} holds point {}, which is not of this shard; was a file renamed? Use "
        "another --out folder, or --restart",
        shard.index, shard.count, result.index));
  }
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.index);
  bool good = first == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [rest, second] = std::from_chars(slash + 1, end, shard.count);
    good = second == std::errc() && rest == end && shard.index >= 1 && shard.index <= shard.count;
  }
  if (!good)
    throw std::invalid_argument(fmt::format("'{}' is no shard; write i/n with 1 <= i <= n, e.g. 2/3", text));
  return shard;
}

std::string program_version() {
  const std::string commit = built_from_commit();
  if (!commit.ends_with("-dirty") && commit != "unknown") return commit;
  return fmt::format("{} {}", commit, fingerprint_of_files({"/proc/self/exe"}));
}

std::vector<PointResult> run_study(const Study& study, const StudyCheck& check, const TrialFunction& trial,
                                   const std::filesystem::path& out, const StudyOptions& options) {
  const CheckedInputs inputs = check_inputs(study, check, options.jobs);
  const JournalHeader header{
      .study = study, .inputs = inputs.fingerprint, .commit = options.commit, .libm = libm_text()};
  prepare_output_folder(out);
  Journal journal(out / journal_name(options.shard.index, options.shard.count), header, options.restart);
  refuse_points_of_others(journal, options.shard);
  const std::vector<int> all = points_of(study, options.shard);
  const std::vector<int> left = without(all, journal.finished());
  if (options.shard.count == 1 && !left.empty()) remove_study_outputs(out);
  Progress progress(options, inputs.files, static_cast<int>(all.size()), journal.finished());
  Failures failures;
  const int jobs = options.jobs > 0 ? options.jobs : tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(jobs);
  arena.initialize();  // without memory for this, the end of an earlier global_control would wait without end
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(jobs));
  arena.execute([&] { measure_points(left, study, trial, inputs.files, journal, progress, failures); });
  failures.throw_if_any(study);
  return progress.results();
}

}  // namespace phalanx
