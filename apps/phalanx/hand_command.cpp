// SPDX-License-Identifier: Apache-2.0
// phalanx hand show|export|pictures: the hand of a hand file or of a patient's profile.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "hand_pictures.h"
#include "phalanx/core/constants.h"
#include "phalanx/hand/anthropometry.h"
#include "phalanx/hand/fit.h"
#include "phalanx/mesh/import.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/hand_export.h"
#include "phalanx/scene/hand_meshes.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

struct HandOptions {
  std::string profile, file, side, meshes, coupling;
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
  if (options.coupling == "none") hand.coupling = HandCoupling::kNone;
  return hand;
}

/// Formats the distance from the means: "+0.8 SD" from one, or "-0.8 SD of men, +0.5 SD of women".
std::string deviations(double value, std::span<const Norm> norms) {
  std::string text;
  for (const Norm& norm : norms) {
    text += fmt::format("{}{:+.1f} SD of {} ({:.1f} +- {:.1f} mm)", text.empty() ? "" : ", ",
                        (value - norm.mean) / norm.sd, norm.group, norm.mean / kMm, norm.sd / kMm);
  }
  return text;
}

std::string sizes(const HandParameters& hand) {
  std::string text = fmt::format("hand length   {:>8.2f} mm   {}\n", hand_length(hand) / kMm,
                                 deviations(hand_length(hand), hand_length_norms()));
  text += fmt::format("hand breadth  {:>8.2f} mm   {}\n\n", hand_breadth(hand) / kMm,
                      deviations(hand_breadth(hand), hand_breadth_norms()));
  text += fmt::format("{:<36}{:>11}{:>9}{:>13}\n", "segment", "length [mm]", "[SD]", "breadth [mm]");
  for (int s = 0; s < kSegments - 1; ++s) {
    const Norm norm = segment_length_norm(s);
    const double length = segment_length(hand, s);
    text += fmt::format("{:<36}{:>11.2f}{:>+9.1f}{:>13.2f}\n", segment_name(s), length / kMm,
                        (length - norm.mean) / norm.sd, segment_breadth(hand, s) / kMm);
  }
  return text;
}

std::string ranges(const HandParameters& hand) {
  std::string text = fmt::format("\n{:<24}{:>10}{:>10}{:>12}\n", "joint", "least", "largest", "open [deg]");
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    text += fmt::format("{:<24}{:>10.1f}{:>10.1f}{:>12.1f}\n", joint_name(j), kRadToDeg * hand.min_angle[i],
                        kRadToDeg * hand.max_angle[i], kRadToDeg * hand.open_angle[i]);
  }
  return text;
}

/// Lists the coupled rotations, in degrees at the ends of the joint's range.
std::string couplings(const HandParameters& hand) {
  std::string text;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCoupling& coupling = hand.digits[static_cast<std::size_t>(digit)].coupling;
    const auto add = [&](std::string_view rotation, int i, double ratio) {
      if (ratio == 0.0) return;
      const auto joint = static_cast<std::size_t>(joint_index(digit, i));
      text += fmt::format("{:<24}{:>24}{:>8.3f}{:>12.1f}{:>9.1f}\n",
                          fmt::format("{} {}", digit_name(digit), rotation),
                          joint_name(joint_index(digit, i)), ratio, kRadToDeg * ratio * hand.min_angle[joint],
                          kRadToDeg * ratio * hand.max_angle[joint]);
    };
    add("metacarpal", 0, coupling.metacarpal_per_flexion);
    add("pronation", 0, coupling.pronation_per_flexion);
    add("pronation", kAbductionJoint, coupling.pronation_per_abduction);
  }
  if (text.empty()) return text;
  return fmt::format("\n{:<24}{:>24}{:>8}{:>12}{:>9}\n", "coupled rotation", "follows", "ratio", "from [deg]",
                     "to") +
         text;
}

std::size_t triangles(const SegmentMeshes& meshes) {
  std::size_t count = 0;
  for (const TriangleMesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

/// Describes a hand in text: its sizes with their distance from the published means in standard deviations,
/// its ranges of motion, its triangles.
std::string hand_table(const LoadedHand& hand) {
  return fmt::format("{}: a {} hand\n", hand.parameters.name,
                     hand.handedness == Handedness::kLeft ? "left" : "right") +
         sizes(hand.parameters) + ranges(hand.parameters) + couplings(hand.parameters) +
         fmt::format("\ntriangles: {} that collide, {} that are shown\n", triangles(hand.meshes.collision),
                     triangles(hand.meshes.display));
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
  command
      .add_option(
          "--coupling", options.coupling,
          "file: the rotations that follow from the joints' angles, as the hand file has them; none [file]")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"file", "none"}));
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

  auto posed = std::make_shared<HandOptions>();
  auto pictures = std::make_shared<HandPicturesOptions>();
  CLI::App* draw =
      hand->add_subcommand("pictures", "Draw the hand in named postures, one by one and on one sheet");
  draw->add_option("POSTURES", pictures->postures,
                   "a file of postures: a name in assets/postures or a .csv file, in degrees")
      ->required();
  add_hand_options(*draw, *posed);
  draw->add_option("--out", pictures->folder,
                   "writes NAME.png for each posture and postures.png into this folder")
      ->required()
      ->type_name("DIR");
  draw->add_option("--width", pictures->width, "of one picture in pixels; its height is 5/4 of it")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  draw->add_option("--columns", pictures->columns, "pictures in a row of the sheet")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  draw->callback([draw, posed, pictures, &job] {
    refuse_empty_values(*draw);
    job = [posed, pictures] { return draw_postures(described(*posed), *pictures); };
  });
}

}  // namespace phalanx
