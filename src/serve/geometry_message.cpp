// SPDX-License-Identifier: Apache-2.0
#include "serve/geometry_message.h"

#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "phalanx/geometry.pb.h"

namespace phalanx {
namespace {

void put(const TriangleMesh& mesh, wire::Mesh& out) {
  out.mutable_position()->Reserve(static_cast<int>(3 * mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) out.add_position(static_cast<float>(v[k]));
  }
  out.mutable_index()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t i : t) out.add_index(static_cast<std::uint32_t>(i));
  }
}

/// Adds position and unit quaternion x y z w, like the poses of a Tick.
void put(const Pose& X, wire::Skin& out) {
  const Eigen::Quaterniond q(X.R);
  for (int k = 0; k < 3; ++k) out.add_bind_pose(static_cast<float>(X.p[k]));
  for (const double c : {q.x(), q.y(), q.z(), q.w()}) out.add_bind_pose(static_cast<float>(c));
}

void put(const HandSkin& skin, wire::Skin& out) {
  put(skin.mesh, *out.mutable_mesh());
  for (std::size_t i = 0; i < skin.mesh.vertices.size(); ++i) {
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
      out.add_segment(skin.segment[i][k]);
      out.add_weight(skin.weight[i][k]);
    }
  }
  for (const Pose& X : skin.X_BS) put(X, out);
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

bool same(const SegmentMeshes& a, const SegmentMeshes& b) {
  for (std::size_t s = 0; s < kSegments; ++s) {
    if (!same(a[s], b[s])) return false;
  }
  return true;
}

void put_joints(const HandParameters& hand, wire::Geometry& out) {
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    out.add_joint_name(std::string(joint_name(j)));
    out.add_joint_min(static_cast<float>(hand.min_angle[i]));
    out.add_joint_max(static_cast<float>(hand.max_angle[i]));
    out.add_joint_open(static_cast<float>(hand.open_angle[i]));
  }
}

/// @param bytes  null: there was no memory
WebResponse response_with(const Bytes& bytes) {
  if (!bytes) return {.status = 500, .type = "text/plain", .body = nullptr, .immutable = false};
  return {.status = 200, .type = "application/x-protobuf", .body = bytes, .immutable = false};
}

}  // namespace

std::string geometry_message(const SessionGeometry& geometry) {
  wire::Geometry out;
  out.set_revision(geometry.revision);
  out.set_left(geometry.handedness == Handedness::kLeft);
  for (const TriangleMesh& mesh : geometry.segment) put(mesh, *out.add_segment());
  if (!same(geometry.display, geometry.segment)) {
    for (const TriangleMesh& mesh : geometry.display) put(mesh, *out.add_display());
  }
  if (geometry.skin) put(*geometry.skin, *out.mutable_skin());
  put(geometry.object, *out.mutable_object());
  out.set_rate_hz(static_cast<float>(geometry.rate_hz));
  for (int s = 0; s < kSegments; ++s) out.add_segment_name(std::string(segment_name(s)));
  put_joints(geometry.hand, out);
  return out.SerializeAsString();
}

Bytes GeometryCache::encode(const SessionGeometry& geometry) noexcept {
  try {
    return std::make_shared<const std::string>(geometry_message(geometry));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void GeometryCache::request(std::shared_ptr<const SessionGeometry> geometry, Respond respond) {
  std::unique_lock lock(mutex_);
  if (bytes_ && revision_ == geometry->revision) {
    const Bytes bytes = bytes_;
    lock.unlock();
    return respond(response_with(bytes));
  }
  requests_.push_back({std::move(geometry), std::move(respond)});
  if (working_) return;
  try {
    std::thread([self = shared_from_this()] { self->work(); }).detach();
    working_ = true;
  } catch (const std::system_error&) {  // no thread: the page requests it again
    const Request refused = std::move(requests_.back());
    requests_.pop_back();
    lock.unlock();
    refused.respond(response_with(nullptr));
  }
}

void GeometryCache::work() {
  std::unique_lock lock(mutex_);
  while (!requests_.empty()) {
    const Request next = std::move(requests_.front());
    requests_.pop_front();
    Bytes bytes = revision_ == next.geometry->revision ? bytes_ : nullptr;
    lock.unlock();
    if (!bytes) bytes = encode(*next.geometry);
    next.respond(response_with(bytes));
    lock.lock();
    bytes_ = std::move(bytes);
    revision_ = next.geometry->revision;
  }
  working_ = false;
}

}  // namespace phalanx
