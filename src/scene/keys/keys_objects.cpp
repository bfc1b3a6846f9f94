// SPDX-License-Identifier: Apache-2.0
// Keys of one element of objects[]. object_kinds.cpp states which kinds of object have them.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "phalanx/force/parameter_ranges.h"
#include "phalanx/mesh/length_units.h"
#include "scene/keys/key_rows.h"
#include "scene/object_kinds.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

}  // namespace

void add_object_keys(std::vector<SceneKey>& keys) {
  const KeyRows other_object(keys, ChangeKind::kOtherObject);
  constexpr NumberRange kSize = above(0, 2000);
  other_object.choice("objects[].kind", object_kind_names(), "teapot", "the shape",
                      [](T t, V v) { t.object.kind = v.text; });
  other_object.word(KeyType::kFile, "objects[].file", std::nullopt, "a mesh file: .obj .3ds .stl .ply .glb",
                    [](T t, V v) { t.object.file = v.text; });
  other_object.number("objects[].size_mm", "mm", between(0, 2000), 100,
                      "teapot: from handle to spout; file: its largest extent, 0: its numbers are in `unit`",
                      [](T t, V v) { t.object.size = v.number * kMm; });
  other_object.choice("objects[].unit", {"m", "mm", "cm", "in"}, "m",
                      "unit of the file's numbers; has an effect with size_mm = 0 only", [](T t, V v) {
                        t.object.unit = kLengthUnits[static_cast<std::size_t>(v.integer)].metres;
                      });
  other_object.integer("objects[].decimate_to", between(0, 10000000), 0,
                       "approximate number of triangles after simplification; 0: none",
                       [](T t, V v) { t.object.decimate_to = static_cast<int>(v.integer); });
  other_object.number("objects[].diameter_mm", "mm", kSize, 60, "outer diameter",
                      [](T t, V v) { t.object.diameter = v.number * kMm; });
  other_object.number("objects[].length_mm", "mm", kSize, 100, "along the axis (z); key: along x",
                      [](T t, V v) { t.object.length = v.number * kMm; });
  other_object.number("objects[].breadth_mm", "mm", kSize, 25, "of the bow, along y",
                      [](T t, V v) { t.object.breadth = v.number * kMm; });
  other_object.number("objects[].thickness_mm", "mm", kSize, 2.2, "along z",
                      [](T t, V v) { t.object.thickness = v.number * kMm; });
  other_object.number("objects[].bump_mm", "mm", between(0, 300), 4,
                      "height of the bumps, below the outer diameter; 0: a smooth ball",
                      [](T t, V v) { t.object.bump = v.number * kMm; });
  other_object.number("objects[].head_diameter_mm", "mm", between(0, 2000), 0,
                      "of the grip at its upper end; 0: a plain dowel",
                      [](T t, V v) { t.object.head_diameter = v.number * kMm; });
  other_object.number("objects[].lid_diameter_mm", "mm", kSize, 70, "of the lid",
                      [](T t, V v) { t.object.lid_diameter = v.number * kMm; });
  other_object.number("objects[].ring_diameter_mm", "mm", kSize, 80, "of the tube's centre line, around z",
                      [](T t, V v) { t.object.ring_diameter = v.number * kMm; });
  other_object.number(
      "objects[].tube_diameter_mm", "mm", {.min = 0, .max = 2000, .min_open = true, .max_open = true}, 20,
      "of the tube; below the ring's", [](T t, V v) { t.object.tube_diameter = v.number * kMm; });
  other_object.vector("objects[].extent_mm", "mm", kSize, 50, "full edge lengths along x, y, z",
                      [](T t, V v) { t.object.extent = v.vector * kMm; });
  other_object.integer("objects[].triangles", between(8, 2000000), 1000, "approximate number of triangles",
                       [](T t, V v) { t.object.triangles = static_cast<int>(v.integer); });
  other_object.number("objects[].friction", "", ranges::kFriction, std::nullopt,
                      "sliding: Coulomb friction coefficient of this object; not stated: contact.friction",
                      [](T t, V v) { t.object.friction = v.number; });
  other_object.vector("objects[].position_mm", "mm", between(-10000, 10000), 0,
                      "the object's centre in the world", [](T t, V v) { t.object.pose.p = v.vector * kMm; });
  other_object.vector("objects[].rotation_deg", "deg", between(-360, 360), 0,
                      "roll, pitch, yaw as for the hand",
                      [](T t, V v) { t.object.pose.R = rotation_of(v.vector); });

  for (const ObjectKind& kind : object_kinds()) {
    for (const KeyOfKind& own : kind.keys) {
      const auto key = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& known) {
        return known.path == fmt::format("objects[].{}", own.name);
      });
      if (key == keys.end())
        throw std::logic_error(
            fmt::format("the kind {} names objects[].{}, which is no key", kind.name, own.name));
      key->kinds.push_back({kind.name, own.default_value});
    }
  }
}
}  // namespace phalanx
