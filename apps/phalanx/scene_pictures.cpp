// SPDX-License-Identifier: Apache-2.0
#include "scene_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "commands.h"
#include "option_text.h"
#include "phalanx/figures/contact_sheet.h"
#include "phalanx/figures/picture_moment.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/simulation/simulate.h"
#include "picture_file.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Content of one picture.
struct Sitting {
  std::string name;
  DrawnHand hand;
  TriangleMesh object;
  Snapshot snapshot;
  double largest_force = 0.0;  ///< largest force of a segment [N]
};

Sitting sit(const std::string& name, const std::string& profile) {
  Overrides overrides;
  if (!profile.empty()) overrides.emplace_back("hand.profile", option_as_toml("--profile", profile));
  const SceneDescription scene = load_scene(name, overrides);
  ResolvedScene resolved = resolve(scene, {.hand = HandDetail::kDrawn, .motion = true});
  const Motion motion = resolved.motion.value();
  DrawnHand hand = drawn_hand(resolved.hand);
  const auto model = std::make_unique<HapticModel>(build_model(std::move(resolved)));
  const std::uint64_t ticks = tick_count(simulation_seconds(scene, motion), scene.parameters.rate_hz);
  Sitting sitting{.name = scene.name,
                  .hand = std::move(hand),
                  .object = model->object.mesh(),
                  .snapshot = {},
                  .largest_force = 0.0};
  PictureMoment moment(ticks, DisplayedHand(*model, scene.parameters.contact.margin));
  simulate(*model, scene.parameters, motion, ticks,
           {.tick = [&](const Snapshot& snapshot) { moment.see(snapshot); }, .progress = {}});
  sitting.snapshot = moment.snapshot();
  for (const SegmentSnapshot& segment : sitting.snapshot.segment)
    sitting.largest_force = std::max(sitting.largest_force, segment.force);
  return sitting;
}

}  // namespace

int draw_scenes(const ScenePicturesOptions& options) {
  std::vector<std::string> names = options.scenes;
  if (names.empty())
    for (const SceneInfo& info : list_scenes())
      if (!info.name.starts_with("bench_")) names.push_back(info.name);
  std::vector<Sitting> sittings;
  double full_force = 0.0;
  for (const std::string& name : names) {
    sittings.push_back(sit(name, options.profile));
    full_force = std::max(full_force, sittings.back().largest_force);
  }
  prepare_output_folder(options.folder);
  ProgressBar bar("rendering", true);
  std::vector<SheetTile> tiles;
  for (const Sitting& sitting : sittings) {
    bar.show(tiles.size(), sittings.size());
    const PictureOptions picture{.width = options.width,
                                 .height = options.width * 3 / 4,
                                 .full_force = full_force,
                                 .force_scale = false};
    Image image = render_picture(sitting.hand, sitting.object, sitting.snapshot, picture);
    save_picture(image, options.folder / (sitting.name + ".png"));
    tiles.push_back({std::move(image), fmt::format("{}  {:.1f} N", sitting.name, sitting.largest_force)});
  }
  bar.show(tiles.size(), sittings.size());
  save_picture(contact_sheet(tiles, options.columns), options.folder / "scenes.png");
  fmt::print("wrote    {}/NAME.png of {} scenes, and all of them on {}/scenes.png\n", options.folder.string(),
             tiles.size(), options.folder.string());
  return kDone;
}

}  // namespace phalanx
