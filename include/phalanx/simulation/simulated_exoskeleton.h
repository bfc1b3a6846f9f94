// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton: a controller with sensors, delays and motors around the plant.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/hand/joints.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/plant.h"
#include "phalanx/simulation/transmission.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Intended motion of the patient over one tick of the controller, at constant speed.
struct IntendedMove {
  JointArray from{};  ///< [rad]
  JointArray to{};    ///< [rad]
  JointArray push{};  ///< external torque on each joint [Nm]
};

/// Simulated device that senses, holds and drives at the controller's rate:
///   begin_tick()  takes the newest command that has arrived, measures, sets the motors for this tick
///   end_tick()    advances the plant by one period
/// Between the two, send() takes the command that the host computed from sample().
///
/// If another controller decides on the torque, measure_tick() and drive() replace begin_tick(). Nothing is
/// delayed then, and commands from send() have no effect.
///
/// The measurement is the angle plus seeded normal noise, rounded to the sensor's least significant bit.
/// Coupled joints and copied digits follow theirs; all others stay at the open hand. The joint torques go
/// through the transmission and are held for a tick (zero-order hold). If the command carries local walls
/// that are still valid, their forces are evaluated at this tick's angles in place of the host's. Equal
/// parameters, seed and commands give equal bits. Real-time except for the constructor.
class SimulatedExoskeleton {
 public:
  /// Places the hand at rest at `start` [rad].
  /// @param open  the open hand, where joints without a sensor stay [rad]
  /// @throws std::invalid_argument as Plant and Transmission.
  SimulatedExoskeleton(const Exoskeleton& exoskeleton, const PatientParameters& patient,
                       const JointArray& open, const JointArray& start, std::uint64_t seed,
                       double step = Plant::kDefaultStep);

  void begin_tick() noexcept;
  void end_tick(const IntendedMove& move) noexcept;

  /// Begins a tick by measuring only.
  void measure_tick() noexcept;
  /// Sets the motors for the present tick: joint torques through the transmission [Nm].
  void drive(const JointArray& torque) noexcept;
  /// Makes a motor exert no force in the present tick, its bias included: a broken one. Call
  /// it after drive().
  /// @pre motor < number of motors (asserted in debug)
  void fail_motor(std::size_t motor) noexcept;

  /// Sends a command that the host finishes at `finished` [s]. It acts from the controller's first tick at or
  /// after  finished + return delay.  Commands act in the order in which they are sent, so `finished` should
  /// not decrease: a later command waits for those before it. Of those that have arrived by a tick, the last
  /// counts. A command whose time is not finite is dropped. There is room for one command at each of the
  /// controller's ticks within compute and return delay. If more are on their way for different ticks, the
  /// newest replaces the one before it.
  void send(const Snapshot& snapshot, double finished) noexcept;

  /// @returns the measurement of the present tick.
  [[nodiscard]] const Sample& sample() const noexcept { return sample_; }
  /// @returns the time of the present tick [s].
  [[nodiscard]] double time_s() const noexcept { return static_cast<double>(tick_) * period_; }
  [[nodiscard]] double period() const noexcept { return period_; }
  [[nodiscard]] const Exoskeleton& exoskeleton() const noexcept { return exoskeleton_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
  /// @returns the distribution of the torques at the present tick.
  [[nodiscard]] const Rendered& rendered() const noexcept { return rendered_; }

 private:
  struct Command {
    double arrives = 0.0;
    double valid_until = 0.0;  ///< of the walls, if there are any [s]
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
  std::vector<Command> on_the_way_;  ///< ring
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  Rendered rendered_;
  PlantInput input_;
};

}  // namespace phalanx
