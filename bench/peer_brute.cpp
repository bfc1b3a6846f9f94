// SPDX-License-Identifier: Apache-2.0
#include "peer_brute.h"

#include <algorithm>
#include <cmath>

namespace phalanx::bench {

std::vector<BruteEngine::Ball> BruteEngine::balls_of(const TriangleMesh& mesh, const Pose& X) {
  std::vector<Ball> balls;
  balls.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Ball ball;
    for (std::size_t i = 0; i < 3; ++i) {
      ball.corners[i] = X * mesh.vertices[static_cast<std::size_t>(t[i])];
    }
    ball.centre = (ball.corners[0] + ball.corners[1] + ball.corners[2]) / 3.0;
    for (const Vec3& corner : ball.corners) {
      ball.radius = std::max(ball.radius, (corner - ball.centre).norm());
    }
    ball.radius += 1e-12;  // rounding
    balls.push_back(ball);
  }
  return balls;
}

BruteEngine::BruteEngine(const HandModel& hand, const TriangleMesh& object)
    : hand_(hand), object_(balls_of(object, Pose{})) {}

/// visit(i, j, closest) returns the new limit; pairs whose spheres are farther apart than it are left out.
template <class Visit>
void BruteEngine::for_each_pair(int segment, const Pose& X_WS, double limit, Visit&& visit) const {
  const std::vector<Ball> balls = balls_of(hand_.mesh(segment), X_WS);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    for (std::size_t j = 0; j < object_.size(); ++j) {
      const double reach = limit + balls[i].radius + object_[j].radius;
      if ((balls[i].centre - object_[j].centre).squaredNorm() > reach * reach) continue;
      limit = visit(static_cast<int>(i), static_cast<int>(j),
                    triangle_distance(balls[i].corners, object_[j].corners));
    }
  }
}

Nearest BruteEngine::nearest(int segment, const Pose& X_WS, double cap) {
  // No segment is farther away than this from an object that a hand can reach; spheres need a finite number.
  constexpr double kFar = 1e3;
  Nearest best{.distance = cap};
  for_each_pair(segment, X_WS, std::min(cap, kFar), [&](int, int, const TriangleDistance& closest) {
    const double distance = std::sqrt(closest.squared);
    if (distance < best.distance) best = {distance, closest.on_a, closest.on_b};
    return std::min(best.distance, kFar);
  });
  return best;
}

void BruteEngine::pairs_within(int segment, const Pose& X_WS, double limit, std::vector<ClosePair>& pairs) {
  pairs.clear();
  for_each_pair(segment, X_WS, limit, [&](int i, int j, const TriangleDistance& closest) {
    const double distance = std::sqrt(closest.squared);
    if (distance <= limit) pairs.push_back({distance, closest.on_a, closest.on_b, i, j});
    return limit;
  });
}

}  // namespace phalanx::bench
