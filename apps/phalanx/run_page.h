// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "phalanx/station/station_host.h"
#include "run_console.h"
#include "run_options.h"

namespace phalanx {

/// @throws std::invalid_argument  options of the page that contradict each other, and what to type instead
void check_page_options(const RunOptions& options);

/// The cockpit of `phalanx run`, from the making of its server to its end.
class RunPage {
 public:
  /// Binds, says on the console how the page is reached, and serves. @param host, console  outlive the page
  /// @throws WebServerError or std::runtime_error, saying what to do
  RunPage(const RunOptions& options, StationHost& host, RunConsole& console);
  ~RunPage();

  /// A line for each address. Those with a token are for a terminal only.
  void say_addresses(RunConsole& console) const;

  void tell(const std::string& code, const std::string& text, bool fault);  ///< Cockpit::tell()
  void typed(const std::string& code, const std::string& text);             ///< Cockpit::typed()
  void fault_reported(const std::string& file, double fault_time);          ///< Cockpit::fault_reported()

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx
