// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/live_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace phalanx {
namespace {

double line(double from, double to, double part) noexcept { return from + part * (to - from); }

/// In equal ratios; an infinite or unbounded end counts as kUnbounded on the way.
double ratio(double from, double to, double part) noexcept {
  const double a = std::min(std::abs(from), LiveModel::kUnbounded);
  const double b = std::min(std::abs(to), LiveModel::kUnbounded);
  return a * std::pow(b / a, part);
}

}  // namespace

bool changes_in_contact(const std::string& key) {
  constexpr std::array<std::string_view, 7> kKeys = {
      "force.stiffness_n_per_mm", "force.damping_ns_per_m", "smoothing.enabled", "smoothing.min_n_per_s",
      "smoothing.max_n_per_s",    "smoothing.min_n",        "smoothing.max_n"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

BlendedParameters blended_of(const HapticModel& model) noexcept {
  return {.stiffness = model.force.stiffness,
          .damping = model.force.damping,
          .smoothing = model.smoothing.enabled,
          .min_rate = model.smoothing.min_rate,
          .max_rate = model.smoothing.max_rate};
}

LiveModel::LiveModel(std::unique_ptr<HapticModel> model)
    : model_(std::move(model)), state_(std::make_unique<HapticState>(*model_)) {}

void LiveModel::apply(double part) noexcept {
  model_->force.stiffness = line(from_.stiffness, to_.stiffness, part);
  model_->force.damping = line(from_.damping, to_.damping, part);
  model_->smoothing.enabled = true;
  model_->smoothing.min_rate = -ratio(from_.min_rate, to_.min_rate, part);
  model_->smoothing.max_rate = ratio(from_.max_rate, to_.max_rate, part);
}

void LiveModel::blend_to(const BlendedParameters& target) noexcept {
  const auto with_bounds = [](BlendedParameters parameters) {
    if (!parameters.smoothing) parameters.min_rate = -(parameters.max_rate = kUnbounded);
    return parameters;
  };
  from_ = with_bounds(blended_of(*model_));
  to_ = target;
  left_ = kBlend;
}

Status LiveModel::advance(const Sample& sample) noexcept {
  if (left_ > 0.0) {
    left_ -= 1.0 / model_->rate_hz;
    const BlendedParameters target = to_;
    if (!to_.smoothing) to_.min_rate = -(to_.max_rate = kUnbounded);
    apply(std::clamp(1.0 - left_ / kBlend, 0.0, 1.0));
    to_ = target;
    if (left_ <= 0.0) {
      model_->force.stiffness = to_.stiffness;
      model_->force.damping = to_.damping;
      model_->smoothing = {.enabled = to_.smoothing, .min_rate = to_.min_rate, .max_rate = to_.max_rate};
    }
  }
  return step(*model_, sample, *state_);
}

void LiveModel::swap(LiveModel& other) noexcept {
  std::swap(model_, other.model_);
  std::swap(state_, other.state_);
  std::swap(from_, other.from_);
  std::swap(to_, other.to_);
  std::swap(left_, other.left_);
}

}  // namespace phalanx
