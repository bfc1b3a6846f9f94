// SPDX-License-Identifier: Apache-2.0
#include "replay.h"

#include <stdexcept>
#include <string>

namespace phalanx::bench {

ContactModel contact_model(const HapticModel& model, const HapticParameters& parameters) {
  return {model.hand, model.trees(), model.object, parameters.contact, parameters.period()};
}

GdpValues values_of(const GdpState& state) {
  return {state.angle, state.poses, state.hcp_angle, state.started, state.inside, state.record};
}

void set_values(const GdpValues& values, GdpState& state) {
  state.angle = values.angle;
  state.poses = values.poses;
  state.hcp_angle = values.hcp_angle;
  state.started = values.started;
  state.inside = values.inside;
  state.record = values.record;
}

std::vector<GdpValues> replay(const HapticModel& model, const HapticParameters& parameters,
                              const std::vector<JointArray>& angle) {
  GdpState state(contact_model(model, parameters));
  HandPoses hcp;
  std::vector<GdpValues> out;
  out.reserve(angle.size() + 1);
  out.push_back(values_of(state));
  for (const JointArray& hcp_angle : angle) {
    model.hand.poses(hcp_angle, hcp);
    static_cast<void>(advance_gdp(contact_model(model, parameters), hcp_angle, hcp, kMeasured, state));
    out.push_back(values_of(state));
  }
  return out;
}

void check_replay(const HapticModel& model, const HapticParameters& parameters,
                  const std::vector<JointArray>& angle, const std::vector<GdpValues>& states) {
  HapticState state(model, parameters);
  for (std::size_t tick = 0; tick < angle.size(); ++tick) {
    static_cast<void>(
        step(model, parameters, {static_cast<double>(tick) / parameters.rate_hz, angle[tick]}, state));
    if (state.snapshot().gdp_angle != states[tick + 1].angle) {
      throw std::runtime_error("step() and advance_gdp() part at tick " + std::to_string(tick) +
                               " of the same motion");
    }
  }
}

}  // namespace phalanx::bench
