// SPDX-License-Identifier: Apache-2.0
// A scene as a file states it, checked, in SI units: which hand, which objects, which forces, which motion.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/contact/contact_parameters.h"
#include "phalanx/core/math.h"
#include "phalanx/device/motion.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/hand/joints.h"
#include "phalanx/scene/scene_error.h"

namespace phalanx {

/// One object of a scene. Which sizes count depends on its kind (docs/scenes.md); a scene that states another
/// is refused.
struct ObjectDescription {
  std::string kind = "teapot";  ///< sphere box cylinder torus mug teapot file, or an object of mesh/objects.h
  std::filesystem::path
      file;  ///< file: the mesh; a scene file's relative path is resolved against the scene's folder
  double size =
      0.1;  ///< teapot: from handle to spout; file: largest extent, 0 keeps the file's numbers as metres [m]
  double unit = 1.0;            ///< file with size 0: metres per unit of its numbers
  int decimate_to = 0;          ///< file: about how many triangles it is simplified to; 0: keeps its own
  double diameter = 0.06;       ///< whatever is round, over all [m]
  double length = 0.1;          ///< along the axis; key: along x [m]
  double breadth = 0.025;       ///< key [m]
  double thickness = 0.0022;    ///< key [m]
  double bump = 0.004;          ///< therapy_ball [m]
  double head_diameter = 0.0;   ///< peg; 0: none [m]
  double lid_diameter = 0.07;   ///< jar [m]
  double ring_diameter = 0.08;  ///< torus: of the tube's centre line [m]
  double tube_diameter = 0.02;  ///< torus [m]
  Vec3 extent = Vec3::Constant(0.05);  ///< box, putty_bar: full edge lengths [m]
  int triangles = 1000;                ///< about how many the program's own objects get
  Pose pose;                           ///< X_WO
};

/// Where the hand's meshes come from.
enum class HandMeshSource {
  kFile,      ///< the hand file's; capsules if it names none
  kCapsules,  ///< capsules whatever the hand file names
};

struct HandDescription {
  std::string file = "adult";  ///< a hand file's name in assets/hands, or a path
  Handedness handedness = Handedness::kRight;
  std::string profile;  ///< if not empty: a profile's name in assets/profiles, or a path; then it says file
                        ///< and handedness, and what they say here does not count
  HandMeshSource mesh_source = HandMeshSource::kFile;
  int triangles = 2250;             ///< capsules: about how many over all segments (S2: 2,248)
  std::string triangles_stated_at;  ///< where a scene states them, "FILE:LINE: KEY = VALUE"; empty: nowhere
  Pose pose;                        ///< X_WH
};

struct MotionDescription {
  ScriptedMotion script;
  std::filesystem::path file;  ///< if not empty: play this CSV instead of the script
  std::string
      mapping;  ///< mapping file's name in assets/mappings, or a path; empty: columns are joint names in rad
  std::optional<int> trial;  ///< which trial of a file whose time runs backwards, counted from 1
  double lead_in_s = 0.0;    ///< from the open hand to the file's first sample, put before the file [s] >= 0
};

/// A value that a scene lays over a key of another file.
struct OverlaidValue {
  std::string path;   ///< the file's key: "motors.index_pip.friction_n"
  std::string value;  ///< as it would stand in a file
  std::string place;  ///< where the scene states it: "grasp.toml:12", or the override
};

/// A file that a scene names, with what the scene says otherwise.
struct FileWithOverlay {
  std::string file;  ///< a name in the assets' folder, or a path
  std::vector<OverlaidValue> overlay;
  std::string stated_at;  ///< where the scene names the file, "FILE:LINE: KEY = VALUE"; empty: nowhere
};

struct SceneDescription {
  std::string name;
  std::string description;  ///< one line
  double rate_hz = 200.0;   ///< [Hz], 1 .. 4000
  double seconds = 0.0;     ///< length of a simulation [s]; 0: the motion's
  std::uint64_t seed = 1;
  bool mirror = false;  ///< the world is mirrored in x = 0; hand.handedness is already the mirrored one
  HandDescription hand;
  std::vector<ObjectDescription> objects;
  ContactParameters contact;
  ForceLawParameters force;
  SmoothingParameters smoothing;
  StabiliserParameters stabiliser;
  OscillationParameters oscillation;
  LimitParameters limits;  ///< a limit turned "off" has its flag cleared; joint_speed "off" is infinite
  MotionDescription motion;
  /// load_device(): phalanx/scene/device_file.h
  FileWithOverlay device = {.file = "beihang", .overlay = {}, .stated_at = {}};
  /// load_patient(): phalanx/scene/patient_file.h
  FileWithOverlay patient = {.file = "adult", .overlay = {}, .stated_at = {}};
};

/// `key=value` as on the command line, in order: `rate_hz`, `force.law`, `objects.0.size_mm`; an index one
/// past the end appends. The value is read as TOML if it parses as TOML, else as a string. Relative paths in
/// it are relative to the working directory.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene: `scene` is a name in scenes/, or a path (contains `/` or ends with .toml). Overrides are
/// applied to the file's tree before it is checked, by the same code. Every number is finite and in the range
/// of its row in scene_keys().
/// @throws SceneError naming file:line (or the override), key, value and remedy; an unknown key is answered
/// with the nearest known one. Set-up only.
[[nodiscard]] SceneDescription load_scene(const std::string& scene, const Overrides& overrides = {});

/// The same from text; `origin` names it in messages, relative files resolve against `folder`. For fuzzing
/// and uploads.
[[nodiscard]] SceneDescription parse_scene(const std::string& text, const std::string& origin,
                                           const std::filesystem::path& folder,
                                           const Overrides& overrides = {});

/// Everything that load_scene() would refuse about a scene, a sentence each, as far as one problem does not
/// hide the next; empty: it would refuse nothing. Set-up only.
[[nodiscard]] std::vector<std::string> problems_of_scene(const std::string& scene);

/// "side_n=3" -> {"side_n", "3"}. @throws SceneError if there is no `=` or nothing before it.
[[nodiscard]] std::pair<std::string, std::string> parse_override(const std::string& key_and_value);

struct SceneInfo {
  std::string name;
  std::string description;  ///< the scene's own line; if it cannot be read, what is wrong with it
  bool readable = true;
  bool touches = true;  ///< its motion is not one in free air: the simulated patient can press
};

/// The scenes in scenes/, by name. @throws SceneError if the folder is not found.
[[nodiscard]] std::vector<SceneInfo> list_scenes();

}  // namespace phalanx
