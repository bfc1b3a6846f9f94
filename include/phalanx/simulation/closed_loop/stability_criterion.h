// SPDX-License-Identifier: Apache-2.0
// The criterion of a trial's stability, and its other results, collected tick by tick.
#pragma once

#include <array>
#include <string>

#include "phalanx/simulation/press_intent.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Bounds for a stable trial, peak to peak in the window. The sent force of every contact may swing by at
/// most `force_swing`. The measured finger at that contact may swing along its normal n by at most
/// `position_swing`. The measured finger is the HCP (haptic device controlled position).
struct StabilityCriterion {
  double force_swing = 0.5;        ///< [N]
  double position_swing = 0.5e-3;  ///< [m]
  double ghost_force = 0.01;       ///< a smaller force counts as zero [N]
  /// Least part of the intended force that the digit must reach [-]; below it, the trial proves nothing.
  double least_press = 0.1;
  /// Largest mean force that the motors cannot exert, as a part of the digit's intended force [-]. Above it,
  /// the patient would not feel the force.
  double most_unrendered = 0.1;
  double rest = 0.3;  ///< time between the end of the press and the window [s]
};

/// Result of one closed-loop run of one seed.
struct TrialResult {
  bool valid =
      true;  ///< only the limiter that is studied acted (motor saturation excepted), and a contact was made
  std::string why_invalid;      ///< a few words; empty if valid
  bool stable = false;          ///< no contact swings by more than the criterion allows
  double force_swing = 0.0;     ///< largest peak-to-peak sent force over the contacts, in the window [N]
  double position_swing = 0.0;  ///< the same for the HCP's position along the contact's normal n [m]
  double peak_depth = 0.0;      ///< deepest penetration of the whole run [m]
  double mean_force = 0.0;      ///< force of the pressing contact, in the window [N]
  double mean_depth = 0.0;      ///< depth of the pressing contact, in the window [m]
  double ghost_s = 0.0;         ///< time with a force after the finger has left the wall [s]
  double ghost_energy = 0.0;    ///< work of this force on the finger [J]
};

/// Observer of a trial: give every snapshot to add(), then call result(). Not real-time.
class TrialObserver {
 public:
  /// @param plan  of the trial; it outlives the observer, which refers to it
  TrialObserver(const PressPlan& plan, const TrialSchedule& schedule,
                const StabilityCriterion& criterion = {});

  /// Sets the patient's intent. A trial is invalid if the finger hardly presses, or is still moving there
  /// in the window.
  void expect(const PressIntent& intent);

  /// Adds one step of the host.
  /// @param t         time of the host's step [s]
  /// @param rendered  torque that the motors receive at that time, after the delays; the ghost force is
  /// computed from it [Nm]
  /// @param unrendered  torque that the motors could not exert at that time [Nm]
  void add(double t, const Snapshot& snapshot, const JointArray& rendered, const JointArray& unrendered = {});
  [[nodiscard]] TrialResult result() const;

 private:
  struct Range {
    double low = 0.0, high = 0.0;
    bool any = false;
    void add(double value) noexcept;
    [[nodiscard]] double swing() const noexcept { return high - low; }
  };
  /// State of one contact, followed at the material point that it had when it was first seen in the window.
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
  std::array<double, kDigits> unrendered_sum_{};  ///< force that the motors cannot exert, summed over
                                                  ///< the window [N]
  bool halved_ = false;                           ///< OscillationReaction::kHalve acted
  std::array<double, kDigits> meant_{};           ///< intended force of each digit [N]; 0: not known
  double arrival_ = 0.0;                          ///< [s]

  struct Ghost {
    bool pressed = false;  ///< there was a force while the finger was inside
    bool left = false;
    double left_at = 0.0, ended_at = 0.0;
    double before = 0.0;  ///< position along n at the previous tick [m]
    double energy = 0.0;
  };
  std::array<Ghost, kDigits> ghost_;
};

}  // namespace phalanx
