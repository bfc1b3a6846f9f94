// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/hand_file.h"

#include <fmt/format.h>

#include <cmath>

#include "phalanx/core/constants.h"
#include "phalanx/scene/data_paths.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

/// Far beyond any hand: a value outside has a wrong decimal point or unit.
constexpr NumberRange kPlaceMm = {.min = -300.0, .max = 300.0};
constexpr NumberRange kLengthMm = {.min = 0.0, .max = 200.0};
constexpr NumberRange kSizeMm = {.min = 0.0, .max = 200.0, .min_open = true};
constexpr NumberRange kAngleDeg = {.min = -180.0, .max = 180.0};
constexpr NumberRange kDirection = {.min = -1e3, .max = 1e3};
/// An angle that follows from a joint's is at most as large.
constexpr NumberRange kRatio = {.min = -1.0, .max = 1.0};

/// Checks that the element has the name that its place implies: a file with two swapped lines is refused.
void require_name(TomlTable& table, std::string_view expected) {
  if (table.text("name") != expected) {
    table.fail("name", fmt::format("the entry at this place must be \"{}\"; put the entries in that order",
                                   expected));
  }
}

void read_joint(TomlTable table, int joint, HandParameters& hand) {
  require_name(table, joint_name(joint));
  const auto j = static_cast<std::size_t>(joint);
  DhRow& row = hand.digits[j / kJointsPerDigit].dh[j % kJointsPerDigit];
  row.a = table.number("a_mm", kLengthMm) * kMm;
  row.alpha = table.number("alpha_deg", kAngleDeg) * kDeg;
  row.d = table.number("d_mm", kPlaceMm) * kMm;
  row.theta = table.number("theta_deg", kAngleDeg) * kDeg;
  const double min_deg = table.number("min_deg", kAngleDeg);
  const double max_deg = table.number("max_deg", {.min = min_deg, .max = 180.0, .min_open = true});
  const double open_deg = table.number("open_deg", {.min = min_deg, .max = max_deg});
  hand.min_angle[j] = min_deg * kDeg;
  hand.max_angle[j] = max_deg * kDeg;
  hand.open_angle[j] = open_deg * kDeg;
  if (table.has("closed_deg"))
    hand.closed_angle[j] = table.number("closed_deg", {.min = min_deg, .max = max_deg}) * kDeg;
  table.finish();
}

void read_segment(TomlTable table, int segment, HandParameters& hand) {
  require_name(table, segment_name(segment));
  SegmentShape& shape = hand.segments[static_cast<std::size_t>(segment)];
  shape.radius_base = table.number("radius_base_mm", kSizeMm) * kMm;
  shape.radius_tip = table.number("radius_tip_mm", kSizeMm) * kMm;
  shape.length = table.number("length_mm", kSizeMm) * kMm;
  if (shape.length <= std::abs(shape.radius_base - shape.radius_tip)) {
    table.fail("length_mm",
               "one end's sphere contains the other's; the length must exceed the difference of the radii");
  }
  table.finish();
}

Vec3 unit_vector(TomlTable& table, std::string_view key) {
  const Vec3 v = table.vector(key, kDirection);
  if (v.norm() < 1e-6) table.fail(key, "has no direction; write a vector that is not zero");
  return v.normalized();
}

void read_coupling(TomlTable& table, DigitParameters& digit) {
  if (table.has("pronation")) {
    TomlTable pronation = table.table("pronation");
    digit.coupling.pronation_per_flexion = pronation.number("per_flexion", kRatio);
    digit.coupling.pronation_per_abduction = pronation.number_or("per_abduction", kRatio, 0.0);
    pronation.finish();
  }
  if (table.has("metacarpal")) {
    TomlTable metacarpal = table.table("metacarpal");
    digit.coupling.metacarpal_per_flexion = metacarpal.number("per_flexion", kRatio);
    digit.metacarpal_base = metacarpal.vector("base_mm", kPlaceMm) * kMm;
    digit.metacarpal_axis = unit_vector(metacarpal, "axis");
    metacarpal.finish();
  }
}

void read_digit(TomlTable table, int digit, HandParameters& hand) {
  DigitParameters& parameters = hand.digits[static_cast<std::size_t>(digit)];
  parameters.base = table.vector("base_mm", kPlaceMm) * kMm;
  parameters.distal = unit_vector(table, "distal");
  const Vec3 dorsal = unit_vector(table, "dorsal");
  const Vec3 across = dorsal - dorsal.dot(parameters.distal) * parameters.distal;
  if (across.norm() < 0.1)
    table.fail("dorsal", "is parallel to `distal`; it must point out of the digit's back");
  parameters.dorsal = across.normalized();
  auto joints = table.tables("joints", kJointsPerDigit);
  for (int i = 0; i < kJointsPerDigit; ++i)
    read_joint(joints[static_cast<std::size_t>(i)], joint_index(digit, i), hand);
  auto segments = table.tables("segments", kSegmentsPerDigit);
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    read_segment(segments[static_cast<std::size_t>(k)], segment_index(digit, k), hand);
  }
  read_coupling(table, parameters);
  table.finish();
}

PalmShape read_palm(TomlTable table) {
  PalmShape palm;
  palm.length = table.number("length_mm", kSizeMm) * kMm;
  palm.wrist_breadth = table.number("wrist_breadth_mm", kSizeMm) * kMm;
  palm.wrist_thickness = table.number("wrist_thickness_mm", kSizeMm) * kMm;
  palm.knuckle_breadth = table.number("knuckle_breadth_mm", kSizeMm) * kMm;
  palm.knuckle_thickness = table.number("knuckle_thickness_mm", kSizeMm) * kMm;
  palm.offset = table.vector("offset_mm", kPlaceMm) * kMm;
  table.finish();
  return palm;
}

constexpr std::string_view kSegmentWord = "{segment}";
/// From a hundredth of a millimetre to a kilometre: no program exports in another unit.
constexpr NumberRange kUnitMm = {.min = 1e-2, .max = 1e6};

/// Reads a path, relative to `folder`.
std::filesystem::path read_path(TomlTable& table, std::string_view key, const std::filesystem::path& folder) {
  const std::string text = table.text(key);
  if (text.empty()) table.fail(key, "names no file; name one, or remove the key");
  if (text.find('\0') != std::string::npos) table.fail(key, "holds a zero byte; remove it");
  return folder / text;
}

/// Reads a path with one `{segment}`, relative to `folder`.
std::filesystem::path read_pattern(TomlTable& table, std::string_view key,
                                   const std::filesystem::path& folder) {
  const std::string text = table.text(key);
  const std::size_t first = text.find(kSegmentWord);
  if (first == std::string::npos || text.find(kSegmentWord, first + 1) != std::string::npos) {
    table.fail(key,
               "must hold {segment} once, where the segment's name stands in the files' names: "
               "\"meshes/{segment}.obj\"");
  }
  return read_path(table, key, folder);
}

HandMeshFiles read_meshes(TomlTable table, const std::filesystem::path& folder) {
  HandMeshFiles meshes;
  meshes.place = table.place();
  meshes.collision = read_pattern(table, "collision", folder);
  if (table.has("display")) meshes.display = read_pattern(table, "display", folder);
  if (table.has("skin")) meshes.skin = read_path(table, "skin", folder);
  meshes.unit = table.number("unit_mm", kUnitMm) * kMm;
  if (table.has("handedness")) {
    const std::string word = table.text("handedness");
    if (word != "right" && word != "left")
      table.fail("handedness", "must be \"right\" or \"left\": which hand the mesh files show");
    if (word == "left") meshes.handedness = Handedness::kLeft;
  }
  table.finish();
  return meshes;
}

}  // namespace

std::filesystem::path HandMeshFiles::of_segment(const std::filesystem::path& pattern, int segment) {
  std::string text = pattern.string();
  text.replace(text.rfind(kSegmentWord), kSegmentWord.size(), segment_name(segment));
  return text;
}

HandFile parse_hand_file(const std::string& text, const std::string& origin,
                         const std::filesystem::path& folder) {
  const toml::table root = parse_toml(text, origin);
  TomlTable table(root, origin, "");
  HandFile file;
  HandParameters& hand = file.parameters;
  hand.name = table.text("name");
  for (int digit = 0; digit < kDigits; ++digit) read_digit(table.table(digit_name(digit)), digit, hand);
  hand.palm = read_palm(table.table("palm"));
  if (table.has("meshes")) file.meshes = read_meshes(table.table("meshes"), folder);
  table.finish();
  return file;
}

HandFile read_hand_file(const std::string& name_or_path, const std::filesystem::path& base) {
  const auto file = find_data_file("hand", name_or_path, "assets/hands", ".toml", base);
  return parse_hand_file(read_text_file(file.string(), "hand"), file.string(), file.parent_path());
}

HandParameters parse_hand(const std::string& text, const std::string& origin) {
  return parse_hand_file(text, origin).parameters;
}

HandParameters load_hand_file(const std::string& name_or_path, const std::filesystem::path& base) {
  return read_hand_file(name_or_path, base).parameters;
}

}  // namespace phalanx
