// SPDX-License-Identifier: Apache-2.0
// The channels of a recording.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "record/mcap/mcap_writer.h"

namespace phalanx {

/// Numbers of the channels, and of their schemas.
enum class Topic : std::uint16_t {
  kSetup = 1,
  kChange,
  kStep,
  kPose,
  kEvent,
  kGap,
  kClock,
  kLoop,
  kGeometry,
  kFrames,  ///< this and those that follow are for tools that read Foxglove's schemas
  kMeshes,
  kForces
};

struct TopicName {
  Topic topic;
  std::string_view name;
  std::string_view schema;
};
inline constexpr std::array<TopicName, 12> kTopics = {{
    {Topic::kSetup, "/setup", "phalanx.wire.Setup"},
    {Topic::kChange, "/change", "phalanx.wire.Change"},
    {Topic::kStep, "/step", "phalanx.wire.Step"},
    {Topic::kPose, "/pose", "phalanx.wire.Tick"},
    {Topic::kEvent, "/event", "phalanx.wire.Event"},
    {Topic::kGap, "/gap", "phalanx.wire.Gap"},
    {Topic::kClock, "/clock", "phalanx.wire.ClockPair"},
    {Topic::kLoop, "/loop", "phalanx.wire.Loop"},
    {Topic::kGeometry, "/geometry", "phalanx.wire.Geometry"},
    {Topic::kFrames, "/foxglove/frames", "foxglove.FrameTransforms"},
    {Topic::kMeshes, "/foxglove/meshes", "foxglove.SceneUpdate"},
    {Topic::kForces, "/foxglove/forces", "foxglove.SceneUpdate"},
}};

/// @returns the largest message of a type that is read [bytes]: a small message may become large once it is parsed. Only a
/// model is large by itself.
template <class Wire>
[[nodiscard]] constexpr std::size_t largest_message(const Wire& /*message*/) noexcept {
  return requires(const Wire& wire) { wire.model(); } || requires(const Wire& wire) {
    wire.start();
  } ? 256U << 20U : 256U << 10U;
}

/// @returns the schemas of all channels; each holds the FileDescriptorSet of its message with all that it imports
/// @param foxglove  with Topic::kFrames and those that follow
[[nodiscard]] std::vector<mcap::Schema> recording_schemas(bool foxglove = true);
[[nodiscard]] std::vector<mcap::Channel> recording_channels(bool foxglove = true);

}  // namespace phalanx
