// SPDX-License-Identifier: Apache-2.0
// The cockpit: what the pages see of the station, and what they may do with it.             docs/cockpit.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/serve/web_server.h"
#include "phalanx/station/station_host.h"

namespace phalanx {

/// What stays as it is from the start on.
struct CockpitSettings {
  std::filesystem::path log;      ///< file: every change, a JSON line each; empty: none
  std::filesystem::path uploads;  ///< folder for meshes that pages send; made when the first comes
  std::string version;            ///< of the program, for people
  std::function<double()> clock;  ///< that only goes forward [s]; empty: the system's. For tests
};

/// Roles: everybody who sees the page may stop; one page at a time is the operator and may do the rest. The
/// first page that may operate becomes it by itself; others take over openly: all pages are told who took it
/// from whom. A page that reloads keeps its role if it is back within 10 s; one that comes back while its old
/// line still counts as open takes its own place. A page is sent ticks only as fast as it says that it has
/// seen them; one that speaks another protocol is turned away, in words. The log is written by a thread of
/// its own; where it cannot be written, changes are made nevertheless, and both the pages and the log say so.
/// Nothing here is for a real-time thread: all functions allocate, lock, or both.
class Cockpit final : public WebApplication {
 public:
  static constexpr std::uint32_t kProtocol = 1;                     ///< of proto/phalanx/cockpit.proto
  static constexpr std::size_t kUploadLimit = 64U * 1024U * 1024U;  ///< [bytes]

  /// @param host  outlives the cockpit
  /// @throws std::runtime_error if the log cannot be written
  Cockpit(StationHost& host, CockpitSettings settings);
  ~Cockpit() override;

  /// Where its answers go. Before WebServer::start(). @param server  ends before the cockpit, and the
  /// station's owner calls StationHost::go_on() no more while it does
  /// @param viewer_urls  links to look on, told to pages that may operate
  void attach(WebServer& server, const std::vector<std::string>& viewer_urls = {});

  /// A notice of the station's to all pages, and to the log. From any thread.
  /// @param code  what a page may translate by: "fault", "reset_refused", ...
  void tell(const std::string& code, const std::string& text, bool fault);
  /// What somebody has changed at the station's own terminal, likewise. From any thread.
  void typed(const std::string& code, const std::string& text);
  /// Where a fault's report was written: shown beside that fault only. From any thread.
  /// @param fault_time  FaultEvent::time of the report [s], the host's clock
  void fault_reported(const std::string& file, double fault_time);

  void joined(PageId page, const Visitor& visitor) override;
  void left(PageId page) override;
  void received(PageId page, std::string_view message) override;
  void received_too_much(PageId page, std::string_view last) override;
  void frame() override;
  void requested(const WebRequest& request, std::function<void(WebAnswer)> answer) override;
  [[nodiscard]] std::size_t body_limit(const WebRequest& head) override;

 private:
  struct Parts;
  std::shared_ptr<Parts> parts_;  ///< answers that come late look whether it is still there
};

}  // namespace phalanx
