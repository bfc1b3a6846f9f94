// SPDX-License-Identifier: Apache-2.0
// The session: it keeps a station running while scene, object, hand, rate and device change.
//
// Any thread asks for a change, which waits in a CommandQueue. The worker's thread makes it (SessionWorker).
// The owner's thread calls Session::poll(), which answers. They share a SessionState. Their headers are in
// src/station.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/range_session.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/hand/hand_skin.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session_change.h"
#include "phalanx/station/session_statistics.h"
#include "phalanx/station/station.h"

namespace phalanx {

class CommandQueue;
class ImportCache;
struct HapticModel;
class SessionState;
class SessionWorker;

/// Settings of a Session.
struct SessionSettings {
  std::string scene = "first_touch";    ///< name of a shipped scene, or a file
  Overrides overrides;                  ///< replace values of the scene, until another scene is loaded
  std::string device = "simulated";     ///< "simulated", "sliders", or an address (docs/device.md)
  std::string calibration;              ///< calibration file; empty: the device's own values
  std::string range = {};               ///< file of the patient's own range of motion; empty: none
  std::string clinician;                ///< who answers for a fingertip force above 5 N: safety_settings.h
  std::optional<double> watchdog = {};  ///< DeviceInfo::watchdog of a glove's firmware [s]
  bool force_feedback = true;           ///< false: a glove that only senses (DeviceInfo::actuated)
  RealtimeRequest realtime;             ///< for the loop's thread
  bool ask_for_realtime = true;         ///< false: the loop and the link are ordinary threads
  bool keep_changes = false;            ///< for next_change()
  /// Writes the calibration wizard's result, on the worker's thread.
  /// @returns the file's path. @throws if it cannot
  std::function<std::string(const Calibration&)> write_calibration;
  /// Writes the patient's range that was measured, likewise.
  std::function<std::string(const MeasuredRange&)> write_range = {};
};

/// One step of a calibration, or of the measurement of a patient's range.
struct WizardStep {
  enum class Kind : std::uint8_t {
    kBegin,       ///< begins a calibration after `plan`
    kMeasure,     ///< measures the pose; begins to take the digit's positions
    kSkip,        ///< leaves the pose or digit out
    kBack,        ///< goes back by one
    kGoTo,        ///< goes to `pose`, which may be a digit
    kAbandon,     ///< ends without a file
    kWrite,       ///< writes the file and uses it
    kBeginRange,  ///< begins to measure the range of `patient`
    kAccept,      ///< accepts the digit's range
    kEnter,       ///< sets `angle` as the known angle of `joint` in `pose`
    kDropRange,   ///< outside of a calibration: the patient's range in force no longer limits the torque
  };
  Kind kind = Kind::kBegin;
  std::size_t pose = 0;
  CalibrationPlan plan = {};  ///< without stops: they are those of the scene's device
  std::string patient = {};   ///< MeasuredRange::patient
  int joint = 0;
  double angle = 0.0;  ///< [rad]
};

/// Order of a whole station for Session::replace(). Keys that it does not name have the scene's values.
struct StationOrder {
  std::string scene;         ///< name of a shipped scene, or a file
  Overrides overrides = {};  ///< replace values of the scene; those of the station before do not hold
  std::optional<HandSource> source = {};  ///< none: the hand is moved as before
  std::string calibration = {};           ///< calibration file; empty: the device's own values
  std::string range = {};                 ///< file of the patient's own range of motion; empty: none
  bool always = true;    ///< false: a station that runs with the same values is left, if nothing begins
  bool stopped = false;  ///< the station begins after a stop(): its torque is zero until resume()
  std::uint64_t recording = 0;  ///< RunRecorder::next_recording() that begins with it; 0: none
};

/// Geometry that stays the same from step to step.
struct SessionGeometry {
  std::uint32_t revision = 0;
  Handedness handedness = Handedness::kRight;
  HandParameters hand;    ///< as a right hand
  Pose X_WH;              ///< pose of the palm
  SegmentMeshes segment;  ///< meshes of the contact search
  SegmentMeshes display;  ///< meshes that are shown without a skin
  std::optional<HandSkin> skin;
  TriangleMesh object;                   ///< in W
  std::vector<ObjectFriction> friction;  ///< of the objects in it
  double rate_hz = 0.0;
  std::shared_ptr<const HapticModel> model;  ///< of the same hand and object
};

/// State of a session that seldom changes. Each change publishes a new SessionInfo; a reader keeps the one
/// that it holds.
struct SessionInfo {
  std::uint64_t revision = 0;
  std::string scene;
  std::string description;
  Overrides overrides;  ///< override the scene; the newest value of each key
  Overrides values;     ///< all values of the scene's file and the overrides, as TOML
  HandSource source = HandSource::kPatient;
  std::string device_spec;
  std::string calibration;  ///< calibration file; empty: the device's own values
  std::string range;        ///< file of the patient's own range of motion; empty: none
  DeviceInfo device;
  double fingertip_force = 0.0;  ///< limit of a digit's force [N]
  double margin = 0.0;           ///< ContactParameters::margin [m]
  std::string patient;           ///< SafetySettings::patient of the station
  std::vector<int> sensed_joints;
  std::string realtime;  ///< granted scheduling; empty: not asked for, or not known yet
  std::string busy;      ///< the change being made; empty: none. It is cleared before poll() can answer
  bool running = false;  ///< a station exists
  std::string trouble;   ///< why no station exists, or a problem of the device in calibration
  std::shared_ptr<const SessionGeometry> geometry;
  std::shared_ptr<const CalibrationSession::View> wizard;  ///< null: no calibration runs
  std::shared_ptr<const RangeSession::View> range_wizard;  ///< null: no range is measured

  /// @returns true while a calibration runs or a range is measured: there is no station then.
  [[nodiscard]] bool calibrating() const noexcept { return wizard != nullptr || range_wizard != nullptr; }
};

/// Result of a change.
struct ChangeOutcome {
  std::string refused;     ///< reason, for people; empty: done or overtaken
  bool overtaken = false;  ///< newer values of all its keys came before it was tried; it was not made
};

/// Session of one device with a running station. Any thread asks for changes. The worker's thread makes them,
/// one after the other. The owner's thread calls poll(), which answers them.
///
/// If a change is refused, everything stays as it was. If the old station cannot be made again either (the
/// device does not open, for example), there is none until reset() or another change. A station that has to
/// end first comes to zero torque. The next one begins at zero torque, with its start ramp. It begins
/// stopped, until resume(), in three cases: after a stop() without a later resume(), after a fault, and after
/// a station that could not be made. While a calibration runs, all other changes are refused.
///
/// Once a station was for a patient's session (SafetySettings::patient), all later ones are.
///
/// Not real-time: all functions take locks. stop(), view(), info() and the other functions for any thread
/// hold a lock only to copy, and never wait for a change. The station's loop shares no lock with them.
class Session {
 public:
  /// Callback with the result of a change. poll() calls it once, but not after shut_down() has begun.
  using Done = std::function<void(const ChangeOutcome&)>;

  /// Loads the scene, opens the device, and starts the station and the worker's thread. That thread and the
  /// threads that it starts inherit the caller's scheduling.
  /// @param clock  the process's clock; outlives the session
  /// @throws SceneError, DeviceError, CalibrationError or std::invalid_argument; each names the remedy.
  /// std::system_error if no thread can be made
  Session(SessionSettings settings, const Clock& clock);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();  ///< shut_down()

  // ---- for any thread
  // A function with a Done throws std::runtime_error if too many changes wait already, or after shut_down()
  // has begun. It then does not call Done. Waiting sets become one: if newer values of the same keys overtake
  // a value, it is never tried.
  /// Ramps to zero torque now. The torque stays zero until resume(), also over changes.
  void stop() noexcept;
  /// Ends a stop().
  /// @returns false, with no effect, after shut_down() has begun or if stop() is called at the same moment
  bool resume() noexcept;
  /// Ends the stop that a remote user saw. It has no effect if another stop has come since.
  /// @param stops  stops() at the time that the user saw it. @returns true if the stop was ended
  bool resume(std::uint64_t stops) noexcept;
  /// @returns how often the torque was held until resume(): by stop(), by a fault that ended with its
  /// station, or because no station could be made.
  [[nodiscard]] std::uint64_t stops() const noexcept;
  void reset() noexcept;  ///< after a fault; without a station, tries again to make one
  /// Resets the fault that a remote user saw. It has no effect if there is another fault by now.
  /// @param fault_time  FaultEvent::time of the fault seen [s]; 0: there was none
  /// @returns true if a reset was asked for
  bool reset(double fault_time) noexcept;
  /// Asks to open a digit that started inside the object. A person has seen its way out and has confirmed it.
  /// @param way      DigitOpening::way that the person saw [m]
  /// @param running  StationView::running of the view that the person saw
  /// @throws std::invalid_argument, with the remedy, if forces are not on, or have been off since; if the device has
  /// no motors; if the digit needs no opening; or if its way has changed by more than OpeningState::kSameWay
  void open_digit(int digit, double way, std::uint64_t running);
  /// Replaces values of the scene's keys: in contact, at zero torque or with a new station, as the keys need.
  /// An empty value removes an override.
  void set(Overrides changes, Done done);
  /// Loads another scene, without the overrides of the last one.
  void load_scene(std::string scene, Done done);
  /// Replaces the whole station, as load_scene() does: at zero torque, and stopped if it was stopped. It is also for a
  /// session without a station. What can be refused before the station ends is refused then; if the device refuses
  /// afterwards, the station before is made again, as a new one. With StationOrder::stopped that one is stopped, too.
  void replace(StationOrder order, Done done);
  /// Selects kPatient or kSliders of the simulated device; refused for a device on a wire.
  void set_source(HandSource source, Done done);
  /// Sets the joint angles of the hand that the sliders move [rad]. They are clamped to the range of motion;
  /// an angle that is not finite is left as it was.
  /// @returns false, with no effect, if sliders do not move the hand of the running station
  bool set_sliders(const JointArray& angle) noexcept;
  /// Takes one step of a calibration or of the measurement of a range. kBegin and kBeginRange end the station at zero
  /// torque; kAbandon and kWrite start it.
  void calibrate(WizardStep step, Done done);

  [[nodiscard]] bool held_stopped() const noexcept;  ///< no resume() since stops() last rose
  [[nodiscard]] double now() const noexcept;         ///< the process's clock [s]
  [[nodiscard]] JointArray sliders() const;          ///< the angles last set [rad]
  [[nodiscard]] StationView view() const;  ///< after the newest step; without a station, the last one's
  [[nodiscard]] DeadlineStatistics deadlines() const;  ///< of the station that view() shows
  [[nodiscard]] SessionStatistics statistics() const;  ///< over all stations since the session's start
  [[nodiscard]] std::shared_ptr<const SessionInfo> info() const;
  [[nodiscard]] const SessionSettings& settings() const noexcept { return settings_; }
  /// @returns the cache of the meshes that the stations import; it may outlive the session
  [[nodiscard]] std::shared_ptr<ImportCache> imports() const noexcept { return imports_; }

  // ---- for one thread at a time
  /// Fetches the next step's record, station by station, also after shut_down().
  /// @param samples  receives the samples of the step
  /// @returns true if there was one
  [[nodiscard]] bool next_record(StepRecord& record, std::vector<DeviceSample>& samples);
  /// Fetches the next change, with SessionSettings::keep_changes. A change comes before the first record of a step that
  /// names it: fetch records first, then all changes, and look for those of the records.
  /// @returns true if there was one
  [[nodiscard]] bool next_change(SessionChange& change);

  // ---- the owner's thread
  /// Answers the changes that are done. Returns at once; call it every 20 ms or so.
  /// @throws what a Done throws; the next call then goes on with the answer after that one
  void poll();
  [[nodiscard]] std::optional<FaultReport> take_fault_report();
  [[nodiscard]] std::optional<RealtimeGrant> grant() const;
  /// Ramps to zero torque for good, then waits for the change being made and for the station's end.
  void shut_down() noexcept;

 private:
  void publish_grant();

  const SessionSettings settings_;
  const Clock& clock_;
  const std::unique_ptr<SessionState> state_;
  const std::unique_ptr<CommandQueue> queue_;
  const std::shared_ptr<ImportCache> imports_;
  const std::unique_ptr<SessionWorker> worker_;  ///< declared last, so that it ends first
  bool ended_ = false;                           ///< shut_down() has begun; the owner's thread
};

}  // namespace phalanx
