// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report.h"

namespace phalanx::bench {
namespace {

using Json = nlohmann::json;

Json json_of(const std::vector<TimesRow>& rows) {
  Json out = Json::array();
  for (const TimesRow& row : rows) {
    out.push_back({{"phase", row.phase},
                   {"ticks", row.ticks},
                   {"p50_us", row.us.p50},
                   {"p90_us", row.us.p90},
                   {"p99_us", row.us.p99},
                   {"p99.9_us", row.us.p999},
                   {"max_us", row.us.max},
                   {"raw_max_us", row.raw_max}});
  }
  return out;
}

Json json_of(const PeerRow& peer) {
  const Agreement& a = peer.agreement;
  return {{"name", peer.plan.name},
          {"ticks", peer.ticks},
          {"repeats", peer.plan.repeats},
          {"every", peer.plan.every},
          {"ticks_with_queries", peer.with_queries},
          {"p50_us", peer.p50},
          {"our_p50_us", peer.our_p50},
          {"p99.9_us", peer.p999},
          {"our_p99.9_us", peer.our_p999},
          {"p50_without_queries_us", peer.idle_p50},
          {"our_p50_without_queries_us", peer.our_idle_p50},
          {"contacts", a.records},
          {"unique_contacts", a.unique},
          {"largest_angle_difference_rad", a.angle},
          {"largest_point_difference_m", a.point},
          {"largest_depth_difference_m", a.depth},
          {"grazing", a.grazing},
          {"different", a.different}};
}

Json json_of(const ObjectCost& cost) {
  return {{"triangles", cost.triangles},
          {"bytes_a_triangle", cost.bytes_a_triangle},
          {"mesh_bytes_a_triangle", cost.mesh_bytes_a_triangle},
          {"build_s", cost.build_s}};
}

Json json_of(const SceneReport& scene) {
  Json peers = Json::array();
  for (const PeerRow& peer : scene.peers) peers.push_back(json_of(peer));
  return {{"scene", scene.scene},
          {"object_triangles", scene.object_triangles},
          {"hand_triangles", scene.hand_triangles},
          {"motions", scene.motions},
          {"ticks", scene.ticks},
          {"hash", fmt::format("{:016x}", scene.hash)},
          {"hash_on_record", scene.hash_check != HashCheck::kNotOnRecord},
          {"warm", json_of(scene.warm)},
          {"cold", json_of(scene.cold)},
          {"peers", peers},
          {"object", json_of(scene.cost)}};
}

Json json_of(const RecordingReport& recording) {
  Json out = json_of(std::vector<TimesRow>{recording.times}).front();
  out.update({{"recording", recording.recording},
              {"object", recording.object},
              {"size_mm", recording.size_mm},
              {"object_triangles", recording.triangles},
              {"lowered_mm", recording.lowered_mm},
              {"in_contact", recording.in_contact},
              {"contact_mode", recording.sliding ? "sliding" : "static"},
              {"friction", recording.friction},
              {"seconds", recording.seconds},
              {"slid", recording.slid},
              {"search_exhausted", recording.exhausted},
              {"offset_along_mm", recording.offset_mm},
              {"farthest_offset_along_mm", recording.farthest_mm},
              {"jumps", recording.jumps},
              {"slow_jumps", recording.slow_jumps},
              {"unsolved", recording.unsolved},
              {"hash", fmt::format("{:016x}", recording.hash)}});
  return out;
}

}  // namespace

Json json(const Report& report) {
  Json scenes = Json::array();
  for (const SceneReport& scene : report.scenes) scenes.push_back(json_of(scene));
  Json out = {{"commit", report.made.commit},
              {"cpu", report.made.cpu},
              {"instructions", report.instructions},
              {"compiler", report.made.compiler},
              {"build_type", report.made.build_type},
              {"date", report.made.date},
              {"scenes", scenes}};
  for (const RecordingReport& recording : report.recordings) out["recordings"].push_back(json_of(recording));
  if (report.million.triangles > 0) out["large_object"] = json_of(report.million);
  return out;
}

}  // namespace phalanx::bench
