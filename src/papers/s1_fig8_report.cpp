// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "papers/s1_fig8.h"
#include "phalanx/core/constants.h"
#include "phalanx/record/made.h"
#include "record/made_json.h"

namespace phalanx {
namespace {

constexpr int kFinger = static_cast<int>(Digit::kIndex);
constexpr std::array<const char*, 3> kJointNames = {"MCP flexion", "PIP", "DIP"};
constexpr std::array<const char*, 3> kSegmentNames = {"proximal", "middle", "distal"};

/// @returns the value of MCP flexion (i = 0), PIP (1) or DIP (2).
double of_joint(const JointArray& values, std::size_t i) {
  return values[static_cast<std::size_t>(joint_index(kFinger, i == 0 ? 0 : static_cast<int>(i) + 1))];
}
const SegmentSnapshot& of_segment(const Snapshot& snapshot, std::size_t i) {
  return snapshot.segment[static_cast<std::size_t>(segment_index(kFinger, static_cast<int>(i)))];
}

}  // namespace

std::string fig8_text(const std::vector<Fig8Situation>& situations) {
  std::string text =
      "S1 fig. 8: the index finger and a ball in seven situations, pressed and held still.\n"
      "S1 says which joints carry torque; its angles, depths, forces and torques are not printed as "
      "numbers.\n"
      "Torque is what the contacts do to the finger, axis . (r x f): pressing flexors are pushed open, so it "
      "is negative.\n\n";
  for (const Fig8Situation& situation : situations) {
    const Snapshot& s = situation.held;
    text += fmt::format("({}) {}\n", situation.letter, situation.title);
    text += fmt::format("    {:<12}{:>10}{:>10}{:>13}   {:<26}{:<10}{:>8}{:>12}{:>11}\n", "joint",
                        "HCP [deg]", "GDP [deg]", "torque [Nm]", "torque in S1", "segment", "contact",
                        "depth [mm]", "force [N]");
    for (std::size_t i = 0; i < 3; ++i) {
      const SegmentSnapshot& segment = of_segment(s, i);
      text += fmt::format(
          "    {:<12}{:>10.2f}{:>10.2f}{:>13.6f}   {:<26}{:<10}{:>8}{:>12.3f}{:>11.3f}\n", kJointNames[i],
          kRadToDeg * of_joint(s.hcp_angle, i), kRadToDeg * of_joint(s.gdp_angle, i), of_joint(s.torque, i),
          carries_torque(situation, static_cast<int>(i)) ? "some, value not printed" : "zero",
          kSegmentNames[i], segment.contact ? "yes" : "no", 1e3 * segment.depth, segment.force);
    }
  }
  return text;
}

std::string fig8_csv(const std::vector<Fig8Situation>& situations) {
  std::string text = "situation";
  for (const char* joint : {"mcp", "pip", "dip"}) {
    text += fmt::format(",{0}_hcp_rad,{0}_gdp_rad,{0}_torque_nm", joint);
  }
  for (const char* segment : kSegmentNames)
    text += fmt::format(",{0}_contact,{0}_depth_m,{0}_force_n", segment);
  text += "\n";
  for (const Fig8Situation& situation : situations) {
    text += situation.letter;
    const Snapshot& s = situation.held;
    for (std::size_t i = 0; i < 3; ++i) {
      text +=
          fmt::format(",{},{},{}", of_joint(s.hcp_angle, i), of_joint(s.gdp_angle, i), of_joint(s.torque, i));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const SegmentSnapshot& segment = of_segment(s, i);
      text += fmt::format(",{},{},{}", segment.contact ? 1 : 0, segment.depth, segment.force);
    }
    text += "\n";
  }
  return text;
}

std::string fig8_json(const std::vector<Fig8Situation>& situations) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["experiment"] = "s1-fig8";
  json["paper"] = "S1 fig. 8";
  json["paper_values"] = "not printed";
  for (const Fig8Situation& situation : situations) {
    Json entry;
    entry["situation"] = std::string(1, situation.letter);
    entry["title"] = situation.title;
    entry["ball"] = {
        {"diameter_m", situation.ball_diameter},
        {"centre_m", {situation.ball_centre.x(), situation.ball_centre.y(), situation.ball_centre.z()}}};
    for (std::size_t i = 0; i < 3; ++i) {
      entry["joints"][kJointNames[i]] = {
          {"hcp_rad", of_joint(situation.held.hcp_angle, i)},
          {"gdp_rad", of_joint(situation.held.gdp_angle, i)},
          {"torque_nm", of_joint(situation.held.torque, i)},
          {"carries_torque_in_s1", carries_torque(situation, static_cast<int>(i))}};
      const SegmentSnapshot& segment = of_segment(situation.held, i);
      entry["segments"][kSegmentNames[i]] = {{"contact", segment.contact},
                                             {"in_contact_in_s1", situation.touching[i]},
                                             {"depth_m", segment.depth},
                                             {"force_n", segment.force}};
    }
    json["situations"].push_back(entry);
  }
  json["made"] = made_json(made_here());
  return json.dump(2) + "\n";
}

}  // namespace phalanx
