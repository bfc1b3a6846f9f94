// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "report.h"

namespace phalanx::bench {
namespace {

std::string hash_words(const SceneReport& scene) {
  switch (scene.hash_check) {
    case HashCheck::kMatches:
      return "as expected";
    case HashCheck::kNotOnRecord:
      return "not on record for this libm; the repeats agree";
    case HashCheck::kRecorded:
      return "now on record";
  }
  return "";
}

std::string heading(const SceneReport& scene) {
  return fmt::format("{}: {} object triangles, {} hand triangles, {} motions, {} ticks", scene.scene,
                     scene.object_triangles, scene.hand_triangles, scene.motions, scene.ticks);
}

std::string idle_words(const PeerRow& peer) {
  return fmt::format("{}: p50 of the {} ticks without queries {:.2f} us, ours {:.2f} us", peer.plan.name,
                     peer.ticks - peer.with_queries, peer.idle_p50, peer.our_idle_p50);
}

std::string recordings_markdown(const std::vector<RecordingReport>& recordings) {
  std::string text = fmt::format("\n## Recorded human motion, {} contacts\n\n",
                                 recordings.front().sliding ? "sliding" : "static");
  text +=
      "| recording | object | mm | triangles | ticks | contact | offset | "
      "farthest | jumps | slow | unsolved | p50 | p99 | p99.9 | max | raw max "
      "|\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const RecordingReport& r : recordings) {
    text += fmt::format(
        "| {} | {} | {:.0f} | {} | {} | {:.0f} % | {:.1f} mm | {:.1f} mm | {:.2f} % | {:.2f} % | {:.2f} % | "
        "{:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n",
        r.recording, r.object, r.size_mm, r.triangles, r.times.ticks, 100.0 * r.in_contact, r.offset_mm,
        r.farthest_mm, 100.0 * r.jumps, 100.0 * r.slow_jumps, 100.0 * r.unsolved, r.times.us.p50,
        r.times.us.p99, r.times.us.p999, r.times.us.max, r.times.raw_max);
  }
  return text;
}

double ratio(double theirs, double ours) { return ours > 0.0 ? theirs / ours : 0.0; }

std::string agreement_words(const PeerRow& peer) {
  const Agreement& a = peer.agreement;
  return fmt::format(
      "{}: {} ticks agree with ours to {:.1e} rad; {} contacts made, {} unique, points to {:.1e} m, depths "
      "to "
      "{:.1e} m; {} grazing, {} different",
      peer.plan.name, a.ticks, a.angle, a.records, a.unique, a.point, a.depth, a.grazing.size(),
      a.different.size());
}

std::string listed(const std::vector<std::string>& lines, std::string_view label) {
  constexpr std::size_t kShown = 20;
  std::string text;
  for (std::size_t i = 0; i < lines.size() && i < kShown; ++i)
    text += fmt::format("    {}: {}\n", label, lines[i]);
  if (lines.size() > kShown) text += fmt::format("    and {} more (--json has all)\n", lines.size() - kShown);
  return text;
}

std::string row_text(std::string_view kind, const TimesRow& row) {
  return fmt::format("  {:<5}{:<9}{:>7}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>10.2f}\n", kind, row.phase,
                     row.ticks, row.us.p50, row.us.p90, row.us.p99, row.us.p999, row.us.max, row.raw_max);
}

std::string row_markdown(std::string_view kind, const TimesRow& row) {
  return fmt::format("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", kind,
                     row.phase, row.ticks, row.us.p50, row.us.p90, row.us.p99, row.us.p999, row.us.max,
                     row.raw_max);
}

std::string scene_markdown(const SceneReport& scene) {
  std::string text = fmt::format("\n## {}\n\nHash of the forces {:016x} ({}).\n\n", heading(scene),
                                 scene.hash, hash_words(scene));
  text +=
      "| caches | phase | ticks | p50 | p90 | p99 | p99.9 | max | raw max "
      "|\n|---|---|---:|---:|---:|---:|---:|"
      "---:|---:|\n";
  for (const TimesRow& row : scene.warm) text += row_markdown("warm", row);
  for (const TimesRow& row : scene.cold) text += row_markdown("cold", row);
  if (!scene.peers.empty()) {
    text +=
        "\n| peer | ticks (repeats) | with queries | p50, peer / ours | ratio | p99.9, peer / ours | ratio "
        "|\n|---|---:|---:|---:|---:|---:|---:|\n";
    for (const PeerRow& peer : scene.peers) {
      text += fmt::format("| {} | {} ({}) | {} | {:.1f} / {:.1f} | {:.1f} | {:.1f} / {:.1f} | {:.1f} |\n",
                          peer.plan.name, peer.ticks, peer.plan.repeats, peer.with_queries, peer.p50,
                          peer.our_p50, ratio(peer.p50, peer.our_p50), peer.p999, peer.our_p999,
                          ratio(peer.p999, peer.our_p999));
    }
    text += "\n";
    for (const PeerRow& peer : scene.peers) {
      if (peer.plan.kind == PeerKind::kFclPruned) text += "- " + idle_words(peer) + "\n";
      text += "- " + agreement_words(peer) + "\n";
      for (const std::string& line : peer.agreement.grazing) text += "  - grazing: " + line + "\n";
    }
  }
  return text + "\n" + cost_text(scene.cost);
}

}  // namespace

std::string recordings_heading(bool sliding) {
  return fmt::format(
      "\n{} "
      "contacts\n{:<44}{:<12}{:>5}{:>10}{:>8}{:>9}{:>9}{:>10}{:>8}{:>8}{:>10}{:>9}{:>9}{:>9}{:>9}{:>10}\n",
      sliding ? "sliding" : "static", "recording", "object", "mm", "triangles", "ticks", "contact", "offset",
      "farthest", "jumps", "slow", "unsolved", "p50", "p99", "p99.9", "max", "raw max");
}

std::string recording_text(const RecordingReport& recording) {
  return fmt::format(
      "{:<44}{:<12}{:>5.0f}{:>10}{:>8}{:>8.0f}%{:>7.1f}mm{:>8.1f}mm{:>7.2f}%{:>7.2f}%{:>9.2f}%"
      "{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>10.2f}\n",
      recording.recording, recording.object, recording.size_mm, recording.triangles, recording.times.ticks,
      100.0 * recording.in_contact, recording.offset_mm, recording.farthest_mm, 100.0 * recording.jumps,
      100.0 * recording.slow_jumps, 100.0 * recording.unsolved, recording.times.us.p50,
      recording.times.us.p99, recording.times.us.p999, recording.times.us.max, recording.times.raw_max);
}

std::string cost_text(const ObjectCost& cost) {
  return fmt::format("{} triangles: {:.1f} bytes a triangle ({:.1f} of them the mesh), built in {:.3f} s\n",
                     cost.triangles, cost.bytes_a_triangle, cost.mesh_bytes_a_triangle, cost.build_s);
}

std::string scene_text(const SceneReport& scene) {
  std::string text =
      fmt::format("\n{}\n  hash of the forces {:016x}: {}\n", heading(scene), scene.hash, hash_words(scene));
  text += fmt::format("  {:<14}{:>7}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}   [us]\n", "whole step", "ticks", "p50",
                      "p90", "p99", "p99.9", "max", "raw max");
  for (const TimesRow& row : scene.warm) text += row_text("warm", row);
  for (const TimesRow& row : scene.cold) text += row_text("cold", row);
  if (!scene.peers.empty()) {
    text += fmt::format("  {:<12}{:>7}{:>6}{:>9}{:>11}{:>9}{:>8}{:>11}{:>9}{:>8}   [us]\n", "peer", "ticks",
                        "rep.", "queries", "p50 peer", "ours", "ratio", "p99.9 peer", "ours", "ratio");
  }
  for (const PeerRow& peer : scene.peers) {
    text +=
        fmt::format("  {:<12}{:>7}{:>6}{:>9}{:>11.1f}{:>9.1f}{:>8.1f}{:>11.1f}{:>9.1f}{:>8.1f}\n",
                    peer.plan.name, peer.ticks, peer.plan.repeats, peer.with_queries, peer.p50, peer.our_p50,
                    ratio(peer.p50, peer.our_p50), peer.p999, peer.our_p999, ratio(peer.p999, peer.our_p999));
  }
  for (const PeerRow& peer : scene.peers) {
    if (peer.plan.kind == PeerKind::kFclPruned) text += "  " + idle_words(peer) + "\n";
    text += "  " + agreement_words(peer) + "\n" + listed(peer.agreement.grazing, "grazing") +
            listed(peer.agreement.different, "DIFFERENT");
  }
  return text + "  " + cost_text(scene.cost);
}

std::string markdown(const Report& report) {
  const Made& made = report.made;
  std::string text = fmt::format(
      "# The whole step, measured\n\nWritten by `bench/run`; [bench/README.md](../README.md) says what the "
      "columns mean. Times in microseconds, one core.\n\n| | |\n|---|---|\n| commit | {} |\n| CPU | {} |\n| "
      "instructions | {} |\n| "
      "compiler | {} |\n| build | {} |\n| date | {} |\n",
      made.commit, made.cpu, report.instructions, made.compiler, made.build_type, made.date);
  for (const SceneReport& scene : report.scenes) text += scene_markdown(scene);
  if (report.million.triangles > 0) {
    text += "\n## A large object\n\n" + cost_text(report.million);
  }
  if (!report.recordings.empty()) text += recordings_markdown(report.recordings);
  return text;
}

}  // namespace phalanx::bench
