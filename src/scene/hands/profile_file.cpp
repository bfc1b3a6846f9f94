// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/profile_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/hand/anthropometry.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr NumberRange kAnyNumber = {};

/// Writes a range: "141.7 to 233 mm".
std::string in_words(const PlausibleRange& range, double unit, std::string_view unit_name) {
  return fmt::format("{:.4g} to {:.4g} {}", range.min / unit, range.max / unit, unit_name);
}

/// Checks a range with a tolerance: a size at the very end of the range must pass after fitting, too.
bool within(const PlausibleRange& range, double value) noexcept {
  constexpr double kRounding = 1e-9;
  return value >= range.min - kRounding && value <= range.max + kRounding;
}

double plausible_mm(TomlTable& table, std::string_view key, const PlausibleRange& range) {
  const double value = table.number(key, kAnyNumber) * kMm;
  if (!within(range, value)) {
    table.fail(key,
               fmt::format("is implausible for an adult: the published mean +- {:g} SD is {} ({}); measure "
                           "again, in millimetres",
                           kPlausibleDeviations, in_words(range, kMm, "mm"), range.source));
  }
  return value;
}

Handedness read_handedness(TomlTable& table) {
  const std::string word = table.text("handedness");
  if (word != "right" && word != "left")
    table.fail("handedness", "must be \"right\" or \"left\": which hand wears the device");
  return word == "right" ? Handedness::kRight : Handedness::kLeft;
}

void read_segment(TomlTable table, Profile& profile, std::array<bool, kSegments - 1>& seen) {
  HandSize& size = profile.size;
  const std::string name = table.text("name");
  const auto segment = find_segment(name);
  if (!segment || *segment == kPalm) {
    std::vector<std::string_view> known;
    for (int s = 0; s < kSegments - 1; ++s) known.push_back(segment_name(s));
    table.fail("name", segment ? "the palm's size is hand_length_mm and hand_breadth_mm; state those"
                               : fmt::format("is no segment of a digit; the nearest one is \"{}\"",
                                             nearest_name(name, known)));
  }
  const auto s = static_cast<std::size_t>(*segment);
  if (seen[s]) table.fail("name", "is stated twice; keep one");
  seen[s] = true;
  if (table.has("length_mm"))
    size.segment[s].length = plausible_mm(table, "length_mm", plausible_segment_length(*segment));
  // Whether a breadth is plausible depends on the base hand's: fit_profile() checks it.
  if (table.has("breadth_mm")) {
    size.segment[s].breadth = table.number("breadth_mm", {.min = 0.0, .max = 200.0, .min_open = true}) * kMm;
    profile.breadth_stated_at[s] = table.place() + ".breadth_mm";
  }
  if (!size.segment[s].length && !size.segment[s].breadth)
    table.fail("name", "states neither length_mm nor breadth_mm; add one, or remove the line");
  table.finish();
}

void read_ranges(TomlTable table, Profile& profile) {
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::string_view key = joint_name(joint);
    if (!table.has(key)) continue;
    const auto [min_deg, max_deg] = table.pair(key, kAnyNumber);
    const PlausibleRange possible = plausible_angle(joint);
    if (!(min_deg < max_deg)) {
      table.fail(
          key,
          "is an empty range; write [least, largest] in degrees. For a joint that does not move, write a "
          "range of one degree");
    }
    if (!within(possible, min_deg * kDeg) || !within(possible, max_deg * kDeg)) {
      table.fail(key,
                 fmt::format("is anatomically impossible: this joint may move from {} ({}); check the sign "
                             "(flexion and spreading are positive) and the unit",
                             in_words(possible, kDeg, "deg"), possible.source));
    }
    profile.range[static_cast<std::size_t>(joint)] = {min_deg * kDeg, max_deg * kDeg};
  }
  table.finish();
}

/// Checks sizes that follow from the stated ones, and breadths, which are compared with the base hand's.
void check_fit(const Profile& profile, const HandParameters& base, const HandFit& fit) {
  std::string stated_at;
  const auto fail = [&](std::string_view what, double value, double unit, std::string_view unit_name,
                        const PlausibleRange& range) {
    const std::string& place = stated_at.empty() ? profile.origin : stated_at;
    throw SceneError(
        fmt::format("{}: {} is {:.4g} {}, which is implausible: {} ({}); correct the sizes that the "
                    "profile states",
                    place, what, value / unit, unit_name, in_words(range, unit, unit_name), range.source));
  };
  for (int s = 0; s < kSegments - 1; ++s) {
    const SegmentFit& own = fit.segment[static_cast<std::size_t>(s)];
    stated_at.clear();
    const double length = own.length * segment_length(base, s);
    if (const auto range = plausible_segment_length(s); !within(range, length))
      fail(fmt::format("the length of {}", segment_name(s)), length, kMm, "mm", range);
    PlausibleRange breadth = plausible_breadth_ratio();
    breadth.min *= segment_breadth(base, s);
    breadth.max *= segment_breadth(base, s);
    stated_at = profile.breadth_stated_at[static_cast<std::size_t>(s)];
    if (const double value = own.breadth_middle * segment_breadth(base, s); !within(breadth, value))
      fail(fmt::format("the breadth of {}", segment_name(s)), value, kMm, "mm", breadth);
  }
  stated_at.clear();
  if (const auto range = plausible_palm_ratio(); !within(range, fit.palm_length))
    fail("the palm's length relative to the base hand's", fit.palm_length, 1.0, "", range);
  const double length = hand_length(fitted_parameters(base, fit));
  if (const auto range = plausible_hand_length(); !within(range, length))
    fail("the hand's length", length, kMm, "mm", range);
  if (const auto range = plausible_hand_breadth(); !within(range, fit.palm_breadth * hand_breadth(base)))
    fail("the hand's breadth", fit.palm_breadth * hand_breadth(base), kMm, "mm", range);
}

}  // namespace

Profile parse_profile(const std::string& text, const std::string& origin,
                      const std::filesystem::path& folder) {
  const toml::table root = parse_toml(text, origin);
  TomlTable table(root, origin, "");
  Profile profile;
  profile.origin = origin;
  profile.folder = folder;
  profile.name = table.text("name");
  if (table.has("hand")) profile.hand = table.text("hand");
  profile.handedness = read_handedness(table);
  if (table.has("hand_length_mm"))
    profile.size.hand_length = plausible_mm(table, "hand_length_mm", plausible_hand_length());
  if (table.has("hand_breadth_mm"))
    profile.size.hand_breadth = plausible_mm(table, "hand_breadth_mm", plausible_hand_breadth());
  if (table.has("segments")) {
    std::array<bool, kSegments - 1> seen{};
    for (TomlTable& segment : table.tables("segments", -1)) read_segment(segment, profile, seen);
  }
  if (table.has("range_of_motion")) read_ranges(table.table("range_of_motion"), profile);
  table.finish();
  return profile;
}

Profile load_profile(const std::string& name_or_path, const std::filesystem::path& base) {
  const auto file = find_data_file("profile", name_or_path, "assets/profiles", ".toml", base);
  return parse_profile(read_text_file(file.string(), "profile"), file.string(), file.parent_path());
}

FittedHand fit_profile(const Profile& profile, const HandParameters& base) {
  FittedHand hand;
  try {
    hand.fit = fit_hand(base, profile.size);
    check_fit(profile, base, hand.fit);
    hand.parameters = fitted_parameters(base, hand.fit);
  } catch (const SceneError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}: {}", profile.origin, error.what()));
  }
  hand.parameters.name = profile.name;
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (!profile.range[j]) continue;
    const auto [least, largest] = *profile.range[j];
    hand.parameters.min_angle[j] = least;
    hand.parameters.max_angle[j] = largest;
    hand.parameters.open_angle[j] = std::clamp(hand.parameters.open_angle[j], least, largest);
    if (auto& closed = hand.parameters.closed_angle[j]) closed = std::clamp(*closed, least, largest);
  }
  return hand;
}

}  // namespace phalanx
