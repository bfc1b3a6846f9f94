// SPDX-License-Identifier: Apache-2.0
// The mechanics of exoskeleton and finger: motors, tendons in sheaths, joints, the patient's impedance.
#pragma once

#include <cstddef>
#include <vector>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/patient.h"

namespace phalanx {

/// What acts on the plant from outside during one call of Plant::advance().
struct PlantInput {
  std::vector<double> motor_force;  ///< command to each motor, held [N]; not finite counts as 0
  JointArray intended{};            ///< where the patient wants each joint to be at the beginning [rad]
  JointArray intended_speed{};      ///< and how fast that moves [rad/s]
  JointArray push{};                ///< torque from outside on each joint [Nm]
};

/// Where energy came from and went to since the start [J]. Each term is the sum over all steps of a force
/// times the mean of the speeds before and after the step.
struct EnergyLedger {
  double motors = 0.0;       ///< done by the motors on the rotors
  double patient = 0.0;      ///< done by the patient's impedance and by pushes on the joints
  double dissipated = 0.0;   ///< in viscous and dry friction and in the tendons' damping, >= 0
  double turned_over = 0.0;  ///< sum of the absolute values of all of these
};

/// One motor and its tendon, in the tendon's coordinates.
struct TendonState {
  double wound = 0.0;        ///< y, what the motor has wound up [m]
  double speed = 0.0;        ///< of the rotor [m/s]
  double motor_force = 0.0;  ///< f, behind the lag [N]
  double tension = 0.0;      ///< T, mean over the last step [N]
};

/// Motor force  df/dt = (u - f) / lag,  |u| <= force_limit.
/// Rotor        m y'' = f - T - b y' - friction(y').
/// Tendon       T = k (|s| - play) sign(s) + c s'  where the stretch s = y - sum_j arm_j q_j has taken up the
/// play (half the backlash), else 0; pull_only: T >= 0. Joint        I_j q_j'' = sum_i arm_ij T_i - b q_j' -
/// friction(q_j') + k_p (q_intended - q) + b_p (q_intended' - q') + push.
///
/// Fixed step, of second order where motion is smooth: half a step of drift, one kick with all position
/// forces taken in the middle, half a step of drift (position Verlet; Hairer, Lubich & Wanner 2003, with the
/// damping by its mean speed). Dry friction enters the kick as the impulse that is needed to stop, at most
/// h F: what sticks has the speed 0 exactly and does not creep. The kicks of bodies that a tendon damps
/// against each other are solved by sweeps of Gauss-Seidel, until no speed changes by more than 1e-9 of
/// itself or kMostSweeps are done. A tendon that may only pull and would end a step below 0 does nothing in
/// that step instead; what its spring then gives up is lost in its own damper. Same parameters and inputs,
/// same bits.
///
/// Whatever arrives, the state stays finite: a command, a push or a patient's torque that is not finite
/// counts as 0, and what patient and push do on a joint is kept within kLargestTorque. Real-time: advance()
/// allocates nothing, locks nothing, throws nothing.
class Plant {
 public:
  static constexpr double kDefaultStep = 50e-6;  ///< [s]
  static constexpr double kLongest = 3600.0;     ///< of one call [s]
  static constexpr double kLargestTorque = 1e6;  ///< that patient and push may do on a joint together [Nm]

  /// At rest at `start`, tendons without tension.
  /// @param step  upper bound of the integration step [s]; a call of advance() is cut into equal steps of at
  /// most this
  /// @throws std::invalid_argument as check_exoskeleton() and check_patient(), or if `start` of one of its
  /// joints is not finite, if `step` is not in 1e-7 .. 1e-3 s, or too long for the stiffest tendon: times the
  /// fastest natural frequency it may be 1 (at 2 the integration is unstable).
  Plant(const Exoskeleton& exoskeleton, const PatientParameters& patient, const JointArray& start,
        double step = kDefaultStep);

  /// Goes on for `duration` [s], at most kLongest, under constant `input`; one that is not above 0 does
  /// nothing. @pre input.motor_force has one entry a motor (asserted in debug; a missing one counts as 0).
  void advance(const PlantInput& input, double duration) noexcept;

  /// Angles of the hand's joints [rad]; those that the device does not have stay where they started.
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }
  [[nodiscard]] const JointArray& speed() const noexcept { return speed_; }  ///< [rad/s]
  /// Torque of the tendons on each joint, mean over the last step [Nm].
  [[nodiscard]] const JointArray& tendon_torque() const noexcept { return tendon_torque_; }

  /// @pre motor < number of motors (asserted in debug)
  [[nodiscard]] TendonState tendon(std::size_t motor) const noexcept;

  [[nodiscard]] const EnergyLedger& energy() const noexcept { return energy_; }
  /// Kinetic energy and the tendons' elastic energy [J].
  [[nodiscard]] double stored_energy() const noexcept;

 private:
  static constexpr int kMostSweeps = 40;

  /// One coordinate: a joint or a rotor.
  struct Body {
    double mass = 0.0, damping = 0.0;  ///< own viscous damping, the patient's included
    DryFriction friction{};
    double position = 0.0, speed = 0.0, next_speed = 0.0;
    double drive = 0.0;            ///< sum of the forces of this step that do not depend on speeds
    double drag = 0.0;             ///< damping of all that acts on it, tendons included
    double holds_winding = 0.0;    ///< largest dry friction of this step against a rising position
    double holds_unwinding = 0.0;  ///< and against a falling one
    double stopping = 0.0;         ///< impulse that dry friction took in this step
    double momentum = 0.0;  ///< at the end of this step, but for dry friction and other bodies' speeds; ...
    double inverse = 0.0;   ///< ... times this it is the speed
  };
  struct Joint {
    int joint;
    std::size_t body;
    double stiffness, patient_damping, damping;
  };
  struct Arm {
    std::size_t body;
    double arm;
  };
  struct Tendon {
    std::size_t rotor = 0;
    std::size_t first_arm = 0, last_arm = 0;            ///< in arms_
    double stiffness = 0.0, damping = 0.0, play = 0.0;  ///< half the backlash
    bool pull_only = false;
    double capstan = 0.0;
    double lag = 0.0, limit = 0.0;
    double half_decay = 0.0;                     ///< of the lag in half a step
    double motor_force = 0.0;                    ///< f
    double elastic = 0.0, active_damping = 0.0;  ///< of this step
    double drive = 0.0;                          ///< f in the middle of this step
    double tension = 0.0;                        ///< mean of the last step
    bool released = false;                       ///< slack in this step although its spring was stretched
  };

  void one_step(const PlantInput& input, double h, double t) noexcept;
  void load(const PlantInput& input, double h, double t) noexcept;
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
  std::vector<double> patient_torque_;  ///< of this step but for the damping of q', a joint
  std::vector<double> pulled_;          ///< by the tendons' dampers in this sweep, a joint [Nm]
  JointArray angle_{};
  JointArray speed_{};
  JointArray tendon_torque_{};
  EnergyLedger energy_;
};

}  // namespace phalanx
