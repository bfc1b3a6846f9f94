// SPDX-License-Identifier: Apache-2.0
#include "device/served_controller.h"

#include <algorithm>
#include <random>

namespace phalanx {
namespace {

constexpr int kFramesPerTick = 256;  ///< limit, so that a flood does not delay the controller's tick

}  // namespace

ServedController::ServedController(SimulatedController& controller, FaultyWire& wire,
                                   ControllerFaultPlan& plan, ControllerLog* log)
    : controller_(controller), wire_(wire), plan_(plan), log_(log) {}

std::uint32_t ServedController::new_epoch() {
  std::random_device entropy;
  return static_cast<std::uint32_t>(entropy());
}

ServedStatistics ServedController::serve(const Clock& clock, const Transport& transport,
                                         std::optional<double> seconds, const std::atomic<int>& stop) {
  const double period = controller_.period();
  const double begin = clock.now();
  std::uint64_t next = 1;  // number of the tick on the process's clock
  while (stop == 0 && !transport.lost()) {
    const double t = static_cast<double>(next) * period;
    if (seconds && t > *seconds) break;
    if (!clock.sleep_until(begin + t)) continue;
    const auto due = static_cast<std::uint64_t>((clock.now() - begin) / period + 1e-6);
    if (due > next) {
      controller_.skip(due - next);
      statistics_.late += due - next;
      next = due;
    }
    tick(static_cast<double>(next) * period);
    ++next;
  }
  statistics_.seconds = clock.now() - begin;
  return statistics_;
}

/// Advances the clock of a controller that is too slow. @returns true if this tick is left out
bool ServedController::leaves_out(double t) noexcept {
  const ControllerSlowness slowness = plan_.slowness(t);
  if (++left_out_ >= slowness.every) {
    left_out_ = 0;
    return false;
  }
  if (!slowness.clock) controller_.skip(1);
  return true;
}

void ServedController::tick(double t) noexcept {
  if (leaves_out(t)) return;
  const PacketFaults faults = plan_.packets(t);
  if (plan_.restarts(t)) {
    controller_.restart(controller_.controller().epoch + 1000U);
    wire_.clear();
    has_host_ = false;
    newest_command_ = 0;
    ++statistics_.restarts;
  }
  take_frames(t, faults);
  const phx_output& output = controller_.tick(plan_.breakage(t));
  if (output.sample_size > 0 && has_host_) wire_.send(t, faults, {output.sample, output.sample_size}, host_);
  wire_.flush(t, faults, has_host_ ? std::optional(host_) : std::nullopt);
  if (log_ != nullptr) log_->add(controller_, newest_command_);
  ++statistics_.ticks;
}

void ServedController::take_frames(double t, const PacketFaults& faults) noexcept {
  for (int i = 0; i < kFramesPerTick; ++i) {
    Peer from = 0;
    const std::size_t size = wire_.receive(t, faults, frame_, from);
    if (size == 0) return;
    const std::span<const std::uint8_t> frame = std::span(frame_).first(size);
    std::size_t reply_size = 0;
    const phx_received received = controller_.receive(frame, reply_, reply_size);
    if (received == PHX_NEW_SESSION) {
      host_ = from;
      has_host_ = true;
      newest_command_ = 0;
    }
    if (log_ != nullptr && received != PHX_NEW_SESSION) note_command(frame);
    if (reply_size > 0) wire_.send(t, faults, std::span(reply_).first(reply_size), from);
  }
}

/// Notes the newest command of the session, whether the controller uses it or not.
void ServedController::note_command(std::span<const std::uint8_t> frame) noexcept {
  phx_message message;
  if (phx_decode(frame.data(), frame.size(), &message) != PHX_OK) return;
  if (message.header.epoch != controller_.controller().epoch) return;
  if (message.header.type == PHX_COMMAND)
    newest_command_ = std::max(newest_command_, message.as.command.tick);
  else if (message.header.type == PHX_COMMAND_WALLS)
    newest_command_ = std::max(newest_command_, message.as.walls.command.tick);
}

}  // namespace phalanx
