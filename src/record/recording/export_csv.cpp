// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/export_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/device/channel_map.h"
#include "phalanx/hand/joints.h"
#include "phalanx/record/output_file.h"
#include "phalanx/recording.pb.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// One CSV file that grows row by row.
class Table {
 public:
  Table(const fs::path& folder, const char* name, const std::string& header)
      : file_(folder / (std::string(name) + ".csv")), out_(file_) {
    out_.text(header + "\n");
  }
  Table& begin(double time) {
    out_.number(time);
    return *this;
  }
  Table& number(double value) {
    out_.text(",");
    out_.number(value);
    return *this;
  }
  Table& integer(std::uint64_t value) {
    out_.text(",");
    out_.integer(value);
    return *this;
  }
  /// A count; an empty field if there is none.
  Table& count(std::optional<std::int32_t> value) {
    out_.text(value ? fmt::format(",{}", *value) : ",");
    return *this;
  }
  /// A text in quotes, with those in it doubled.
  Table& text(std::string_view value) {
    std::string quoted = ",\"";
    for (const char c : value) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    out_.text(quoted + "\"");
    return *this;
  }
  void end() {
    out_.text("\n");
    ++rows_;
  }
  [[nodiscard]] ExportedFile finished() {
    out_.commit();
    return {.file = file_, .rows = rows_};
  }

 private:
  const fs::path file_;
  OutputFile out_;
  std::uint64_t rows_ = 0;
};

std::string columns(const char* what) {
  std::string header;
  for (int joint = 0; joint < kJoints; ++joint) header += fmt::format(",{}_{}", what, joint_name(joint));
  return header;
}

std::string steps_header() {
  return "time_s,station,tick,host_time_s,state,fault,status,factor,stiffness_n_per_m,lateness_us,duration_"
         "us" +
         columns("torque_nm");
}

std::string samples_header() {
  std::string header = "time_s,station,tick,sequence,device_time_us,emergency_stop,factor";
  for (std::size_t c = 0; c < kMaxChannels; ++c) header += fmt::format(",raw_counts_{}", c);
  return header;
}

std::string hand_header() {
  std::string header = "time_s,tick" + columns("angle_measured_rad") + columns("angle_shown_rad");
  for (int digit = 0; digit < kDigits; ++digit) header += fmt::format(",force_n_{}", digit_name(digit));
  return header;
}

class Export {
 public:
  Export(const fs::path& folder, const ExportOptions& options) : options_(options) {
    const auto wanted = [&](const char* name) {
      return options.tables.empty() ||
             std::find(options.tables.begin(), options.tables.end(), name) != options.tables.end();
    };
    const auto add = [&](std::unique_ptr<Table>& table, const char* name, const std::string& header) {
      if (wanted(name)) table = std::make_unique<Table>(folder, name, header);
    };
    add(steps_, "steps", steps_header());
    add(samples_, "samples", samples_header());
    add(channels_, "channels", "station,channel,kind,index,gain,offset");
    add(hand_, "hand", hand_header());
    add(events_, "events", "time_s,code,who,text");
  }

  void add(std::string_view schema, const mcap::Message& message, double time) {
    if (schema == "phalanx.wire.Setup" && parsed(message, setup_)) add_setup();
    if (!(time >= options_.from && time < options_.to)) return;
    if (schema == "phalanx.wire.Step" && (steps_ || samples_) && parsed(message, step_)) add_step(time);
    if (schema == "phalanx.wire.Tick" && hand_ && parsed(message, tick_)) add_hand(time);
    if (schema == "phalanx.wire.Event" && events_ && parsed(message, event_))
      events_->begin(time).text(event_.code()).text(event_.who()).text(event_.text()).end();
    if (schema == "phalanx.wire.Gap" && events_ && parsed(message, gap_))
      events_->begin(time)
          .text("gap")
          .text("")
          .text(fmt::format("steps {} to {} of station {} are missing: {}", gap_.first_tick(),
                            gap_.last_tick(), gap_.station(), gap_.why()))
          .end();
  }

  std::vector<ExportedFile> finished() {
    std::vector<ExportedFile> files;
    for (Table* table : {steps_.get(), samples_.get(), channels_.get(), hand_.get(), events_.get()})
      if (table != nullptr) files.push_back(table->finished());
    return files;
  }

 private:
  void add_setup() {
    if (!channels_) return;
    for (int c = 0; c < setup_.channel_size(); ++c) {
      const wire::DeviceChannel& channel = setup_.channel(c);
      channels_->begin(static_cast<double>(setup_.station()));
      channels_->integer(static_cast<std::uint64_t>(c)).integer(channel.kind()).integer(channel.index());
      channels_->number(channel.gain()).number(channel.offset()).end();
    }
  }

  void add_step(double time) {
    if (steps_) {
      steps_->begin(time).integer(step_.station()).integer(step_.tick()).number(step_.time());
      steps_->integer(static_cast<std::uint64_t>(std::max(0, static_cast<int>(step_.state()))))
          .integer(step_.fault());
      steps_->integer(step_.status()).number(step_.factor()).number(step_.stiffness());
      steps_->number(static_cast<double>(step_.lateness_us()))
          .number(static_cast<double>(step_.duration_us()));
      for (int j = 0; j < kJoints; ++j) steps_->number(j < step_.torque_size() ? step_.torque(j) : 0.0);
      steps_->end();
    }
    if (!samples_) return;
    for (const wire::Sample& sample : step_.sample()) {
      samples_->begin(time).integer(step_.station()).integer(step_.tick()).integer(sample.sequence());
      samples_->integer(sample.time_us()).integer(sample.estop() ? 1 : 0).number(sample.factor());
      for (int c = 0; c < static_cast<int>(kMaxChannels); ++c)
        samples_->count(c < sample.raw_size() ? std::optional(sample.raw(c)) : std::nullopt);
      samples_->end();
    }
  }

  void add_hand(double time) {
    hand_->begin(time).integer(tick_.tick());
    for (int j = 0; j < kJoints; ++j)
      hand_->number(j < tick_.hcp_angle_size() ? static_cast<double>(tick_.hcp_angle(j)) : 0.0);
    for (int j = 0; j < kJoints; ++j)
      hand_->number(j < tick_.gdp_angle_size() ? static_cast<double>(tick_.gdp_angle(j)) : 0.0);
    for (const double force : digit_forces(tick_)) hand_->number(force);
    hand_->end();
  }

  const ExportOptions& options_;
  std::unique_ptr<Table> steps_, samples_, channels_, hand_, events_;
  wire::Setup setup_;
  wire::Step step_;
  wire::Tick tick_;
  wire::Event event_;
  wire::Gap gap_;
};

void check(const fs::path& folder, const ExportOptions& options) {
  for (const std::string& table : options.tables) {
    std::string known;
    bool found = false;
    for (const ExportTable& each : export_tables()) {
      found = found || table == each.name;
      known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
    }
    if (!found) throw std::invalid_argument(fmt::format("there is no table '{}'; known: {}", table, known));
  }
  if (!(options.from >= 0.0 && options.from < options.to))
    throw std::invalid_argument(fmt::format("from {} s to {} s there is no time; the recording begins at 0",
                                            options.from, options.to));
  std::error_code ignored;
  if (fs::exists(folder, ignored))
    throw std::invalid_argument(fmt::format("'{}' exists; name a folder that does not", folder.string()));
}

}  // namespace

const std::vector<ExportTable>& export_tables() {
  static const std::vector<ExportTable> kTables = {
      {"steps", "each step: state, times, and the torques that were sent [Nm]"},
      {"samples", "each sample of the device, in raw counts"},
      {"channels", "what the counts mean: value = gain raw + offset, in rad, Nm, N or m"},
      {"hand", "about 60 a second: measured and shown angles [rad], force on each digit [N]"},
      {"events", "what happened, with who and when"}};
  return kTables;
}

std::vector<ExportedFile> export_csv(const fs::path& recording, const fs::path& folder,
                                     const ExportOptions& options,
                                     const std::function<void(double)>& on_progress) {
  check(folder, options);
  prepare_output_folder(folder);
  Export tables(folder, options);
  for_each_message_of(recording, on_progress,
                      [&](std::string_view schema, const mcap::Message& message, double time) {
                        tables.add(schema, message, time);
                      });
  return tables.finished();
}

}  // namespace phalanx
