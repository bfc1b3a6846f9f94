// SPDX-License-Identifier: Apache-2.0
#include "hand_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "commands.h"
#include "phalanx/core/constants.h"
#include "phalanx/figures/contact_sheet.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/posture_file.h"
#include "picture_file.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSheet = "postures";
constexpr double kMostPixels = 2e8;  ///< of all pictures together: they stay in memory for the sheet

/// Returns the pose of the hand in the world: the fingers point up, the palm to +y.
Pose upright() {
  Pose X_WH;
  X_WH.R = Vec3(1.0, -1.0, -1.0).asDiagonal();
  return X_WH;
}

/// Returns the direction of the camera: 20 deg from the palm's normal to the thumb's side, 25 deg down.
Vec3 palmar_radial_view(Handedness handedness) {
  const double thumb_side = handedness == Handedness::kRight ? -1.0 : 1.0;
  const double azimuth = 20.0 * kDeg, elevation = 25.0 * kDeg;
  return {-thumb_side * std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
          -std::sin(elevation)};
}

Snapshot posed(const HandModel& model, const JointArray& angle) {
  HandPoses poses;
  model.poses(angle, poses);
  Snapshot snapshot;
  for (int digit = 0; digit < kDigits; ++digit)
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      snapshot.gdp_pose[static_cast<std::size_t>(segment_index(digit, k))] =
          poses.digit[static_cast<std::size_t>(digit)].segment[static_cast<std::size_t>(k)];
  snapshot.gdp_pose[kPalm] = model.palm_pose();
  snapshot.hcp_pose = snapshot.gdp_pose;
  return snapshot;
}

std::string caption(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

int draw_postures(const HandDescription& description, const HandPicturesOptions& options) {
  const std::vector<Posture> postures = load_postures(options.postures);
  for (const Posture& posture : postures)
    if (posture.name == kSheet)
      throw std::invalid_argument(fmt::format("{}: posture \"{}\" has the name of the sheet; rename it",
                                              options.postures, posture.name));
  const double pixels = 1.25 * options.width * options.width * static_cast<double>(postures.size());
  if (pixels > kMostPixels)
    throw std::invalid_argument(fmt::format(
        "{}: {} postures at a width of {} are {:.0f} million pixels; at most {:.0f} million fit a "
        "sheet: draw fewer postures or smaller pictures",
        options.postures, postures.size(), options.width, 1e-6 * pixels, 1e-6 * kMostPixels));
  const fs::path sheet = options.folder / fmt::format("{}.png", kSheet);
  if (fs::is_directory(sheet))
    throw std::invalid_argument(
        fmt::format("{} is a folder; remove it, or choose another --out", sheet.string()));
  LoadedHand loaded = load_hand(description, HandDetail::kDrawn);
  const HandModel model(loaded.parameters, loaded.handedness, upright(), loaded.meshes.collision);
  const PictureOptions picture{.width = options.width,
                               .height = options.width * 5 / 4,
                               .force_scale = false,
                               .view = palmar_radial_view(loaded.handedness)};
  const DrawnHand drawn = drawn_hand(std::move(loaded));
  prepare_output_folder(options.folder);
  ProgressBar bar("rendering", true);
  std::vector<SheetTile> tiles;
  for (const Posture& posture : postures) {
    bar.show(tiles.size(), postures.size());
    Image image = render_picture(drawn, {}, posed(model, posture.angle), picture);
    save_picture(image, options.folder / (posture.name + ".png"));
    tiles.push_back({std::move(image), caption(posture.name)});
  }
  bar.show(tiles.size(), postures.size());
  save_picture(contact_sheet(tiles, options.columns), sheet);
  fmt::print("wrote    {}/NAME.png of {} postures, and all of them on {}/{}.png\n", options.folder.string(),
             tiles.size(), options.folder.string(), kSheet);
  return kDone;
}

}  // namespace phalanx
