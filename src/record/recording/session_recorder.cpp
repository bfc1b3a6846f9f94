// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/session_recorder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <ctime>
#include <deque>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/record/change_reader.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/record/retention.h"
#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"
#include "record/plain_text.h"
#include "record/recording/foxglove_message.h"
#include "record/recording/geometry_message.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"
#include "record/recording/topics.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

constexpr double kBetweenPoses = 1.0 / 60.0;           // [s]
constexpr double kBetweenLoops = 1.0;                  // statistics of deadlines [s]
constexpr double kBetweenClocks = 10.0;                // pairs of clocks [s]
constexpr std::size_t kLargeChunk = 8U << 20U;         // is written before its time [bytes]
constexpr std::size_t kEventLength = 4000;             // [bytes]
constexpr std::size_t kExerciseEventLength = 200'000;  // of what a replay of an exercise needs [bytes]
constexpr std::size_t kMostWaitingEvents = 1000;
constexpr double kBetweenTries = 0.2;  // of a disk that refuses [s]
constexpr const char* kTooFast = "they came faster than they were fetched";
constexpr const char* kRefused = "the disk did not take them";
constexpr const char* kNoMemory = "there was no memory for them";

std::int64_t utc_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// @returns true for an event without which an exercise cannot be carried out again (record/exercise/exercise_events.h)
bool is_of_exercise(const std::string& code) { return code.starts_with("exercise_"); }

std::uint64_t free_bytes(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder.empty() ? "." : folder, error);
  return error ? 0 : space.available;
}

/// Makes a file whose name is free. Two programs that start within a second get two files.
std::unique_ptr<mcap::WritableFile> new_file(const RecorderSettings& settings, std::filesystem::path& name) {
  check_recordings_folder(settings);
  const std::string date = fmt::format("{:%Y-%m-%dT%H-%M-%SZ}", fmt::gmtime(std::time(nullptr)));
  for (int i = 1;; ++i) {
    name = settings.folder / fmt::format("{}{}.mcap{}", date, i == 1 ? std::string() : fmt::format("-{}", i),
                                         settings.encryption ? ".enc" : "");
    try {
      return std::make_unique<mcap::DiskFile>(name);
    } catch (const std::system_error& error) {
      if (error.code() != std::errc::file_exists) throw;
    }
  }
}

}  // namespace

void check_recordings_folder(const RecorderSettings& settings) {
  prepare_output_folder(settings.folder);
  const std::uint64_t room = free_bytes(settings.folder);
  if (room < settings.least_room)
    throw std::invalid_argument(fmt::format(
        "the folder of recordings, {}, has {} MB of room left, and a recording needs at least {} MB to "
        "begin; make room, name another folder with --record DIR, or record nothing with --record off",
        settings.folder.string(), room >> 20U, settings.least_room >> 20U));
  if (!settings.quota) return;
  const std::uint64_t used = recorded_bytes(settings.folder);
  if (used >= *settings.quota)
    throw std::invalid_argument(
        fmt::format("the recordings of {} have {:.1f} GB, and --record-quota-gb allows {:.1f} GB; delete "
                    "some with `phalanx session "
                    "delete` or `phalanx session prune`, allow more, or record nothing with --record off",
                    settings.folder.string(), 1e-9 * static_cast<double>(used),
                    1e-9 * static_cast<double>(*settings.quota)));
}

namespace {

/// @returns null if the settings do not encrypt
std::unique_ptr<mcap::WritableFile> encrypting(mcap::WritableFile& file, const RecorderSettings& settings) {
  return settings.encryption ? std::make_unique<mcap::EncryptedFile>(file, *settings.encryption) : nullptr;
}

/// @returns the room that is left for recordings. @param others  bytes of the folder's other recordings
std::uint64_t room_left(const RecorderSettings& settings, const std::filesystem::path& folder,
                        std::uint64_t others, std::uint64_t own) {
  const std::uint64_t disk = free_bytes(folder);
  if (!settings.quota) return disk;
  const std::uint64_t used = others + own;
  return std::min(disk, *settings.quota > used ? *settings.quota - used : 0);
}

}  // namespace

std::map<std::string, std::string> recording_metadata(const std::string& version) {
  const Made made = made_here();
  return {{"version", version},
          {"commit", made.commit},
          {"cpu", made.cpu},
          {"compiler", made.compiler},
          {"build_type", made.build_type},
          {"libm", fmt::format("{:016x}", libm_fingerprint())},
          {"exact", "/setup /change /step: from these every step can be computed again, to the last bit"},
          {"derived",
           "/geometry, /pose, /foxglove/*, hcp_angle and gdp_angle of /step: about 60 a second, computed "
           "from the samples"}};
}

struct SessionRecorder::Impl {
  Impl(RecorderSettings given, Session& of_session, const Clock& process_clock,
       std::filesystem::path given_name, std::unique_ptr<mcap::WritableFile> given_file,
       std::shared_ptr<ChangeReader> given_changes)
      : settings(std::move(given)),
        session(of_session),
        changes(given_changes ? std::move(given_changes) : std::make_shared<ChangeReader>(of_session)),
        clock(process_clock),
        name(std::move(given_name)),
        file(std::move(given_file)),
        encrypted(encrypting(*file, settings)),
        writer(encrypted ? *encrypted : *file, recording_schemas(settings.foxglove),
               recording_channels(settings.foxglove), {{"phalanx", settings.metadata}}),
        begin_mono(clock.now()),
        begin_utc(utc_ns()) {
    now_bytes = writer.size();
    others = settings.quota ? recorded_bytes(name.parent_path()) : 0;
    now_free = room_left(settings, name.parent_path(), others, 0);
    put_clock(begin_mono);
  }

  // ---- the recorder's thread
  void add(const StepRecord& record, std::span<const DeviceSample> samples);
  void put_step(const StepRecord& record, std::span<const DeviceSample> samples, double now);
  void update();
  void put_clock(double now);
  void put_events();
  void put_change(const SessionChange& change, double now);
  void put_geometry(const SessionGeometry& next, double now);
  void put_large(Topic topic, double now, const google::protobuf::MessageLite& message);
  void put_scene(const StationView& view);
  void fetch_station(const StepRecord& record);
  void fetch_change(std::uint64_t number, double now);
  void end_station(std::uint64_t of, std::uint64_t last, double now);
  void put_last_changes(double now);
  void lost(std::uint64_t first, std::uint64_t last, const char* why) noexcept;
  void put_gap(double now);
  bool write(double now) noexcept;
  void say_trouble(const std::exception& error) noexcept;
  /// @returns true if the disk refuses, and no more may wait. (A large model alone is written with the next update().)
  [[nodiscard]] bool is_full() const noexcept {
    return writer.pending() && writer.open_bytes() > kMostWaitingBytes;
  }
  [[nodiscard]] std::uint64_t time_of(double mono) const noexcept {
    return static_cast<std::uint64_t>(begin_utc + std::llround((mono - begin_mono) * 1e9));
  }
  void put(Topic topic, double now, const google::protobuf::MessageLite& message) {
    bytes.clear();
    message.SerializeToString(&bytes);
    writer.add(static_cast<std::uint16_t>(topic), time_of(now), bytes);
    if (oldest.load() == 0.0) oldest = now;
  }

  const RecorderSettings settings;
  Session& session;
  const std::shared_ptr<ChangeReader> changes;
  const Clock& clock;
  std::filesystem::path name;
  std::unique_ptr<mcap::WritableFile> file;
  std::unique_ptr<mcap::WritableFile> encrypted;  ///< over `file`; null: it is written as it is
  mcap::McapWriter writer;
  const double begin_mono;
  const std::int64_t begin_utc;

  std::uint64_t others = 0;   ///< bytes of the folder's recordings at the beginning
  std::uint64_t station = 0;  ///< of the newest step
  std::uint64_t tick = 0;     ///< of the newest step in the file, or in its gap
  std::uint64_t change = 0;   ///< newest that was fetched
  std::size_t channels = 0;   ///< of the device
  double steps_to_angles = 0.0;
  double period = 1e-3;
  /// Steps that are missing, and of which the file does not say so yet.
  struct Missing {
    std::uint64_t station = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;  ///< 0: none
    const char* why = "";
  };
  Missing missing;
  std::uint64_t until = 0;  ///< first station that another recorder takes; 0: none
  double next_pose = 0.0;
  double next_loop = 0.0;
  double next_clock = 0.0;
  double next_try = 0.0;
  std::uint64_t posed = 0;  ///< tick of the newest pose
  std::string bytes;
  wire::Step step;
  wire::Tick pose;
  wire::Setup setup;
  wire::Change changed;
  foxglove::FrameTransforms frames;
  foxglove::SceneUpdate forces;
  bool arrows_shown = false;  ///< by the newest of Topic::kForces

  // ---- shared
  struct TimedEvent {
    std::string code, who, text;
    double time = 0.0;
  };
  mutable std::mutex mutex;
  std::deque<TimedEvent> events;
  std::uint64_t events_lost = 0;  ///< that came while too many waited
  std::string trouble;
  std::atomic<double> oldest{0.0};  ///< time of the oldest message that is not on the disk [s]; 0: none
  std::atomic<std::uint64_t> now_bytes{0};
  std::atomic<std::uint64_t> now_free{0};
  std::atomic<std::uint64_t> lost_steps{0};
};

void SessionRecorder::Impl::add(const StepRecord& record, std::span<const DeviceSample> samples) {
  const double now = record.input.time;
  if (record.station != station) fetch_station(record);
  if (record.command.tick > tick + 1) lost(tick + 1, record.command.tick - 1, kTooFast);
  tick = record.command.tick;
  if (is_full()) return lost(tick, tick, kRefused);
  try {
    put_step(record, samples, now);
  } catch (...) {
    lost(tick, tick, kNoMemory);
    throw;
  }
}

void SessionRecorder::Impl::put_step(const StepRecord& record, std::span<const DeviceSample> samples,
                                     double now) {
  put_gap(now);
  if (record.input.exchanged > change) fetch_change(record.input.exchanged, now);
  if (record.input.changed > change) fetch_change(record.input.changed, now);
  steps_to_angles -= 1.0;
  const bool with_angles = steps_to_angles <= 0.0;
  if (with_angles) steps_to_angles += kBetweenPoses / period;
  write_step(record, samples, channels, with_angles, step);
  put(Topic::kStep, now, step);
}

/// Writes the setups up to that of the station whose first step this is.
void SessionRecorder::Impl::fetch_station(const StepRecord& record) {
  while (station != record.station) {
    const SessionChange* next = changes->next();
    if (next == nullptr) return;
    put_change(*next, record.input.time);
    changes->pop();
  }
}

/// Names the steps that are missing at a station's end. @param last  number of its last step
void SessionRecorder::Impl::end_station(std::uint64_t of, std::uint64_t last, double now) {
  if (of == station && station != 0 && last > tick) {
    lost(tick + 1, last, kTooFast);
    tick = last;
  }
  put_gap(now);
}

void SessionRecorder::Impl::fetch_change(std::uint64_t number, double now) {
  while (change < number) {
    const SessionChange* next = changes->next();
    if (next == nullptr) return;
    put_change(*next, now);
    changes->pop();
  }
}

/// Writes the changes that no step has named, and the gap before the recording's end.
void SessionRecorder::Impl::put_last_changes(double now) {
  for (const SessionChange* next = changes->next(); next != nullptr; next = changes->next()) {
    if (until != 0 && next->station >= until) break;
    put_change(*next, now);
    changes->pop();
  }
  if (until != 0) return;  // end_before() has named the last step
  const StationView last = session.view();
  end_station(last.station, last.tick, now);
}

void SessionRecorder::Impl::put_change(const SessionChange& next, double now) {
  if (next.number != 0) {
    if (next.geometry) put_geometry(*next.geometry, now);
    write_change(next, changed);
    put(Topic::kChange, now, changed);
    change = next.number;
    return;
  }
  end_station(next.last_station, next.last_tick, now);
  channels = next.setup->channels.size();
  period = 1.0 / next.geometry->rate_hz;
  put_geometry(*next.geometry, now);
  write_change(next, session.settings().device, setup);
  put(Topic::kSetup, now, setup);
  station = next.station;
  tick = 0;
  steps_to_angles = 0.0;
}

/// Writes what pages and other tools show from now on. It comes before what else is written of a change: without memory, the
/// change is tried again, and a second copy of this does no harm.
void SessionRecorder::Impl::put_geometry(const SessionGeometry& next, double now) {
  {
    wire::Geometry geometry;  // not kept: an object may have millions of triangles
    write_geometry(next, geometry);
    put_large(Topic::kGeometry, now, geometry);
  }
  if (!settings.foxglove) return;
  foxglove::SceneUpdate meshes;
  write_meshes(next, time_of(now), meshes);
  put_large(Topic::kMeshes, now, meshes);
}

/// Writes a derived message. A large one gets a chunk of its own, since readers take chunks of a limited size. It is left out
/// while the disk refuses, and above half of that size.
void SessionRecorder::Impl::put_large(Topic topic, double now, const google::protobuf::MessageLite& message) {
  const std::size_t size = message.ByteSizeLong();
  if (size <= kLargeChunk) return put(topic, now, message);
  if (size > mcap::kMostBytes / 2) return;
  if (!write(now)) return;
  put(topic, now, message);
  write(now);
}

void SessionRecorder::Impl::put_scene(const StationView& view) {
  write_frames(view, time_of(view.time), frames);
  put(Topic::kFrames, view.time, frames);
  const bool any = write_forces(view, time_of(view.time), forces) > 0;
  if (any || arrows_shown) put(Topic::kForces, view.time, forces);
  arrows_shown = any;
}

/// Notes steps that are lost; the gap is written before the next step.
void SessionRecorder::Impl::lost(std::uint64_t first, std::uint64_t last, const char* why) noexcept {
  if (missing.last == 0) missing = {.station = station, .first = first, .last = last, .why = why};
  missing.last = last;
  lost_steps += last - first + 1;
}

void SessionRecorder::Impl::put_gap(double now) {
  if (missing.last == 0) return;
  wire::Gap gap;
  gap.set_station(missing.station);
  gap.set_first_tick(missing.first);
  gap.set_last_tick(missing.last);
  gap.set_why(missing.why);
  put(Topic::kGap, now, gap);
  missing = {};
}

void SessionRecorder::Impl::put_clock(double now) {
  wire::ClockPair pair;
  pair.set_monotonic(clock.now());
  pair.set_utc_ns(utc_ns());
  put(Topic::kClock, now, pair);
}

void SessionRecorder::Impl::put_events() {
  for (;;) {
    std::unique_lock lock(mutex);
    if (events.empty() && events_lost > 0) {
      const std::uint64_t lost = std::exchange(events_lost, 0);
      events.push_back({.code = "events_lost",
                        .who = {},
                        .text = fmt::format("{} events came faster than they could be written", lost),
                        .time = clock.now()});
    }
    if (events.empty()) return;
    const TimedEvent next = std::move(events.front());
    events.pop_front();
    lock.unlock();
    wire::Event event;
    event.set_code(as_utf8(next.code));
    event.set_who(as_utf8(next.who));
    event.set_text(
        shortened(as_utf8(next.text), is_of_exercise(next.code) ? kExerciseEventLength : kEventLength));
    put(Topic::kEvent, next.time, event);
  }
}

void SessionRecorder::Impl::update() {
  const double now = clock.now();
  if (!is_full()) {
    put_events();
    if (now >= next_pose) {
      next_pose = std::max(next_pose + kBetweenPoses, now);
      const StationView view = session.view();
      // The next station may be another recording's.
      if (view.time > 0.0 && view.station == station && view.snapshot.tick != posed) {
        posed = view.snapshot.tick;
        write_tick(view, pose);
        put(Topic::kPose, view.time, pose);
        if (settings.foxglove) put_scene(view);
      }
    }
    if (now >= next_loop) {
      next_loop = now + kBetweenLoops;
      wire::Loop loop;
      write_loop(session.deadlines(), loop);
      put(Topic::kLoop, now, loop);
      now_free = room_left(settings, name.parent_path(), others, writer.size());
    }
    if (now >= next_clock) {
      next_clock = now + kBetweenClocks;
      put_clock(now);
    }
  }
  const double since = oldest.load();
  const bool due = since != 0.0 && now - since >= kChunkSeconds;
  if ((due || writer.open_bytes() > kLargeChunk) && now >= next_try) write(now);
}

/// Writes the chunk. @returns false if the disk refuses
bool SessionRecorder::Impl::write(double now) noexcept {
  try {
    writer.write_chunk();
    oldest = 0.0;
    now_bytes = writer.size();
    const std::lock_guard lock(mutex);
    trouble.clear();
    return true;
  } catch (const std::exception& error) {
    next_try = now + kBetweenTries;
    say_trouble(error);
    return false;
  }
}

void SessionRecorder::Impl::say_trouble(const std::exception& error) noexcept {
  const std::lock_guard lock(mutex);
  try {
    trouble = error.what();
  } catch (const std::bad_alloc&) {
    trouble = "no memory";  // short: needs none
  }
}

std::unique_ptr<SessionRecorder::Impl> SessionRecorder::begun(RecorderSettings settings, Session& session,
                                                              const Clock& clock,
                                                              std::shared_ptr<ChangeReader> changes) {
  std::filesystem::path name;
  try {
    auto file = new_file(settings, name);
    return std::make_unique<Impl>(settings, session, clock, name, std::move(file), std::move(changes));
  } catch (const std::system_error& error) {
    std::error_code ignored;
    std::filesystem::remove(name, ignored);  // it holds nothing
    throw std::runtime_error(fmt::format(
        "the recording {} cannot be written ({}); name another folder with --record DIR, or record nothing "
        "with --record off",
        name.string(), error.code().message()));
  } catch (...) {
    std::error_code ignored;
    if (!name.empty()) std::filesystem::remove(name, ignored);
    throw;
  }
}

SessionRecorder::SessionRecorder(RecorderSettings settings, Session& session, const Clock& clock,
                                 std::shared_ptr<ChangeReader> changes)
    : impl_(begun(std::move(settings), session, clock, std::move(changes))) {}

SessionRecorder::SessionRecorder(RecorderSettings settings, Session& session, const Clock& clock,
                                 std::filesystem::path name, std::unique_ptr<mcap::WritableFile> file,
                                 std::shared_ptr<ChangeReader> changes)
    : impl_(std::make_unique<Impl>(std::move(settings), session, clock, std::move(name), std::move(file),
                                   std::move(changes))) {}

SessionRecorder::~SessionRecorder() = default;

void SessionRecorder::add(const StepRecord& record, std::span<const DeviceSample> samples) {
  impl_->add(record, samples);
}

void SessionRecorder::update() { impl_->update(); }

void SessionRecorder::end_before(std::uint64_t station) {
  Impl& impl = *impl_;
  impl.until = station;
  const double now = impl.clock.now();
  impl.put_last_changes(now);
  if (const SessionChange* next = impl.changes->beginning_of(station))
    impl.end_station(next->last_station, next->last_tick, now);
}

void SessionRecorder::discard() noexcept {
  std::error_code ignored;
  std::filesystem::remove(impl_->name, ignored);
}

bool SessionRecorder::finish() noexcept {
  Impl& impl = *impl_;
  const double now = impl.clock.now();
  try {
    impl.put_last_changes(now);
    impl.put_events();
    impl.put_clock(now);
    impl.writer.finish();
    impl.oldest = 0.0;
    impl.now_bytes = impl.writer.size();
    return true;
  } catch (const std::exception& error) {
    impl.say_trouble(error);
    return false;
  }
}

void SessionRecorder::event(const std::string& code, const std::string& who, const std::string& text) {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->events.size() >= kMostWaitingEvents && !is_of_exercise(code)) {
    ++impl_->events_lost;
    return;
  }
  impl_->events.push_back({.code = code, .who = who, .text = text, .time = impl_->clock.now()});
}

RecordingStatus SessionRecorder::status() const {
  const double since = impl_->oldest.load();
  RecordingStatus status{.file = impl_->name,
                         .bytes = impl_->now_bytes,
                         .free_bytes = impl_->now_free,
                         .unsaved = since == 0.0 ? 0.0 : std::max(0.0, impl_->clock.now() - since),
                         .lost_steps = impl_->lost_steps,
                         .trouble = {}};
  const std::lock_guard lock(impl_->mutex);
  status.trouble = impl_->trouble;
  return status;
}

}  // namespace phalanx
