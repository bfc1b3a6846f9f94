// SPDX-License-Identifier: Apache-2.0
// phalanx session: the recordings of `phalanx run`. phalanx replay: one of them, played again.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "commands.h"
#include "patient/registry_options.h"
#include "phalanx/figures/recording_page.h"
#include "phalanx/record/export_recording.h"
#include "phalanx/record/output_file.h"
#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/retention.h"
#include "retention_options.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "out/recordings";

/// Options of the commands.
struct SessionOptions {
  std::string folder = kFolder;
  std::string file;
  std::string out;
  std::string format = "csv";
  std::vector<std::string> parts;
  std::vector<std::string> columns;
  std::string subject = "01";
  std::string task;
  double from = 0.0;
  std::optional<double> to;
  std::optional<double> keep_days;
  std::optional<double> keep_gb;
  RegistryOptions registry;  ///< --keys
  FindRecordingKey keys;     ///< of `registry`
  bool confirmed = false;
  bool quiet = false;
};

/// Finds a recording by its path, by its name in the folder, or as "last".
fs::path found(const SessionOptions& o) {
  std::error_code ignored;
  if (o.file == "last") {
    const std::vector<RecordingSummary> all = list_recordings(o.folder, {}, o.keys);
    if (all.empty())
      throw std::invalid_argument(fmt::format(
          "there is no recording in {}; `phalanx run` makes one, and --folder names another folder",
          o.folder));
    return all.back().file;
  }
  for (const fs::path& name :
       {fs::path(o.file), fs::path(o.folder) / o.file, fs::path(o.folder) / (o.file + ".mcap"),
        fs::path(o.folder) / (o.file + ".mcap.enc")})
    if (fs::is_regular_file(name, ignored)) return name;
  throw std::invalid_argument(
      fmt::format("there is no recording {}, and none of that name in {}; `phalanx session list` shows them",
                  o.file, o.folder));
}

void say_repaired(const fs::path& file, const RepairedRecording& repaired) {
  if (repaired.needs_key)
    fmt::print(
        stderr,
        "{} was damaged; {} frames are whole and kept. It is encrypted: with its key (--keys FILE), the same "
        "command completes it. The original is {}\n",
        file.string(), repaired.chunks, repaired.original.string());
  else
    fmt::print(stderr,
               "{} had no end or was damaged; it is whole again, with {} chunks. The original is {}\n",
               file.string(), repaired.chunks, repaired.original.string());
  for (const std::string& loss : repaired.losses) fmt::print(stderr, "  lost: {}\n", loss);
}

/// Finds a recording, and repairs it if it has no end. @throws std::invalid_argument if its key is not here
fs::path opened(const SessionOptions& o) {
  const fs::path file = found(o);
  const RecordingSummary summary = summarise_recording(file, o.keys);
  if (summary.written)
    throw std::invalid_argument(fmt::format("{} is being written; end that run first", file.string()));
  if (summary.no_key) throw std::invalid_argument(fmt::format("{}: {}", file.string(), summary.trouble));
  if (summary.has_end) return file;
  const RepairedRecording repaired = repair_recording(file, o.keys);
  if (repaired.changed) say_repaired(file, repaired);
  return file;
}

std::string date_text(double utc) {
  return utc <= 0.0 ? "unknown"
                    : fmt::format("{:%Y-%m-%d %H:%M:%S}Z", fmt::gmtime(static_cast<std::time_t>(utc)));
}

bool is_known(const RecordingSummary& recording) { return recording.has_end && !recording.no_key; }

int list(const SessionOptions& o) {
  const std::vector<RecordingSummary> all = list_recordings(o.folder, {}, o.keys);
  if (all.empty()) {
    fmt::print("no recordings in {}\n", o.folder);
    return kDone;
  }
  fmt::print("{:<30} {:<20} {:>9} {:>9} {:>8}  {:<16} {}\n", "file", "begin", "duration", "steps", "MB",
             "scene", "state");
  for (const RecordingSummary& recording : all)
    fmt::print("{:<30} {:<20} {:>9} {:>9} {:>8.1f}  {:<16} {}\n", recording.file.filename().string(),
               date_text(recording.begin),
               is_known(recording) ? fmt::format("{:.1f} s", recording.seconds) : "-",
               is_known(recording) ? std::to_string(recording.steps) : "-",
               1e-6 * static_cast<double>(recording.bytes), recording.scene.empty() ? "-" : recording.scene,
               recording_state(recording));
  return kDone;
}

/// Lets only the owner read what is written from here on: what is made of an encrypted recording is not encrypted.
void write_for_owner_alone() { ::umask(S_IRWXG | S_IRWXO); }

void warn_of_plain(const fs::path& out) {
  fmt::print(stderr,
             "{} is not encrypted, and stays if the person is deleted; delete it when it is not needed\n",
             out.string());
}

int show(const SessionOptions& o) {
  const fs::path file = opened(o);
  const RecordingSummary summary = summarise_recording(file, o.keys);
  ProgressBar bar("reading", !o.quiet);
  const RecordingContent content = read_recording(
      file, [&](double part) { bar.show(static_cast<std::uint64_t>(1000.0 * part), 1000); }, o.keys);
  const fs::path out = o.out.empty() ? beside_recording(file, ".html") : fs::path(o.out);
  if (summary.encrypted) write_for_owner_alone();
  write_text_file(out, recording_page_html(summary, content));
  if (summary.encrypted) warn_of_plain(out);
  fmt::print(
      "{}\n  {}, {:.1f} s, {} steps, {} events, {} gaps\n  scene {}, device {}, recorded by Phalanx {}\n  "
      "page: {}\n",
      file.string(), date_text(summary.begin), summary.seconds, summary.steps, summary.events, summary.gaps,
      summary.scene, summary.device, summary.version, out.string());
  return kDone;
}

int export_as(const SessionOptions& o) {
  const ExportFormatName& format = export_format(o.format);
  const fs::path file = opened(o);
  ExportOptions options;
  options.format = format.format;
  options.parts = o.parts;
  options.columns = o.columns;
  options.subject = o.subject;
  options.task = o.task;
  options.from = o.from;
  if (o.to) options.to = *o.to;
  const fs::path out = o.out.empty() ? beside_recording(file, format.ending) : fs::path(o.out);
  const bool encrypted = summarise_recording(file, o.keys).encrypted;
  if (encrypted) write_for_owner_alone();
  std::vector<ExportedPart> written;
  {
    ProgressBar bar("exporting", !o.quiet);
    written = export_recording(
        file, out, options, [&](double part) { bar.show(static_cast<std::uint64_t>(1000.0 * part), 1000); },
        o.keys);
  }
  if (encrypted) warn_of_plain(out);
  const char* what = format.format == ExportFormat::kRos2 ? "messages" : "rows";
  for (const ExportedPart& each : written)
    fmt::print("{}: {}, {} {}\n", each.file.string(), each.part, each.rows, what);
  return kDone;
}

int repair(const SessionOptions& o) {
  const fs::path file = found(o);
  const RepairedRecording repaired = repair_recording(file, o.keys);
  if (repaired.changed)
    say_repaired(file, repaired);
  else if (repaired.needs_key)
    fmt::print(
        "{} is encrypted, and its key is not here: {} frames, all with the right checksum. With --keys FILE "
        "its chunks are checked, too, and its end is made if it has none\n",
        file.string(), repaired.chunks);
  else
    fmt::print("{} is whole: {} chunks, all with the right checksum\n", file.string(), repaired.chunks);
  return kDone;
}

int remove(const SessionOptions& o) {
  const fs::path file = found(o);
  const RecordingSummary summary = summarise_recording(file, o.keys);
  if (summary.written)
    throw std::invalid_argument(fmt::format("{} is being written; end that run first", file.string()));
  if (!o.confirmed)
    throw std::invalid_argument(
        fmt::format("{} ({}, {:.1f} MB) would be gone for good; type the same with --yes", file.string(),
                    date_text(summary.begin), 1e-6 * static_cast<double>(summary.bytes)));
  for (const fs::path& each : delete_recording(file)) fmt::print("deleted {}\n", each.string());
  return kDone;
}

int prune(const SessionOptions& o) {
  const RetentionRule rule = retention_rule(o.keep_days, o.keep_gb);
  if (!rule.deletes()) throw std::invalid_argument("state what to keep: --keep-days D, --keep-gb G, or both");
  const std::vector<RecordingSummary> expired = expired_recordings(
      list_recordings(o.folder, {}, o.keys), rule, static_cast<double>(std::time(nullptr)));
  double bytes = 0.0;
  for (const RecordingSummary& recording : expired) {
    bytes += static_cast<double>(recording.bytes);
    if (o.confirmed) delete_recording(recording.file);
    fmt::print("{} {} ({}, {:.1f} MB)\n", o.confirmed ? "deleted" : "would delete", recording.file.string(),
               date_text(recording.begin), 1e-6 * static_cast<double>(recording.bytes));
  }
  fmt::print("{} recordings, {:.1f} MB{}\n", expired.size(), 1e-6 * bytes,
             o.confirmed || expired.empty() ? "" : "; type the same with --yes to delete them for good");
  return kDone;
}

int play_again(const SessionOptions& o) {
  const fs::path file = opened(o);
  ReplayResult result;
  {
    ProgressBar bar("replaying", !o.quiet);
    result = replay(
        file, [&](double part) { bar.show(static_cast<std::uint64_t>(1000.0 * part), 1000); }, nullptr,
        o.keys);
  }
  fmt::print("{}: {} stations, {} steps in {:.1f} s; {} made again, {} different\n", file.string(),
             result.stations, result.steps, result.seconds, result.compared, result.different);
  if (result.missing + result.not_compared > 0)
    fmt::print(
        "  {} steps are missing in the file; {} cannot be made again, since what they depend on is missing\n",
        result.missing, result.not_compared);
  if (!result.exact)
    fmt::print(
        "  recorded on {}, whose mathematical functions round otherwise than this machine's: compared to "
        "within {} Nm and rad, not to the last bit\n",
        result.recorded_on, ReplayResult::kTolerance);
  if (result.other_version) fmt::print("  computed by another version: {}\n", result.recorded_by);
  if (result.first)
    fmt::print(
        "  first difference: station {}, step {} at {:.3f} s: {}\n  largest difference of a torque: {} Nm\n",
        result.first->station, result.first->tick, result.first->time, result.first->what,
        result.largest_torque);
  else if (result.exact && result.compared > 0)
    fmt::print("  of those made again, every force, angle and command has the same bits\n");
  return result.different == 0 ? kDone : kFailed;
}

/// Runs a command with the keys of its options.
int with_keys(const std::shared_ptr<SessionOptions>& options, int (*work)(const SessionOptions&)) {
  return with_registry_errors([&] {
    options->keys = recording_keys_of(options->registry);
    return work(*options);
  });
}

/// @returns the help on the parts of all formats
std::string parts_text() {
  std::string text = "parts to write, separated by commas [all]; of csv, hdf5 and matlab the tables:";
  for (const ExportFormat format : {ExportFormat::kCsv, ExportFormat::kRos2, ExportFormat::kBids}) {
    if (format == ExportFormat::kRos2) text += "\nof ros2 the topics:";
    if (format == ExportFormat::kBids) text += "\nof bids the tables:";
    for (const ExportPart& part : export_parts(format))
      text += fmt::format("\n- {}: {}", part.name, part.meaning);
  }
  return text;
}

CLI::Option* add_file(CLI::App& command, SessionOptions& options) {
  command.add_option("--folder", options.folder, "folder of the recordings")
      ->capture_default_str()
      ->type_name("DIR");
  return command.add_option("FILE", options.file, "a recording: its path, its name in the folder, or last")
      ->required();
}

}  // namespace

void add_session_command(CLI::App& app, Job& job) {
  CLI::App* session = app.add_subcommand(
      "session", "The recordings of `phalanx run`: list, show, export, repair, delete, prune");
  session->require_subcommand(1);
  auto options = std::make_shared<SessionOptions>();
  const auto add = [&](const char* name, const char* help, int (*work)(const SessionOptions&), bool file) {
    CLI::App* command = session->add_subcommand(name, help);
    if (file)
      add_file(*command, *options);
    else
      command->add_option("--folder", options->folder, "folder of the recordings")
          ->capture_default_str()
          ->type_name("DIR");
    add_registry_options(*command, options->registry);
    command->callback([options, command, work, &job] {
      refuse_empty_values(*command);
      job = [options, work] { return with_keys(options, work); };
    });
    return command;
  };
  add("list", "List the recordings of a folder", list, false);
  CLI::App* shown = add("show", "Draw forces and events of a recording on one page", show, true);
  shown->add_option("--out", options->out, "the page [beside the recording]")->type_name("FILE.html");
  shown->add_flag("--quiet", options->quiet, "no progress bar");
  CLI::App* exported = add("export", "Write a recording in the format of other programs", export_as, true);
  exported
      ->add_option("--out", options->out,
                   "a folder or file that does not exist yet [beside the recording, named as it]")
      ->type_name("PATH");
  std::string formats = "format:";
  for (const ExportFormatName& format : export_formats())
    formats += fmt::format("\n{}: {}", format.name, format.meaning);
  exported->add_option("--format", options->format, formats)->capture_default_str()->type_name("NAME");
  exported->add_option("--parts", options->parts, parts_text())->delimiter(',')->type_name("NAME,...");
  exported
      ->add_option("--columns", options->columns,
                   "columns of csv, hdf5 and matlab, separated by commas [all]: torque is all joints', "
                   "torque_nm_index_pip_flexion is one")
      ->delimiter(',')
      ->type_name("NAME,...");
  exported->add_option("--subject", options->subject, "label of the person in a BIDS data set")
      ->capture_default_str()
      ->type_name("LABEL");
  exported->add_option("--task", options->task, "label of the task there [the scene]")->type_name("LABEL");
  exported->add_option("--from", options->from, "begin, since the recording's begin")
      ->capture_default_str()
      ->type_name("S");
  exported->add_option("--to", options->to, "end [the recording's]")->type_name("S");
  exported->add_flag("--quiet", options->quiet, "no progress bar");
  add("repair", "Keep what is whole of a recording that has no end or is damaged", repair, true);
  add("delete", "Delete a recording", remove, true)
      ->add_flag("--yes", options->confirmed, "delete without asking");
  CLI::App* pruned = add("prune", "Delete old recordings", prune, false);
  add_retention(*pruned, options->keep_days, options->keep_gb, "--keep-");
  pruned->add_flag("--yes", options->confirmed, "delete; else they are only listed");
}

void add_replay_command(CLI::App& app, Job& job) {
  auto options = std::make_shared<SessionOptions>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Make every step of a recording again, through the code that the station runs, and compare its bits");
  command->footer("Exit codes: 0 all steps are the same, 1 some differ, 2 wrong usage or input.");
  add_file(*command, *options);
  add_registry_options(*command, options->registry);
  command->add_flag("--quiet", options->quiet, "no progress bar");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return with_keys(options, play_again); };
  });
}

}  // namespace phalanx
