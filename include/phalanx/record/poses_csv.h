// SPDX-License-Identifier: Apache-2.0
// poses.csv: where every segment of both hands was at every tick.
#pragma once

#include <filesystem>

#include "phalanx/record/output_file.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Header `tick,segment,hand,px,py,pz,qw,qx,qy,qz`; per tick 16 rows with hand = `hcp`, then 16 with `gdp`:
/// the pose X_WS of the segment's frame in the world, position in m, rotation as a unit quaternion with qw >=
/// 0. Not real-time. @throws as OutputFile.
class PosesCsv {
 public:
  explicit PosesCsv(const std::filesystem::path& file);
  void write(const Snapshot& snapshot);
  /// Makes the file appear under its name.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace phalanx
