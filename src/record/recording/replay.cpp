// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/device/channel_map.h"
#include "phalanx/record/made.h"
#include "phalanx/record/replay_visitor.h"
#include "record/mcap/mcap_reader.h"
#include "record/recording/own_steps.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"
#include "record/recording/topics.h"

namespace phalanx {
namespace {

std::string channel_name(const DeviceChannel& channel) {
  const auto joint = [&] { return std::string(joint_name(channel.index)); };
  const auto digit = [&] { return std::string(digit_name(channel.index)); };
  switch (channel.kind) {
    case ChannelKind::kAngle:
      return "angle of " + joint();
    case ChannelKind::kTorque:
      return "torque of " + joint();
    case ChannelKind::kForce:
      return "force of " + digit();
    case ChannelKind::kMotor:
      return fmt::format("motor {}", channel.index);
    case ChannelKind::kCurl:
      return "curl of " + digit();
    case ChannelKind::kSplay:
      return "splay of " + digit();
  }
  return "unknown";
}

class Replay {
 public:
  Replay(const std::filesystem::path& file, const FindRecordingKey& keys)
      : name_(file), file_(file, keys), reader_(file_) {}

  /// @param visitor  null: none
  ReplayResult run(const std::function<void(double)>& on_progress, ReplayVisitor* visitor) {
    visitor_ = visitor;
    mcap::Message message;
    std::uint64_t told = 0;
    std::optional<std::uint64_t> begin_ns;
    while (reader_.next(message)) {
      if (!begin_ns) begin_ns = message.time;
      message_time_ = message.time > *begin_ns ? 1e-9 * static_cast<double>(message.time - *begin_ns) : 0.0;
      const std::string_view schema = reader_.schema_of(message.channel);
      if (schema == "phalanx.wire.Step")
        step(parsed(step_, message));
      else if (schema == "phalanx.wire.Setup")
        begin(parsed(setup_, message));
      else if (schema == "phalanx.wire.Change")
        changes_[parsed(change_, message).number()] = change_;
      else if (schema == "phalanx.wire.Gap")
        gap(parsed(gap_, message));
      if (on_progress && reader_.place() >= told) {
        on_progress(static_cast<double>(reader_.place()) /
                    static_cast<double>(std::max<std::uint64_t>(1, file_.size())));
        told = reader_.place() + file_.size() / 200;
      }
    }
    if (result_.stations == 0)
      throw std::runtime_error(
          fmt::format("{}: it holds no station; it is no recording of Phalanx", name_.string()));
    origin();
    return std::move(result_);
  }

 private:
  template <class Wire>
  const Wire& parsed(Wire& into, const mcap::Message& message) {
    if (message.data.size() > largest_message(into))
      throw std::runtime_error(fmt::format("{}: message {} of channel {} has {} bytes; at most {} are read",
                                           name_.string(), message.sequence, message.channel,
                                           message.data.size(), largest_message(into)));
    if (!into.ParseFromArray(message.data.data(), static_cast<int>(message.data.size())))
      throw std::runtime_error(fmt::format("{}: message {} of channel {} does not match its schema",
                                           name_.string(), message.sequence, message.channel));
    return into;
  }

  /// Runs what makes something of recorded numbers. @throws std::runtime_error naming the place
  template <class Make>
  auto made(const std::string& place, const Make& make) {
    try {
      return make();
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}, {}: {}; replay it with the version that recorded it, {}",
                                           name_.string(), place, error.what(), metadata("version")));
    }
  }

  [[nodiscard]] std::string metadata(const std::string& key) const {
    const std::string value = metadata_of(reader_, key);
    return value.empty() ? "unknown" : value;
  }

  void origin() {
    const Made here = made_here();
    result_.recorded_by = fmt::format("{} ({}, {}, {})", metadata("version"), metadata("commit"),
                                      metadata("compiler"), metadata("build_type"));
    result_.recorded_on = metadata("cpu");
    result_.other_version = metadata("commit") != here.commit || metadata("compiler") != here.compiler ||
                            metadata("build_type") != here.build_type;
    result_.other_machine = !same_machine_;
    result_.exact = same_machine_;
  }

  void begin(const wire::Setup& setup) {
    const std::string place = fmt::format("station {}", setup.station());
    model_ = made(place, [&] { return read_model(setup.start().model()); });
    station_.reset();
    own_.reset();
    if (setup.own_steps())
      own_ = made(place, [&] {
        return std::make_unique<OwnSteps>(
            std::make_unique<Rendering>(model_, read_parameters(setup.start())));
      });
    else
      station_ = made(place, [&] { return read_station(setup, model_); });
    first_model_ = model_;
    model_of_ = 0;
    changes_.clear();
    channels_ = station_ ? station_->channels().channels() : std::vector<DeviceChannel>();
    same_machine_ = metadata("libm") == fmt::format("{:016x}", libm_fingerprint());
    number_ = setup.station();
    tick_ = 0;
    lost_ = false;
    ++result_.stations;
    if (visitor_ == nullptr) return;
    visitor_->station({.number = number_,
                       .scene = setup.start().scene(),
                       .device = read_device(setup),
                       .calibration = setup.calibration(),
                       .rate_hz = 1.0 / read_parameters(setup.start()).period()});
  }

  void gap(const wire::Gap& gap) {
    if (gap.station() != number_ || gap.last_tick() < gap.first_tick() || gap.last_tick() <= tick_) return;
    result_.missing += gap.last_tick() - std::max(tick_, gap.first_tick() - 1);
    if (visitor_ != nullptr)
      visitor_->missing(number_, std::max(tick_ + 1, gap.first_tick()), gap.last_tick());
    tick_ = gap.last_tick();
    lost_ = true;
  }

  const wire::Change& change_of(std::uint64_t number) {
    const auto change = changes_.find(number);
    if (change == changes_.end()) throw std::runtime_error("it is not in the file");
    return change->second;
  }

  std::unique_ptr<Rendering> rendering_of(std::uint64_t number) {
    return made(fmt::format("change {}", number), [&] {
      const wire::Change& change = change_of(number);
      if (change.model_of() != model_of_) {
        model_ = change.model_of() == 0 ? first_model_ : read_model(change_of(change.model_of()).model());
        model_of_ = change.model_of();
      }
      auto rendering = std::make_unique<Rendering>(model_, read_parameters(change), number);
      changes_.erase(changes_.begin(),
                     changes_.lower_bound(std::min(number, model_of_)));  // no step names them any more
      return rendering;
    });
  }

  void not_made(const wire::Step& recorded) {
    ++result_.not_compared;
    if (visitor_ != nullptr) visitor_->unknown_step(recorded.station(), recorded.tick());
  }

  void step(const wire::Step& recorded) {
    ++result_.steps;
    if (result_.steps == 1) begin_time_ = recorded.time();
    result_.seconds = recorded.time() - begin_time_;
    // A station's beginning, or steps of it, may be lost with a damaged part of the file.
    if ((!station_ && !own_) || recorded.station() != number_) return not_made(recorded);
    if (recorded.tick() > tick_ + 1) {
      result_.missing += recorded.tick() - tick_ - 1;
      if (visitor_ != nullptr) visitor_->missing(number_, tick_ + 1, recorded.tick() - 1);
    }
    if (recorded.tick() != tick_ + 1) lost_ = true;
    tick_ = recorded.tick();
    if (lost_) return not_made(recorded);
    if (own_) return own_step(recorded);
    make(recorded);
    compare(recorded);
    if (visitor_ != nullptr) show(recorded);
  }

  void show(const wire::Step& recorded) {
    StepRecord made;
    made.station = number_;
    made.input = read_input(recorded);
    made.command = station_->command();
    made.hash = station_->hash();
    made.samples = static_cast<std::uint32_t>(samples_.size());
    station_->describe(made);
    visitor_->step(made, samples_, message_time_);
  }

  /// Makes a step of a program that called step() itself, and compares it.
  void own_step(const wire::Step& recorded) {
    if (recorded.changed() != 0) own_->change_to(parameters_of(recorded.changed()));
    made(fmt::format("tick {}", recorded.tick()), [&] { own_->make(recorded); });
    StepRecord made;
    made.station = number_;
    made.input = read_input(recorded);
    own_->describe(made);
    ++result_.compared;
    const double torque = torque_difference(recorded, made.command.torque);
    result_.largest_torque = std::max(result_.largest_torque, torque);
    const bool same =
        same_machine_ ? made.hash == recorded.hash()
                      : torque <= ReplayResult::kTolerance && same_angles(recorded, made.command.gdp_angle);
    if (!same) differs(recorded, "angles, forces or torques (their hash differs)");
    if (visitor_ != nullptr) visitor_->step(made, {}, message_time_);
  }

  HapticParameters parameters_of(std::uint64_t change) {
    return made(fmt::format("change {}", change), [&] { return read_parameters(change_of(change)); });
  }

  void make(const wire::Step& recorded) {
    const StepInput input = read_input(recorded);
    read_samples(recorded, samples_);
    static_cast<void>(station_->serve(input.requests, input.connection_at_requests, input.time));
    if (!station_->ending()) {
      if (input.waits) static_cast<void>(station_->wait_for_exchange());
      if (input.exchanged != 0) static_cast<void>(station_->exchange(rendering_of(input.exchanged)));
      if (input.changed != 0) station_->change_to(parameters_of(input.changed));
    }
    station_->confirm_openings(input.openings);
    static_cast<void>(station_->step(samples_, input.connection, input.late, input.time));
  }

  void compare(const wire::Step& recorded) {
    ++result_.compared;
    const double torque = torque_difference(recorded, station_->command().torque);
    result_.largest_torque = std::max(result_.largest_torque, torque);
    const std::string check = channel_check(samples_, channels_.size());
    const bool same_input = check == recorded.channel_check();
    const bool same = same_machine_ ? station_->hash() == recorded.hash() : close(recorded, torque);
    if (same && same_input) return;
    if (result_.first && visitor_ == nullptr) return differs(recorded, {});
    differs(recorded,
            same_input ? output_difference(recorded) : input_difference(check, recorded.channel_check()));
  }

  void differs(const wire::Step& recorded, std::string what) {
    ++result_.different;
    if (visitor_ != nullptr) visitor_->different(number_, recorded.tick(), what);
    if (result_.first) return;
    result_.first = {.station = number_,
                     .tick = recorded.tick(),
                     .time = recorded.time() - begin_time_,
                     .what = std::move(what)};
  }

  [[nodiscard]] static double recorded_torque(const wire::Step& recorded, std::size_t joint) {
    return recorded.torque_size() == kJoints ? recorded.torque(static_cast<int>(joint)) : 0.0;
  }

  [[nodiscard]] static double torque_difference(const wire::Step& recorded, const JointArray& made) {
    double largest = 0.0;
    for (std::size_t j = 0; j < kJoints; ++j)
      largest = std::max(largest, std::abs(made[j] - recorded_torque(recorded, j)));
    return largest;
  }

  [[nodiscard]] static bool same_angles(const wire::Step& recorded, const JointArray& made) {
    for (int j = 0; j < recorded.gdp_angle_size() && j < kJoints; ++j)
      if (!(std::abs(made[idx(j)] - recorded.gdp_angle(j)) <= ReplayResult::kTolerance)) return false;
    return true;
  }

  [[nodiscard]] bool close(const wire::Step& recorded, double torque) const {
    if (!(torque <= ReplayResult::kTolerance)) return false;
    if (static_cast<int>(station_->safety().state()) != static_cast<int>(recorded.state())) return false;
    for (std::size_t d = 0; d < station_->command().stopped.size(); ++d)
      if (station_->command().stopped[d] != ((recorded.stopped() >> d & 1U) != 0)) return false;
    return same_angles(recorded, station_->snapshot().gdp_angle);
  }

  /// Names the first channel whose raw values are not those that the station got.
  [[nodiscard]] std::string input_difference(const std::string& check, const std::string& recorded) const {
    for (std::size_t c = 0; c < channels_.size() && 2 * c + 1 < std::min(check.size(), recorded.size()); ++c)
      if (check.compare(2 * c, 2, recorded, 2 * c, 2) != 0)
        return fmt::format("channel {} ({}): the sample in the file is not the one that the station got", c,
                           channel_name(channels_[c]));
    return "the samples in the file are not those that the station got";
  }

  [[nodiscard]] std::string output_difference(const wire::Step& recorded) const {
    const SafetyState state = station_->safety().state();
    if (static_cast<int>(state) != static_cast<int>(recorded.state()))
      return fmt::format("state: recorded {}, now {}",
                         safety_state_name(static_cast<SafetyState>(
                             std::clamp(recorded.state(), wire::SAFETY_WAITING, wire::SAFETY_FAULT))),
                         safety_state_name(state));
    for (std::size_t j = 0; j < kJoints; ++j)
      if (station_->command().torque[j] != recorded_torque(recorded, j))
        return fmt::format("torque of {}: recorded {} Nm, now {} Nm", joint_name(static_cast<int>(j)),
                           recorded_torque(recorded, j), station_->command().torque[j]);
    for (std::size_t d = 0; d < station_->command().stopped.size(); ++d)
      if (station_->command().stopped[d] != ((recorded.stopped() >> d & 1U) != 0))
        return fmt::format("{} {}: recorded otherwise", digit_name(static_cast<int>(d)),
                           station_->command().stopped[d] ? "is stopped" : "is not stopped");
    if (recorded.gdp_angle_size() == kJoints)
      for (std::size_t j = 0; j < kJoints; ++j)
        if (station_->snapshot().gdp_angle[j] != recorded.gdp_angle(static_cast<int>(j)))
          return fmt::format("shown angle of {}: recorded {} rad, now {} rad",
                             joint_name(static_cast<int>(j)), recorded.gdp_angle(static_cast<int>(j)),
                             station_->snapshot().gdp_angle[j]);
    return "forces or angles (their hash differs; the torques that were sent are the same)";
  }

  const std::filesystem::path name_;
  const mcap::ReadableFile file_;
  mcap::McapReader reader_;
  ReplayResult result_;
  wire::Step step_;
  wire::Setup setup_;
  wire::Change change_;
  wire::Gap gap_;
  std::map<std::uint64_t, wire::Change> changes_;
  std::uint64_t model_of_ = 0;  ///< number of the change that model_ is of
  std::shared_ptr<const HapticModel> model_;
  std::shared_ptr<const HapticModel> first_model_;  ///< of the station's setup
  std::unique_ptr<StationStep> station_;
  std::unique_ptr<OwnSteps> own_;  ///< of a program that called step() itself; then there is no station_
  std::vector<DeviceChannel> channels_;
  std::vector<DeviceSample> samples_;
  std::uint64_t number_ = 0;  ///< of the station
  std::uint64_t tick_ = 0;
  bool same_machine_ = true;
  bool lost_ = false;  ///< steps of this station are missing
  double begin_time_ = 0.0;
  ReplayVisitor* visitor_ = nullptr;
  double message_time_ = 0.0;  ///< of the newest message, since the recording's beginning [s]
};

}  // namespace

ReplayResult replay(const std::filesystem::path& file, const std::function<void(double)>& on_progress,
                    ReplayVisitor* visitor, const FindRecordingKey& keys) {
  try {
    return Replay(file, keys).run(on_progress, visitor);
  } catch (const mcap::McapError& error) {
    throw std::runtime_error(
        fmt::format("{}: {}; phalanx session repair FILE keeps what is whole", file.string(), error.what()));
  } catch (const mcap::NoKeyError& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace phalanx
