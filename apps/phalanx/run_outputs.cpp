// SPDX-License-Identifier: Apache-2.0
#include "run_outputs.h"

#include <fmt/format.h>

#include <stdexcept>

#include "phalanx/mesh/import.h"
#include "phalanx/record/output_file.h"
#include "picture_file.h"

namespace phalanx {
namespace {

void prepare_folder_of(const std::filesystem::path& file) {
  if (file.empty()) return;
  if (std::filesystem::is_directory(file)) {
    throw std::invalid_argument(fmt::format("'{}' is a folder; name a file in it", file.string()));
  }
  prepare_output_folder(file.has_parent_path() ? file.parent_path() : ".");
  try {
    const OutputFile probe(file);  // not committed, so it is removed again
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(
        fmt::format("{}; name a file in a folder that you may write to", error.what()));
  }
}

}  // namespace

RunOutputs::RunOutputs(OutputPlan plan, const HapticModel& model, double margin, DrawnHand drawn,
                       std::uint64_t ticks)
    : plan_(std::move(plan)),
      model_(model),
      drawn_(std::move(drawn)),
      moment_(
          ticks,
          plan_.picture.empty() ? std::nullopt : std::optional<DisplayedHand>(std::in_place, model, margin),
          plan_.picture_at) {
  prepare_folder_of(plan_.plot);
  prepare_folder_of(plan_.picture);
  if (!plan_.folder.empty()) {
    prepare_output_folder(plan_.folder);
    prepare_output_folder(plan_.folder / "hand");
    // Remove files of an earlier run: one that this run does not write must not stay beside the others.
    for (const char* name : {"summary.json", "ticks.csv", "poses.csv", "contacts.csv"})
      std::filesystem::remove(plan_.folder / name);
    ticks_.emplace(plan_.folder / "ticks.csv");
    if (plan_.poses) poses_.emplace(plan_.folder / "poses.csv");
    if (plan_.contacts) contacts_.emplace(plan_.folder / "contacts.csv");
  }
}

void RunOutputs::add(const Snapshot& snapshot) {
  if (ticks_) ticks_->write(snapshot);
  if (poses_) poses_->write(snapshot);
  if (contacts_) contacts_->write(snapshot);
  if (!plan_.plot.empty()) trace_.push_back(trace_tick(snapshot));
  moment_.see(snapshot);
}

void RunOutputs::finish(const Summary& summary, const PlotText& text) {
  if (!plan_.plot.empty()) write_text_file(plan_.plot, plot_svg(trace_, text));
  if (!plan_.picture.empty()) {
    const Image image = render_picture(drawn_, model_.object.mesh(), moment_.snapshot());
    save_picture(image, plan_.picture);
  }
  if (plan_.folder.empty()) return;
  write_meshes();
  ticks_->commit();
  if (poses_) poses_->commit();
  if (contacts_) contacts_->commit();
  write_text_file(plan_.folder / "summary.json", summary_json(summary));
}

void RunOutputs::write_meshes() const {
  write_then_rename(plan_.folder / "object.obj", [&](const std::filesystem::path& file) {
    write_obj(model_.object.mesh(), file, "object");
  });
  for (int segment = 0; segment < kSegments; ++segment) {
    const std::string name(segment_name(segment));
    write_then_rename(plan_.folder / "hand" / (name + ".obj"), [&](const std::filesystem::path& file) {
      write_obj(model_.hand.mesh(segment), file, name);
    });
  }
}

}  // namespace phalanx
