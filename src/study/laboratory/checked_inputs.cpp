// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/checked_inputs.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/scene/scene.h"
#include "study/laboratory/fingerprint.h"

namespace phalanx {
namespace {

/// Exception of the smallest index that threw.
class FirstException {
 public:
  [[nodiscard]] bool is_before(int index) const { return index_ < index; }
  void add_current(int index) {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (index >= index_) return;
    index_ = index;
    exception_ = std::current_exception();
  }
  void rethrow_if_any() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::atomic<int> index_ = std::numeric_limits<int>::max();
  std::exception_ptr exception_;
};

/// Calls `function` with 0 .. count - 1 on several threads, which have ended when it returns, so that a process may
/// fork after it. @throws as `function` with the smallest index for which it throws
void for_each_on_threads(int count, int threads, const std::function<void(int)>& function) {
  std::atomic<int> next{0};
  FirstException first;
  const auto work = [&] {
    for (int i; (i = next++) < count && !first.is_before(i);) {
      try {
        function(i);
      } catch (...) {
        first.add_current(i);
      }
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (int i = 1; i < std::min(threads, count); ++i) others.emplace_back(work);
    } catch (
        const std::system_error&) {  // the system has no further thread: those that there are do the work
    }
    work();
  }
  first.rethrow_if_any();
}

[[noreturn]] void refuse_changing(const std::filesystem::path& file) {
  throw std::runtime_error(
      fmt::format("{}: changed while the points were checked; nothing was begun, type the same command again",
                  file.string()));
}

}  // namespace

InputFiles::State InputFiles::state_of(const std::filesystem::path& file) noexcept {
  struct stat now{};
  if (::stat(file.c_str(), &now) != 0) return {};
  return {.device = now.st_dev,
          .inode = now.st_ino,
          .size = static_cast<std::int64_t>(now.st_size),
          .seconds = now.st_mtim.tv_sec,
          .nanoseconds = now.st_mtim.tv_nsec};
}

bool InputFiles::add(const std::filesystem::path& file) {
  const auto place = states_.lower_bound(file);
  if (place != states_.end() && place->first == file) return false;
  states_.emplace_hint(place, file, state_of(file));
  return true;
}

const std::filesystem::path* InputFiles::changed() const {
  for (const auto& [file, state] : states_) {
    if (state_of(file) != state) return &file;
  }
  return nullptr;
}

void InputFiles::refuse_changed() const {
  if (const std::filesystem::path* file = changed())
    throw InputsChanged(fmt::format(
        "{}: was changed or removed while the study ran, so that points may have been measured with "
        "either content; those that were finished before are kept. Restore the file and type the "
        "same command again, or measure all with the new content (--restart)",
        file->string()));
}

TrialFunction checked_trial(const TrialFunction& trial, const InputFiles& files) {
  return [&trial, &files](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    TrialResult result;
    try {
      result = trial(overrides, stiffness, press, seed);
    } catch (...) {
      files.refuse_changed();
      throw;
    }
    files.refuse_changed();
    return result;
  };
}

CheckedInputs check_inputs(const Study& study, const StudyCheck& check, int jobs) {
  constexpr int kTogether = 4096;  // points whose inputs are in memory
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = jobs > 0 ? std::min(jobs, cores) : cores;
  const int points = point_count(study);
  Fingerprint texts;
  std::set<std::filesystem::path> files;
  InputFiles states;
  std::vector<StudyInputs> inputs;
  for (int begin = 0; begin < points; begin += kTogether) {
    inputs.assign(static_cast<std::size_t>(std::min(kTogether, points - begin)), {});
    for_each_on_threads(static_cast<int>(inputs.size()), threads, [&](int i) {
      const StudyPoint point = study_point(study, begin + i);
      try {
        inputs[static_cast<std::size_t>(i)] = check(point_overrides(study, point));
      } catch (const std::invalid_argument& error) {
        throw SceneError(fmt::format("study {}, point {} ({}): {}", study.name, begin + i,
                                     point_text(study, point), error.what()));
      }
    });
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      StudyInputs& input = inputs[i];
      std::filesystem::path first_new;
      for (const auto* list : {&input.read, &input.files}) {
        for (const auto& file : *list) {
          if (states.add(file) && first_new.empty()) first_new = file;
        }
      }
      // It was read before its state was: what is read since must be the same.
      if (!first_new.empty()) {
        const StudyPoint point = study_point(study, begin + static_cast<int>(i));
        StudyInputs again;
        try {
          again = check(point_overrides(study, point));
        } catch (const std::invalid_argument&) {  // it was valid a moment ago
          refuse_changing(first_new);
        }
        if (again.text != input.text || again.read != input.read || again.files != input.files)
          refuse_changing(first_new);
      }
      texts.add(input.text);
      for (auto& file : input.files) files.insert(std::move(file));
    }
  }
  std::string fingerprint = texts.text() + fingerprint_of_files({files.begin(), files.end()});
  if (const auto* file = states.changed()) refuse_changing(*file);
  return {.fingerprint = std::move(fingerprint), .files = std::move(states)};
}

std::string check_study(const Study& study, const StudyCheck& check, int jobs) {
  return check_inputs(study, check, jobs).fingerprint;
}

}  // namespace phalanx
