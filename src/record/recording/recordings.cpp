// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/recording.pb.h"
#include "record/mcap/mcap_file.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Fills in what the file's beginning says: program, scene and device.
void read_begin(const mcap::ReadableFile& file, RecordingSummary& out) {
  mcap::McapReader reader(file);
  mcap::Message message;
  while (reader.next(message)) {
    if (out.begin == 0.0) out.begin = 1e-9 * static_cast<double>(message.time);
    if (reader.schema_of(message.channel) != "phalanx.wire.Setup") continue;
    wire::Setup setup;
    if (!setup.ParseFromArray(message.data.data(), static_cast<int>(message.data.size())))
      throw mcap::McapError("its first station does not match its schema");
    out.scene = setup.start().scene();
    out.device = setup.device_name();
    break;
  }
  if (const auto phalanx = reader.metadata().find("phalanx"); phalanx != reader.metadata().end())
    if (const auto version = phalanx->second.find("version"); version != phalanx->second.end())
      out.version = version->second;
}

void read_end(const mcap::ReadableFile& file, RecordingSummary& out) {
  const mcap::Summary summary = mcap::read_summary(file);
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  for (const mcap::ChunkEntry& chunk : summary.chunks) {
    first = first == 0 ? chunk.first : std::min(first, chunk.first);
    last = std::max(last, chunk.last);
  }
  out.begin = 1e-9 * static_cast<double>(first);
  out.seconds = 1e-9 * static_cast<double>(last - first);
  for (const mcap::Channel& channel : summary.channels) {
    const auto count = summary.messages.find(channel.id);
    if (count == summary.messages.end()) continue;
    if (channel.topic == "/step") out.steps = count->second;
    if (channel.topic == "/event") out.events = count->second;
    if (channel.topic == "/gap") out.gaps = count->second;
  }
}

/// @returns a name beside the file that is free
fs::path free_name(const fs::path& file, const std::string& ending) {
  fs::path name = file.string() + ending;
  std::error_code ignored;
  for (int i = 2; fs::exists(name, ignored); ++i) name = fmt::format("{}{}-{}", file.string(), ending, i);
  return name;
}

template <class Wire>
bool parsed(const mcap::Message& message, Wire& into) {
  return into.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()));
}

/// Calls `on_message(schema, message, time)` for each message of a recording; the time is that since its beginning [s].
/// @throws std::runtime_error naming the place and the remedy if the file is not whole
template <class OnMessage>
void for_each_message_of(const fs::path& name, const std::function<void(double)>& on_progress,
                         OnMessage on_message) {
  try {
    const mcap::ReadableFile file(name);
    mcap::McapReader reader(file);
    mcap::Message message;
    std::optional<std::uint64_t> begin;
    std::uint64_t told = 0;
    while (reader.next(message)) {
      if (!begin) begin = message.time;
      const double time = 1e-9 * (static_cast<double>(message.time) - static_cast<double>(*begin));
      on_message(reader.schema_of(message.channel), message, std::max(0.0, time));
      if (on_progress && reader.place() >= told) {
        on_progress(static_cast<double>(reader.place()) /
                    static_cast<double>(std::max<std::uint64_t>(1, file.size())));
        told = reader.place() + file.size() / 200;
      }
    }
  } catch (const mcap::McapError& error) {
    throw std::runtime_error(
        fmt::format("{}: {}; phalanx session repair FILE keeps what is whole", name.string(), error.what()));
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: cannot be read ({})", name.string(), error.code().message()));
  }
}

/// @returns the sum of the magnitudes on each digit, as asked of the motors [N]
DigitArray digit_forces(const wire::Tick& tick) {
  DigitArray force{};
  for (const wire::Contact& contact : tick.contact())
    if (const std::uint32_t digit = contact.segment() / kSegmentsPerDigit; digit < kDigits)
      force[digit] += static_cast<double>(tick.factor() * contact.force());
  return force;
}

}  // namespace

RecordingSummary summarise_recording(const fs::path& file) {
  RecordingSummary out;
  out.file = file;
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw std::invalid_argument(fmt::format(
        "there is no recording {}; `phalanx session list` shows those of the folder", file.string()));
  try {
    out.written = mcap::is_being_written(file);
    const mcap::ReadableFile readable(file);
    out.bytes = readable.size();
    out.has_end = mcap::has_end(readable);
    if (out.has_end) read_end(readable, out);
    read_begin(readable, out);
  } catch (const std::exception& trouble) {
    out.trouble = trouble.what();
  }
  return out;
}

std::vector<RecordingSummary> list_recordings(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".mcap") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<RecordingSummary> all;
  for (const fs::path& file : files)
    if (fs::is_regular_file(file, error)) all.push_back(summarise_recording(file));
  return all;
}

RepairedRecording repair_recording(const fs::path& file) {
  static_cast<void>(summarise_recording(file));
  if (mcap::is_being_written(file))
    throw std::invalid_argument(fmt::format("{} is being written; end that run first", file.string()));
  const fs::path made = file.string() + ".repairing";
  std::error_code ignored;
  fs::remove(made, ignored);  // of a repair that was interrupted
  RepairedRecording out;
  try {
    const mcap::ReadableFile from(file);
    mcap::DiskFile to(made);
    const mcap::Repaired repaired = mcap::repair(from, to);
    out.chunks = repaired.summary.chunks.size();
    for (const mcap::Damage& damage : repaired.damages) {
      out.lost_bytes += damage.length;
      out.losses.push_back(
          fmt::format("{} bytes from byte {} on: {}", damage.length, damage.place, damage.what));
    }
    out.changed = !repaired.had_end || !repaired.damages.empty();
  } catch (const mcap::McapError& error) {
    fs::remove(made, ignored);
    throw std::invalid_argument(
        fmt::format("{}: {}; there is nothing to repair", file.string(), error.what()));
  } catch (...) {
    fs::remove(made, ignored);
    throw;
  }
  if (!out.changed) {
    fs::remove(made, ignored);
    return out;
  }
  out.original = free_name(file, ".torn");
  std::error_code linked;
  fs::create_hard_link(file, out.original, linked);
  if (linked) fs::copy_file(file, out.original);  // a file system without links
  fs::rename(made, file);
  mcap::synchronise_folder(file.parent_path());
  return out;
}

RecordingContent read_recording(const fs::path& name, const std::function<void(double)>& on_progress) {
  RecordingContent out;
  const auto add = [&](double time, std::string code, std::string who, std::string text) {
    out.events.push_back(
        {.time = time, .code = std::move(code), .who = std::move(who), .text = std::move(text)});
  };
  for_each_message_of(
      name, on_progress,
      [&, tick = wire::Tick(), event = wire::Event(), setup = wire::Setup(), change = wire::Change(),
       gap = wire::Gap()](std::string_view schema, const mcap::Message& message, double time) mutable {
        if (schema == "phalanx.wire.Tick" && parsed(message, tick)) {
          out.forces.push_back({.time = time, .force = digit_forces(tick)});
        } else if (schema == "phalanx.wire.Event" && parsed(message, event)) {
          add(time, event.code(), event.who(), event.text());
        } else if (schema == "phalanx.wire.Setup" && parsed(message, setup)) {
          add(time, "station", "",
              fmt::format("scene {}, device {}", setup.start().scene(), setup.device_name()));
        } else if (schema == "phalanx.wire.Change" && parsed(message, change)) {
          add(time, "change", "", change.has_model() ? "another object" : "other parameters");
        } else if (schema == "phalanx.wire.Gap" && parsed(message, gap)) {
          add(time, "gap", "",
              fmt::format("steps {} to {} are missing: {}", gap.first_tick(), gap.last_tick(), gap.why()));
        }
      });
  return out;
}

Motion recorded_motion(const fs::path& name) {
  Motion longest;
  Motion motion;
  const auto keep_longest = [&] {
    if (motion.time_s.size() > longest.time_s.size()) longest = std::move(motion);
    motion = {};
  };
  for_each_message_of(name, {},
                      [&, map = std::optional<ChannelMap>(), step = wire::Step(), setup = wire::Setup(),
                       samples = std::vector<DeviceSample>(), sample = Sample()](
                          std::string_view schema, const mcap::Message& message, double) mutable {
                        if (schema == "phalanx.wire.Setup" && parsed(message, setup)) {
                          keep_longest();
                          map.emplace(read_channel_map(setup));
                          motion.angle_origin = map->angle_origins();
                        }
                        if (schema != "phalanx.wire.Step" || !map || !parsed(message, step)) return;
                        read_samples(step, samples);
                        for (const DeviceSample& raw : samples) {
                          map->convert(raw, sample);
                          if (!motion.time_s.empty() && sample.time_s <= motion.time_s.back()) continue;
                          motion.time_s.push_back(sample.time_s);
                          motion.angle.push_back(sample.angle);
                        }
                      });
  keep_longest();
  if (longest.time_s.size() < 2)
    throw std::runtime_error(
        fmt::format("{}: it holds no motion: fewer than two samples of a device", name.string()));
  check_motion(longest);
  return longest;
}

}  // namespace phalanx
