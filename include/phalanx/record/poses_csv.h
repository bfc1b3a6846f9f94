// SPDX-License-Identifier: Apache-2.0
// poses.csv: the pose of every segment of both hands at every tick.
#pragma once

#include <filesystem>

#include "phalanx/record/output_file.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// File with the header `tick,segment,hand,px,py,pz,qw,qx,qy,qz`. Each tick has 16 rows with hand = `hcp`
/// (measured), then 16 with `gdp` (displayed). A row holds the pose X_WS of the segment's frame in the world:
/// position [m], and rotation as a unit quaternion with qw >= 0. Not real-time. @throws as OutputFile.
class PosesCsv {
 public:
  explicit PosesCsv(const std::filesystem::path& file);
  void write(const Snapshot& snapshot);
  /// Renames the file to its name.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace phalanx
