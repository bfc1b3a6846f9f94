// SPDX-License-Identifier: Apache-2.0
// A patient of the registry: a code, a side, limits and a prescription. No name, no date of birth: the clinic
// keeps that list.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Result of the entry check: the least active flexion and release that the device needs. It resists, it
/// does not assist.
struct EntryCheck {
  double flexion_deg = 0.0;  ///< active flexion that was reached [deg], 0 .. 180
  double release_deg = 0.0;  ///< of that flexion, what was released again actively [deg], 0 .. 180
  std::string date;          ///< UTC, "2026-05-04"
  bool suitable = false;     ///< false: the person is not suitable for this device
};

/// One line of a prescription.
struct PrescribedExercise {
  std::string exercise;                          ///< name of an exercise
  int repetitions_per_day = 0;                   ///< 0: the exercise's own number; at most 1000
  double minutes_per_day = 0.0;                  ///< 0: the exercise's own dose [min]; at most 240
  std::map<std::string, std::string> overrides;  ///< key of the exercise -> value, as in its file
  std::string note;
};

/// What the registry knows of a patient. Everything but `record` is sealed with the patient's key
/// on the disk.
struct Patient {
  std::string record;  ///< random id, 32 hexadecimal digits; add_patient() makes it, and it never changes
  std::string code;    ///< 1 .. 16 of A-Z, 0-9 and '-', "P07"; unique among living patients
  Handedness side = Handedness::kRight;
  std::string
      symbol;  ///< one of patient_symbols(), beside the code against confusion; empty in add_patient(): chosen

  std::string profile;              ///< hand profile: name or path; empty: the scene's
  std::string calibration;          ///< calibration file; empty: none yet
  std::string calibration_device;   ///< device that the calibration belongs to
  std::string calibration_serial;   ///< serial number of that device
  std::string calibration_method;   ///< "jig", "poses", ...: as the calibration file states it
  std::string calibration_expires;  ///< UTC, "2026-05-04": last day of validity; empty: it does not expire
  std::string range;                ///< file of the measured range; empty: none
  std::map<std::string, std::pair<double, double>>
      own_range_deg;  ///< joint name -> least, largest active angle [deg]
  std::array<double, kDigits>
      own_force_n{};  ///< largest own force of each digit [N]; 0: not measured; at most 200

  std::optional<double> force_limit_n;  ///< lowers the device's limit of a digit's force [N], > 0 .. 100
  std::optional<double> stiffness_limit_n_per_mm;  ///< lowers the stiffness [N/mm], > 0 .. 10
  std::optional<double> torque_limit_nm;           ///< lowers each joint's torque limit [Nm], > 0 .. 5

  std::vector<std::string> contraindications;  ///< a session is refused while there is one
  std::vector<std::string> warnings;           ///< shown before torque
  std::vector<PrescribedExercise> prescription;
  bool consent = false;      ///< the person consents to the recording of their data
  std::string consent_date;  ///< UTC, "2026-05-04"; empty: unknown
  std::optional<EntryCheck> entry;
  std::string note;  ///< at most 4000 bytes
};

/// @returns the 12 words of the picture symbols: "sun", "tree", "boat", ...
[[nodiscard]] std::span<const std::string_view> patient_symbols() noexcept;

/// @returns "left" or "right"
[[nodiscard]] std::string_view side_name(Handedness side) noexcept;

/// Checks all fields but `record`: ranges, lengths, UTF-8, the form of code and dates, the symbol, joint
/// names. It refuses texts that look like an identity: '@', a date as a code, words for a birth date.
/// @throws std::invalid_argument naming field, value and remedy
void check_patient_fields(const Patient& patient);

/// @returns the patient as one JSON object with the fields' names as above; without null fields
[[nodiscard]] std::string patient_json(const Patient& patient);
/// Reads what patient_json() writes. An absent field has its default, an unknown one is refused.
/// @throws std::invalid_argument naming the field; it does not call check_patient_fields()
[[nodiscard]] Patient parse_patient_json(std::string_view text);

/// @returns revision of a patient's fields: 32 hexadecimal digits of the SHA-256 of patient_json(). Equal
/// fields have equal revisions.
[[nodiscard]] std::string patient_revision(const Patient& patient);

}  // namespace phalanx
