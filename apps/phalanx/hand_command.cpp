// SPDX-License-Identifier: Apache-2.0
// phalanx hand show|export: the hand of a hand file or of a patient's profile.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "hand_table.h"
#include "phalanx/mesh/import.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/hand_export.h"
#include "phalanx/scene/hand_meshes.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

struct HandOptions {
  std::string profile, file, side, meshes;
  std::string format, out;
};

/// Loads the hand. A path is relative to the working folder; a name is searched in assets/.
HandDescription described(const HandOptions& options) {
  if (!options.profile.empty() && !(options.file.empty() && options.side.empty())) {
    throw std::invalid_argument(fmt::format(
        "--profile {}: the profile says which hand; leave out --hand and --side", options.profile));
  }
  HandDescription hand;
  hand.profile = options.profile;
  if (!options.file.empty()) hand.file = options.file;
  if (options.side == "left") hand.handedness = Handedness::kLeft;
  if (options.meshes == "capsules") hand.mesh_source = HandMeshSource::kCapsules;
  return hand;
}

int show_hand(const HandOptions& options) {
  fmt::print("{}", hand_table(load_hand(described(options))));
  return kDone;
}

struct ExportPlan {
  fs::path file;    ///< of the URDF (Unified Robot Description Format) or MJCF (MuJoCo)
  fs::path folder;  ///< folder of the file and its meshes
};

ExportPlan plan_export(const HandOptions& options) {
  const bool urdf = options.format == "urdf";
  const fs::path out = options.out;
  const std::string extension = out.extension().string();
  ExportPlan plan;
  if (extension == ".urdf" || extension == ".xml") {
    if (urdf != (extension == ".urdf")) {
      throw std::invalid_argument(fmt::format("--out '{}': a {} file's name must end in {}", options.out,
                                              options.format, urdf ? ".urdf" : ".xml"));
    }
    plan.file = out;
    plan.folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  } else {
    plan.folder = out;
    plan.file = out / (urdf ? "hand.urdf" : "hand.xml");
  }
  if (fs::is_directory(plan.file))
    throw std::invalid_argument(fmt::format("'{}' is a folder; name a file in it", plan.file.string()));
  return plan;
}

void write_meshes(const SegmentMeshes& meshes, const fs::path& folder) {
  for (int segment = 0; segment < kSegments; ++segment) {
    const std::string name(segment_name(segment));
    write_then_rename(folder / (name + ".obj"), [&](const fs::path& file) {
      write_obj(meshes[static_cast<std::size_t>(segment)], file, name);
    });
  }
}

bool same(const SegmentMeshes& a, const SegmentMeshes& b) {
  for (std::size_t s = 0; s < kSegments; ++s)
    if (a[s].triangles != b[s].triangles || a[s].vertices != b[s].vertices) return false;
  return true;
}

int export_hand(const HandOptions& options) {
  const ExportPlan plan = plan_export(options);
  const LoadedHand hand = load_hand(described(options));
  ExportedMeshes folders;
  if (!same(hand.meshes.collision, hand.meshes.display))
    folders = {.collision = "meshes/collision", .display = "meshes/display"};
  const std::string text = options.format == "urdf" ? urdf_text(hand, folders) : mjcf_text(hand, folders);
  prepare_output_folder(plan.folder);
  prepare_output_folder(plan.folder / folders.collision);
  prepare_output_folder(plan.folder / folders.display);
  fs::remove(plan.file);  // of an earlier run: the file is written last, when its meshes exist
  write_meshes(hand.meshes.collision, plan.folder / folders.collision);
  if (folders.display != folders.collision) write_meshes(hand.meshes.display, plan.folder / folders.display);
  write_text_file(plan.file, text);
  fmt::print("wrote    {} ({}, {} hand, {} links with meshes in {})\n", plan.file.string(),
             hand.parameters.name, hand.handedness == Handedness::kLeft ? "left" : "right", kSegments,
             (plan.folder / "meshes").string());
  return kDone;
}

void add_hand_options(CLI::App& command, HandOptions& options) {
  command
      .add_option("--profile", options.profile,
                  "a patient's profile: a name in assets/profiles or a .toml file")
      ->type_name("NAME");
  command.add_option("--hand", options.file, "a hand file: a name in assets/hands or a .toml file [adult]")
      ->type_name("NAME");
  command.add_option("--side,--handedness", options.side, "right or left [right]")
      ->type_name("SIDE")
      ->check(CLI::IsMember({"right", "left"}));
  command
      .add_option("--meshes", options.meshes,
                  "file: the hand file's meshes; capsules: capsules in any case [file]")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"file", "capsules"}));
}

}  // namespace

void add_hand_command(CLI::App& app, Job& job) {
  CLI::App* hand = app.add_subcommand("hand", "The hand of a hand file or of a patient's profile");
  hand->require_subcommand(1);

  auto shown = std::make_shared<HandOptions>();
  CLI::App* show = hand->add_subcommand(
      "show", "Sizes, ranges of motion and triangles, and how far sizes are from the published means");
  add_hand_options(*show, *shown);
  show->callback([show, shown, &job] {
    refuse_empty_values(*show);
    job = [shown] { return show_hand(*shown); };
  });

  auto exported = std::make_shared<HandOptions>();
  CLI::App* to_file = hand->add_subcommand("export", "Write the hand as URDF or MJCF, its meshes beside it");
  add_hand_options(*to_file, *exported);
  to_file->add_option("--format", exported->format, "urdf or mjcf")
      ->required()
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"urdf", "mjcf"}));
  to_file
      ->add_option("--out", exported->out,
                   "a folder for hand.urdf or hand.xml and meshes/, or the file's own name (.urdf, .xml)")
      ->required()
      ->type_name("PATH");
  to_file->callback([to_file, exported, &job] {
    refuse_empty_values(*to_file);
    job = [exported] { return export_hand(*exported); };
  });
}

}  // namespace phalanx
