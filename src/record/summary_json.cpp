// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "phalanx/record/summary.h"
#include "record/json_by_name.h"
#include "record/made_json.h"

namespace phalanx {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string summary_json(const Summary& summary) {
  Json json = Json::object();
  json["scene"] = summary.scene;
  json["ticks"] = summary.ticks;
  json["rate_hz"] = summary.rate_hz;
  json["seconds"] = summary.seconds;
  json["triangles"] = {{"hand", summary.hand_triangles}, {"object", summary.object_triangles}};
  const StepTimes& t = summary.step_us;
  json["step_us"] = {{"p50", t.p50}, {"p90", t.p90}, {"p99", t.p99}, {"p999", t.p999}, {"max", t.max}};
  json["angle_origin"] = angle_origin_json(summary.angle_origin);
  json["contact_ticks"] = json_by_name(summary.contact_ticks, segment_name);
  json["peak_force_n"] = json_by_name(summary.peak_force, segment_name);
  json["peak_torque_nm"] = json_by_name(summary.peak_torque, joint_name);
  json["peak_total_force"] = {{"force_n", summary.peak_total_force},
                              {"time_s", summary.peak_total_force_time_s}};
  Json& limiter_ticks = json["limiter_ticks"] = Json::object();
  for (const LimiterActivity& limiter : limiters(summary)) limiter_ticks[limiter.name] = limiter.ticks;
  json["status_ticks"] = json_by_name(summary.status_ticks, status_name);
  json["warnings"] = warnings(summary);
  json["made"] = made_json(summary.made);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace phalanx
