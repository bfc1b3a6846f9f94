// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "c_api/calls.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/replay_visitor.h"

namespace phalanx::c_api {

/// Steps of a recording that were made again.
struct Recording {
  ReplayResult result;
  std::vector<phalanx_recorded_step> steps;
  std::string scene;
  double rate_hz = 0.0;
};

namespace {

class StepCollector final : public ReplayVisitor {
 public:
  StepCollector(Recording& into, double from, double to) : into_(into), from_(from), to_(to) {}

  void station(const ReplayedStation& begun) override {
    if (into_.rate_hz != 0.0) return;
    into_.scene = begun.scene;
    into_.rate_hz = begun.rate_hz;
  }

  void step(const StepRecord& record, std::span<const DeviceSample> /*samples*/, double time) override {
    if (!(time >= from_ && time < to_)) return;
    phalanx_recorded_step& step = into_.steps.emplace_back();
    step.status = static_cast<std::uint32_t>(record.status);
    step.station = record.station;
    step.tick = record.command.tick;
    step.time_s = time;
    std::copy(record.command.torque.begin(), record.command.torque.end(), step.torque);
    std::copy(record.angle.begin(), record.angle.end(), step.hcp_angle);
    std::copy(record.command.gdp_angle.begin(), record.command.gdp_angle.end(), step.gdp_angle);
    std::copy(record.force.begin(), record.force.end(), step.digit_force);
    step.stiffness = record.stiffness;
  }

 private:
  Recording& into_;
  const double from_;
  const double to_;
};

}  // namespace
}  // namespace phalanx::c_api

using namespace phalanx::c_api;

phalanx_result phalanx_recording_open(const char* path, double from_s, double to_s,
                                      phalanx_recording** recording) {
  if (path == nullptr) return null_argument("path");
  if (recording == nullptr) return null_argument("recording");
  if (std::isnan(from_s)) return failed(PHALANX_ERROR_REFUSED, "from_s = nan: must be a number of seconds");
  if (std::isnan(to_s)) return failed(PHALANX_ERROR_REFUSED, "to_s = nan: must be a number of seconds");
  return guarded([&] {
    auto read = std::make_unique<Recording>();
    StepCollector collector(*read, from_s, to_s);
    read->result = phalanx::replay(path, {}, &collector);
    make_handle(std::move(read), recording);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_recording_get_info(const phalanx_recording* recording, phalanx_recording_info* info) {
  const auto* const object = object_of<Recording>(recording);
  if (object == nullptr) return wrong_handle("recording");
  phalanx_recording_info full{};
  full.exact = object->result.exact ? 1 : 0;
  full.steps = object->steps.size();
  full.compared = object->result.compared;
  full.different = object->result.different;
  full.missing = object->result.missing;
  full.rate_hz = object->rate_hz;
  const std::size_t length = std::min(object->scene.size(), sizeof full.scene - 1);
  std::copy_n(object->scene.data(), length, full.scene);
  return write_struct(full, sizeof full, info, "phalanx_recording_info");
}

phalanx_result phalanx_recording_get_step(const phalanx_recording* recording, uint64_t index,
                                          phalanx_recorded_step* step) {
  const auto* const object = object_of<Recording>(recording);
  if (object == nullptr) return wrong_handle("recording");
  if (index >= object->steps.size())
    return failed(PHALANX_ERROR_INDEX, "index: must be below phalanx_recording_info.steps");
  phalanx_recorded_step full = object->steps[index];
  return write_struct(full, sizeof full, step, "phalanx_recorded_step");
}

phalanx_result phalanx_recording_destroy(phalanx_recording* recording) {
  return destroy<Recording>(recording, "recording");
}
