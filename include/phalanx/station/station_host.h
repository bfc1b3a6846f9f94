// SPDX-License-Identifier: Apache-2.0
// Whoever owns the station: keeps it running while scene, object, hand, rate and device change.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"
#include "phalanx/hand/hand_meshes.h"
#include "phalanx/hand/hand_skin.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/assemble.h"
#include "phalanx/station/station.h"

namespace phalanx {

/// What moves the hand.
enum class HandSource { kDevice, kPatient, kSliders };

struct StationHostSettings {
  std::string scene = "first_touch";
  Overrides overrides;
  std::string device = "simulated";  ///< "simulated", "sliders", or an address: open_device.h
  std::string calibration;           ///< its file; empty: the device's own numbers
  std::string clinician;
  RealtimeRequest realtime;
  bool ask_for_realtime = true;
  /// Writes what the calibration wizard found. @returns the file. @throws if it cannot
  std::function<std::string(const Calibration&)> write_calibration;
};

/// What does not change from step to step.
struct HostGeometry {
  std::uint32_t revision = 0;
  Handedness handedness = Handedness::kRight;
  HandParameters hand;    ///< of a right hand
  Pose X_WH;              ///< the palm
  SegmentMeshes segment;  ///< what the search sees
  SegmentMeshes display;  ///< what is shown without a skin
  std::optional<HandSkin> skin;
  TriangleMesh object;  ///< in W
  double rate_hz = 0.0;
};

/// What changes seldom. A new one takes the place of the last, so that whoever holds one can read on.
struct HostState {
  std::uint64_t revision = 0;
  std::string scene;
  std::string description;
  Overrides overrides;  ///< laid over the scene, the last word of each key
  Overrides values;     ///< all that the scene's file and the overrides state, as TOML
  HandSource source = HandSource::kPatient;
  std::string device_spec;
  std::string calibration;  ///< its file; empty: the device's own numbers
  DeviceInfo device;
  double fingertip_force = 0.0;  ///< largest of a digit [N]
  std::vector<int> sensed_joints;
  std::string realtime;  ///< what the system granted; empty: not asked, or not known yet
  std::string busy;      ///< the change on its way; empty: none
  bool running = false;  ///< there is a station
  std::string trouble;   ///< why there is none, or what the calibration's device has
  std::shared_ptr<const HostGeometry> geometry;
  std::shared_ptr<const CalibrationSession::View> wizard;  ///< null: no calibration is on
};

/// Changes are asked for from any thread, made on a worker's one after the other, and answered by whoever
/// calls go_on(). Where a change is refused, everything stays as it was; should the device not open again
/// either, there is no station until reset(). A station that has to end comes to zero torque first, and the
/// next one begins at zero torque, with its ramp; after a stop() that nobody took back, or a fault, it begins
/// stopped. While a calibration is on, all other changes are refused.
class StationHost {
 public:
  /// What became of a request: empty if it is done, else the reason. Called in go_on(); never once
  /// shut_down() has begun.
  using Done = std::function<void(const std::string& refused)>;

  /// Loads the scene, opens the device and starts the station.
  /// @param clock  of the process; outlives the host
  /// @throws SceneError, DeviceError, CalibrationError or std::invalid_argument, saying what to do
  StationHost(StationHostSettings settings, const Clock& clock);
  StationHost(const StationHost&) = delete;
  StationHost& operator=(const StationHost&) = delete;
  ~StationHost();  ///< shut_down()

  // ---- any thread
  // Whatever has a Done throws std::runtime_error if too many changes wait already; then Done is not called.
  // Sets that wait become one: a value that a newer one of the same key overtakes is answered as that one.
  /// At once: zero torque, and it stays until resume(), also over changes.
  void stop() noexcept;
  void resume() noexcept;
  /// The same from afar: nothing if somebody has said stop since the speaker saw `stops`. @returns whether
  bool resume(std::uint64_t stops) noexcept;
  [[nodiscard]] std::uint64_t stops() const noexcept;  ///< how often somebody has said stop
  void reset() noexcept;  ///< after a fault; where there is no station, tries again to make one
  /// The same from afar: nothing if there is another fault by now than the one of that time [s].
  /// @param fault_time  FaultEvent::time; 0: there was none. @returns whether
  bool reset(double fault_time) noexcept;
  /// Lays values over the scene's keys. In contact, at zero torque, or with a new station: whatever the keys
  /// need. An empty value takes an override away.
  void set(Overrides changes, Done done);
  void load_scene(std::string scene, Done done);
  /// kPatient and kSliders, of the simulated device; refused for a device on a wire.
  void set_source(HandSource source, Done done);
  /// Where the sliders' hand is wanted [rad]; clamped to the range of motion. Only with kSliders.
  void set_sliders(const JointArray& angle) noexcept;
  /// Ends the station at zero torque and leads through the poses; kAbandon and kWrite go back to a station.
  void calibrate(CalibrationSession::Step step, std::size_t pose, Done done);

  [[nodiscard]] bool held_stopped() const noexcept;  ///< somebody said stop(), and nobody resume()
  [[nodiscard]] double now() const noexcept;         ///< of the process's clock [s]
  [[nodiscard]] JointArray sliders() const;          ///< where they were last set [rad]
  [[nodiscard]] StationView view() const;  ///< of the newest step; the last one's while there is no station
  [[nodiscard]] DeadlineStatistics deadlines() const;
  [[nodiscard]] std::shared_ptr<const HostState> state() const;
  [[nodiscard]] const StationHostSettings& settings() const noexcept { return settings_; }

  // ---- the owner's thread
  /// Answers what is done and begins the next change. Waits for nothing.
  void go_on();
  /// The next step's record of the station that runs. @returns whether there was one
  [[nodiscard]] bool next_record(StepRecord& record);
  [[nodiscard]] std::optional<FaultReport> take_fault_report();
  [[nodiscard]] std::optional<RealtimeGrant> grant() const;
  void lengthen_steps(double seconds) noexcept;  ///< Station::lengthen_steps()
  /// Torque falls to zero at once, and nobody brings it back; then waits for a change on its way, and for the
  /// station's end.
  void shut_down() noexcept;

 private:
  struct Parts;
  StationHostSettings settings_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx
