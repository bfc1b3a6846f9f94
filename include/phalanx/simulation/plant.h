// SPDX-License-Identifier: Apache-2.0
// The mechanics of exoskeleton and finger: motors, tendons in sheaths, joints, the patient's impedance.
//
// The simulated exoskeleton consists of these mechanics, the motors' force distribution (transmission.h),
// sensors and delays (simulated_exoskeleton.h), and a controller that the link reaches. A simulated
// patient (patient.h, press_intent.h) moves it from the inside.
#pragma once

#include <cstddef>
#include <vector>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/simulation/patient.h"

namespace phalanx {

/// External inputs of the plant during one call of Plant::advance().
struct PlantInput {
  std::vector<double> motor_force;  ///< command to each motor, held [N]; a value that is not finite
                                    ///< counts as 0
  JointArray intended{};            ///< the patient's intended angles at the beginning [rad]
  JointArray intended_speed{};      ///< speed of the intended angles [rad/s]
  JointArray push{};                ///< external torque on each joint [Nm]
};

/// Energy balance since the start [J]. Each term is the sum over all steps of a force times the mean of the
/// speeds before and after the step.
struct EnergyLedger {
  double motors = 0.0;       ///< work of the motors on the rotors
  double patient = 0.0;      ///< work of the patient's impedance and of pushes on the joints
  double dissipated = 0.0;   ///< lost in viscous and dry friction and in the tendons' damping, >= 0
  double turned_over = 0.0;  ///< sum of the absolute values of all of these
};

/// One motor and its tendon, in the tendon's coordinates.
struct TendonState {
  double wound = 0.0;        ///< y, length that the motor has wound up [m]
  double speed = 0.0;        ///< speed of the rotor [m/s]
  double motor_force = 0.0;  ///< f, after the lag [N]
  double tension = 0.0;      ///< T, mean over the last step [N]
};

/// Forward dynamics of the device and the patient's hand:
///   motor force  df/dt = (u - f) / lag,  |u| <= force_limit
///   rotor        m y'' = f - T - b y' - friction(y')
///   tendon       T = k (|s| - play) sign(s) + c s'  while |s| exceeds the play (half the backlash), else 0;
///                stretch s = y - sum_j arm_j q_j;  pull_only: T >= 0.
///                With a linkage: e(q_j) for arm_j q_j, and r(q_j) for arm_j, in the middle of the step
///   joint        I_j q_j'' = sum_i arm_ij T_i - b q_j' - friction(q_j')
///                + k_p (q_intended - q) + b_p (q_intended' - q') + push
///
/// The step is fixed, and of second order where motion is smooth: half a step of drift, one kick with all
/// position forces taken in the middle, half a step of drift. This is position Verlet (Hairer, Lubich &
/// Wanner 2003); damping enters by its mean speed. Dry friction enters the kick as the impulse that is needed
/// to stop, at most h F. A sticking body therefore has the speed 0 exactly and does not creep.
///
/// Tendons damp bodies against each other. Gauss-Seidel sweeps solve the kicks of these bodies, until no
/// speed changes by more than 1e-9 of itself or kMostSweeps are done. If a pull-only tendon would end a step
/// below 0, it exerts no force in that step. Its own damper then takes the energy that its spring gives up.
/// Equal parameters and inputs give equal bits.
///
///
/// The state stays finite for every input. A command, a push or a patient's torque that is not finite counts
/// as 0. The torque of patient and push on a joint is bounded by kLargestTorque. Real-time: advance() does
/// not allocate, lock or throw.
class Plant {
 public:
  static constexpr double kDefaultStep = 50e-6;  ///< [s]
  static constexpr double kLongest = 3600.0;     ///< longest duration of one call [s]
  static constexpr double kLargestTorque = 1e6;  ///< bound of patient and push together on a joint [Nm]

  /// Places the hand at rest at `start`, with tendons without tension.
  /// @param step  upper bound of the integration step [s]; advance() divides its duration into equal steps of
  /// at most this
  /// @throws std::invalid_argument as check_exoskeleton() and check_patient(); if `start` of one of its
  /// joints is not finite; if `step` is not in 1e-7 .. 1e-3 s; or if `step` times the fastest natural
  /// frequency exceeds 1 (the integration is unstable from 2 on).
  Plant(const Exoskeleton& exoskeleton, const PatientParameters& patient, const JointArray& start,
        double step = kDefaultStep);

  /// Advances by `duration` [s], at most kLongest, under constant `input`; a duration that is not above 0
  /// does nothing. @pre input.motor_force has one entry a motor (asserted in debug; a missing one
  /// counts as 0).
  void advance(const PlantInput& input, double duration) noexcept;

  /// @returns the angles of the hand's joints [rad]; joints that the device does not have stay at `start`.
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }
  [[nodiscard]] const JointArray& speed() const noexcept { return speed_; }  ///< [rad/s]
  /// @returns the torque of the tendons on each joint, mean over the last step [Nm].
  [[nodiscard]] const JointArray& tendon_torque() const noexcept { return tendon_torque_; }

  /// @pre motor < number of motors (asserted in debug)
  [[nodiscard]] TendonState tendon(std::size_t motor) const noexcept;

  [[nodiscard]] const EnergyLedger& energy() const noexcept { return energy_; }
  /// @returns the kinetic energy and the tendons' elastic energy [J].
  [[nodiscard]] double stored_energy() const noexcept;

 private:
  static constexpr int kMostSweeps = 40;

  /// One coordinate: a joint or a rotor.
  struct Body {
    double mass = 0.0, damping = 0.0;  ///< own viscous damping, the patient's included
    DryFriction friction{};
    double position = 0.0, speed = 0.0, next_speed = 0.0;
    double drive = 0.0;            ///< sum of this step's forces that do not depend on speeds
    double drag = 0.0;             ///< total damping, tendons included
    double holds_winding = 0.0;    ///< largest dry friction of this step against a rising position
    double holds_unwinding = 0.0;  ///< the same against a falling one
    double stopping = 0.0;         ///< impulse of dry friction in this step
    double momentum = 0.0;  ///< at the end of this step, without dry friction and other bodies' speeds; ...
    double inverse = 0.0;   ///< ... times this it is the speed
  };
  struct Joint {
    int joint;
    std::size_t body;
    double stiffness, patient_damping, damping;
  };
  struct Arm {
    std::size_t body;
    double arm;  ///< with a linkage that of this step
  };
  /// Linkage of an element of arms_.
  struct Curve {
    std::size_t arm;
    std::size_t tendon;
    JointLinkage linkage;
  };
  struct Tendon {
    std::size_t rotor = 0;
    std::size_t first_arm = 0, last_arm = 0;            ///< range in arms_
    double stiffness = 0.0, damping = 0.0, play = 0.0;  ///< play: half the backlash
    bool pull_only = false;
    double capstan = 0.0;
    double lag = 0.0, limit = 0.0;
    double half_decay = 0.0;                     ///< decay of the lag in half a step
    double motor_force = 0.0;                    ///< f
    double elastic = 0.0, active_damping = 0.0;  ///< in this step
    double drive = 0.0;                          ///< f in the middle of this step
    double tension = 0.0;                        ///< mean over the last step
    double bend = 0.0;      ///< sum of  e(q) - r q  of its linkages, at the angles of follow_linkages() [m]
    bool released = false;  ///< made slack in this step, although its spring was stretched
  };

  void one_step(const PlantInput& input, double h, double t) noexcept;
  void load(const PlantInput& input, double h, double t) noexcept;
  void follow_linkages() noexcept;
  void pull(Tendon& tendon, double command) noexcept;
  void solve_speeds(double h) noexcept;
  bool sweep(double h) noexcept;
  bool release_pushing() noexcept;
  void book(double h) noexcept;
  [[nodiscard]] double stretch(const Tendon& tendon) const noexcept;
  [[nodiscard]] double mean_stretch_speed(const Tendon& tendon) const noexcept;
  [[nodiscard]] static double elastic_tension(const Tendon& tendon, double stretch) noexcept;

  double step_;
  std::vector<Body> bodies_;  ///< joints, then rotors
  std::vector<Joint> joints_;
  std::vector<Tendon> tendons_;
  std::vector<Arm> arms_;
  std::vector<Curve> curves_;
  std::vector<double> patient_torque_;  ///< of each joint in this step, without the damping of q'
  std::vector<double> pulled_;          ///< by the tendons' dampers in this sweep, on each joint [Nm]
  JointArray angle_{};
  JointArray speed_{};
  JointArray tendon_torque_{};
  EnergyLedger energy_;
};

}  // namespace phalanx
