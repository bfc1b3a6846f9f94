// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/fault.h"

#include <algorithm>
#include <array>

namespace phalanx {
namespace {

struct Entry {
  Fault fault;
  std::string_view name, meaning, remedy;
};

constexpr std::array kEntries{
    Entry{Fault::kNone, "none", "Nothing is wrong.", "Nothing to do."},
    Entry{Fault::kStepTooOld, "step_too_old",
          "The newest step that the controller had was 20 ms old, so it went to zero torque.",
          "See that the host's loop runs and that the link carries its commands, then reset."},
    Entry{Fault::kSensorRange, "sensor_range",
          "A sensor read outside its valid range in 3 samples running: its wire is open or shorted.",
          "Check the sensor's plug and wire, or its range in the controller, then reset."},
    Entry{Fault::kEmergencyStop, "emergency_stop", "The emergency stop was pressed.",
          "Find out why, release the button, then reset."},
    Entry{Fault::kDrive, "drive",
          "The device's own electronics report a fault: a motor driver, a supply or a temperature.",
          "Look at the device's own display or log, mend it, then reset."},
    Entry{Fault::kNoSample, "no_sample", "No sample has come from the device for 10 ms.",
          "Check the cable, the device's power and whether another program loads this computer, then reset."},
    Entry{Fault::kControllerRestarted, "controller_restarted",
          "The controller speaks of another session than ours: it has been switched off and on.",
          "Check its power supply, then reset; that opens a new session."},
    Entry{Fault::kRefused, "refused",
          "The device has refused us: it belongs to another host, or speaks another version.",
          "End the other program that uses the device, or bring firmware and host to one version, then "
          "reset."},
    Entry{Fault::kSampleNotFinite, "sample_not_finite", "An angle was not a number in 3 samples running.",
          "Check the calibration file and the sensor, then reset."},
    Entry{Fault::kOutOfRange, "out_of_range",
          "A joint was far outside the patient's range of motion in 3 samples running.",
          "Check how the device is worn, calibrate again if needed, then reset."},
    Entry{Fault::kJump, "jump", "A joint moved faster than a hand can in 3 samples running.",
          "Check the joint's sensor and its wire, then reset."},
    Entry{Fault::kClockBackwards, "clock_backwards",
          "The device's clock did not increase in 3 samples running.",
          "Restart the device; if it happens again, its firmware is faulty. Then reset."},
    Entry{Fault::kStuckSensor, "stuck_sensor",
          "A sensor stood still while motors or coupled joints say that its joint moved.",
          "Check that the sensor's shaft turns with its joint, then reset."},
    Entry{Fault::kTorqueDisagrees, "torque_disagrees",
          "The torque or force that was measured is not the one that was commanded.",
          "Check the motor, its tendon and the sensor's calibration, then reset."},
    Entry{Fault::kOverload, "overload", "Too many steps in a row ended too late.",
          "Lower the scene's rate or the meshes' number of triangles, or free the computer, then reset."},
    Entry{Fault::kForceCeiling, "force_ceiling", "A step asked for more force on a digit than is allowed.",
          "Check stiffness and force limits of the scene, then reset."},
    Entry{Fault::kCommandNotFinite, "command_not_finite", "A step's command was not a finite number.",
          "Keep the fault report and tell the authors; then reset."},
    Entry{Fault::kDeviceLost, "device_lost", "The device's port or socket failed.",
          "Plug the device in again, check that its port is there and reset; if that does not help, start "
          "the program again."},
    Entry{Fault::kNotActing, "not_acting", "The device does not act on the commands that it is sent.",
          "Check that it is the right device and that its firmware follows docs/link.md, then reset."},
    Entry{Fault::kOscillation, "oscillation",
          "The force oscillated again within 10 s of its return after an oscillation.",
          "Lower the stiffness or narrow the smoothing's bounds, then reset."},
    Entry{Fault::kSampleRate, "sample_rate",
          "The device sent less than half or more than twice the samples that it promises.",
          "Correct the rate in its firmware (WELCOME) or its clock, and see that its processor is not "
          "overloaded; then reset."},
};

const Entry& entry(Fault fault) noexcept {
  static constexpr Entry kUnknown{
      Fault::kNone, "unknown", "The device reports a fault that this version does not know.",
      "Look the number up in the device's documents, or bring host and firmware to one version, then reset."};
  const auto* const found =
      std::find_if(kEntries.begin(), kEntries.end(), [fault](const Entry& e) { return e.fault == fault; });
  return found == kEntries.end() ? kUnknown : *found;
}

}  // namespace

std::string_view fault_name(Fault fault) noexcept { return entry(fault).name; }
std::string_view fault_meaning(Fault fault) noexcept { return entry(fault).meaning; }
std::string_view fault_remedy(Fault fault) noexcept { return entry(fault).remedy; }

}  // namespace phalanx
