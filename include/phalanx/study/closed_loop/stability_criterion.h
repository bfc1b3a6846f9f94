// SPDX-License-Identifier: Apache-2.0
// Whether a trial was stable, and what else it came to, gathered tick by tick.
#pragma once

#include <array>

#include "phalanx/device/press_intent.h"
#include "phalanx/step/snapshot.h"
#include "phalanx/study/laboratory/trial.h"

namespace phalanx {

/// Stable: in the window, the force sent of every contact that is ever there swings by at most `force_swing`,
/// and the HCP at that contact, along its n, by at most `position_swing`, both from peak to peak.
struct StabilityCriterion {
  double force_swing = 0.5;        ///< [N]
  double position_swing = 0.5e-3;  ///< [m]
  double ghost_force = 0.01;       ///< below this a force counts as gone [N]
  /// Of the force that the digit is meant to reach [-]; with less nothing is proven.
  double least_press = 0.1;
  /// Mean force that no motor renders, of the force that the digit is meant to reach [-]; with more nothing
  /// is felt.
  double most_unrendered = 0.1;
  double rest = 0.3;  ///< between the end of the press and the window [s]
};

/// Feed every snapshot to add(), then ask result().
class TrialObserver {
 public:
  TrialObserver(const PressPlan& plan, const TrialSchedule& schedule,
                const StabilityCriterion& criterion = {});

  /// What the patient intends: a trial in which the finger hardly presses, or is still on its way in the
  /// window, is invalid.
  void expect(const PressIntent& intent);

  /// @param t         time of the host's step [s]
  /// @param rendered  torque that the motors are told to render at that time, which the ghost is read from:
  /// what was sent is felt only after the delays [Nm]
  /// @param unrendered  torque that no motor could render at that time [Nm]
  void add(double t, const Snapshot& snapshot, const JointArray& rendered, const JointArray& unrendered = {});
  [[nodiscard]] TrialResult result() const;

 private:
  struct Range {
    double low = 0.0, high = 0.0;
    bool any = false;
    void add(double value) noexcept;
    [[nodiscard]] double swing() const noexcept { return high - low; }
  };
  /// A contact is followed by the material point that it had when it was first seen in the window.
  struct Watched {
    bool seen = false;
    Vec3 p_S = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    Range force, position;
    double force_sum = 0.0, depth_sum = 0.0;
  };
  void watch_window(const Snapshot& snapshot);
  void watch_ghost(double t, const Snapshot& snapshot, const JointArray& rendered);
  [[nodiscard]] std::size_t pressing_segment() const noexcept;
  [[nodiscard]] std::string why_invalid(bool touched, bool swings) const;

  const PressPlan& plan_;
  TrialSchedule schedule_;
  StabilityCriterion criterion_;
  std::array<Watched, kSegments> watched_;
  int window_ticks_ = 0;
  double peak_depth_ = 0.0;
  Status limited_ = Status::kOk;
  std::array<double, kDigits> unrendered_sum_{};  ///< force that nobody renders, in the window [N]
  bool halved_ = false;                           ///< OscillationReaction::kHalve acted
  std::array<double, kDigits> meant_{};           ///< force of each digit [N]; 0: not known
  double arrival_ = 0.0;                          ///< [s]

  struct Ghost {
    bool pressed = false;  ///< there was a force while the finger was inside
    bool left = false;
    double left_at = 0.0, ended_at = 0.0;
    double before = 0.0;  ///< position along n at the tick before [m]
    double energy = 0.0;
  };
  std::array<Ghost, kDigits> ghost_;
};

}  // namespace phalanx
