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
#include "phalanx/station/session_statistics.h"
#include "phalanx/station/station.h"

namespace phalanx {

/// What moves the hand.
enum class HandSource { kDevice, kPatient, kSliders };

struct StationHostSettings {
  std::string scene = "first_touch";  ///< a shipped one's name, or a file
  Overrides overrides;                ///< laid over the scene's keys, until another scene is loaded
  std::string device = "simulated";   ///< "simulated", "sliders", or an address: open_device.h
  std::string calibration;            ///< its file; empty: the device's own numbers
  std::string clinician;              ///< who answers for a fingertip force above 5 N: safety_settings.h
  RealtimeRequest realtime;           ///< of the loop's thread
  bool ask_for_realtime = true;       ///< false: the loop and the link are ordinary threads
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

/// What became of a request.
struct ChangeOutcome {
  std::string refused;     ///< why, for people; empty: it is done, or overtaken
  bool overtaken = false;  ///< newer values of all its keys came before it was tried: never checked nor made
};

/// Changes are asked for from any thread, made on a worker's one after the other, and answered by whoever
/// calls go_on(). Where a change is refused, everything stays as it was; should that not be made again either
/// (the device does not open), there is no station until reset() or a change brings one. A station that has
/// to end comes to zero torque first, and the next one begins at zero torque, with its ramp; after a stop()
/// that nobody took back, after a fault, and after one that could not be made, it begins stopped, until
/// resume(). While a calibration is on, all other changes are refused.
///
/// Real-time: none of it; all take locks. stop(), view(), state() and whatever else is for any thread hold
/// them for copies only and never wait for a change. The station's own loop shares no lock with them.
class StationHost {
 public:
  /// Called in go_on(), once; never once shut_down() has begun.
  using Done = std::function<void(const ChangeOutcome&)>;

  /// Loads the scene, opens the device and starts the station.
  /// @param clock  of the process; outlives the host
  /// @throws SceneError, DeviceError, CalibrationError or std::invalid_argument, saying what to do
  StationHost(StationHostSettings settings, const Clock& clock);
  StationHost(const StationHost&) = delete;
  StationHost& operator=(const StationHost&) = delete;
  ~StationHost();  ///< shut_down()

  // ---- any thread
  // Whatever has a Done throws std::runtime_error if too many changes wait already; then Done is not called.
  // Sets that wait become one: a value that newer ones of the same keys overtake is never tried.
  /// At once: zero torque, and it stays until resume(), also over changes.
  void stop() noexcept;
  /// @returns whether: not once shut_down() has begun, nor if somebody says stop in the same moment
  bool resume() noexcept;
  /// The same from afar: nothing if it is another stop by now than the one that the speaker saw.
  /// @param stops  stops(), as it was seen. @returns whether
  bool resume(std::uint64_t stops) noexcept;
  /// How often the torque was held until resume(): somebody said stop, a fault ended with its station, or no
  /// station could be made.
  [[nodiscard]] std::uint64_t stops() const noexcept;
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
  /// Where the sliders' hand is wanted [rad]; clamped to the range of motion, and what is not finite is left
  /// as it was. @returns whether sliders move the hand of the station that runs; nothing is done otherwise
  bool set_sliders(const JointArray& angle) noexcept;
  /// Ends the station at zero torque and leads through the poses; kAbandon and kWrite go back to a station.
  void calibrate(CalibrationSession::Step step, std::size_t pose, Done done);

  [[nodiscard]] bool held_stopped() const noexcept;  ///< since stops() rose last, nobody has said resume()
  [[nodiscard]] double now() const noexcept;         ///< of the process's clock [s]
  [[nodiscard]] JointArray sliders() const;          ///< where they were last set [rad]
  [[nodiscard]] StationView view() const;  ///< of the newest step; the last one's while there is no station
  [[nodiscard]] DeadlineStatistics deadlines() const;  ///< of the station that view() shows
  [[nodiscard]] SessionStatistics session() const;     ///< of all stations since the host's start
  [[nodiscard]] std::shared_ptr<const HostState> state() const;
  [[nodiscard]] const StationHostSettings& settings() const noexcept { return settings_; }

  // ---- one thread, any
  /// The next step's record, of each station in turn, also after shut_down(). @returns true if there was one
  [[nodiscard]] bool next_record(StepRecord& record);

  // ---- the owner's thread
  /// Answers what is done and begins the next change. Waits for nothing.
  void go_on();
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
