// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/recordings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/recording.pb.h"
#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_file.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"
#include "record/plain_text.h"
#include "record/recording/own_steps.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"
#include "record/recording/topics.h"
#include "record/recording/view_message.h"
#include "record/synchronise_folder.h"

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
    if (!parsed(message, setup)) throw mcap::McapError("its first station does not match its schema");
    out.scene = one_line(setup.start().scene());
    out.device = one_line(setup.device_name());
    break;
  }
  out.version = one_line(metadata_of(reader, "version"));
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

/// @returns the begin that the name of a recording states: UTC [s since 1970]; 0: it states none
double begin_in_name(const fs::path& file) {
  std::tm utc{};
  const std::string name = file.filename().string();
  return ::strptime(name.c_str(), "%Y-%m-%dT%H-%M-%SZ", &utc) == nullptr
             ? 0.0
             : static_cast<double>(::timegm(&utc));
}

/// Fills in what an encrypted file says to all.
void read_encrypted(const fs::path& file, RecordingSummary& out) {
  const auto encrypted = mcap::summarise_encrypted(mcap::StoredBytes(file));
  if (!encrypted) return;
  out.encrypted = true;
  out.key_id = encrypted->id;
  out.begins = true;
  out.has_end = encrypted->has_end;
}

/// @returns the time of the last change of a file: UTC [s since 1970]
double changed_at(const fs::path& file) {
  const auto time = std::chrono::file_clock::to_sys(fs::last_write_time(file));
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

/// @returns the summary of a whole file that has not changed since; null: there is none
const RecordingSummary* unchanged(const fs::path& file, const std::vector<RecordingSummary>& known) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const RecordingSummary& each) { return each.file == file; });
  if (found == known.end() || !found->has_end || !found->trouble.empty() || found->written) return nullptr;
  std::error_code error;
  const bool same =
      fs::file_size(file, error) == found->bytes && !error && changed_at(file) == found->changed;
  return same ? &*found : nullptr;
}

/// @returns a name beside the file that is free
fs::path free_name(const fs::path& file, const std::string& ending) {
  fs::path name = file.string() + ending;
  std::error_code ignored;
  for (int i = 2; fs::exists(name, ignored); ++i) name = fmt::format("{}{}-{}", file.string(), ending, i);
  return name;
}

void remove_quietly(const fs::path& file) noexcept {
  std::error_code ignored;
  fs::remove(file, ignored);
}

/// Gives the file a second name; on a file system without links, copies it to the disk itself.
void keep_original(const fs::path& file, const fs::path& original) {
  std::error_code linked;
  fs::create_hard_link(file, original, linked);
  if (!linked) return synchronise_folder(original.parent_path());
  const mcap::StoredBytes from(file);
  mcap::DiskFile to(original);
  constexpr std::uint64_t kPart = 1U << 20U;
  std::string part;
  for (std::uint64_t place = 0; place < from.size(); place += part.size()) {
    from.read(place, kPart, part);
    if (part.empty()) throw std::system_error(EIO, std::generic_category(), file.string());
    to.write(place, part);
  }
  to.synchronise();
}

/// Writes what is whole of a file into another. An encrypted one is written encrypted; without its key, only whole frames are.
/// @returns a result whose names are not set yet
RepairedRecording repair_into(const fs::path& file, const FindRecordingKey& keys, mcap::DiskFile& to) {
  RepairedRecording out;
  const auto lost = [&](const mcap::Damage& damage, bool bytes, const char* of) {
    if (bytes) out.lost_bytes += damage.length;
    out.losses.push_back(
        fmt::format("{} bytes from byte {} on{}: {}", damage.length, damage.place, of, damage.what));
  };
  const mcap::StoredBytes stored(file);
  const auto encrypted = mcap::summarise_encrypted(stored);
  const std::optional<RecordingKey> key = encrypted && keys ? keys(encrypted->id) : std::nullopt;
  if (encrypted && !key) {
    const mcap::KeptFrames kept = mcap::keep_whole_frames(stored, to);
    for (const mcap::Damage& damage : kept.damages) lost(damage, true, " of the encrypted file");
    out.chunks = kept.frames;
    out.changed = !kept.damages.empty();
    out.needs_key = true;
    return out;
  }
  const mcap::ReadableFile from(file, keys, mcap::Unreadable::kFilled);
  std::optional<mcap::EncryptedFile> sealed;
  if (encrypted) sealed.emplace(to, RecordingEncryption{.id = encrypted->id, .key = *key});
  const mcap::Repaired repaired = mcap::repair(from, sealed ? static_cast<mcap::WritableFile&>(*sealed) : to);
  out.chunks = repaired.summary.chunks.size();
  const std::vector<mcap::Damage> undecrypted = from.undecrypted();
  for (const mcap::Damage& damage : undecrypted)
    lost(damage, repaired.damages.empty(), " of the encrypted file");
  for (const mcap::Damage& damage : repaired.damages)
    lost(damage, true, encrypted ? " of the recording" : "");
  out.changed = !repaired.had_end || !out.losses.empty();
  return out;
}

}  // namespace

bool has_recording_name(const fs::path& file) {
  return file.extension() == ".mcap" || (file.extension() == ".enc" && file.stem().extension() == ".mcap");
}

fs::path beside_recording(const fs::path& file, const std::string& ending) {
  fs::path name = file.extension() == ".enc" ? fs::path(file).replace_extension() : file;
  return name.replace_extension(ending);
}

std::string recording_state(const RecordingSummary& recording) {
  if (recording.written) return "being written";
  if (!recording.begins) return recording.trouble;
  if (recording.no_key) return recording.has_end ? "encrypted, no key" : "encrypted, no key, no end: repair";
  if (!recording.has_end) return "no end: repair";
  if (!recording.trouble.empty()) return recording.trouble;
  return recording.gaps > 0 ? fmt::format("{} gaps", recording.gaps) : "whole";
}

RecordingSummary summarise_recording(const fs::path& file, const FindRecordingKey& keys) {
  RecordingSummary out;
  out.file = file;
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw std::invalid_argument(fmt::format(
        "there is no recording {}; `phalanx session list` shows those of the folder", file.string()));
  try {
    out.written = mcap::is_being_written(file);
    out.bytes = fs::file_size(file);
    out.changed = changed_at(file);
    read_encrypted(file, out);
    const mcap::ReadableFile readable(file, keys);
    out.has_end = mcap::has_end(readable);
    out.begins = mcap::begins_as_mcap(readable);
    if (out.has_end) read_end(readable, out);
    read_begin(readable, out);
  } catch (const mcap::NoKeyError& trouble) {
    out.trouble = trouble.what();
    out.no_key = true;
    out.begin = begin_in_name(file);
  } catch (const std::exception& trouble) {
    out.trouble = trouble.what();
  }
  return out;
}

std::vector<RecordingSummary> list_recordings(const fs::path& folder,
                                              const std::vector<RecordingSummary>& known,
                                              const FindRecordingKey& keys) {
  std::vector<RecordingSummary> all;
  std::error_code error;
  if (!fs::exists(folder, error)) return all;
  fs::directory_iterator entries(folder, error);
  if (error)
    throw std::invalid_argument(fmt::format("the folder {} cannot be read ({}); name another with --folder",
                                            folder.string(), error.message()));
  for (const fs::directory_entry& entry : entries)
    if (has_recording_name(entry.path()) && fs::is_regular_file(entry.path(), error)) {
      const RecordingSummary* same = unchanged(entry.path(), known);
      all.push_back(same != nullptr ? *same : summarise_recording(entry.path(), keys));
    }
  std::sort(all.begin(), all.end(), [](const RecordingSummary& a, const RecordingSummary& b) {
    return std::tie(a.begin, a.file) < std::tie(b.begin, b.file);
  });
  return all;
}

RepairedRecording repair_recording(const fs::path& file, const FindRecordingKey& keys) {
  static_cast<void>(summarise_recording(file));
  if (mcap::is_being_written(file))
    throw std::invalid_argument(fmt::format("{} is being written; end that run first", file.string()));
  const fs::path made = free_name(file, fmt::format(".repairing-{}", ::getpid()));
  RepairedRecording out;
  try {
    mcap::DiskFile to(made);
    out = repair_into(file, keys, to);
    if (out.changed) {
      out.original = free_name(file, ".torn");
      keep_original(file, out.original);
      fs::rename(made, file);
      synchronise_folder(file.parent_path());
    }
  } catch (const mcap::McapError& error) {
    remove_quietly(made);
    throw std::invalid_argument(
        fmt::format("{}: {}; there is nothing to repair", file.string(), error.what()));
  } catch (const mcap::NoKeyError& error) {
    remove_quietly(made);
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
  } catch (...) {
    remove_quietly(made);
    throw;
  }
  remove_quietly(made);
  return out;
}

RecordingContent read_recording(const fs::path& name, const std::function<void(double)>& on_progress,
                                const FindRecordingKey& keys) {
  RecordingContent out;
  const auto add = [&](double time, std::string code, std::string who, std::string text) {
    out.events.push_back(
        {.time = time, .code = std::move(code), .who = std::move(who), .text = std::move(text)});
  };
  for_each_message_of(
      name, on_progress, keys,
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

namespace {

/// Collects the samples of each station. One whose device's clock goes back, as after a restart of its controller, counts as
/// two.
class MotionReader {
 public:
  void add(std::string_view schema, const mcap::Message& message) {
    if (schema == "phalanx.wire.Setup" && parsed(message, setup_)) {
      keep_longest();
      map_.emplace(read_channel_map(setup_));
    }
    if (schema != "phalanx.wire.Step" || !map_ || !parsed(message, step_)) return;
    if (step_.station() != setup_.station()) return;  // its setup is lost
    if (setup_.own_steps()) {
      read_own_sample(step_, sample_);
      return add(sample_.angle_origin);
    }
    read_samples(step_, samples_);
    for (const DeviceSample& raw : samples_) add(raw);
  }
  [[nodiscard]] Motion longest() {
    keep_longest();
    return std::move(longest_);
  }

 private:
  void add(const DeviceSample& raw) {
    map_->convert(raw, sample_);
    add(map_->angle_origins());
  }
  void add(const AngleOrigins& origins) {
    if (!motion_.time_s.empty() && sample_.time_s == motion_.time_s.back()) return;
    if (!motion_.time_s.empty() && sample_.time_s < motion_.time_s.back()) keep_longest();
    motion_.angle_origin = origins;
    motion_.time_s.push_back(sample_.time_s);
    motion_.angle.push_back(sample_.angle);
  }
  void keep_longest() {
    if (motion_.time_s.size() > longest_.time_s.size()) longest_ = std::move(motion_);
    motion_ = {};
  }

  Motion motion_;
  Motion longest_;
  std::optional<ChannelMap> map_;
  wire::Setup setup_;
  wire::Step step_;
  std::vector<DeviceSample> samples_;
  Sample sample_;
};

}  // namespace

Motion recorded_motion(const fs::path& name, const FindRecordingKey& keys) {
  MotionReader reader;
  try {
    for_each_message_of(name, {}, keys,
                        [&](std::string_view schema, const mcap::Message& message, double /*time*/) {
                          reader.add(schema, message);
                        });
  } catch (const std::invalid_argument& error) {  // numbers of the device that this version does not take
    throw std::runtime_error(fmt::format("{}: {}", name.string(), error.what()));
  }
  Motion longest = reader.longest();
  if (longest.time_s.size() < 2)
    throw std::runtime_error(
        fmt::format("{}: it holds no motion: fewer than two samples of a device", name.string()));
  check_motion(longest);
  return longest;
}

}  // namespace phalanx
