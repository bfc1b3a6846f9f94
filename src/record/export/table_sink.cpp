// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "phalanx/device/channel_map.h"
#include "phalanx/exercise/observation_table.h"
#include "phalanx/hand/joints.h"
#include "phalanx/recording.pb.h"
#include "phalanx/step/snapshot.h"
#include "record/export/export_sink.h"
#include "record/export/segment_wrench.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool is_key(const std::string& column) { return column == "time" || column == "station" || column == "tick"; }

/// One table, of which only the chosen columns are written.
class ChosenTable {
 public:
  /// @param columns  chosen names; empty: all. Those found are removed from `unknown`
  ChosenTable(const ExportTable& table, const std::vector<std::string>& columns,
              std::vector<std::string>& unknown) {
    chosen_.name = table.name;
    chosen_.meaning = table.meaning;
    for (const ExportColumn& column : table.columns) {
      ExportColumn kept = column;
      kept.labels.clear();
      bool any = false;
      for (std::size_t i = 0; i < column.width(); ++i) {
        const bool take = columns.empty() || is_key(column.name) || is_chosen(column, i, columns, unknown);
        (column.is_text ? take_text_ : take_number_).push_back(take);
        any = any || take;
        if (take && !column.labels.empty()) kept.labels.push_back(column.labels[i]);
      }
      if (any) chosen_.columns.push_back(std::move(kept));
      holds_chosen_ = holds_chosen_ || (any && (columns.empty() || !is_key(column.name)));
    }
  }
  /// @returns false if it has none of the chosen columns
  [[nodiscard]] bool holds_chosen() const noexcept { return holds_chosen_; }
  void begin(TableFormat& format) { writer_ = format.begin(chosen_); }
  [[nodiscard]] bool writes() const noexcept { return writer_ != nullptr; }

  void add(const ExportRow& row) {
    kept_.clear();
    for (std::size_t i = 0; i < row.numbers.size(); ++i)
      if (take_number_.at(i)) kept_.numbers.push_back(row.numbers[i]);
    for (std::size_t i = 0; i < row.texts.size(); ++i)
      if (take_text_.at(i)) kept_.texts.push_back(row.texts[i]);
    writer_->add(kept_);
  }
  [[nodiscard]] ExportedPart finish() {
    ExportedPart part = writer_->finish();
    writer_.reset();
    return part;
  }

 private:
  static bool is_chosen(const ExportColumn& column, std::size_t i, const std::vector<std::string>& columns,
                        std::vector<std::string>& unknown) {
    bool found = false;
    for (const std::string& name : columns) {
      if (name != column.name && name != column.full_name(i)) continue;
      found = true;
      std::erase(unknown, name);
    }
    return found;
  }

  ExportTable chosen_;
  std::vector<bool> take_number_;
  std::vector<bool> take_text_;
  bool holds_chosen_ = false;
  ExportRow kept_;
  std::unique_ptr<TableWriter> writer_;
};

class TableSink final : public ExportSink {
 public:
  TableSink(std::unique_ptr<TableFormat> format, const ExportOptions& options) : format_(std::move(format)) {
    std::vector<std::string> unknown = options.columns;
    for (const ExportTable& table : export_tables())
      tables_.push_back(std::make_unique<ChosenTable>(table, options.columns, unknown));
    std::erase_if(unknown, is_key);
    if (!unknown.empty()) throw std::invalid_argument(unknown_column(unknown.front()));
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      const std::string& name = export_tables()[t].name;
      const bool wanted = options.parts.empty() ? !export_tables()[t].if_named
                                                : std::find(options.parts.begin(), options.parts.end(),
                                                            name) != options.parts.end();
      if (wanted && tables_[t]->holds_chosen()) tables_[t]->begin(*format_);
    }
    if (std::none_of(tables_.begin(), tables_.end(), [](const auto& table) { return table->writes(); }))
      throw std::invalid_argument("none of the chosen tables has any of the chosen columns");
  }

  void add(std::string_view schema, const mcap::Message& message, double time, bool in_range) override {
    if (schema == "phalanx.wire.Setup" && parsed(message, setup_)) add_setup();
    if (!in_range) return;
    if (schema == "phalanx.wire.Step" && any({"steps", "samples", "angles"}) && parsed(message, step_)) {
      add_step(time);
      add_samples(time);
    }
    if (schema == "phalanx.wire.Tick" && any({"hand", "segments"}) && parsed(message, tick_)) {
      add_hand(time);
      add_segments(time);
    }
    if (schema == "phalanx.wire.Event" && any({"events"}) && parsed(message, event_))
      add_event(time, event_.code(), event_.who(), event_.text());
    if (schema == "phalanx.wire.Gap" && any({"events"}) && parsed(message, gap_))
      add_event(time, "gap", "",
                fmt::format("steps {} to {} of station {} are missing: {}", gap_.first_tick(),
                            gap_.last_tick(), gap_.station(), gap_.why()));
  }

  void add_observation(const Observation& observation, std::uint64_t station, double host_time,
                       double time) override {
    ChosenTable* table = written("observations");
    if (table == nullptr) return;
    row_.clear();
    number(time);
    integer(station);
    integer(observation.tick);
    number(host_time);
    append_observation(observation, row_.numbers);
    table->add(row_);
  }

  std::vector<ExportedPart> finish() override {
    std::vector<ExportedPart> parts;
    for (const auto& table : tables_)
      if (table->writes()) parts.push_back(table->finish());
    format_->finish();
    return parts;
  }

 private:
  static std::string unknown_column(const std::string& name) {
    std::string known;
    for (const ExportTable& table : export_tables()) {
      known += fmt::format("{} {}:", known.empty() ? "" : ";", table.name);
      for (const ExportColumn& column : table.columns) known += " " + column.name;
    }
    return fmt::format("there is no column '{}'; those of the tables are:{}", name, known);
  }
  [[nodiscard]] ChosenTable* written(std::string_view name) const {
    for (std::size_t t = 0; t < tables_.size(); ++t)
      if (export_tables()[t].name == name && tables_[t]->writes()) return tables_[t].get();
    return nullptr;
  }
  [[nodiscard]] bool any(std::initializer_list<std::string_view> names) const {
    return std::any_of(names.begin(), names.end(),
                       [&](std::string_view name) { return written(name) != nullptr; });
  }
  void number(double value) { row_.numbers.push_back(value); }
  template <class Integer>
  void integer(Integer value) {
    row_.numbers.push_back(static_cast<double>(value));
  }

  void add_setup() {
    map_ = channel_map_of(setup_);
    ChosenTable* table = written("channels");
    if (table == nullptr) return;
    for (int c = 0; c < setup_.channel_size(); ++c) {
      const wire::DeviceChannel& channel = setup_.channel(c);
      row_.clear();
      integer(setup_.station());
      integer(c);
      integer(channel.kind());
      integer(channel.index());
      number(channel.gain());
      number(channel.offset());
      table->add(row_);
    }
  }

  void add_step(double time) {
    ChosenTable* table = written("steps");
    if (table == nullptr) return;
    row_.clear();
    number(time);
    integer(step_.station());
    integer(step_.tick());
    number(step_.time());
    integer(static_cast<int>(step_.state()));
    integer(step_.fault());
    integer(step_.status());
    number(step_.factor());
    number(step_.stiffness());
    number(static_cast<double>(step_.lateness_us()));
    number(static_cast<double>(step_.duration_us()));
    for (int j = 0; j < kJoints; ++j) number(j < step_.torque_size() ? step_.torque(j) : 0.0);
    table->add(row_);
  }

  void add_samples(double time) {
    if (ChosenTable* table = written("samples"); table != nullptr) {
      for (const wire::Sample& sample : step_.sample()) {
        row_.clear();
        number(time);
        integer(step_.station());
        integer(step_.tick());
        integer(sample.sequence());
        integer(sample.time_us());
        integer(sample.estop() ? 1 : 0);
        number(sample.factor());
        for (int c = 0; c < static_cast<int>(kMaxChannels); ++c)
          number(c < sample.raw_size() ? static_cast<double>(sample.raw(c)) : kNone);
        table->add(row_);
      }
    }
    ChosenTable* table = written("angles");
    if (table == nullptr || !map_ || step_.station() != setup_.station()) return;
    read_samples(step_, samples_);
    for (const DeviceSample& raw : samples_) {
      map_->convert(raw, sample_);
      row_.clear();
      number(time);
      integer(step_.station());
      integer(step_.tick());
      integer(raw.time_us);
      for (const double angle : sample_.angle) number(angle);
      table->add(row_);
    }
  }

  void add_hand(double time) {
    ChosenTable* table = written("hand");
    if (table == nullptr) return;
    row_.clear();
    number(time);
    integer(tick_.tick());
    for (int j = 0; j < kJoints; ++j)
      number(j < tick_.hcp_angle_size() ? static_cast<double>(tick_.hcp_angle(j)) : kNone);
    for (int j = 0; j < kJoints; ++j)
      number(j < tick_.gdp_angle_size() ? static_cast<double>(tick_.gdp_angle(j)) : kNone);
    for (const double force : digit_forces(tick_)) number(force);
    table->add(row_);
  }

  void add_segments(double time) {
    ChosenTable* table = written("segments");
    if (table == nullptr) return;
    const std::optional<SegmentPoses> X_WS = shown_poses(tick_);
    if (!X_WS) return;
    row_.clear();
    number(time);
    integer(tick_.tick());
    for (const Pose& X : *X_WS)
      for (int k = 0; k < 3; ++k) number(X.p[k]);
    for (const Pose& X : *X_WS) {
      const Eigen::Quaterniond q(X.R);
      for (const double value : {q.x(), q.y(), q.z(), q.w()}) number(value);
    }
    const SegmentWrenches wrenches = segment_wrenches(tick_, *X_WS);
    for (const SegmentWrench& wrench : wrenches)
      for (int k = 0; k < 3; ++k) number(wrench.force[k]);
    for (const SegmentWrench& wrench : wrenches)
      for (int k = 0; k < 3; ++k) number(wrench.moment[k]);
    table->add(row_);
  }

  void add_event(double time, const std::string& code, const std::string& who, const std::string& text) {
    row_.clear();
    number(time);
    row_.texts = {code, who, text};
    written("events")->add(row_);
  }

  std::unique_ptr<TableFormat> format_;
  std::vector<std::unique_ptr<ChosenTable>> tables_;  ///< as export_tables()
  std::optional<ChannelMap> map_;                     ///< of the station
  ExportRow row_;
  std::vector<DeviceSample> samples_;
  Sample sample_;
  wire::Setup setup_;
  wire::Step step_;
  wire::Tick tick_;
  wire::Event event_;
  wire::Gap gap_;
};

}  // namespace

std::unique_ptr<ExportSink> table_sink(std::unique_ptr<TableFormat> format, const ExportOptions& options) {
  return std::make_unique<TableSink>(std::move(format), options);
}

}  // namespace phalanx
