// SPDX-License-Identifier: Apache-2.0
// The hand that a scene names: its parameters, its handedness, and its meshes from files.
#pragma once

#include <optional>

#include "phalanx/hand/hand_meshes.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/hand_skin.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

class ImportCache;

/// Parameters of a hand without its meshes, as a motion needs them.
struct HandNumbers {
  HandParameters parameters;                   ///< as a right hand
  Handedness handedness = Handedness::kRight;  ///< which hand it is
};

/// A hand with its meshes.
struct LoadedHand {
  HandParameters parameters;                   ///< as a right hand
  Handedness handedness = Handedness::kRight;  ///< which hand it is
  HandMeshes meshes;                           ///< of that hand, left or right
  std::optional<HandSkin> skin;  ///< of that hand, with bind poses; none: not read, or none named
};

/// Loads the parameters of the scene's hand, from its hand file or its profile. It opens no mesh.
/// @throws SceneError as read_hand_file(), load_profile() and fit_profile(). Set-up only.
[[nodiscard]] HandNumbers load_hand_numbers(const HandDescription& hand);

/// Parts that load_hand() reads besides the collision meshes.
enum class HandDetail {
  kCollision,  ///< none
  kDrawn,      ///< those of a picture: the skin, or the display meshes of a hand without one
  kDisplay,    ///< the display meshes
  kAll,        ///< the display meshes and the skin
};

/// Loads the scene's hand, fitted if it names a profile. If its hand file names no meshes, or the scene states
/// `hand.meshes = "capsules"`, both sets are capsules of about `hand.triangles` triangles. Display meshes that
/// the hand file does not name are the collision meshes.
/// @throws SceneError as load_hand_numbers() and load_hand_skin(), or if `hand.triangles` is stated for a hand
/// whose meshes are files. For a mesh file, the message names the file, its value and the remedy. It refuses a
/// missing or unreadable file, and a collision mesh that is not closed or winds inwards. It refuses a vertex
/// more than 300 mm from the segment's joint. A largest extent below 3 mm is refused too, since the unit is
/// then wrong. Set-up only: one forked reader for each mesh that is not in the cache.
/// @param imports  cache of imported meshes; null: none
[[nodiscard]] LoadedHand load_hand(const HandDescription& hand, HandDetail detail = HandDetail::kDisplay,
                                   ImportCache* imports = nullptr);

/// @throws SceneError as load_hand_numbers(), or naming the skin file, the element, its value and the remedy.
/// It refuses a missing file, one larger than 16 MB, broken JSON, and a missing or malformed entry. It
/// refuses an unknown segment, an index without a vertex, and weights that are not above 0 or whose sum is
/// not 1 to 0.001. It also refuses a vertex more than 300 mm from the wrist's centre. Set-up only.
[[nodiscard]] std::optional<HandSkin> load_hand_skin(const HandDescription& hand);

}  // namespace phalanx
