// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "phalanx/record/run_recorder.h"
#include "phalanx/station/session.h"
#include "run/run_console.h"
#include "run/run_options.h"

namespace phalanx {

class ExerciseHost;
class Registry;

/// Patients of the page. Null: none.
struct PagePatients {
  std::shared_ptr<Registry> registry = {};
  std::shared_ptr<ExerciseHost> exercises = {};  ///< carries out their exercises
};

/// Checks the options of the page.
/// @throws std::invalid_argument if they contradict each other; the message names what to type instead
void check_page_options(const RunOptions& options);

/// The cockpit of `phalanx run`: its server, from start to end.
class RunPage {
 public:
  /// Binds the server, shows the page's addresses on the console, and serves.
  /// @param session, console  outlive the page
  /// @param patients  and accounts
  /// @throws WebServerError or std::runtime_error, naming the remedy
  RunPage(const RunOptions& options, Session& session, RunRecorder& recorder, RunConsole& console,
          PagePatients patients = {});
  ~RunPage();

  /// Writes a line for each address. Addresses with a token are written to a terminal only.
  void say_addresses(RunConsole& console) const;

  void tell(const std::string& code, const std::string& text, bool fault);  ///< Cockpit::notify()
  void typed(const std::string& code, const std::string& text);             ///< Cockpit::typed()
  void fault_reported(const std::string& file, double fault_time);          ///< Cockpit::fault_reported()

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx
