// SPDX-License-Identifier: Apache-2.0
// phalanx patient report | fhir.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "patient/patient_commands.h"
#include "patient/patient_fields.h"
#include "patient/patient_text.h"
#include "patient/registry_options.h"
#include "phalanx/patients/patient_report.h"

namespace phalanx {
namespace {

struct PatientReportOptions : PatientOptions {
  std::string day = {};
  std::string language = "en";
  std::string output = {};
};

/// A new file that only its owner may read. It is removed unless it is kept.
class OwnersFile {
 public:
  explicit OwnersFile(std::filesystem::path file) : file_(std::move(file)) {
    std::filesystem::remove(file_, ignored_);  // what a killed program left
    number_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
    made_ = number_ >= 0;
  }
  ~OwnersFile() {
    if (number_ >= 0) ::close(number_);
    if (made_ && !kept_) std::filesystem::remove(file_, ignored_);
  }
  OwnersFile(const OwnersFile&) = delete;
  OwnersFile& operator=(const OwnersFile&) = delete;

  [[nodiscard]] bool made() const noexcept { return made_; }

  /// Writes the text to the disk itself, and gives the file its name.
  /// @returns false if the disk refuses it
  [[nodiscard]] bool keep(std::string_view text, const std::filesystem::path& name) {
    while (!text.empty()) {
      const ::ssize_t written = ::write(number_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    kept_ = ::fsync(number_) == 0 && std::rename(file_.c_str(), name.c_str()) == 0;
    return kept_;
  }

 private:
  std::filesystem::path file_;
  std::error_code ignored_ = {};
  int number_ = -1;
  bool made_ = false;
  bool kept_ = false;
};

/// Checks that a report may be written there.
/// @throws std::invalid_argument if it is in the data folder, or another thing than a file
void check_output(const PatientReportOptions& o) {
  if (o.output.empty()) return;
  namespace fs = std::filesystem;
  const fs::path inside =
      fs::weakly_canonical(fs::absolute(o.output))
          .lexically_relative(fs::weakly_canonical(fs::absolute(data_folder_of(o.registry))));
  if (!inside.empty() && *inside.begin() != "..")
    throw std::invalid_argument(fmt::format(
        "--output {}: the file would lie in the data folder, where all else is sealed; choose another place",
        o.output));
  if (fs::exists(o.output) && !fs::is_regular_file(o.output))
    throw std::invalid_argument(fmt::format(
        "--output {}: this is no file; name a file, or leave it out for standard output", o.output));
}

/// Writes the file as a whole, with mode 0600. Without one, to standard output.
/// @throws std::invalid_argument if the file cannot be made; std::runtime_error if the disk refuses the data
void write_report(const std::string& text, const std::string& output) {
  if (output.empty()) {
    fmt::print("{}", text);
    return;
  }
  OwnersFile file(output + ".partial");
  if (!file.made())
    throw std::invalid_argument(fmt::format(
        "--output {}: this file cannot be written; name one in a folder that exists and is yours", output));
  if (!file.keep(text, output))
    throw std::runtime_error(fmt::format("{}: the disk refuses the data", output));
  fmt::print("{}\n", printable(output));
}

ReportInput input_of(const PatientReportOptions& o) {
  check_output(o);
  OpenedRegistry opened = open_registry(o.registry);
  return read_report_input(opened.registry, opened.actor, o.code, o.day, utc_today());
}

int make_report(const PatientReportOptions& o) {
  const ReportLanguage language = report_language(o.language);
  write_report(report_html(input_of(o), language), o.output);
  return kDone;
}

int make_fhir(const PatientReportOptions& o) {
  write_report(fmt::format("{}\n", report_fhir(input_of(o))), o.output);
  return kDone;
}

void add_report_options(CLI::App& command, PatientReportOptions& options) {
  add_code(command, options);
  command.add_option("--day", options.day, "only of this day, UTC, as 2026-05-04 [all days]")
      ->type_name("DATE");
  command
      .add_option("--output", options.output,
                  "the file to write [standard output]; it has the code in plain text")
      ->type_name("FILE");
}

}  // namespace

void add_patient_report_commands(CLI::App& patient, Job& job) {
  auto reported = std::make_shared<PatientReportOptions>();
  CLI::App* report = add_patient_job(
      patient, "report", "Make a report as an HTML page that prints well on A4", reported, job, make_report);
  add_report_options(*report, *reported);
  report->add_option("--lang", reported->language, "language of the report: en or de")
      ->check(CLI::IsMember({"en", "de"}))
      ->capture_default_str()
      ->type_name("LANGUAGE");
  auto bundled = std::make_shared<PatientReportOptions>();
  CLI::App* fhir = add_patient_job(patient, "fhir", "Make a FHIR R4 bundle of results and entered tests",
                                   bundled, job, make_fhir);
  add_report_options(*fhir, *bundled);
}

}  // namespace phalanx
