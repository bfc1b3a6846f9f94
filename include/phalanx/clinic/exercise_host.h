// SPDX-License-Identifier: Apache-2.0
// Exercises of patients on a station that goes on running: what `phalanx run` and its pages use.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "phalanx/device/fault.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/registry/accounts.h"

namespace phalanx {

/// Wish to begin an exercise for a patient.
struct ExerciseOrder {
  std::string record;     ///< random id of the patient's records
  std::string exercise;   ///< its name
  std::string confirm;    ///< the patient's code, typed again
  std::string demo = {};  ///< skill of a simulated participant (demo_skill()); empty: a person
  std::optional<std::uint64_t> seed = {};  ///< none: drawn
};

/// State of the exercise that runs, or of the last one.
struct ExerciseStatus {
  enum class Stage : std::uint8_t { kNone, kOpening, kRunning, kClosing, kEnded };
  Stage stage = Stage::kNone;
  std::uint32_t number = 0;  ///< since the program's start, from 1; 0: none has begun
  std::string record = {};   ///< of the patient
  std::string code = {};     ///< of the patient; not for pages without a session
  std::string symbol = {};
  std::string side = {};
  ExerciseDescription exercise = {};
  bool simulated = false;  ///< a simulated participant or device: the result is not of a person
  bool demo = false;       ///< a simulated participant moves the hand
  ExerciseView view = {};
  std::optional<Observation> newest = {};
  std::array<double, kDigits> flexion = {};         ///< share between open and closed hand, 0 .. 1
  std::array<double, kDigits> target_flexion = {};  ///< of ExerciseTarget::kAngle; NaN: none
  std::uint64_t stops = 0;  ///< Session::stops(): a resume that states it ends no later stop
  bool forces_off = false;  ///< a person, a fault or a stall keeps the torque at zero
  /// The station's present fault, which needs a reset; kNone: no fault
  Fault fault = Fault::kNone;
  bool last_success = false;
  /// Why it could not begin, or its result could not be made. It may name the patient's code
  std::string trouble = {};
  std::string trouble_without_code = {};      ///< the same for pages without a session
  std::string recording = {};                 ///< its file name; empty: not yet
  std::optional<ExerciseResult> result = {};  ///< kEnded, as the recording gave it
};

/// Origin of an input.
struct InputOrigin {
  /// Session::stops() of the state that the person has seen; none: of this moment
  std::optional<std::uint64_t> stops = {};
  std::string account = {};  ///< that is signed in; empty: none
};

/// Carries out exercises one after the other. Any thread, not real-time; clinic/station_exercises.h implements it
/// for a station.
class ExerciseHost {
 public:
  ExerciseHost() = default;
  ExerciseHost(const ExerciseHost&) = delete;
  ExerciseHost& operator=(const ExerciseHost&) = delete;
  virtual ~ExerciseHost() = default;

  /// Asks to begin. It reads the registry; the station is opened by the owner's thread.
  /// @returns ExerciseStatus::number of it
  /// @throws std::invalid_argument or ExerciseError naming what refuses it and the remedy; RegistryError as Registry;
  /// std::runtime_error if another exercise runs
  virtual std::uint32_t begin(const Actor& actor, const ExerciseOrder& order) = 0;
  /// Gives an input to the exercise that runs. kPause, kAbort, and a pain or fatigue at its limit stop the torque before it
  /// returns. kResume ends no stop that came after InputOrigin::stops.
  /// @throws std::invalid_argument if no exercise runs; std::runtime_error if a stop came after InputOrigin::stops
  virtual void input(const ExerciseInput& input, const InputOrigin& origin) = 0;
  void input(const ExerciseInput& input) { this->input(input, {}); }
  /// Resets the station's fault. @throws std::invalid_argument if no exercise runs
  virtual void reset() = 0;
  /// Ends the use of a patient's key, so that the patient can be deleted, and forgets the patient's exercise. Returns when
  /// the recording with this key is closed. Not for the owner's thread.
  /// @throws std::runtime_error if an exercise of this patient runs, the device is being calibrated, or the recording is not
  /// closed within 15 s
  virtual void release_key(const std::string& record) = 0;
  [[nodiscard]] virtual ExerciseStatus status() const = 0;
};

}  // namespace phalanx
