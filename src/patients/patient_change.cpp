// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/patient_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "phalanx/core/constants.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/patients/bound_files.h"
#include "phalanx/patients/prescribed_line.h"
#include "phalanx/scene/profile_file.h"

namespace phalanx {
namespace {

bool has_data_of_hand(const Patient& patient) {
  return !patient.profile.empty() || !patient.calibration.empty() || !patient.range.empty() ||
         !patient.own_range_deg.empty() || patient.entry ||
         std::any_of(patient.own_force_n.begin(), patient.own_force_n.end(),
                     [](double n) { return n > 0.0; });
}

auto values_of(const EntryCheck& check) {
  return std::tie(check.flexion_deg, check.release_deg, check.date, check.suitable);
}

bool same_entry(const std::optional<EntryCheck>& a, const std::optional<EntryCheck>& b) {
  return a.has_value() == b.has_value() && (!a || values_of(*a) == values_of(*b));
}

auto values_of(const PrescribedExercise& line) {
  return std::tie(line.exercise, line.repetitions_per_day, line.minutes_per_day, line.overrides, line.note);
}

void copy_calibration(const Patient& from, Patient& to) {
  to.calibration = from.calibration;
  to.calibration_device = from.calibration_device;
  to.calibration_serial = from.calibration_serial;
  to.calibration_method = from.calibration_method;
  to.calibration_expires = from.calibration_expires;
}

void refuse_calibration_facts(const Patient& before, const Patient& wanted) {
  if (wanted.calibration_device != before.calibration_device ||
      wanted.calibration_serial != before.calibration_serial ||
      wanted.calibration_method != before.calibration_method)
    throw std::invalid_argument(
        "calibration_device, calibration_serial, calibration_method: they come from the calibration file; "
        "state the file as calibration, and its last day as calibration_expires");
}

/// @param kept  `before` without what another side clears
void change_calibration(const Patient& before, const Patient& kept, const Patient& wanted,
                        const std::string& today, ChangedPatient& out) {
  Patient& next = out.patient;
  const bool other_day = wanted.calibration_expires != before.calibration_expires;
  copy_calibration(kept, next);
  if (wanted.calibration == before.calibration && !other_day) return refuse_calibration_facts(before, wanted);
  if (wanted.calibration.empty()) {
    if (other_day && !wanted.calibration_expires.empty())
      throw std::invalid_argument(fmt::format(
          "calibration_expires {}: it is the last day of a calibration; state the file as calibration, too",
          wanted.calibration_expires));
    return clear_calibration(next);
  }
  if (bind_calibration(next, wanted.calibration, wanted.calibration_expires, today))
    out.said.emplace_back(
        "the range was measured with the calibration before, and is gone: measure it again");
}

void check_prescription(const Patient& before, const Patient& wanted, std::vector<std::string>& said) {
  std::set<std::string> names;
  for (const PrescribedExercise& line : wanted.prescription) {
    if (!names.insert(line.exercise).second)
      throw std::invalid_argument(
          fmt::format("prescription {}: this exercise has two lines; keep one", line.exercise));
    const bool known =
        std::any_of(before.prescription.begin(), before.prescription.end(),
                    [&](const PrescribedExercise& each) { return values_of(each) == values_of(line); });
    if (known) continue;
    if (std::string remark = check_prescribed(line); !remark.empty()) said.push_back(std::move(remark));
  }
}

}  // namespace

bool take_side(Patient& patient, Handedness side) {
  const bool clears = side != patient.side && has_data_of_hand(patient);
  patient.side = side;
  if (!clears) return false;
  patient.profile.clear();
  clear_calibration(patient);
  patient.own_range_deg.clear();
  patient.own_force_n = {};
  patient.entry.reset();
  return true;
}

std::string cleared_by_side(Handedness side) {
  return fmt::format(
      "profile, calibration, range, own range, own force and entry check were of the other hand, and are "
      "gone: "
      "measure the {} hand",
      side_name(side));
}

void check_profile_side(const Patient& patient) {
  if (patient.profile.empty()) return;
  const Handedness side = load_profile(patient.profile).handedness;
  if (side == patient.side) return;
  throw std::invalid_argument(fmt::format(
      "profile {}: it is of a {} hand, and {} exercises the {} hand; name a profile of this side, "
      "or change the side",
      patient.profile, side_name(side), patient.code, side_name(patient.side)));
}

void judge_entry_check(EntryCheck& check) {
  const EntryRequirement least;
  check.suitable = check.flexion_deg * kDeg >= least.flexion && check.release_deg * kDeg >= least.release;
}

ChangedPatient changed_patient(const Patient& before, const Patient& wanted, const std::string& today) {
  ChangedPatient out;
  out.patient = wanted;
  Patient& next = out.patient;
  Patient kept = before;
  if (take_side(kept, wanted.side)) out.said.push_back(cleared_by_side(wanted.side));
  if (wanted.profile == before.profile) next.profile = kept.profile;
  if (wanted.profile != before.profile || wanted.side != before.side) check_profile_side(next);
  if (wanted.range == before.range) next.range = kept.range;
  if (wanted.own_range_deg == before.own_range_deg) next.own_range_deg = kept.own_range_deg;
  if (wanted.own_force_n == before.own_force_n) next.own_force_n = kept.own_force_n;
  if (same_entry(wanted.entry, before.entry)) {
    next.entry = kept.entry;
  } else if (next.entry) {
    judge_entry_check(*next.entry);
  }
  change_calibration(before, kept, wanted, today, out);
  if (wanted.range != before.range && !wanted.range.empty()) bind_range(next, wanted.range);
  if (wanted.consent != before.consent && wanted.consent_date == before.consent_date)
    next.consent_date = today;
  check_prescription(before, wanted, out.said);
  return out;
}

}  // namespace phalanx
