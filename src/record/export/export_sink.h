// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/record/export_recording.h"
#include "phalanx/recording.pb.h"
#include "record/export/export_table.h"
#include "record/mcap/mcap_writer.h"

namespace phalanx {

/// Gets the messages of a recording, and writes them in another format.
class ExportSink {
 public:
  ExportSink() = default;
  ExportSink(const ExportSink&) = delete;
  ExportSink& operator=(const ExportSink&) = delete;
  virtual ~ExportSink() = default;

  /// @param schema     of the message: "phalanx.wire.Step"
  /// @param time       since the beginning of the recording [s]
  /// @param in_range   false: it is not to be exported, but may state what later messages mean
  virtual void add(std::string_view schema, const mcap::Message& message, double time, bool in_range) = 0;
  /// Gets what exercises observe at a step, after all messages, if the part `observations` is exported.
  /// @param time       since the beginning of the recording [s]
  /// @param host_time  StepInput::time [s]
  virtual void add_observation(const Observation& /*observation*/, std::uint64_t /*station*/,
                               double /*host_time*/, double /*time*/) {}
  /// Writes what is left.
  virtual std::vector<ExportedPart> finish() = 0;
};

/// @returns a sink that makes rows of the messages and writes them in a format
/// @throws std::invalid_argument for an unknown column
[[nodiscard]] std::unique_ptr<ExportSink> table_sink(std::unique_ptr<TableFormat> format,
                                                     const ExportOptions& options);

/// @returns how the samples of a station become angles; none if this version does not take its channels: angles are then left
/// out of an export
[[nodiscard]] std::optional<ChannelMap> channel_map_of(const wire::Setup& setup);

/// @returns the parts of a ROS 2 bag: its topics
[[nodiscard]] const std::vector<ExportPart>& ros2_parts();
/// @param folder  exists, and is empty
[[nodiscard]] std::unique_ptr<ExportSink> ros2_sink(const std::filesystem::path& folder,
                                                    const ExportOptions& options);

}  // namespace phalanx
