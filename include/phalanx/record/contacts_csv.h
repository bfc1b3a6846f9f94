// SPDX-License-Identifier: Apache-2.0
// contacts.csv: the contact points of sliding mode at every tick.
#pragma once

#include <filesystem>

#include "phalanx/record/output_file.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// File with the header `tick,segment,px_m,py_m,pz_m,nx,ny,nz,force_n,tx_n,ty_n,tz_n,spin_nm,mu,slip`, one row
/// for each ContactPoint of each tick, in W: its place on the GDP segment, its normal, the force along the
/// normal, the friction force along the surface, friction's moment about the normal, the coefficient, and 1 if
/// it slips. No tick has more than ContactPoints::kMost rows; a tick without contact has none. Not real-time.
/// @throws as OutputFile.
class ContactsCsv {
 public:
  explicit ContactsCsv(const std::filesystem::path& file);
  void write(const Snapshot& snapshot);
  /// Renames the file to its name.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace phalanx
