// SPDX-License-Identifier: Apache-2.0
// One tick of the GDP by the rules of docs/architecture.md ("The GDP, exactly"), written anew on top of plain
// distance queries: what a lab would build from a collision library.
#pragma once

#include <array>
#include <vector>

#include "peer_clearance.h"
#include "peer_engine.h"
#include "peer_motion.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::bench {

class PeerGdp {
 public:
  PeerGdp(const HapticModel& model, const ContactParameters& parameters, DistanceEngine& engine,
          Pruning pruning);

  /// What advance_gdp() does, for GdpMethod::kContinuous. The force's direction is n_c: the peers leave the
  /// interpolated normals out, which are not compared.
  Status advance(const JointArray& hcp_angle, const HandPoses& hcp, const std::array<bool, kDigits>& measured,
                 GdpState& state);

  /// Drops what has been remembered from tick to tick.
  void forget() { clearance_.forget(); }

  /// The pairs that tie for the record that a segment got in the last tick, the one that gave its point
  /// first; empty if it got none.
  [[nodiscard]] const std::vector<ClosePair>& tied(int segment) const { return tied_[idx(segment)]; }

  /// Questions of distance that the engine has been asked.
  [[nodiscard]] long questions() const { return clearance_.questions() + lists_; }

 private:
  struct Tick;
  struct Stop;
  struct Step;

  void measure(const Tick& tick, int k, const DigitAngles& hcp_angle, const DigitPose& hcp,
               ContactRecord& record) const;
  [[nodiscard]] bool nearer_pushes(const Tick& tick, int k, const DigitAngles& hcp_angle,
                                   const DigitPose& hcp, const GdpState& state) const;
  [[nodiscard]] bool goes_through(const Tick& tick);
  void follow(const Tick& tick, int k, ContactRecord& record) const;
  [[nodiscard]] int held_joints(Tick& tick, GdpState& state);
  void advance_digit(Tick& tick, GdpState& state);
  [[nodiscard]] Stop next_stop(Tick& tick, GdpState& state);
  [[nodiscard]] Step step_of(const Tick& tick, int k, double longest);
  void list_pairs(int segment, const Pose& X_WS, double limit);
  void make_record(const Tick& tick, int k, const SegmentField* field, GdpState& state);
  void set_offset(const Tick& tick, int k, const GdpState& state, ContactRecord& record) const;

  const HapticModel& model_;
  const ContactParameters& parameters_;
  DistanceEngine& engine_;
  Pruning pruning_;
  Clearance clearance_;
  std::vector<ClosePair> pairs_;  ///< scratch
  std::array<std::vector<ClosePair>, kSegments> tied_;
  long lists_ = 0;
};

}  // namespace phalanx::bench
