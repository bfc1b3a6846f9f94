// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/bound_files.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/device/measured_range.h"
#include "phalanx/hand/joints.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/range_file.h"

namespace phalanx {
namespace {

/// @returns true for the form of "2026-05-04"; the registry checks that there is such a day
bool has_form_of_date(const std::string& text) {
  constexpr std::string_view kForm = "0000-00-00";
  if (text.size() != kForm.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    if (digit != (kForm[i] == '0') || (!digit && text[i] != '-')) return false;
  }
  return true;
}

void check_measured_range(const Patient& patient, const MeasuredRange& range, const std::string& file) {
  if (patient.calibration.empty())
    throw std::invalid_argument(
        fmt::format("--range {}: {} has no calibration; state --calibration FILE --expires DATE first", file,
                    patient.code));
  if (range.device != patient.calibration_device || range.serial != patient.calibration_serial)
    throw std::invalid_argument(
        fmt::format("--range {}: it was measured on {} {}, the calibration of {} is for {} {}; measure it "
                    "with `phalanx device "
                    "range`",
                    file, range.device, range.serial, patient.code, patient.calibration_device,
                    patient.calibration_serial));
  if (!range.patient.empty() && range.patient != patient.code)
    throw std::invalid_argument(
        fmt::format("--range {}: it is of patient {}, not of {}; measure it with `phalanx "
                    "device range --patient {}`",
                    file, range.patient, patient.code, patient.code));
  const Calibration calibration = load_calibration(patient.calibration);
  if (range.calibration != calibration.date)
    throw std::invalid_argument(fmt::format(
        "--range {}: it was measured with the calibration of {}, {} has that of {}; measure it again", file,
        range.calibration, patient.code, calibration.date));
}

}  // namespace

std::string calibration_methods(const Calibration& calibration) {
  std::set<std::string> names;
  for (const CalibratedChannel& channel : calibration.channels)
    names.emplace(calibration_method_name(channel.method));
  return fmt::format("{}", fmt::join(names, "+"));
}

bool bind_calibration(Patient& patient, const std::string& file, const std::string& expires,
                      const std::string& today) {
  if (expires.empty())
    throw std::invalid_argument(fmt::format(
        "--calibration {}: state its last day with --expires DATE, as --expires 2026-12-31", file));
  if (!has_form_of_date(expires) || expires < today)
    throw std::invalid_argument(
        fmt::format("--expires {}: write a day from today ({}) on, as 2026-12-31", expires, today));
  const Calibration calibration = load_calibration(file);
  const std::string path = std::filesystem::absolute(file).lexically_normal().string();
  // A range without a file was typed: it belongs to the calibration that it was typed with.
  bool forgets = patient.range.empty() && !patient.own_range_deg.empty() && !patient.calibration.empty() &&
                 patient.calibration != path;
  if (!patient.range.empty()) {
    try {
      forgets = load_range(patient.range).calibration != calibration.date;
    } catch (const std::exception&) {
      forgets = true;  // without the file nothing shows that it belongs to this calibration
    }
  }
  if (forgets) {
    patient.range.clear();
    patient.own_range_deg.clear();
  }
  patient.calibration = path;
  patient.calibration_device = calibration.device;
  patient.calibration_serial = calibration.serial;
  patient.calibration_method = calibration_methods(calibration);
  patient.calibration_expires = expires;
  return forgets;
}

void bind_range(Patient& patient, const std::string& file) {
  const MeasuredRange range = load_range(file);
  check_measured_range(patient, range, file);
  patient.range = std::filesystem::absolute(file).lexically_normal().string();
  patient.own_range_deg.clear();
  for (int joint = 0; joint < kJoints; ++joint) {
    const auto& measured = range.joint[static_cast<std::size_t>(joint)];
    if (measured)
      patient.own_range_deg[std::string(joint_name(joint))] = {measured->min / kDeg, measured->max / kDeg};
  }
}

void clear_calibration(Patient& patient) {
  patient.calibration.clear();
  patient.calibration_device.clear();
  patient.calibration_serial.clear();
  patient.calibration_method.clear();
  patient.calibration_expires.clear();
  patient.range.clear();
  patient.own_range_deg.clear();
}

std::string calibration_validity(const Patient& patient, const std::string& today) {
  if (patient.calibration.empty()) return "none";
  if (patient.calibration_expires.empty()) return "without a last day";
  return fmt::format("{} {}", patient.calibration_expires < today ? "expired on" : "until",
                     patient.calibration_expires);
}

}  // namespace phalanx
