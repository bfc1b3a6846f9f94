// SPDX-License-Identifier: Apache-2.0
// What a recording costs: the station at 1 kHz in one process and one run, slices without a recording between slices with
// one; the time of the recorder's thread, and the size of the file; and what its encryption adds.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/core/nice_thread.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/simulation/press_intent.h"
#include "phalanx/station/session.h"
#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_reader.h"
#include "rounds.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kSettle = 0.5;  ///< at the beginning of a slice, not counted [s]

/// What slices of one kind came to, round by round.
struct Phase {
  std::string name;
  bool records = false;
  Rounds step{};
  Rounds lateness{};
  double seconds = 0.0;
  double processor = 0.0;  ///< time of the thread that fetches the steps [s]
  std::uint64_t bytes = 0;
};

double thread_seconds() {
  rusage use{};
  ::getrusage(RUSAGE_THREAD, &use);
  const auto of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return of(use.ru_utime) + of(use.ru_stime);
}

class Bench {
 public:
  explicit Bench(std::filesystem::path folder)
      : folder_(std::move(folder)),
        session_(settings(), clock_),
        recorder_(recorder_settings(), session_, clock_) {}
  ~Bench() {
    if (!finished_) finish();
    std::filesystem::remove_all(folder_);
  }

  /// Ends the recording. @returns its file, which the destructor deletes
  std::filesystem::path finish() {
    finished_ = true;
    session_.shut_down();
    recorder_.finish();
    return recorder_.status().file;
  }

  /// Runs a slice on a thread such as `phalanx run` records with.
  void run(double seconds, Phase& phase) {
    std::thread thread = start_nice_thread("phalanx-record", [&] { slice(seconds, phase); });
    while (!done_.exchange(false)) {
      session_.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    thread.join();
  }
  [[nodiscard]] std::string realtime() const { return session_.info()->realtime; }

 private:
  static SessionSettings settings() {
    SessionSettings settings;
    settings.scene = "grasp_teapot";
    settings.overrides = {{"rate_hz", "1000"}};
    settings.keep_changes = true;
    return settings;
  }
  [[nodiscard]] RecorderSettings recorder_settings() const {
    return {.folder = folder_, .least_room = 0, .metadata = recording_metadata("bench")};
  }

  void slice(double seconds, Phase& phase) {
    fetch(kSettle, phase, false);
    phase.step.emplace_back();
    phase.lateness.emplace_back();
    const double before = thread_seconds();
    const std::uint64_t bytes = recorder_.status().bytes;
    fetch(seconds, phase, true);
    phase.processor += thread_seconds() - before;
    phase.seconds += seconds;
    phase.bytes += recorder_.status().bytes - bytes;
    done_ = true;
  }

  void fetch(double seconds, Phase& phase, bool counts) {
    const auto end = std::chrono::steady_clock::now() + Seconds(seconds);
    StepRecord record;
    std::vector<DeviceSample> samples;
    while (std::chrono::steady_clock::now() < end) {
      while (session_.next_record(record, samples)) {
        if (phase.records) recorder_.add(record, samples);
        if (!counts) continue;
        phase.step.back().push_back(record.duration * 1e6);
        phase.lateness.back().push_back(record.lateness * 1e6);
      }
      if (phase.records) recorder_.update();
      std::this_thread::sleep_for(std::chrono::microseconds(16'667));
    }
  }

  const Clock clock_;
  const std::filesystem::path folder_;
  Session session_;
  SessionRecorder recorder_;
  std::atomic<bool> done_{false};
  bool finished_ = false;
};

std::string text(const Ratio& ratio) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio.value, ratio.low, ratio.high);
}

void print(const Phase& phase, const Phase& none) {
  fmt::print("| {} | {:.1f} | {} | {:.1f} | {} | {:.2f} % |\n", phase.name, percentile(phase.step, 99.9),
             text(ratio(phase.step, none.step, 99.9)), percentile(phase.lateness, 99.9),
             text(ratio(phase.lateness, none.lateness, 99.9)), 100.0 * phase.processor / phase.seconds);
}

/// A file that keeps what is written in memory that it has already.
class KeptInMemory final : public mcap::WritableFile {
 public:
  explicit KeptInMemory(std::size_t most) { bytes_.reserve(most); }
  void write(std::uint64_t place, std::string_view bytes) override {
    bytes_.resize(static_cast<std::size_t>(place));
    bytes_.append(bytes);
  }
  void synchronise() override {}
  void truncate(std::uint64_t size) override { bytes_.resize(static_cast<std::size_t>(size)); }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

double part_of(std::vector<double>& values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Encrypts the chunks of a whole recording as a recorder writes them, decrypts them, and prints the times of
/// a frame and the bytes that are added. Nothing is written to a disk. @param rounds  over all chunks
void report_encryption(const std::filesystem::path& recording, int rounds) {
  const mcap::ReadableFile file(recording);
  const mcap::Summary summary = mcap::read_summary(file);
  std::vector<std::string> writes;
  std::uint64_t place = 0;
  for (const mcap::ChunkEntry& chunk : summary.chunks) {
    file.read(place, chunk.place - place, writes.emplace_back());
    place = chunk.place;
  }
  file.read(place, file.size() - place, writes.emplace_back());
  const RecordingEncryption encryption{.id = std::string(RecordingEncryption::kIdLength, 'a'), .key = {}};
  std::vector<double> encrypting;
  std::vector<double> decrypting;
  std::uint64_t encrypted_bytes = 0;
  for (int round = 0; round < rounds; ++round) {
    KeptInMemory disk(static_cast<std::size_t>(2 * file.size()));
    mcap::EncryptedFile encrypted(disk, encryption);
    place = 0;
    for (const std::string& write : writes) {
      const Stopwatch watch;
      encrypted.write(place, write);
      encrypting.push_back(watch.us());
      place += write.size();
    }
    encrypted_bytes = disk.bytes().size();
    const mcap::ReadableFile decrypted(mcap::InMemory{disk.bytes()},
                                       [&](const std::string&) { return std::optional(encryption.key); });
    place = 0;
    std::string part;
    for (const std::string& write : writes) {
      const Stopwatch watch;
      decrypted.read(place, write.size(), part);
      decrypting.push_back(watch.us());
      place += write.size();
    }
  }
  const auto bytes = static_cast<double>(file.size());
  fmt::print(
      "\nencrypted: {} frames of {:.0f} bytes; encrypting one takes {:.1f} us (median; 99 %: {:.1f}), "
      "decrypting {:.1f} ({:.1f}); {:.3f} % more bytes\n",
      writes.size(), bytes / static_cast<double>(writes.size()), part_of(encrypting, 0.5),
      part_of(encrypting, 0.99), part_of(decrypting, 0.5), part_of(decrypting, 0.99),
      100.0 * (static_cast<double>(encrypted_bytes) / bytes - 1.0));
}

}  // namespace

/// A slice is whole squeezes of the simulated patient, or the slices would not hold the same work.
int run(double squeezes, int rounds) {
  const double seconds = squeezes * TrialSchedule{}.end;
  const mesh::IsolationHelper helper;  // forks: before all threads
  Bench bench(std::filesystem::temp_directory_path() / fmt::format("phalanx_bench_recording_{}", ::getpid()));
  Phase none{"no recording"};
  Phase again{"no recording, once more"};
  Phase recording{"recording", true};
  Phase warm{"warm", true};
  bench.run(seconds, warm);
  fmt::print("real time: {}\n\n", bench.realtime());
  for (int round = 0; round < rounds; ++round)
    for (Phase* phase : {&none, &recording, &again}) bench.run(seconds, *phase);
  fmt::print(
      "| slices | step p99.9 [us] | ratio | woken late p99.9 [us] | ratio | recorder's thread "
      "|\n|---|---|---|---|---|---|\n");
  print(none, none);
  print(again, none);
  print(recording, none);
  fmt::print(
      "\nratios to the first line, with the middle 95 % of what rounds drawn anew give\n{:.1f} MB in 10 "
      "minutes at 1 kHz\n",
      1e-6 * static_cast<double>(recording.bytes) / recording.seconds * 600.0);
  report_encryption(bench.finish(), 20);
  return 0;
}

}  // namespace phalanx::bench

int main(int argc, char** argv) {
  const double squeezes = argc > 1 ? std::strtod(argv[1], nullptr) : 1.0;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 12;
  if (!(squeezes > 0.0) || rounds < 1) {
    fmt::print(stderr, "usage: phalanx_bench_recording [SQUEEZES OF 5.3 s IN A SLICE [ROUNDS]]\n");
    return 2;
  }
  return phalanx::bench::run(squeezes, rounds);
}
