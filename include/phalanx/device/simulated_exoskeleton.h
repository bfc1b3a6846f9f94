// SPDX-License-Identifier: Apache-2.0
// The exoskeleton that nobody has: a controller with sensors, delays and motors around the plant.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/patient.h"
#include "phalanx/device/plant.h"
#include "phalanx/device/transmission.h"
#include "phalanx/hand/joints.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// What the patient intends over one tick of the controller: from here to there at constant speed.
struct IntendedMove {
  JointArray from{};  ///< [rad]
  JointArray to{};    ///< [rad]
  JointArray push{};  ///< torque from outside on each joint [Nm]
};

/// Sensing, holding and driving at the controller's rate:
///   begin_tick()  takes the newest command that has arrived, measures, sets the motors for this tick
///   end_tick()    the plant goes on for one period
/// and, between the two, send() of whatever the host computed from sample().
///
/// Where another controller decides on the torque, measure_tick() and drive() take the place of begin_tick():
/// nothing is delayed then, and commands that were sent do nothing.
///
/// Measured: angle + seeded normal noise, rounded to the sensor's least significant bit; coupled joints
/// follow theirs, copied digits theirs, all others stay at the open hand. Driven: joint torques through the
/// transmission, held for a tick (zero-order hold); where the command carries local walls that are still
/// valid, their forces are evaluated at this tick's angles in place of the host's. Same parameters, seed and
/// commands, same bits. Real-time but for the constructor.
class SimulatedExoskeleton {
 public:
  /// At rest with the hand at `start` [rad].
  /// @param open  the open hand, where joints without a sensor stay [rad]
  /// @throws std::invalid_argument as Plant and Transmission.
  SimulatedExoskeleton(const Exoskeleton& exoskeleton, const PatientParameters& patient,
                       const JointArray& open, const JointArray& start, std::uint64_t seed,
                       double step = Plant::kDefaultStep);

  void begin_tick() noexcept;
  void end_tick(const IntendedMove& move) noexcept;

  /// Begins a tick by measuring only.
  void measure_tick() noexcept;
  /// Sets the motors for the tick begun last: joint torques through the transmission [Nm].
  void drive(const JointArray& torque) noexcept;
  /// This motor does nothing at all, its bias included, in the tick begun last: a broken one. After drive().
  /// @pre motor < number of motors (asserted in debug)
  void fail_motor(std::size_t motor) noexcept;

  /// A command that the host finished, or will finish, at `finished` [s]: it is in force from the
  /// controller's first tick at or after  finished + return delay,  never before. Commands act in the order
  /// in which they are sent, so `finished` should not decrease: a later one waits for those before it, and of
  /// those that have arrived by a tick the last counts. One whose time is not finite is dropped. There is
  /// room for one at each of the controller's ticks within compute and return delay; should more be on their
  /// way for different ticks than that, the newest takes the place of the one before it.
  void send(const Snapshot& snapshot, double finished) noexcept;

  /// Of the tick begun last.
  [[nodiscard]] const Sample& sample() const noexcept { return sample_; }
  /// Time of that tick [s].
  [[nodiscard]] double time_s() const noexcept { return static_cast<double>(tick_) * period_; }
  [[nodiscard]] double period() const noexcept { return period_; }
  [[nodiscard]] const Exoskeleton& exoskeleton() const noexcept { return exoskeleton_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
  /// What became of the torques at the tick begun last.
  [[nodiscard]] const Rendered& rendered() const noexcept { return rendered_; }

 private:
  struct Command {
    double arrives = 0.0;
    double valid_until = 0.0;  ///< of the walls, if there are any
    bool has_walls = false;
    JointArray torque{};
    JointArray wall_reference{};
    std::array<LocalWall, kSegments> wall{};
  };
  [[nodiscard]] Command& place_on_the_way(double arrives) noexcept;
  void take_arrived() noexcept;
  void measure() noexcept;
  [[nodiscard]] JointArray wanted_torque() const noexcept;

  Exoskeleton exoskeleton_;
  Transmission transmission_;
  Plant plant_;
  Random noise_;
  double period_;
  JointArray open_;
  std::uint64_t tick_ = 0;
  bool begun_ = false;
  Sample sample_;
  Command command_;
  std::vector<Command> on_the_way_;  ///< a ring
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  Rendered rendered_;
  PlantInput input_;
};

}  // namespace phalanx
