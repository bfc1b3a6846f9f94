// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/cockpit.pb.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/serve/cockpit.h"
#include "serve/audit_log.h"
#include "serve/page_requests.h"
#include "serve/seats.h"
#include "serve/shapes.h"
#include "serve/upload_work.h"

namespace phalanx {

/// How a page keeps up with the ticks that it is sent.
struct Pace {
  /// So many may be on their way: at 60 a second, 0.2 s of them.
  static constexpr std::uint64_t kOnTheirWay = 12;
  std::uint64_t sent = 0;        ///< since its welcome; what a newer one has replaced aside
  std::uint64_t seen = 0;        ///< of these, as the page says
  std::optional<double> newest;  ///< time of the newest that it was sent [s]; none yet

  [[nodiscard]] bool keeps_up() const noexcept { return sent - seen < kOnTheirWay; }
};

/// All on the server's thread, unless a function says otherwise.
struct Cockpit::Parts : std::enable_shared_from_this<Cockpit::Parts> {
  Parts(StationHost& station, CockpitSettings given);
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts();
  [[nodiscard]] double now() const { return settings.clock(); }  ///< [s]

  // ---- what goes out: cockpit_outgoing.cpp
  void to_all(const Bytes& bytes);
  /// To all pages and the log, after what is still held of a drag.
  void tell(wire::Notice::Level level, const std::string& who, const std::string& code,
            const std::string& text);
  void tell_drag();
  void tell_drag_if_due();
  void give_control_to_only_page();
  void tell_one(PageId page, const std::string& code, const std::string& text);
  void reply(PageId page, std::uint32_t request, const std::string& refused);
  /// A message of the station in a page's words: without options, and without the folder of the installation.
  [[nodiscard]] std::string for_pages(const std::string& text) const;
  void welcome(PageId page);
  void turn_away(PageId page, std::uint32_t protocol);
  [[nodiscard]] Bytes state_now();
  /// To all pages, with the next frame: however often something changes, not more often than kStateWithin.
  void want_state() { state_wanted = true; }
  void send_state_if_due();
  void send_tick();
  void show_out_the_silent();
  void tell_if_log_breaks();

  // ---- what comes in: cockpit_incoming.cpp
  void obey(PageId page, const wire::ToHost& message);
  /// @param speaker  one key held down is one speaker's: a page, or an address without one
  void stop(const std::string& speaker, const std::string& who);
  void stop(const Seat& seat);
  void fault_reported(const std::string& file, double fault_time);

  // ---- HTTP: cockpit_http.cpp
  void geometry(const std::string& revision, std::function<void(WebAnswer)> answer);
  [[nodiscard]] const Seat* operator_of(const WebRequest& request) const;
  void upload(const WebRequest& request, std::function<void(WebAnswer)> answer);

  StationHost& host;
  const CockpitSettings settings;
  WebServer* server = nullptr;
  std::vector<std::string> viewer_urls;
  AuditLog log;
  Seats seats;
  wire::Welcome choices;  ///< without what differs from page to page
  const std::filesystem::path shipped = data_folder();
  std::map<PageId, Pace> greeted;
  std::map<PageId, double> waiting;              ///< for their hello, since [s]
  std::map<std::string, double> stops_told;      ///< a speaker's newest, for kStopToldEvery [s]
  std::map<std::uint32_t, double> sliders_told;  ///< a page's newest [s]
  /// A change by a control that is being dragged: told when it ends, or something else is told.
  struct Drag {
    PageId page = 0;
    std::string who;
    PageRequest newest;
    double since = 0.0;  ///< [s]
  };
  std::optional<Drag> drag;
  std::string report;       ///< of the fault that began at `reported`
  double reported = -1.0;   ///< [s], the host's clock
  bool log_broken = false;  ///< all pages have been told
  bool state_wanted = false;
  double state_sent = -1e9;  ///< [s]
  std::uint64_t told_revision = 0;
  SafetyState told_safety = SafetyState::kWaiting;
  const std::shared_ptr<Shapes> shapes = std::make_shared<Shapes>();
  std::shared_ptr<UploadWork> upload_work;  ///< the newest

 private:
  void hello(PageId page, const wire::Hello& hello);
  void give_way(PageId page);
  void seen(PageId page, std::uint64_t ticks);
  void take(PageId page);
  void release(PageId page);
  [[nodiscard]] bool is_told(PageId page, const PageRequest& asked);
  /// Whether the drag that is held is of this page and these keys.
  [[nodiscard]] bool continues_drag(PageId page, const PageRequest& asked) const;
  void hold(PageId page, const std::string& who, const PageRequest& asked);
  void refuse_unless_operator(PageId page) const;
  void ask_host(PageId page, const wire::ToHost& message);
  void answered(PageId page, std::uint32_t number, const std::string& who, const PageRequest& asked,
                const ChangeOutcome& outcome);
};

/// A notice of this moment; any bytes may be in `who` and `text`.
[[nodiscard]] wire::Notice notice_of(wire::Notice::Level level, const std::string& who,
                                     const std::string& code, const std::string& text);

/// A line of text.
[[nodiscard]] WebAnswer plain_answer(int status, std::string text);

}  // namespace phalanx
