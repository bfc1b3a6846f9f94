// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a scene, hand, profile or mapping file holds, reading it ends in a description or in an
// error with a message. The first byte chooses what the rest is; a line that begins with `set ` becomes an
// override.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/profile_file.h"
#include "phalanx/scene/scene.h"

namespace {

void require(bool ok) {
  if (!ok) std::abort();
}

void read_scene(std::string text) {
  phalanx::Overrides overrides;
  constexpr std::string_view kSet = "set ";
  while (text.substr(0, kSet.size()) == kSet && overrides.size() < 8) {
    const std::size_t end = text.find('\n');
    overrides.push_back(phalanx::parse_override(
        text.substr(kSet.size(), end == std::string::npos ? end : end - kSet.size())));
    text = end == std::string::npos ? std::string() : text.substr(end + 1);
  }
  const phalanx::SceneDescription scene = phalanx::parse_scene(text, "fuzz.toml", "/", overrides);
  require(scene.parameters.rate_hz >= 1.0 && scene.parameters.rate_hz <= 4000.0);
  require(std::isfinite(scene.parameters.force.stiffness) && scene.parameters.force.stiffness >= 0.0);
  require(scene.parameters.stabiliser.min_rate < 0.0 && scene.parameters.stabiliser.max_rate > 0.0);
  require(scene.parameters.limits.fingertip_force > 0.0 && scene.parameters.limits.fingertip_force <= 15.0);
  for (const phalanx::ObjectDescription& object : scene.objects)
    require(object.pose.p.allFinite() && object.pose.R.allFinite());
}

/// A profile that is accepted makes a hand of finite numbers.
void read_profile(const std::string& text) {
  static const phalanx::HandParameters base = phalanx::load_hand_file("adult");
  const phalanx::FittedHand hand = phalanx::fit_profile(phalanx::parse_profile(text, "fuzz.toml", "/"), base);
  require(std::isfinite(phalanx::hand_length(hand.parameters)));
  for (std::size_t j = 0; j < phalanx::kJoints; ++j) {
    require(hand.parameters.min_angle[j] < hand.parameters.max_angle[j]);
    require(hand.parameters.open_angle[j] >= hand.parameters.min_angle[j] &&
            hand.parameters.open_angle[j] <= hand.parameters.max_angle[j]);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(data + 1, data + size);
  try {
    if (data[0] == 'h') {
      static_cast<void>(phalanx::parse_hand(text, "fuzz.toml"));
    } else if (data[0] == 'p') {
      read_profile(text);
    } else if (data[0] == 'm') {
      phalanx::check_mapping(phalanx::parse_mapping(text, "fuzz.toml"));
    } else {
      read_scene(text);
    }
  } catch (const phalanx::SceneError& error) {
    require(error.what()[0] != '\0');
  }
  return 0;
}
