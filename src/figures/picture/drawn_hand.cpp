// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/drawn_hand.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "phalanx/core/index.h"

namespace phalanx {
namespace picture {
namespace {

/// Distance from a joint within which the tints of the two segments blend [m]. Their meshes overlap there,
/// and a hard border would look ragged.
constexpr float kBlend = 5e-3F;

/// @returns the weight of the segment beyond a joint, at `beyond` [m] past the joint along the bone.
float share_beyond(float beyond) {
  const float t = std::clamp(0.5F + 0.5F * beyond / kBlend, 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// @returns how far `point` is beyond the joint between a digit's segments s and s + 1, along the mean of
/// their bones [m].
float beyond_joint(const SegmentPoses& X_WS, std::size_t s, const Vec3f& point) {
  const auto along = [&](std::size_t k) {
    return static_cast<float>(-(X_WS[k].inverse() * point.cast<double>()).z());
  };
  const auto length = static_cast<float>((X_WS[s + 1].p - X_WS[s].p).norm());
  return 0.5F * (along(s) - length + along(s + 1));
}

Vec3f blended(const SegmentPoses& X_WS, const SegmentColours& colours, int part, const Vec3f& point) {
  const std::size_t s = idx(part);
  Vec3f colour = colours[s];
  if (part >= kPalm) return colour;
  if (part % kSegmentsPerDigit > 0)
    colour += (1.0F - share_beyond(beyond_joint(X_WS, s - 1, point))) * (colours[s - 1] - colours[s]);
  if (part % kSegmentsPerDigit < kSegmentsPerDigit - 1)
    colour += share_beyond(beyond_joint(X_WS, s, point)) * (colours[s + 1] - colours[s]);
  return colour;
}

/// @returns the segment with the largest weight in a triangle of the skin.
int heaviest(const HandSkin& skin, const Triangle& triangle) {
  std::array<float, kSegments> share{};
  for (const std::int32_t corner : triangle) {
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k)
      share[skin.segment[idx(corner)][k]] += skin.weight[idx(corner)][k];
  }
  return static_cast<int>(std::max_element(share.begin(), share.end()) - share.begin());
}

Vec3f blended(const HandSkin& skin, const SegmentColours& colours, std::int32_t vertex) {
  Vec3f colour = Vec3f::Zero();
  for (std::size_t k = 0; k < HandSkin::kInfluences; ++k)
    colour += skin.weight[idx(vertex)][k] * colours[skin.segment[idx(vertex)][k]];
  return colour;
}

/// Appends the skin. It has no creases, at any bending.
void append_skin(RenderMesh& out, const HandSkin& skin, const TriangleMesh& posed,
                 const SegmentColours& colours) {
  append_curved(out, posed, {},
                {.level = kLevel,
                 .crease = std::numbers::pi,
                 .part = [&](std::size_t t) { return heaviest(skin, posed.triangles[t]); },
                 .albedo =
                     [&](std::size_t t, const Vec3& share, const Vec3f&) {
                       Vec3f colour = Vec3f::Zero();
                       for (std::size_t c = 0; c < 3; ++c)
                         colour += static_cast<float>(share[static_cast<Eigen::Index>(c)]) *
                                   blended(skin, colours, posed.triangles[t][c]);
                       return colour;
                     }});
}

void append_segment(RenderMesh& out, const SegmentMeshes& segments, int s, const SegmentPoses& X_WS,
                    const SegmentColours& colours) {
  append_curved(out, segments[idx(s)], X_WS[idx(s)],
                {.level = kLevel,
                 .part = [s](std::size_t) { return s; },
                 .albedo = [&](std::size_t, const Vec3&,
                               const Vec3f& point) { return blended(X_WS, colours, s, point); }});
}

/// @returns the larger distance of the segment's far end and origin between the two hands [m].
double distance(const Pose& a, const Pose& b) {
  const Vec3 tip(0.0, 0.0, -0.03);
  return std::max((a.p - b.p).norm(), (a * tip - b * tip).norm());
}

/// @returns colours for a ghost, which gets its own colour when it is drawn.
SegmentColours no_colours() {
  SegmentColours none;
  none.fill(Vec3f::Zero());
  return none;
}

}  // namespace

void append_hand(RenderMesh& out, const DrawnHand& hand, const SegmentPoses& X_WS,
                 const SegmentColours& colours) {
  if (const auto* skin = std::get_if<HandSkin>(&hand))
    return append_skin(out, *skin, {skinned(*skin, X_WS), skin->mesh.triangles}, colours);
  for (int s = 0; s < kSegments; ++s) append_segment(out, std::get<SegmentMeshes>(hand), s, X_WS, colours);
}

void append_ghost(RenderMesh& out, const DrawnHand& hand, const SegmentPoses& shown,
                  const SegmentPoses& measured) {
  constexpr double kLeast = static_cast<double>(kLeastGhost);
  if (const auto* skin = std::get_if<HandSkin>(&hand)) {
    const std::vector<Vec3> rest = skinned(*skin, shown);
    TriangleMesh ghost{skinned(*skin, measured), skin->mesh.triangles};
    std::erase_if(ghost.triangles, [&](const Triangle& triangle) {
      return std::ranges::all_of(triangle, [&](std::int32_t corner) {
        return (ghost.vertices[idx(corner)] - rest[idx(corner)]).norm() <= kLeast;
      });
    });
    return append_skin(out, *skin, ghost, no_colours());
  }
  for (int s = 0; s < kSegments; ++s) {
    if (distance(shown[idx(s)], measured[idx(s)]) > kLeast)
      append_segment(out, std::get<SegmentMeshes>(hand), s, measured, no_colours());
  }
}

}  // namespace picture

DrawnHand drawn_hand(LoadedHand hand) {
  if (hand.skin) return *std::move(hand.skin);
  return std::move(hand.meshes.display);
}

}  // namespace phalanx
