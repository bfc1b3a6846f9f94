// SPDX-License-Identifier: Apache-2.0
// The cockpit: what pages see of the station and what they may do with it. See docs/cockpit.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/record/session_recorder.h"
#include "phalanx/serve/web_server.h"
#include "phalanx/station/session.h"

namespace phalanx {

class ExerciseHost;
class Registry;

/// Exercise that can be prescribed, as the page of patients lists it.
struct ListedExercise {
  std::string name;           ///< of its file
  std::string title;          ///< for people
  std::string title_de = {};  ///< the same in German; empty: none
  std::string kind;           ///< "training" or "assessment"
  std::string measure;        ///< "press_and_hold"
};

/// Settings that stay constant from the start on.
struct CockpitSettings {
  std::filesystem::path log;              ///< file for the log of changes, one JSON line each; empty: none
  std::filesystem::path uploads;          ///< folder for meshes that pages send; created with the first
  std::filesystem::path recordings = {};  ///< folder that pages may list and read; empty: none
  std::string version;                    ///< of the program, for people
  std::function<double()> clock;          ///< monotonic [s]; empty: the system's. For tests
  std::function<std::optional<RecordingStatus>()> recording =
      {};  ///< state of the recording; empty: nothing is recorded
  /// Gets each notice with its code, who made the change, and its text; on the server's thread.
  std::function<void(const std::string& code, const std::string& who, const std::string& text)> on_notice =
      {};
  std::shared_ptr<Registry> registry = {};  ///< patients and accounts; null: /people answers 404
  std::function<std::vector<ListedExercise>()> exercises =
      {};  ///< that can be prescribed; called on a thread of the cockpit; empty: none
  std::shared_ptr<ExerciseHost> exercises_host = {};  ///< carries out exercises of patients; null: none
};

/// Application behind the web server: connects the pages with a Session.
///
/// Roles. Every page may stop. One page at a time is the operator and may also do the rest. The first page
/// that may operate becomes the operator; others take control openly, and all pages are told who took it
/// from whom. A page that reconnects within 10 s keeps its role. If its old connection still counts as open,
/// it replaces the old one.
///
/// Messages. A page is sent ticks only as fast as it acknowledges them. A page with another protocol is
/// refused with a reason. If the log of changes cannot be written, changes are made all the same, and both
/// the pages and the log say so.
///
/// Patients. With a registry the addresses below /people serve the page of patients (src/serve/people.h). If an
/// account signs in there, the log of changes names it beside the page that the sign-in came from.
///
/// Not real-time: all functions allocate, lock, or both.
class Cockpit final : public WebApplication {
 public:
  static constexpr std::uint32_t kProtocol = 3;                     ///< of proto/phalanx/cockpit.proto
  static constexpr std::size_t kUploadLimit = 64U * 1024U * 1024U;  ///< [bytes]
  static constexpr std::size_t kMarkerLimit = 1000;                 ///< text of a marker [bytes]

  /// @param session  outlives the cockpit
  /// @throws std::runtime_error if the log cannot be written
  Cockpit(Session& session, CockpitSettings settings);
  ~Cockpit() override;

  /// Connects the cockpit with its server. Call it before WebServer::start().
  /// @param server       is destroyed before the cockpit; nothing may call Session::poll() meanwhile
  /// @param viewer_urls  links for viewers, which pages that may operate are sent
  void attach(WebServer& server, const std::vector<std::string>& viewer_urls = {});

  /// Sends a notice of the station to all pages and to the log. Any thread.
  /// @param code  by which pages may translate it: "fault", "reset_refused", ...
  void notify(const std::string& code, const std::string& text, bool fault);
  /// Sends a notice of a change that was typed at the station's terminal. Any thread.
  void typed(const std::string& code, const std::string& text);
  /// Reports the file of a fault report. Pages show it beside that fault only. Any thread.
  /// @param fault_time  FaultEvent::time of the report, on the host's clock [s]
  void fault_reported(const std::string& file, double fault_time);

  void joined(PageId page, const ClientInfo& client) override;
  void left(PageId page) override;
  void received(PageId page, std::string_view message) override;
  void received_over_limit(PageId page, std::string_view message) override;
  void frame() override;
  void requested(const WebRequest& request, std::function<void(WebResponse)> respond) override;
  [[nodiscard]] std::size_t body_limit(const WebRequest& head) override;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< late answers of the station check whether it still exists
};

}  // namespace phalanx
