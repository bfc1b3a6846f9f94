// SPDX-License-Identifier: Apache-2.0
// A scene as its file states it, checked and in SI units: hand, objects, forces, motion.
//
// A scene file is TOML. docs/scenes.md lists all its keys; every value is checked against that table.
// load_scene() reads a scene. build_model() turns it into the model of step(), and make_station_model() into
// that of a Station. The scene names further files: of the hand or a profile, of a motion and its mapping, of
// the simulated device and patient. All errors are SceneErrors that name the file and line, the value, and the
// remedy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/core/math.h"
#include "phalanx/device/motion.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/grasp/grasp_type.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Error of a scene, hand, mapping or motion file that cannot be used. what() names the file and line (or the
/// override), the key or column, the value and the remedy.
class SceneError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// One object of a scene. Its kind decides which sizes apply (docs/scenes.md); a scene that states another
/// size is refused.
struct ObjectDescription {
  std::string kind = "teapot";  ///< sphere box cylinder torus mug teapot file, or an object of mesh/objects.h
  std::filesystem::path
      file;  ///< kind file: the mesh; a relative path is resolved against the scene's folder
  double size =
      0.1;  ///< teapot: from handle to spout; file: largest extent, 0 reads the file's numbers as metres [m]
  double unit = 1.0;            ///< file with size 0: metres per unit of its numbers
  int decimate_to = 0;          ///< file: approximate number of triangles after simplification; 0: unchanged
  double diameter = 0.06;       ///< overall diameter of round kinds [m]
  double length = 0.1;          ///< along the axis; key: along x [m]
  double breadth = 0.025;       ///< key [m]
  double thickness = 0.0022;    ///< key [m]
  double bump = 0.004;          ///< therapy_ball [m]
  double head_diameter = 0.0;   ///< peg; 0: none [m]
  double lid_diameter = 0.07;   ///< jar [m]
  double ring_diameter = 0.08;  ///< torus: of the tube's centre line [m]
  double tube_diameter = 0.02;  ///< torus [m]
  Vec3 extent = Vec3::Constant(0.05);  ///< box, putty_bar: full edge lengths [m]
  std::optional<double> friction;      ///< Coulomb coefficient [-]; empty: contact.friction
  int triangles = 1000;                ///< approximate number for objects that the program makes
  Pose pose;                           ///< X_WO
};

/// Source of the hand's meshes.
enum class HandMeshSource {
  kFile,      ///< those of the hand file; capsules if it names none
  kCapsules,  ///< capsules in any case
};

/// Rotations of the hand that follow from the joints' angles.
enum class HandCoupling {
  kFile,  ///< those of the hand file
  kNone,  ///< none: the palm is rigid, and a digit turns about its four joints only, as in the papers
};

/// The hand of a scene.
struct HandDescription {
  std::string file = "adult";  ///< name of a hand file in assets/hands, or a path
  Handedness handedness = Handedness::kRight;
  std::string profile;  ///< name of a profile in assets/profiles, or a path; if not empty, it replaces `file`
                        ///< and `handedness`
  HandCoupling coupling = HandCoupling::kFile;
  HandMeshSource mesh_source = HandMeshSource::kFile;
  int triangles = 2250;             ///< capsules: approximate number over all segments (2,248 in S2,
                                    ///< docs/architecture.md)
  std::string triangles_stated_at;  ///< place in the scene, "FILE:LINE: KEY = VALUE"; empty: not stated
  Pose pose;                        ///< X_WH
};

/// The motion of a scene.
struct MotionDescription {
  ScriptedMotion script;
  std::filesystem::path file;  ///< if not empty: this CSV file replaces the script
  std::string
      mapping;  ///< mapping file's name in assets/mappings, or a path; empty: columns are joint names in rad
  std::optional<int> trial;  ///< number of the trial, from 1, in a file whose time runs backwards
  double lead_in_s = 0.0;    ///< lead-in from the open hand to the file's first sample [s] >= 0
};

/// The grasp of a scene.
struct GraspDescription {
  /// With a type, resolve() plans wrist and motion for the scene's hand and objects, unless they are those that the scene
  /// states them for. Empty: the scene states them.
  std::optional<GraspType> type;
  bool other_types = false;  ///< without a grasp of this type the others are tried, in the order of GraspType
  std::uint64_t seed = 1;    ///< of the search
  Vec3 forearm = Vec3::Zero();  ///< GraspOptions::forearm, of the scene before it is mirrored
  Vec3 palm = Vec3::Zero();     ///< GraspOptions::palm, likewise
  std::string planned_for;      ///< grasp_checksum() for which the scene states wrist and motion; empty: none
  std::string stated_at;        ///< place that states the type, "FILE:LINE: KEY = VALUE"; empty: none
};

/// A value with which a scene overrides a key of another file.
struct OverlaidValue {
  std::string path;   ///< key of that file: "motors.index_pip.friction_n"
  std::string value;  ///< as written in a file
  std::string place;  ///< place in the scene, "grasp.toml:12", or the override
};

/// A file that a scene names, with the scene's overrides of it.
struct FileWithOverlay {
  std::string file;  ///< a name in the assets' folder, or a path
  std::vector<OverlaidValue> overlay;
  std::string stated_at;  ///< place that names the file, "FILE:LINE: KEY = VALUE"; empty: none
};

/// Purpose of a scene: where it is offered.
enum class ScenePurpose {
  kExercise,   ///< for a hand: the cockpit shows it as a picture
  kStudy,      ///< for studies of stability
  kBenchmark,  ///< for measurements of speed
};

/// @returns the values of the key `purpose`, in the order of ScenePurpose.
[[nodiscard]] const std::vector<std::string>& scene_purpose_names();

/// Content of a scene file, with defaults for keys that it does not state.
struct SceneDescription {
  std::string name;
  std::string description;  ///< one line
  ScenePurpose purpose = ScenePurpose::kExercise;
  double seconds = 0.0;  ///< length of a simulation [s]; 0: the motion's
  std::uint64_t seed = 1;
  bool mirror = false;  ///< the world is mirrored in x = 0; hand.handedness is already the mirrored one
  HandDescription hand;
  std::vector<ObjectDescription> objects;
  HapticParameters parameters;  ///< "off" clears a limit's flag; for joint_speed it means infinity
  GraspDescription grasp;
  MotionDescription motion;
  /// The simulated device (docs/device-file.md)
  FileWithOverlay device = {.file = "beihang", .overlay = {}, .stated_at = {}};
  /// The simulated patient (docs/device-file.md)
  FileWithOverlay patient = {.file = "adult", .overlay = {}, .stated_at = {}};
};

/// Overrides as on the command line, `key=value`, in order: `rate_hz`, `force.law`, `objects.0.size_mm`. An
/// index one past the end appends an object. The value is read as TOML if it is TOML, else as a string.
/// Relative paths in it are relative to the working directory.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene. `scene` is a name in scenes/, or a path (contains `/` or ends with .toml). Overrides are
/// applied to the file's tree before it is checked, by the same code. Every number is finite and in the range
/// that `phalanx scene keys` prints. If the scene states anything about the device or the patient, its file is
/// opened for a check.
/// @throws SceneError naming file and line (or the override), key, value and remedy; for an unknown key also the
/// nearest known one. Set-up only.
[[nodiscard]] SceneDescription load_scene(const std::string& scene, const Overrides& overrides = {});

/// Reads a scene from text; `origin` names it in messages, and relative files are resolved against `folder`.
/// For fuzzing and uploads.
[[nodiscard]] SceneDescription parse_scene(const std::string& text, const std::string& origin,
                                           const std::filesystem::path& folder,
                                           const Overrides& overrides = {});

/// @returns everything that load_scene() would refuse about a scene, one sentence each, as far as one problem
/// does not hide the next; empty: nothing. Set-up only.
[[nodiscard]] std::vector<std::string> problems_of_scene(const std::string& scene);

/// Splits "side_n=3" into {"side_n", "3"}.
/// @throws SceneError if there is no `=` or nothing before it.
[[nodiscard]] std::pair<std::string, std::string> parse_override(const std::string& key_and_value);

/// Name and summary of a scene.
struct SceneInfo {
  std::string name;
  std::string description;  ///< the scene's own line; if it is not readable, the problem
  bool readable = true;
  bool touches = true;  ///< false: a motion in free air, in which the simulated patient cannot press
  ScenePurpose purpose = ScenePurpose::kExercise;
  std::string object_kind;         ///< of the first object; empty: none
  std::optional<GraspType> grasp;  ///< that the scene plans; empty: it states wrist and motion itself
};

/// @returns the scenes in scenes/, by name.
/// @throws SceneError if the folder is not found.
[[nodiscard]] std::vector<SceneInfo> list_scenes();

}  // namespace phalanx
