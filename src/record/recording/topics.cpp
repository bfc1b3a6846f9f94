// SPDX-License-Identifier: Apache-2.0
#include "record/recording/topics.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>
#include <string>

#include "phalanx/recording.pb.h"

namespace phalanx {
namespace {

using google::protobuf::FileDescriptor;

/// Adds a file after those that it imports, each once.
void add_file(const FileDescriptor& file, std::set<std::string>& added,
              google::protobuf::FileDescriptorSet& to) {
  if (!added.insert(file.name()).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) add_file(*file.dependency(i), added, to);
  file.CopyTo(to.add_file());
}

}  // namespace

std::vector<mcap::Schema> recording_schemas(bool foxglove) {
  std::vector<mcap::Schema> schemas;
  for (const TopicName& topic : kTopics) {
    if (!foxglove && topic.topic >= Topic::kFrames) continue;
    const std::string name(topic.schema);
    // All are of the schemas that this program was compiled with.
    const auto* message = google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(name);
    google::protobuf::FileDescriptorSet files;
    std::set<std::string> added;
    add_file(*message->file(), added, files);
    schemas.push_back({.id = static_cast<std::uint16_t>(topic.topic),
                       .name = name,
                       .encoding = "protobuf",
                       .data = files.SerializeAsString()});
  }
  return schemas;
}

std::vector<mcap::Channel> recording_channels(bool foxglove) {
  std::vector<mcap::Channel> channels;
  for (const TopicName& topic : kTopics) {
    if (!foxglove && topic.topic >= Topic::kFrames) continue;
    channels.push_back({.id = static_cast<std::uint16_t>(topic.topic),
                        .schema = static_cast<std::uint16_t>(topic.topic),
                        .topic = std::string(topic.name),
                        .message_encoding = "protobuf"});
  }
  return channels;
}

}  // namespace phalanx
