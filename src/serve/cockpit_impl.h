// SPDX-License-Identifier: Apache-2.0
// Inside of the Cockpit, with an overview of this folder. Begin here to read it.
//
// Threads: all of Cockpit::Impl runs on the server's thread, whose functions must return soon. Further
// threads do what takes long: the log of changes (audit_log.h), the encoding of a geometry
// (geometry_cache.h), one upload at a time (uploads.h), the reading of files (station_files.h), and the
// patients (people.h). The station's owner reports the outcome of a change in Session::poll(); the report is
// posted to the server's thread.
//
// Way of a message: the bytes of a page arrive in Cockpit::received(), are decoded, and go to handle(). A
// stop calls Session::stop() right there: no queue and no other thread stand between the page and the
// station. Requests of the operator go through page_requests.h to the Session; their outcome becomes a Reply
// and a Notice. Each frame sends the newest tick (record/recording/view_message.h), and the state
// (state_message.h) if it has changed or is due.
//
// Further files: participants.h has the roles, exercise_message.h the exercise, people.h the patients,
// plain_text.h and settings_text.h the texts for people.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/cockpit.pb.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/serve/cockpit.h"
#include "phalanx/step/displayed_hand.h"
#include "serve/audit_log.h"
#include "serve/geometry_cache.h"
#include "serve/page_requests.h"
#include "serve/participants.h"
#include "serve/people.h"
#include "serve/station_files.h"
#include "serve/uploads.h"

namespace phalanx {

/// Flow control of the ticks for one page.
struct TickWindow {
  /// Ticks that may be sent and not acknowledged: 0.2 s at 60 a second.
  static constexpr std::uint64_t kUnacknowledged = 12;
  std::uint64_t sent = 0;             ///< since the Welcome, without ticks that a newer one replaced
  std::uint64_t acknowledged = 0;     ///< of these, by Seen
  std::optional<double> newest = {};  ///< time of the newest tick that was sent [s]; none yet
  bool of_patient = false;            ///< of the patient's screen: it gets no notices
  bool may_operate = false;           ///< false: of the viewers' link

  [[nodiscard]] bool open() const noexcept { return sent - acknowledged < kUnacknowledged; }
};

/// State and functions of the Cockpit. Server's thread only, except where a function says otherwise.
struct Cockpit::Impl : std::enable_shared_from_this<Cockpit::Impl> {
  Impl(Session& served, CockpitSettings given);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();
  [[nodiscard]] double now() const { return settings.clock(); }  ///< [s]

  // ---- messages to pages: cockpit_outgoing.cpp
  void send_notice(const Bytes& bytes);  ///< to all pages but the patient's screens
  /// Sends a notice to all pages and the log, after the notice of a drag that is held back.
  void notify(wire::Notice::Level level, const std::string& who, const std::string& code,
              const std::string& text);
  void notify_drag();
  void notify_drag_if_due();
  void notify_if_log_breaks();
  /// Sends a warning to one page only; it is not logged.
  void notify_page(PageId page, const std::string& code, const std::string& text);
  void give_control_to_only_page();
  /// @param refused  why the request is refused; empty: it is done
  void reply(PageId page, std::uint32_t request, const std::string& refused);
  /// @returns a message of the station without command line options and without the installation's folder
  [[nodiscard]] std::string for_pages(const std::string& text) const;
  void send_welcome(PageId page);
  void refuse_protocol(PageId page, std::uint32_t protocol);
  [[nodiscard]] wire::ToPage present_state();
  /// @returns true if a page gets what concerns the patient's screen alone
  [[nodiscard]] bool gets_patient_state(const TickWindow& window) const noexcept {
    return window.of_patient || (exercise_has_station && !window.may_operate);
  }
  /// Sends the state with a later frame, however often something changes: at
  /// most every kShortestStateInterval.
  void request_state() { state_requested = true; }
  void send_state_if_due();
  void send_tick();
  /// Replaces the GDP's poses by those of the hand that is drawn.
  void draw(StationView& view);
  void disconnect_pages_without_hello();

  // ---- exercises and the patient's screen: cockpit_exercise.cpp
  [[nodiscard]] Bytes encoded_exercise(const ExerciseStatus& status) const;
  void look_at_exercise();  ///< before a page gets a state or a geometry
  void send_present_exercise(PageId page);
  void send_exercise_if_due();

  // ---- messages from pages: cockpit_incoming.cpp
  /// @throws std::exception if the message is refused
  void handle(PageId page, const wire::ToHost& message);
  /// Stops the torque at once.
  /// @param source  of the stop, a page or an address: repeated stops of one source are logged once a second
  void stop(const std::string& source, const std::string& who);
  void stop(const Participant& participant);
  void fault_reported(const std::string& file, double fault_time);

  // ---- HTTP requests: cockpit.cpp
  void respond_with_geometry(const std::string& revision, std::function<void(WebResponse)> respond);
  /// @returns the operator if the request is the operator's; else null
  [[nodiscard]] const Participant* operator_of(const WebRequest& request) const;
  void mark(const WebRequest& request, const std::function<void(WebResponse)>& respond);
  /// Writes accounts that have signed in or out to the log, and names them beside their pages from now on.
  void notify_sign_ins();
  void begin_upload(const WebRequest& request, std::function<void(WebResponse)> respond);

  Session& session;
  const CockpitSettings settings;
  WebServer* server = nullptr;
  std::vector<std::string> viewer_urls;
  AuditLog log;
  Participants participants;
  wire::Welcome choices;  ///< the fields of a Welcome that are equal for all pages
  const std::filesystem::path shipped = data_folder();
  std::map<PageId, TickWindow> greeted;          ///< pages that have sent Hello
  std::map<PageId, double> awaiting_hello;       ///< the others, since [s]
  std::map<std::string, double> stops_notified;  ///< newest notice of a source's stop, for kStopInterval [s]
  std::map<std::uint32_t, double> sliders_notified;  ///< newest notice of a participant's sliders [s]
  /// Change by a control that is being dragged. Its notice is held back until the drag ends or another
  /// notice is due.
  struct Drag {
    PageId page = 0;
    std::string who;
    PageRequest newest;
    double since = 0.0;  ///< [s]
  };
  std::optional<Drag> drag;
  std::string report;       ///< file of the fault report for the fault at `reported`
  double reported = -1.0;   ///< host's clock [s]
  bool log_broken = false;  ///< all pages have been notified
  bool state_requested = false;
  double state_sent = -1e9;  ///< [s]
  std::uint64_t sent_revision = 0;
  SafetyState sent_safety = SafetyState::kWaiting;
  const std::shared_ptr<GeometryCache> geometry_cache = std::make_shared<GeometryCache>();
  const std::shared_ptr<People> people = std::make_shared<People>(
      settings.registry, settings.exercises, std::function<double()>(), settings.exercises_host);
  const std::shared_ptr<StationFiles> station_files = std::make_shared<StationFiles>(
      settings.recordings,
      [people = people](const WebRequest& request) { return people->recording_access(request); });
  /// WebServer::send_newest(): ticks are of kind 0.
  static constexpr std::size_t kExerciseMessages = 1;
  /// Part of an exercise of which each change is sent to each page.
  struct SentExercise {
    std::uint32_t number = 0;
    ExerciseStatus::Stage stage = ExerciseStatus::Stage::kNone;
    ExercisePhase phase = ExercisePhase::kReady;
    std::string trouble = {};
    [[nodiscard]] bool operator==(const SentExercise&) const = default;
  };
  SentExercise sent_exercise;
  bool exercise_has_station = false;  ///< exercise_runs(), at the newest frame or page
  bool hides_scene = false;           ///< the exercise that runs does, likewise
  std::uint64_t frames = 0;
  double sign_ins_checked = -1e9;                         ///< [s]
  std::shared_ptr<UploadJob> upload;                      ///< the newest
  std::shared_ptr<const SessionGeometry> drawn_geometry;  ///< of `drawn`
  double drawn_margin = 0.0;                              ///< of `drawn` [m]
  std::optional<DisplayedHand> drawn;
  double drawn_at = 0.0;  ///< time of the step that it followed last [s]

 private:
  void hello(PageId page, const wire::Hello& hello);
  void disconnect_replaced(PageId page);
  void acknowledge(PageId page, std::uint64_t ticks);
  void take_control(PageId page);
  void release_control(PageId page);
  /// @returns true if a notice of the change is due
  [[nodiscard]] bool notice_is_due(PageId page, const PageRequest& request);
  /// @returns true if the drag that is held back is of this page and these keys
  [[nodiscard]] bool continues_drag(PageId page, const PageRequest& request) const;
  void hold_back(PageId page, const std::string& who, const PageRequest& request);
  void feel(PageId page, const wire::Feel& feel);
  void refuse_unless_may_feel(const Participant& participant) const;
  void refuse_during_exercise(const wire::ToHost& message) const;
  void refuse_unless_operator(PageId page) const;
  void pass_to_session(PageId page, const wire::ToHost& message);
  void on_outcome(PageId page, std::uint32_t number, const std::string& who, const PageRequest& request,
                  const ChangeOutcome& outcome);
};

/// @returns a notice with the present time; `who` and `text` may hold any bytes
[[nodiscard]] wire::Notice make_notice(wire::Notice::Level level, const std::string& who,
                                       const std::string& code, const std::string& text);

}  // namespace phalanx
