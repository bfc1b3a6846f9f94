// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/step_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"
#include "record/plain_text.h"
#include "record/recording/foxglove_message.h"
#include "record/recording/geometry_message.h"
#include "record/recording/own_steps.h"
#include "record/recording/setup_message.h"
#include "record/recording/topics.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

constexpr double kBetweenShown = 1.0 / 60.0;       // [s]
constexpr double kChunk = 0.2;                     // [s]
constexpr std::size_t kLargeOwnChunk = 8U << 20U;  // is written before its time [bytes]
constexpr std::size_t kOwnEventLength = 4000;      // [bytes]

std::int64_t utc_now() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(system_clock::now().time_since_epoch()).count();
}

std::unique_ptr<mcap::DiskFile> make_file(const std::filesystem::path& name) {
  if (name.extension() != ".mcap")
    throw std::invalid_argument(fmt::format("{}: the name of a recording ends with .mcap", name.string()));
  try {
    return std::make_unique<mcap::DiskFile>(name);
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("the recording {} cannot be written ({}); name another file",
                                         name.string(), error.code().message()));
  }
}

}  // namespace

struct StepRecorder::Impl {
  Impl(const std::filesystem::path& given, const SessionGeometry& geometry, StepRecorderSettings settings)
      : name(given),
        file(make_file(given)),
        writer(*file, recording_schemas(true), recording_channels(true), {{"phalanx", settings.metadata}}) {
    wire::ClockPair clock;
    clock.set_monotonic(0.0);
    clock.set_utc_ns(begin_utc);
    put(Topic::kClock, clock);
    {
      wire::Geometry shown;  // not kept: an object may have millions of triangles
      write_geometry(geometry, shown);
      put_shown(Topic::kGeometry, shown);
    }
    {
      foxglove::SceneUpdate meshes;
      write_meshes(geometry, time_of(), meshes);
      put_shown(Topic::kMeshes, meshes);
    }
    wire::Setup setup;
    write_own_setup(geometry, settings.scene, settings.values, setup);
    put(Topic::kSetup, setup);
  }

  [[nodiscard]] std::uint64_t time_of() const noexcept {
    return static_cast<std::uint64_t>(begin_utc + std::llround(1e9 * now));
  }

  void put(Topic topic, const google::protobuf::MessageLite& message) {
    if (finished) throw std::runtime_error(fmt::format("{}: the recording is finished", name.string()));
    bytes.clear();
    message.SerializeToString(&bytes);
    writer.add(static_cast<std::uint16_t>(topic), time_of(), bytes);
  }

  /// Writes what only tools show. A large one gets a chunk of its own, and none above half of a chunk's
  /// largest size.
  void put_shown(Topic topic, const google::protobuf::MessageLite& message) {
    const std::size_t size = message.ByteSizeLong();
    if (size > mcap::kMostBytes / 2) return;
    if (size > kLargeOwnChunk) write();
    put(topic, message);
    if (size > kLargeOwnChunk) write();
  }

  void write() {
    try {
      writer.write_chunk();
      next_chunk = now + kChunk;
    } catch (const std::system_error& error) {
      throw std::runtime_error(
          fmt::format("{}: the disk refuses ({})", name.string(), error.code().message()));
    }
  }

  /// Moves the time of messages on; a sample whose time does not increase has that of the one before.
  void move_to(double time_s) noexcept {
    if (!std::isfinite(time_s)) return;
    if (!begun) first_time = time_s;
    begun = true;
    constexpr double kLongest = 1e9;  // [s]: the time fits into its 64 bits
    now = std::max(now, std::min(time_s - first_time, kLongest));
  }

  void put_gap(std::uint64_t next) {
    if (next <= tick + 1) return;
    wire::Gap gap;
    gap.set_station(1);
    gap.set_first_tick(tick + 1);
    gap.set_last_tick(next - 1);
    gap.set_why("they were not added");
    put(Topic::kGap, gap);
  }

  void show(const OwnStep& step) {
    view.time = step.sample.time_s;
    view.tick = step.snapshot.tick;
    view.station = 1;
    view.snapshot = step.snapshot;
    view.stiffness = step.stiffness;
    view.sent = step.snapshot.torque;
    view.state = SafetyState::kRunning;
    view.factor = 1.0;
    view.at_rest =
        std::all_of(view.sent.begin(), view.sent.end(), [](double torque) { return torque == 0.0; });
    write_tick(view, pose);
    put(Topic::kPose, pose);
    write_frames(view, time_of(), frames);
    put(Topic::kFrames, frames);
    const bool any = write_forces(view, time_of(), forces) > 0;
    if (any || arrows_shown) put(Topic::kForces, forces);
    arrows_shown = any;
  }

  const std::filesystem::path name;
  std::unique_ptr<mcap::DiskFile> file;
  mcap::McapWriter writer;
  const std::int64_t begin_utc = utc_now();
  bool begun = false;
  bool finished = false;
  bool arrows_shown = false;  ///< by the newest of Topic::kForces
  double first_time = 0.0;    ///< of the first sample [s]
  double now = 0.0;           ///< since then [s]
  double next_chunk = kChunk;
  double next_shown = 0.0;
  std::uint64_t tick = 0;  ///< of the newest step
  std::string bytes;
  StationView view;
  wire::Step recorded;
  wire::Tick pose;
  foxglove::FrameTransforms frames;
  foxglove::SceneUpdate forces;
};

StepRecorder::StepRecorder(const std::filesystem::path& file, const SessionGeometry& geometry,
                           StepRecorderSettings settings)
    : impl_(std::make_unique<Impl>(file, geometry, std::move(settings))) {}
StepRecorder::StepRecorder(StepRecorder&&) noexcept = default;
StepRecorder& StepRecorder::operator=(StepRecorder&&) noexcept = default;
StepRecorder::~StepRecorder() = default;

void StepRecorder::change(std::uint64_t number, const Overrides& values) {
  SessionChange change;
  change.station = 1;
  change.number = number;
  change.values = values;
  wire::Change out;
  write_change(change, out);
  impl_->put(Topic::kChange, out);
}

void StepRecorder::add(const OwnStep& step) {
  Impl& impl = *impl_;
  impl.move_to(step.sample.time_s);
  impl.put_gap(step.snapshot.tick);
  impl.tick = step.snapshot.tick;
  const bool shown = impl.now >= impl.next_shown;
  write_own_step(step, shown, impl.recorded);
  impl.put(Topic::kStep, impl.recorded);
  if (shown) {
    impl.next_shown = std::max(impl.next_shown + kBetweenShown, impl.now);
    impl.show(step);
  }
  if (impl.now >= impl.next_chunk || impl.writer.open_bytes() > kLargeOwnChunk) impl.write();
}

void StepRecorder::event(const std::string& code, const std::string& who, const std::string& text) {
  wire::Event event;
  event.set_code(as_utf8(code));
  event.set_who(as_utf8(who));
  event.set_text(shortened(as_utf8(text), kOwnEventLength));
  impl_->put(Topic::kEvent, event);
}

void StepRecorder::finish() {
  Impl& impl = *impl_;
  if (impl.finished) return;
  try {
    impl.writer.finish();
    impl.finished = true;
    impl.file.reset();  // no longer locked: other programs see that it is whole
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("{}: the disk refuses ({})", impl.name.string(), error.code().message()));
  }
}

}  // namespace phalanx
