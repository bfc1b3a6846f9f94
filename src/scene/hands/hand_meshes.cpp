// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/hand_meshes.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "phalanx/mesh/import_cache.h"
#include "phalanx/scene/profile_file.h"
#include "scene/hands/skin_file.h"

namespace phalanx {
namespace {

/// Largest distance of a vertex from its segment's joint [m]: the longest hand is shorter.
constexpr double kFarthestOfSegment = 0.3;
/// Smallest plausible extent of a segment [m].
constexpr double kSmallest = 3e-3;

class MeshReader {
 public:
  MeshReader(const HandMeshFiles& files, ImportCache* imports) : files_(files), imports_(imports) {}

  /// Reads one mesh a segment, of a right hand.
  [[nodiscard]] SegmentMeshes read(const std::filesystem::path& pattern, bool collision) const {
    SegmentMeshes meshes;
    for (int segment = 0; segment < kSegments; ++segment) {
      meshes[static_cast<std::size_t>(segment)] =
          read_one(HandMeshFiles::of_segment(pattern, segment), collision);
    }
    if (files_.handedness == Handedness::kLeft) mirror(meshes);
    return meshes;
  }

 private:
  [[nodiscard]] TriangleMesh read_one(const std::filesystem::path& file, bool collision) const {
    TriangleMesh mesh;
    try {
      mesh = import_and_check(file, {.size = 0.0, .unit = files_.unit, .triangles = 0}, imports_).mesh;
    } catch (const std::invalid_argument& error) {
      throw SceneError(fmt::format("{}: {}", files_.place, error.what()));
    }
    check_place(mesh, file);
    if (collision) check_solid(mesh, file);
    return mesh;
  }

  void check_place(const TriangleMesh& mesh, const std::filesystem::path& file) const {
    const Bounds box = bounds(mesh);
    const double farthest = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
    const double extent = (box.max - box.min).maxCoeff();
    if (farthest > kFarthestOfSegment) {
      fail(file,
           fmt::format("reaches {:.4g} mm from the segment's joint, more than {:g} mm; put the joint at "
                       "the mesh's origin, or correct unit_mm = {:g}",
                       1e3 * farthest, 1e3 * kFarthestOfSegment, 1e3 * files_.unit));
    }
    if (extent < kSmallest) {
      fail(file,
           fmt::format(
               "is {:.4g} mm long, less than {:g} mm; correct unit_mm = {:g} (1000 for a file in metres)",
               1e3 * extent, 1e3 * kSmallest, 1e3 * files_.unit));
    }
  }

  void check_solid(const TriangleMesh& mesh, const std::filesystem::path& file) const {
    if (!is_closed(mesh)) {
      fail(file, fmt::format("is not closed, as a collision mesh must be; close it (`phalanx mesh check {}` "
                             "says where it is open)",
                             file.string()));
    }
    if (const double volume = signed_volume(mesh); !(volume > 0.0)) {
      fail(file, fmt::format("encloses {:.4g} mm^3: its triangles wind inwards; reverse them (`phalanx mesh "
                             "check {}`)",
                             1e9 * volume, file.string()));
    }
  }

  [[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) const {
    throw SceneError(fmt::format("{}: {} {}", files_.place, file.string(), problem));
  }

  const HandMeshFiles& files_;
  ImportCache* const imports_;
};

/// A described hand before its meshes are read.
struct Source {
  HandParameters base;         ///< from the hand file
  HandParameters parameters;   ///< fitted ones, or the base's
  std::optional<HandFit> fit;  ///< set if a profile is given
  Handedness handedness = Handedness::kRight;
  std::optional<HandMeshFiles> files;  ///< none: capsules
};

/// Reads the hand file of a scene, without its coupling if the scene wants none.
HandFile read_file(const HandDescription& hand, const std::string& name,
                   const std::filesystem::path& folder) {
  HandFile file = read_hand_file(name, folder);
  if (hand.coupling == HandCoupling::kNone)
    for (DigitParameters& digit : file.parameters.digits) digit.coupling = {};
  return file;
}

Source open(const HandDescription& hand) {
  Source source;
  HandFile file;
  if (hand.profile.empty()) {
    file = read_file(hand, hand.file, ".");
    source.handedness = hand.handedness;
    source.parameters = file.parameters;
  } else {
    const Profile profile = load_profile(hand.profile);
    file = read_file(hand, profile.hand, profile.folder);
    FittedHand fitted = fit_profile(profile, file.parameters);
    source.handedness = profile.handedness;
    source.parameters = std::move(fitted.parameters);
    source.fit = fitted.fit;
  }
  source.base = std::move(file.parameters);
  if (hand.mesh_source == HandMeshSource::kFile) source.files = std::move(file.meshes);
  if (source.files && !hand.triangles_stated_at.empty()) {
    throw SceneError(
        fmt::format("{}: has no effect on hand \"{}\", whose meshes are files; remove it, or state "
                    "hand.meshes = \"capsules\"",
                    hand.triangles_stated_at, source.base.name));
  }
  return source;
}

/// Converts the base hand's right-handed meshes to those of the described hand.
SegmentMeshes of_the_hand(const Source& source, SegmentMeshes meshes) {
  if (source.fit) meshes = fitted_meshes(source.base, *source.fit, std::move(meshes));
  if (source.handedness == Handedness::kLeft) mirror(meshes);
  return meshes;
}

SegmentMeshes collision_meshes(const Source& source, const HandDescription& hand, ImportCache* imports) {
  if (!source.files)
    return of_the_hand(source, make_capsule_meshes(source.base, Handedness::kRight, hand.triangles));
  return of_the_hand(source, MeshReader(*source.files, imports).read(source.files->collision, true));
}

bool has_own_display(const Source& source) { return source.files && !source.files->display.empty(); }

SegmentMeshes display_meshes(const Source& source, const SegmentMeshes& collision, ImportCache* imports) {
  if (!has_own_display(source)) return collision;
  return of_the_hand(source, MeshReader(*source.files, imports).read(source.files->display, false));
}

/// Reads the skin of a right hand; its bind poses are not known yet.
HandSkin read_skin(const HandMeshFiles& files) {
  HandSkin skin;
  try {
    skin = read_skin_file(files.skin);
  } catch (const SceneError& error) {
    throw SceneError(fmt::format("{}.skin: {}", files.place, error.what()));
  }
  if (files.handedness == Handedness::kLeft) mirror(skin.mesh);
  return skin;
}

std::optional<HandSkin> skin_of(const Source& source) {
  if (!source.files || source.files->skin.empty()) return std::nullopt;
  HandSkin skin = read_skin(*source.files);
  skin.X_BS = bind_poses(source.base, Handedness::kRight);
  if (source.fit) skin = fitted_skin(source.base, *source.fit, skin);
  if (source.handedness == Handedness::kLeft) mirror(skin);
  return skin;
}

}  // namespace

HandNumbers load_hand_numbers(const HandDescription& hand) {
  Source source = open(hand);
  return {std::move(source.parameters), source.handedness};
}

LoadedHand load_hand(const HandDescription& hand, HandDetail detail, ImportCache* imports) {
  Source source = open(hand);
  LoadedHand loaded;
  loaded.handedness = source.handedness;
  loaded.meshes.collision = collision_meshes(source, hand, imports);
  if (detail == HandDetail::kDrawn || detail == HandDetail::kAll) loaded.skin = skin_of(source);
  const bool display = detail == HandDetail::kDrawn ? !loaded.skin : detail != HandDetail::kCollision;
  if (display) loaded.meshes.display = display_meshes(source, loaded.meshes.collision, imports);
  loaded.parameters = std::move(source.parameters);
  return loaded;
}

std::optional<HandSkin> load_hand_skin(const HandDescription& hand) { return skin_of(open(hand)); }

}  // namespace phalanx
