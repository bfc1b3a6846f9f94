// SPDX-License-Identifier: Apache-2.0
#include "run/disk_messages.h"

#include <fmt/format.h>

#include <utility>

namespace phalanx {

std::vector<std::string> DiskMessages::next(const RecordingStatus& recording, double now) {
  std::vector<std::string> messages;
  const Disk disk = !recording.trouble.empty()         ? Disk::kRefuses
                    : recording.unsaved > kLongUnsaved ? Disk::kSlow
                                                       : Disk::kTakes;
  if (disk != Disk::kTakes) took_since_ = now;
  const bool lasting = disk != Disk::kTakes || now - took_since_ > kQuiet;
  if (lasting && disk != told_) {
    const Disk before = std::exchange(told_, disk);
    if (disk == Disk::kRefuses) {
      messages.push_back(
          fmt::format("recording: the disk refuses the data ({}); the last {:.1f} s are not saved, and are "
                      "written as soon as it takes them. Make room, or connect the disk; the station goes on",
                      recording.trouble, recording.unsaved));
    } else if (disk == Disk::kTakes) {
      messages.emplace_back("recording: the disk takes the data again");
    } else if (before == Disk::kTakes) {
      messages.push_back(fmt::format(
          "recording: the disk is slow; the last {:.1f} s are not saved yet. They are lost if the "
          "power fails now",
          recording.unsaved));
    }
  }
  if (recording.lost_steps > 2 * lost_told_) {
    lost_told_ = recording.lost_steps;
    messages.push_back(fmt::format("recording: {} steps are missing in it; it names them", lost_told_));
  }
  return messages;
}

}  // namespace phalanx
