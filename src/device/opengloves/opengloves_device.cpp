// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/opengloves/opengloves_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <thread>

#include "device/opengloves/glove_channels.h"
#include "device/opengloves/glove_port.h"
#include "device/opengloves/glove_stops.h"
#include "device/opengloves/glove_wire.h"
#include "phalanx/core/latest.h"
#include "phalanx/device/sample_queue.h"

namespace phalanx {
namespace {

constexpr double kKeepAlive = 0.1;     // a newline is sent after this time without a line [s]
constexpr double kCommandHold = 0.02;  // stops are released this long after the last command [s]
constexpr double kNap = 0.01;          // longest wait on the port, so that close() is not delayed [s]

/// Counters that two threads share.
struct Counters {
  std::atomic<std::uint64_t> received{0}, corrupt{0}, overflowed{0}, sent{0}, clamped{0};
};

void count(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
  counter.fetch_add(by, std::memory_order_relaxed);
}

/// State that the loop has requested.
struct Wanted {
  GloveStops stops{};
  bool enable = false;
  std::uint64_t tick = 0;
  double at = -1e9;  ///< the host's clock at that time [s]
};

class Glove final : public OpenGlovesDevice {
 public:
  Glove(std::string port, unsigned baud, int descriptor, const Clock& clock, OpenGlovesSettings settings)
      : port_(std::move(port)), baud_(baud), clock_(clock), settings_(std::move(settings)) {
    if (settings_.full_scale != 0 && settings_.full_scale != kGloveWide &&
        settings_.full_scale != kGloveNarrow) {
      throw std::invalid_argument(fmt::format(
          "opengloves:{}: a full scale of {} is none that gloves have; write {}, {}, or 0 to find "
          "it out",
          port_, settings_.full_scale, kGloveWide, kGloveNarrow));
    }
    if (descriptor >= 0) wire_.emplace(descriptor);
  }
  ~Glove() override { close(); }

  void set_hand(const HandParameters& hand) override { hand_ = hand; }
  void set_watchdog(std::optional<double> seconds) override { info_.watchdog = seconds; }
  void set_force_feedback(bool has_it) override { info_.actuated = has_it; }
  void set_calibration(std::vector<DeviceChannel> channels) override;
  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override;
  void send(const DeviceCommand& command) noexcept override;
  void reset() noexcept override { mend_ = true; }
  [[nodiscard]] Fault connection_fault() const noexcept override { return fault_; }
  [[nodiscard]] LinkStatistics statistics() const noexcept override;

 private:
  [[nodiscard]] LearntGlove learn();
  void describe(const LearntGlove& glove);
  bool take_line(GloveLine& line) noexcept;
  void answer() noexcept;
  void keep_alive() noexcept;
  void give_sample(const GloveLine& line) noexcept;
  void mend() noexcept;
  void run() noexcept;

  const std::string port_;
  const unsigned baud_;
  const Clock& clock_;
  const OpenGlovesSettings settings_;
  std::optional<HandParameters> hand_;
  LearntGlove learnt_;  ///< empty until learning is over
  DeviceInfo info_;
  std::vector<GloveChannel> channels_;
  int full_scale_ = kGloveWide;
  GloveStopper stopper_;  ///< the loop's thread

  // The glove's thread; before that is started, open().
  std::optional<GloveWire> wire_;
  bool begun_ = false;  ///< a line end was read: the next line is whole
  double heard_ = 0.0;  ///< when the last line came or a newline was sent [s]
  DeviceSample sample_;

  std::thread thread_;
  std::atomic<bool> quit_{false};
  std::atomic<bool> mend_{false};
  std::atomic<Fault> fault_{Fault::kNone};
  Counters counters_;
  Latest<Wanted> wanted_;
  SampleQueue samples_;
};

// ---- set-up ----
void Glove::open() {
  if (thread_.joinable()) return;
  if (!wire_) {
    if (port_.empty()) throw DeviceError("opengloves: a descriptor can be opened once; make a new device");
    wire_.emplace(open_glove_port(port_, baud_));
  }
  begun_ = false;
  try {
    describe(learn());
  } catch (...) {
    wire_.reset();
    throw;
  }
  quit_ = false;
  fault_ = Fault::kNone;
  thread_ = std::thread([this] { run(); });
}

LearntGlove Glove::learn() {
  LearntGlove glove;
  learnt_ = {};
  heard_ = clock_.now();
  double until = heard_ + settings_.hello_timeout;
  double first = 0.0;
  while (clock_.now() < until && !wire_->lost()) {
    wire_->wait(kNap);
    GloveLine line;
    while (take_line(line)) {
      if (!line.usable()) continue;
      if (glove.lines() == 0) {
        first = clock_.now();
        until = first + settings_.learn_for;
      }
      glove.add(line);
    }
    keep_alive();
  }
  if (wire_->lost()) throw DeviceError(fmt::format("opengloves:{}: the port was lost; plug it in", port_));
  if (glove.lines() == 0) {
    throw DeviceError(
        fmt::format("opengloves:{}: no line that a glove sends came within {} s ({} others did); is it "
                    "switched on, is {} "
                    "its baud rate, and is its firmware set to alpha encoding?",
                    port_, settings_.hello_timeout, counters_.corrupt.load(), baud_));
  }
  info_.rate_hz = std::max(1.0, (glove.lines() - 1) / std::max(settings_.learn_for, 1e-3));
  return glove;
}

void Glove::describe(const LearntGlove& glove) {
  learnt_ = glove;
  full_scale_ = settings_.full_scale != 0 ? settings_.full_scale : glove.full_scale();
  channels_ = glove_channels(glove, full_scale_, hand_);
  info_.name = "opengloves";
  info_.serial = settings_.serial;
  if (info_.serial.empty()) info_.serial = usb_serial_number(port_);
  if (info_.serial.empty()) info_.serial = port_;
  info_.renders_torque = false;
  info_.channels.clear();
  for (const GloveChannel& c : channels_) info_.channels.push_back(c.channel);
  stopper_ = GloveStopper(info_.channels, full_scale_, hand_);
}

void Glove::set_calibration(std::vector<DeviceChannel> channels) {
  const bool same = std::equal(
      channels.begin(), channels.end(), info_.channels.begin(), info_.channels.end(),
      [](const DeviceChannel& a, const DeviceChannel& b) { return a.kind == b.kind && a.index == b.index; });
  if (!same)
    throw std::invalid_argument("opengloves: a calibration of other channels than the glove's; calibrate it");
  for (const DeviceChannel& c : channels) {
    if (!std::isfinite(c.gain) || c.gain == 0.0 || !std::isfinite(c.offset)) {
      throw std::invalid_argument(fmt::format(
          "opengloves: a channel has gain {} and offset {}; calibrate the glove again", c.gain, c.offset));
    }
  }
  stopper_ = GloveStopper(channels, full_scale_, hand_);
}

void Glove::close() noexcept {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
  wire_.reset();
}

// ---- the loop's thread ----
std::size_t Glove::receive(double, std::span<DeviceSample> out) noexcept {
  const SampleQueue::Taken taken = samples_.take(out);
  count(counters_.overflowed, taken.dropped);
  return taken.count;
}

void Glove::send(const DeviceCommand& command) noexcept {
  wanted_.write({.stops = info_.actuated ? stopper_.stops(command) : GloveStops{},
                 .enable = command.enable,
                 .tick = command.tick,
                 .at = clock_.now()});
}

LinkStatistics Glove::statistics() const noexcept {
  LinkStatistics s;
  s.received = counters_.received;
  s.corrupt = counters_.corrupt;
  s.overflowed = counters_.overflowed;
  s.sent = counters_.sent;
  s.device_corrupt = counters_.clamped;
  return s;
}

// ---- the glove's thread ----
// Answers every line, also an unreadable one: the firmware waits for an answer. @returns true if
// there was one
bool Glove::take_line(GloveLine& line) noexcept {
  const GloveWire::Piece piece = wire_->next();
  if (piece == GloveWire::Piece::kNone) return false;
  heard_ = clock_.now();
  answer();
  // Bytes before the first line end may be the second half of a line.
  line = piece == GloveWire::Piece::kLine && begun_ ? parse_glove_line(wire_->line()) : GloveLine{};
  if (!learnt_.is_whole(line)) line.damaged = true;
  if (begun_ && !line.usable()) count(counters_.corrupt);
  count(counters_.clamped, static_cast<std::uint64_t>(line.clamped));
  begun_ = true;
  return true;
}

void Glove::answer() noexcept {
  wanted_.update();
  const Wanted& wanted = wanted_.value();
  const bool fresh = clock_.now() - wanted.at <= kCommandHold;
  std::array<char, kGloveAnswerSize> text{};
  const std::size_t size = format_glove_answer(fresh ? wanted.stops : GloveStops{}, text);
  if (!wire_->send({text.data(), size})) return;
  count(counters_.sent);
  const bool active = fresh && wanted.enable;
  sample_.state = active ? DeviceState::kActive : DeviceState::kReady;
  sample_.factor = active ? 1.0 : 0.0;
  if (fresh) sample_.acted_tick = wanted.tick;
}

void Glove::keep_alive() noexcept {
  if (clock_.now() - heard_ < kKeepAlive) return;
  heard_ = clock_.now();
  wire_->send("\n");
}

void Glove::give_sample(const GloveLine& line) noexcept {
  for (std::size_t c = 0; c < channels_.size(); ++c)
    if (line.has[channels_[c].key]) sample_.raw[c] = line.value[channels_[c].key];
  ++sample_.sequence;
  sample_.received = clock_.now();
  // Two lines that were read at once still get increasing times.
  sample_.time_us = std::max(clock_.now_us(), sample_.time_us + 1);
  count(counters_.received);
  if (!samples_.push(sample_)) count(counters_.overflowed);
}

// Opens the port again if reset() was called after the glove was unplugged.
void Glove::mend() noexcept {
  if (!mend_.exchange(false) || fault_.load() == Fault::kNone || port_.empty()) return;
  try {
    const int descriptor = open_glove_port(port_, baud_);
    wire_.emplace(descriptor);
    begun_ = false;
    fault_ = Fault::kNone;
  } catch (const DeviceError&) {
    // Not there yet: the fault stays, and the next reset() tries again.
  }
}

void Glove::run() noexcept {
  while (!quit_) {
    wire_->wait(kNap);
    GloveLine line;
    while (!quit_ && take_line(line))
      if (line.usable()) give_sample(line);
    keep_alive();
    if (wire_->lost()) fault_ = Fault::kDeviceLost;
    mend();
  }
  wire_->send("A0B0C0D0E0\n");  // releases every finger
}

}  // namespace

std::unique_ptr<OpenGlovesDevice> make_opengloves_device(const std::string& port, unsigned baud,
                                                         const Clock& clock,
                                                         const OpenGlovesSettings& settings) {
  return std::make_unique<Glove>(port, baud, -1, clock, settings);
}

std::unique_ptr<OpenGlovesDevice> make_opengloves_device(int file_descriptor, const Clock& clock,
                                                         const OpenGlovesSettings& settings) {
  return std::make_unique<Glove>("", 115200, file_descriptor, clock, settings);
}

}  // namespace phalanx
