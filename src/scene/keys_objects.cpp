// SPDX-License-Identifier: Apache-2.0
// Keys of one element of objects[].
#include <array>

#include "phalanx/mesh/length_units.h"
#include "scene/key_builders.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

}  // namespace

void add_object_keys(std::vector<KeySpec>& keys) {
  constexpr NumberRange kSize = above(0, 2000);
  keys.push_back(choice("objects[].kind",
                        {"teapot", "sphere", "box", "cylinder", "torus", "mug", "bottle", "key", "pen", "cup",
                         "therapy_ball", "putty_bar", "peg", "jar", "tap_handle", "file"},
                        "\"teapot\"", "the shape", [](T t, V v) { t.object.kind = v.text; }));
  keys.push_back(
      for_kinds("file", word(KeyType::kFile, "objects[].file", "", "a mesh file: .obj .3ds .stl .ply .glb",
                             [](T t, V v) { t.object.file = v.text; })));
  keys.push_back(for_kinds(
      "teapot file",
      number("objects[].size_mm", "mm", between(0, 2000), "100",
             "teapot: from handle to spout; file: its largest extent, 0 keeps its numbers as metres",
             [](T t, V v) { t.object.size = v.number * kMm; })));
  keys.push_back(
      for_kinds("file", choice("objects[].unit", {"m", "mm", "cm", "in"}, "\"m\"",
                               "what the file's numbers are; counts with size_mm = 0", [](T t, V v) {
                                 t.object.unit = kLengthUnits[static_cast<std::size_t>(v.integer)].metres;
                               })));
  keys.push_back(
      for_kinds("file", integer("objects[].decimate_to", between(0, 10000000), "0",
                                "simplified to about this many triangles; 0 keeps the file's own",
                                [](T t, V v) { t.object.decimate_to = static_cast<int>(v.integer); })));
  keys.push_back(for_kinds(
      "sphere cylinder mug bottle cup pen therapy_ball peg jar tap_handle",
      number("objects[].diameter_mm", "mm", kSize, "60", "outer diameter",
             [](T t, V v) { t.object.diameter = v.number * kMm; }),
      {{"bottle", "65"}, {"cup", "75"}, {"pen", "10"}, {"therapy_ball", "70"}, {"peg", "9"}, {"jar", "80"}}));
  keys.push_back(
      for_kinds("cylinder mug bottle key cup pen peg jar tap_handle",
                number("objects[].length_mm", "mm", kSize, "100", "along the axis (z); key: along x",
                       [](T t, V v) { t.object.length = v.number * kMm; }),
                {{"bottle", "205"},
                 {"key", "57"},
                 {"cup", "90"},
                 {"pen", "140"},
                 {"peg", "32"},
                 {"jar", "110"},
                 {"tap_handle", "50"}}));
  keys.push_back(for_kinds("key", number("objects[].breadth_mm", "mm", kSize, "25", "of the bow, along y",
                                         [](T t, V v) { t.object.breadth = v.number * kMm; })));
  keys.push_back(for_kinds("key", number("objects[].thickness_mm", "mm", kSize, "2.2", "along z",
                                         [](T t, V v) { t.object.thickness = v.number * kMm; })));
  keys.push_back(
      for_kinds("therapy_ball", number("objects[].bump_mm", "mm", between(0, 300), "4",
                                       "height of the bumps, below the outer diameter; 0: a smooth ball",
                                       [](T t, V v) { t.object.bump = v.number * kMm; })));
  keys.push_back(for_kinds("peg", number("objects[].head_diameter_mm", "mm", between(0, 2000), "0",
                                         "of the grip at its upper end; 0: a plain dowel",
                                         [](T t, V v) { t.object.head_diameter = v.number * kMm; })));
  keys.push_back(for_kinds("jar", number("objects[].lid_diameter_mm", "mm", kSize, "70", "of the lid",
                                         [](T t, V v) { t.object.lid_diameter = v.number * kMm; })));
  keys.push_back(for_kinds(
      "torus", number("objects[].ring_diameter_mm", "mm", kSize, "80", "of the tube's centre line, around z",
                      [](T t, V v) { t.object.ring_diameter = v.number * kMm; })));
  keys.push_back(for_kinds(
      "torus", number("objects[].tube_diameter_mm", "mm", kSize, "20", "of the tube; below the ring's",
                      [](T t, V v) { t.object.tube_diameter = v.number * kMm; })));
  keys.push_back(
      for_kinds("box putty_bar",
                vector("objects[].extent_mm", "mm", kSize, "[50, 50, 50]", "full edge lengths along x, y, z",
                       [](T t, V v) { t.object.extent = v.vector * kMm; }),
                {{"putty_bar", "[100, 35, 30]"}}));
  keys.push_back(
      for_kinds("teapot sphere box cylinder torus mug bottle key pen cup therapy_ball putty_bar peg jar "
                "tap_handle",
                integer("objects[].triangles", between(8, 2000000), "1000", "about how many triangles it has",
                        [](T t, V v) { t.object.triangles = static_cast<int>(v.integer); })));
  keys.push_back(vector("objects[].position_mm", "mm", between(-10000, 10000), "[0, 0, 0]",
                        "the object's centre in the world",
                        [](T t, V v) { t.object.pose.p = v.vector * kMm; }));
  keys.push_back(vector("objects[].rotation_deg", "deg", between(-360, 360), "[0, 0, 0]",
                        "roll, pitch, yaw as for the hand",
                        [](T t, V v) { t.object.pose.R = rotation_of(v.vector); }));
}
}  // namespace phalanx
