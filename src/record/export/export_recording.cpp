// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/export_recording.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/device/channel_map.h"
#include "phalanx/record/hand_observer.h"
#include "phalanx/record/output_file.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/replay_visitor.h"
#include "phalanx/recording.pb.h"
#include "record/export/bids_format.h"
#include "record/export/export_sink.h"
#include "record/export/export_table.h"
#include "record/plain_text.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

void check_part(const ExportOptions& options) {
  std::vector<std::string> known;
  for (const ExportPart& part : export_parts(options.format)) known.push_back(part.name);
  for (const std::string& wanted : options.parts)
    if (std::find(known.begin(), known.end(), wanted) == known.end())
      throw std::invalid_argument(
          fmt::format("there is no part '{}' in this format; known: {}", wanted, fmt::join(known, ", ")));
}

void check_range(const ExportOptions& options) {
  if (!(options.from >= 0.0 && options.from < options.to))
    throw std::invalid_argument(fmt::format("from {} s to {} s there is no time; the recording begins at 0",
                                            options.from, options.to));
}

void check(const fs::path& target, const ExportOptions& options) {
  check_part(options);
  const bool tables = options.format == ExportFormat::kCsv || options.format == ExportFormat::kHdf5 ||
                      options.format == ExportFormat::kMatlab;
  if (!options.columns.empty() && !tables)
    throw std::invalid_argument(
        "columns can be chosen for csv, hdf5 and matlab; of the other formats, choose parts");
  check_range(options);
  std::error_code ignored;
  if (fs::exists(target, ignored))
    throw std::invalid_argument(fmt::format("'{}' exists; name a target that does not", target.string()));
}

/// What is read of a recording before its messages are exported.
struct Beginning {
  ExportOrigin origin;
  BidsLabels labels;
};

Beginning read_beginning(const fs::path& recording, const FindRecordingKey& keys) {
  Beginning out;
  out.origin.name = as_utf8(recording.filename().string());
  out.labels.task = bids_label("");
  try {
    const mcap::ReadableFile file(recording, keys);
    mcap::McapReader reader(file);
    mcap::Message message;
    wire::Setup setup;
    while (reader.next(message)) {
      if (out.origin.begin_utc == 0) out.origin.begin_utc = message.time;
      if (reader.schema_of(message.channel) != "phalanx.wire.Setup" || !parsed(message, setup)) continue;
      out.labels.task = bids_label(fs::path(setup.start().scene()).stem().string());
      out.labels.device = one_line(setup.device_name());
      out.labels.serial = one_line(setup.device_serial());
      out.labels.rate_hz = setup.device_rate_hz();
      if (const auto map = channel_map_of(setup)) out.labels.origin = map->angle_origins();
      break;
    }
    out.origin.version = one_line(metadata_of(reader, "version"));
  } catch (const mcap::McapError&) {  // for_each_message_of() says what is wrong
  } catch (const std::system_error&) {
  } catch (const mcap::NoKeyError&) {
  }
  return out;
}

std::unique_ptr<ExportSink> sink_for(const fs::path& target, const Beginning& beginning,
                                     const ExportOptions& options) {
  switch (options.format) {
    case ExportFormat::kCsv:
      return table_sink(csv_format(target), options);
    case ExportFormat::kHdf5:
      return table_sink(hdf5_format(target, beginning.origin), options);
    case ExportFormat::kMatlab:
      return table_sink(matlab_format(target, beginning.origin), options);
    case ExportFormat::kRos2:
      return ros2_sink(target, options);
    case ExportFormat::kBids:
      break;
  }
  BidsLabels labels = beginning.labels;
  labels.subject = options.subject;
  labels.from = options.from;
  if (!options.task.empty()) labels.task = options.task;
  ExportOptions parts = options;
  if (parts.parts.empty())
    for (const ExportPart& part : bids_parts()) parts.parts.push_back(part.name);
  return table_sink(bids_format(target, beginning.origin, labels), parts);
}

/// Hands each step that a replay makes again to a sink, as exercises observe it.
class ExportObserver final : public ReplayVisitor {
 public:
  ExportObserver(ExportSink& sink, const ExportOptions& options) : sink_(sink), options_(options) {}

  void step(const StepRecord& record, std::span<const DeviceSample> /*samples*/, double time) override {
    const Observation observation = observer_.observe(record);
    if (time >= options_.from && time < options_.to)
      sink_.add_observation(observation, record.station, record.input.time, time);
  }
  void unknown_step(std::uint64_t /*station*/, std::uint64_t /*tick*/) override { observer_.gap(); }
  void missing(std::uint64_t /*station*/, std::uint64_t /*first*/, std::uint64_t /*last*/) override {
    observer_.gap();
  }

 private:
  ExportSink& sink_;
  const ExportOptions& options_;
  HandObserver observer_;
};

std::vector<ExportedPart> write(const fs::path& recording, ExportSink& sink, const ExportOptions& options,
                                const std::function<void(double)>& on_progress,
                                const FindRecordingKey& keys) {
  for_each_message_of(recording, on_progress, keys,
                      [&](std::string_view schema, const mcap::Message& message, double time) {
                        sink.add(schema, message, time, time >= options.from && time < options.to);
                      });
  if (std::find(options.parts.begin(), options.parts.end(), "observations") != options.parts.end()) {
    ExportObserver observer(sink, options);
    static_cast<void>(replay(recording, on_progress, &observer, keys));
  }
  return sink.finish();
}

std::vector<ExportedPart> write(const fs::path& recording, const fs::path& target,
                                const ExportOptions& options, const std::function<void(double)>& on_progress,
                                const FindRecordingKey& keys) {
  const std::unique_ptr<ExportSink> sink = sink_for(target, read_beginning(recording, keys), options);
  return write(recording, *sink, options, on_progress, keys);
}

void remove_folder(const fs::path& folder) noexcept {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace

std::optional<ChannelMap> channel_map_of(const wire::Setup& setup) {
  try {
    return read_channel_map(setup);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

const std::vector<ExportFormatName>& export_formats() {
  static const std::vector<ExportFormatName> kFormats = {
      {ExportFormat::kCsv, "csv", "", "a folder of CSV files"},
      {ExportFormat::kHdf5, "hdf5", ".h5", "an HDF5 file"},
      {ExportFormat::kMatlab, "matlab", ".mat", "a MATLAB file of version 7"},
      {ExportFormat::kRos2, "ros2", "", "a folder with a ROS 2 bag"},
      {ExportFormat::kBids, "bids", "", "a data set of the Brain Imaging Data Structure: motion"}};
  return kFormats;
}

const ExportFormatName& export_format(std::string_view name) {
  std::vector<const char*> known;
  for (const ExportFormatName& format : export_formats()) {
    if (name == format.name) return format;
    known.push_back(format.name);
  }
  throw std::invalid_argument(
      fmt::format("there is no format '{}'; known: {}", name, fmt::join(known, ", ")));
}

std::vector<ExportPart> export_parts(ExportFormat format) {
  if (format == ExportFormat::kRos2) return ros2_parts();
  if (format == ExportFormat::kBids) return bids_parts();
  std::vector<ExportPart> parts;
  for (const ExportTable& table : export_tables()) parts.push_back({table.name, table.meaning});
  return parts;
}

std::vector<ExportedPart> read_tables(const fs::path& recording, std::unique_ptr<TableFormat> format,
                                      const ExportOptions& options,
                                      const std::function<void(double)>& on_progress,
                                      const FindRecordingKey& keys) {
  check_part(options);
  check_range(options);
  return write(recording, *table_sink(std::move(format), options), options, on_progress, keys);
}

std::vector<ExportedPart> export_recording(const fs::path& recording, const fs::path& target,
                                           const ExportOptions& options,
                                           const std::function<void(double)>& on_progress,
                                           const FindRecordingKey& keys) {
  check(target, options);
  const bool is_file = options.format == ExportFormat::kHdf5 || options.format == ExportFormat::kMatlab;
  std::vector<ExportedPart> parts;
  if (is_file) {
    if (target.has_parent_path()) prepare_output_folder(target.parent_path());
    write_then_rename(target, [&](const fs::path& partial) {
      parts = write(recording, partial, options, on_progress, keys);
    });
    for (ExportedPart& part : parts) part.file = target;
    return parts;
  }
  const fs::path partial = target.string() + fmt::format(".partial-{}", ::getpid());
  prepare_output_folder(partial);
  try {
    parts = write(recording, partial, options, on_progress, keys);
    fs::rename(partial, target);
  } catch (const fs::filesystem_error& error) {
    remove_folder(partial);
    throw std::runtime_error(
        fmt::format("{}: cannot be written ({})", target.string(), error.code().message()));
  } catch (...) {
    remove_folder(partial);
    throw;
  }
  for (ExportedPart& part : parts) part.file = target / part.file.lexically_relative(partial);
  return parts;
}

}  // namespace phalanx
