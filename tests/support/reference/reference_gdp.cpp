// SPDX-License-Identifier: Apache-2.0
#include "support/reference/reference_gdp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "phalanx/core/index.h"

namespace phalanx::test {
namespace {

using ThreeCorners = std::array<Vec3, 3>;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFarthestTurn = std::numbers::pi / 6.0;  ///< of the force's direction from n_c [rad]
constexpr double kEdgeWidth = 10e-6;                      ///< a contact is on an edge to this much [m]

Vec3 on_edge(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double square = along.squaredNorm();
  return square > 0.0 ? Vec3(from + std::clamp(along.dot(p - from) / square, 0.0, 1.0) * along) : from;
}

/// Two features, one of each triangle, at their nearest.
struct Touch {
  Vec3 on_a;
  Vec3 on_b;
};

/// The foot of p on the triangle's face, if it is inside.
bool foot_inside(const Vec3& p, const ThreeCorners& t, Vec3& foot) {
  Mat3 axes;  // p = t0 + u (t1 - t0) + v (t2 - t0) + w n
  axes.col(0) = t[1] - t[0];
  axes.col(1) = t[2] - t[0];
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const double area = axes.col(2).norm();
  if (!(area > 1e-9 * axes.col(0).norm() * axes.col(1).norm())) return false;
  const Vec3 u = axes.inverse() * (p - t[0]);
  foot = p - u[2] * axes.col(2);
  return u[0] >= 0.0 && u[1] >= 0.0 && u[0] + u[1] <= 1.0;
}

/// The nearest points of two edges: where their common perpendicular meets both or, if it does not, an end.
Touch nearest_of_edges(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 u = p1 - p0;
  const Vec3 v = q1 - q0;
  const Vec3 n = u.cross(v);
  const double square = n.squaredNorm();
  if (square > 1e-14 * u.squaredNorm() * v.squaredNorm()) {
    const double s = (q0 - p0).cross(v).dot(n) / square;
    const double t = (q0 - p0).cross(u).dot(n) / square;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) return {p0 + s * u, q0 + t * v};
  }
  const std::array<Touch, 4> ends = {{{p0, on_edge(p0, q0, q1)},
                                      {p1, on_edge(p1, q0, q1)},
                                      {on_edge(q0, p0, p1), q0},
                                      {on_edge(q1, p0, p1), q1}}};
  return *std::min_element(ends.begin(), ends.end(), [](const Touch& x, const Touch& y) {
    return (x.on_a - x.on_b).squaredNorm() < (y.on_a - y.on_b).squaredNorm();
  });
}

/// Whether an edge of `points` goes through `t`, and where.
bool pierces_at(const ThreeCorners& points, const ThreeCorners& t, Vec3& where) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& from = points[i];
    const Vec3& to = points[(i + 1) % 3];
    const double low = n.dot(from - t[0]);
    const double high = n.dot(to - t[0]);
    if (!(low * high < 0.0)) continue;
    Vec3 foot;
    where = from + low / (low - high) * (to - from);
    if (foot_inside(where, t, foot)) return true;
  }
  return false;
}

/// Calls use(touch) for 9 pairs of edges, up to 6 of corner and face, and, by choice, 18 of corner and edge.
template <class Use>
void for_each_touch(const ThreeCorners& a, const ThreeCorners& b, bool corner_edges, Use&& use) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) use(nearest_of_edges(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    Vec3 foot;
    if (foot_inside(a[i], b, foot)) use(Touch{a[i], foot});
    if (foot_inside(b[i], a, foot)) use(Touch{foot, b[i]});
    for (std::size_t j = 0; corner_edges && j < 3; ++j) {
      use(Touch{a[i], on_edge(a[i], b[j], b[(j + 1) % 3])});
      use(Touch{on_edge(b[i], a[j], a[(j + 1) % 3]), b[i]});
    }
  }
}

Touch nearest_touch(const ThreeCorners& a, const ThreeCorners& b) {
  Vec3 where;
  if (pierces_at(a, b, where) || pierces_at(b, a, where)) return {where, where};
  Touch best{a[0], b[0]};
  for_each_touch(a, b, false, [&](const Touch& touch) {
    if ((touch.on_a - touch.on_b).squaredNorm() < (best.on_a - best.on_b).squaredNorm()) best = touch;
  });
  return best;
}

/// Where two triangles tie: the polygon of their tied features, widened by kTieBand.
struct Region {
  double weight;
  Vec3 on_a;
  Vec3 on_b;
};

Region tied_place(const ThreeCorners& a, const ThreeCorners& b, const Touch& nearest, double limit) {
  std::vector<Touch> corner;
  for_each_touch(a, b, true, [&](const Touch& touch) {
    if ((touch.on_a - touch.on_b).norm() <= limit) corner.push_back(touch);
  });
  const double disc = std::numbers::pi * kTieBand * kTieBand;
  if (corner.empty()) return {disc, nearest.on_a, nearest.on_b};
  Touch middle{Vec3::Zero(), Vec3::Zero()};
  for (const Touch& x : corner) {
    middle.on_a += x.on_a / static_cast<double>(corner.size());
    middle.on_b += x.on_b / static_cast<double>(corner.size());
  }
  const Vec3 up = (nearest.on_a - nearest.on_b).normalized();
  const Vec3 right = up.unitOrthogonal();
  const auto bearing = [&](const Touch& x) {
    return std::atan2((x.on_a - middle.on_a).dot(up.cross(right)), (x.on_a - middle.on_a).dot(right));
  };
  std::sort(corner.begin(), corner.end(),
            [&](const Touch& x, const Touch& y) { return bearing(x) < bearing(y); });
  Region out{disc, disc * middle.on_a, disc * middle.on_b};
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const Touch& p = corner[i];
    const Touch& q = corner[(i + 1) % corner.size()];
    const double area = 0.5 * (p.on_a - middle.on_a).cross(q.on_a - middle.on_a).norm();
    const double rim = kTieBand * (p.on_a - q.on_a).norm();
    out.weight += area + rim;
    out.on_a += area * (middle.on_a + p.on_a + q.on_a) / 3.0 + rim * (p.on_a + q.on_a) / 2.0;
    out.on_b += area * (middle.on_b + p.on_b + q.on_b) / 3.0 + rim * (p.on_b + q.on_b) / 2.0;
  }
  out.on_a /= out.weight;
  out.on_b /= out.weight;
  return out;
}

/// The vector of the cone of unit vectors `fan` that is nearest to n: the best of the projections on the
/// spans of one, two or three of them that lie between them.
Vec3 nearest_in(const std::vector<Vec3>& fan, const Vec3& n) {
  Vec3 best = fan.front();
  const auto offer = [&](const Vec3& v) {
    if (v.norm() > 1e-9 && v.normalized().dot(n) > best.dot(n)) best = v.normalized();
  };
  for (std::size_t i = 0; i < fan.size(); ++i) {
    offer(fan[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 across = fan[i].cross(fan[j]);
      if (across.norm() < 1e-12) continue;
      const double w_i = n.cross(fan[j]).dot(across) / across.squaredNorm();
      const double w_j = fan[i].cross(n).dot(across) / across.squaredNorm();
      if (w_i >= 0.0 && w_j >= 0.0) offer(w_i * fan[i] + w_j * fan[j]);
      for (std::size_t k = 0; k < j; ++k) {
        Mat3 three;
        three << fan[i], fan[j], fan[k];
        if (std::abs(three.determinant()) < 1e-9) continue;
        const Vec3 weight = three.inverse() * n;
        if (weight.minCoeff() >= 0.0) return n;
      }
    }
  }
  return best;
}

double angle_apart(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

DigitAngles along(const DigitAngles& from, const DigitAngles& rate, double s) {
  DigitAngles q = from;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += s * rate[i];
  return q;
}

int first_moved(const DigitAngles& rate) {
  for (int i = 0; i < kJointsPerDigit; ++i) {
    if (rate[idx(i)] != 0.0) return std::max(0, i - 1);  // flexion and abduction move the first segment
  }
  return kSegmentsPerDigit;
}

}  // namespace

/// What there is to see of a digit at one place of its way.
struct ReferenceGdp::View {
  int blocked = -1;      ///< most distal segment with a pair within the margin that closes
  double closing = 0.0;  ///< how fast that pair closes, of the segment's greatest speed
  double step = 1.0;     ///< how far s may go on until the next look
};

ReferenceGdp::ReferenceGdp(const HandModel& hand, const TriangleMesh& object,
                           const ContactParameters& parameters)
    : hand_(hand.parameters()),
      left_(hand.handedness() == Handedness::kLeft),
      X_WH_(hand.palm_pose()),
      parameters_(parameters),
      object_(pieces_of(object)),
      normals_(surface_normals(object, kFarthestTurn)) {
  for (int s = 0; s < kSegments; ++s) {
    segment_[idx(s)] = pieces_of(hand.mesh(s));
    for (const Vec3& v : hand.mesh(s).vertices) radius_[idx(s)] = std::max(radius_[idx(s)], v.norm());
  }
  state.angle = state.hcp_angle = hand_.open_angle;
}

std::vector<ReferenceGdp::Piece> ReferenceGdp::pieces_of(const TriangleMesh& mesh) {
  std::vector<Piece> out;
  for (const Triangle& t : mesh.triangles) {
    Piece piece{{mesh.vertices[idx(t[0])], mesh.vertices[idx(t[1])], mesh.vertices[idx(t[2])]}, {}, {}, 0.0};
    piece.normal = (piece.corner[1] - piece.corner[0]).cross(piece.corner[2] - piece.corner[0]).normalized();
    piece.centre = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3.0;
    for (const Vec3& x : piece.corner) piece.radius = std::max(piece.radius, (x - piece.centre).norm());
    piece.radius += 1e-12;
    out.push_back(piece);
  }
  return out;
}

Pose ReferenceGdp::pose(int digit, int k, const DigitAngles& angle) const {
  const DigitParameters& chain = hand_.digits[idx(digit)];
  const auto step = [](const Mat3& R, const Vec3& p) { return Pose{R, p}; };
  Pose X;  // in H, of a right hand: x along the link, z the axis of flexion
  X.R.col(0) = chain.distal.normalized();
  X.R.col(2) = chain.dorsal.cross(X.R.col(0)).normalized();
  X.R.col(1) = X.R.col(2).cross(X.R.col(0));
  X.p = chain.base;
  const DigitCoupling& coupling = chain.coupling;
  const Mat3 metacarpal =
      rotation_about(chain.metacarpal_axis.normalized(), coupling.metacarpal_per_flexion * angle[0]);
  X = Pose{metacarpal, chain.metacarpal_base - metacarpal * chain.metacarpal_base} * X;
  for (int i = 0; i < k + 2; ++i) {  // the first segment is moved by two joints, each further one by one more
    const DhRow& row = chain.dh[idx(i)];
    X = X * step(rotation_about(Vec3::UnitZ(), row.theta + angle[idx(i)]), Vec3::Zero());
    X = X * step(Mat3::Identity(), Vec3(0.0, 0.0, row.d));
    X = X * step(rotation_about(Vec3::UnitX(), row.alpha), Vec3(row.a, 0.0, 0.0));
    if (i == 1) {
      const double pronation =
          coupling.pronation_per_flexion * angle[0] + coupling.pronation_per_abduction * angle[1];
      X = X * step(rotation_about(-Vec3::UnitX(), pronation), Vec3::Zero());
    }
  }
  // WebXR: the origin at the joint, -Z along the link, -X the axis of flexion.
  X = X * step(Mat3::Identity(), Vec3(-chain.dh[idx(k + 1)].a, 0.0, 0.0));
  Mat3 webxr;
  webxr << 0, 0, -1, 0, -1, 0, -1, 0, 0;
  X.R = X.R * webxr;
  if (left_) {
    const Mat3 mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
    X = Pose{mirror * X.R * mirror, mirror * X.p};
  }
  return X_WH_ * X;
}

double ReferenceGdp::speed(int digit, int k, const DigitAngles& rate) const {
  // A point is no farther from a joint than the links between and the segment's own radius.
  const DigitParameters& chain = hand_.digits[idx(digit)];
  const DigitCoupling& coupling = chain.coupling;
  const double pronation = std::abs(coupling.pronation_per_flexion * rate[0]) +
                           std::abs(coupling.pronation_per_abduction * rate[1]);
  double sum = 0.0;
  double arm = radius_[idx(segment_index(digit, k))] + std::abs(chain.dh[idx(k + 1)].d);
  for (int i = k + 1; i >= 0; --i) {
    sum += (std::abs(rate[idx(i)]) + (i == 1 ? pronation : 0.0)) * arm;
    if (i > 0) arm += std::abs(chain.dh[idx(i - 1)].a) + std::abs(chain.dh[idx(i - 1)].d);
  }
  arm += (chain.base - chain.metacarpal_base).norm();
  return sum + std::abs(coupling.metacarpal_per_flexion * rate[0]) * arm;
}

/// Whether all of `points` are farther than `limit` from the plane of `piece`, on one side.
bool ReferenceGdp::beyond(const std::array<Vec3, 3>& points, const Piece& piece, double limit) {
  double low = kInfinite;
  double high = -kInfinite;
  for (const Vec3& x : points) {
    const double height = piece.normal.dot(x - piece.corner[0]);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return low > limit + 1e-12 || high < -limit - 1e-12;
}

template <class Use>
void ReferenceGdp::for_each_pair(int digit, int k, const DigitAngles& angle, double limit, Use&& use) const {
  const Pose X = pose(digit, k, angle);
  const double reach = radius_[idx(segment_index(digit, k))];
  const std::vector<Piece>& mine = segment_[idx(segment_index(digit, k))];
  for (std::size_t j = 0; j < object_.size(); ++j) {
    const Piece& theirs = object_[j];
    if ((theirs.centre - X.p).norm() > reach + theirs.radius + limit) continue;
    const Vec3 centre_S = X.R.transpose() * (theirs.centre - X.p);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      const double far = mine[i].radius + theirs.radius + limit;
      if ((mine[i].centre - centre_S).squaredNorm() > far * far) continue;
      Pair pair{i, j, mine[i].corner, {}, {}, 0.0};
      for (Vec3& x : pair.a) x = X * x;
      if (beyond(pair.a, theirs, limit) ||
          beyond(theirs.corner, {pair.a, {}, X.R * mine[i].normal, 0.0}, limit))
        continue;
      const Touch touch = nearest_touch(pair.a, theirs.corner);
      pair.on_a = touch.on_a;
      pair.on_b = touch.on_b;
      pair.distance = (touch.on_a - touch.on_b).norm();
      if (pair.distance <= limit) limit = use(pair);
    }
  }
}

double ReferenceGdp::gap(int digit, int k, const DigitAngles& angle, double cap) const {
  for_each_pair(digit, k, angle, cap, [&](const Pair& pair) { return cap = pair.distance; });
  return cap;
}

double ReferenceGdp::closing_speed(int digit, int k, const DigitAngles& angle, const DigitAngles& rate,
                                   const Vec3& n, const Vec3& x) const {
  constexpr double kH = 1e-6;
  const Vec3 p_S = pose(digit, k, angle).inverse() * x;
  const Vec3 after = pose(digit, k, along(angle, rate, kH)) * p_S;
  const Vec3 before = pose(digit, k, along(angle, rate, -kH)) * p_S;
  return -n.dot(after - before) / (2.0 * kH);
}

ReferenceGdp::View ReferenceGdp::view(int digit, const DigitAngles& from, const DigitAngles& rate, double s,
                                      bool look_ahead) const {
  constexpr double kH = 1e-6;
  // A dip below the margin by less than this may be stepped over: it is within the band.
  constexpr double kDip = 3e-9;
  const double margin = parameters_.margin;
  const DigitAngles angle = along(from, rate, s);
  View out;
  for (int k = first_moved(rate); k < kSegmentsPerDigit; ++k) {
    const double most = speed(digit, k, rate);
    const auto limit = [&] { return margin + (look_ahead ? most * std::min(1.0 - s, out.step) : 0.0); };
    const Pose back = pose(digit, k, angle).inverse();
    const Pose after = pose(digit, k, along(angle, rate, kH)) * back;
    const Pose before = pose(digit, k, along(angle, rate, -kH)) * back;
    const auto velocity = [&](const Vec3& x) { return Vec3((after * x - before * x) / (2.0 * kH)); };
    // Each joint turns what it carries; of a product of turns the second derivative is no longer than this.
    double turning = 0.0;
    for (const double w : rate) turning += std::abs(w);
    const double bend = turning * most;
    for_each_pair(digit, k, angle, limit(), [&](const Pair& pair) {
      const Vec3 n = pair.distance > 0.0 ? pair.direction() : Vec3(Vec3::Zero());
      if (pair.distance <= margin) {
        // "A contact that is touched lightly may close by 1 nm over the whole path and still count as at
        // rest."
        const double closing = pair.distance > 0.0 ? -n.dot(velocity(pair.on_a)) : most;
        if (closing > (pair.distance > margin - 0.5 * kStopBand ? 1e-9 : 0.0)) {
          if (out.blocked != k) out.closing = 0.0;
          out.blocked = k;
          out.closing = std::max(out.closing, closing / most);
        }
      }
      if (!look_ahead) return limit();
      // The object's triangle is below the plane through its nearest point; the segment's is above it at
      // least as far as its lowest corner, and a corner keeps height - speed h - bend h^2 / 2.
      const double floor = std::min(margin - kDip, pair.distance - 1e-9);
      double step = 1.0;
      for (const Vec3& x : pair.a) {
        const double room = std::max(0.0, n.dot(x - pair.on_b) - floor);
        const double closing = -n.dot(velocity(x));
        step = std::min(step,
                        2.0 * room / (closing + std::sqrt(closing * closing + 2.0 * bend * room) + 1e-300));
      }
      out.step = std::min(out.step, std::max({step, (pair.distance - margin) / most, 1e-9 / most}));
      return limit();
    });
  }
  return out;
}

ReferenceStop ReferenceGdp::first_stop(int digit, const DigitAngles& from, const DigitAngles& rate,
                                       double s) const {
  View now = view(digit, from, rate, s, true);
  while (now.blocked < 0 && s < 1.0) {
    double low = s;
    s = std::min(1.0, s + now.step);
    now = view(digit, from, rate, s, true);
    while (now.blocked >= 0 && s - low > 1e-13) {
      const double middle = 0.5 * (low + s);
      const View there = view(digit, from, rate, middle, false);
      if (there.blocked >= 0) {
        s = middle;
        now = there;
      } else {
        low = middle;
      }
    }
  }
  return {digit, now.blocked, s, along(from, rate, s), rate, now.closing};
}

double ReferenceGdp::penetration(int digit, int k, const ReferenceRecord& record, const DigitAngles& gdp,
                                 const DigitAngles& hcp) const {
  const auto height = [&](const DigitAngles& q) { return (pose(digit, k, q) * record.p_S).dot(record.n_c); };
  const double end = height(gdp) - height(hcp);
  if (!record.along) return end;
  DigitAngles way{};
  for (std::size_t i = 0; i < way.size(); ++i) way[i] = hcp[i] - gdp[i];
  constexpr double kH = 1e-3;  // of fourth order: 1e-13 m, from rounding and from the difference
  const double closing = (height(along(gdp, way, 2.0 * kH)) - height(along(gdp, way, -2.0 * kH)) -
                          8.0 * (height(along(gdp, way, kH)) - height(along(gdp, way, -kH)))) /
                         (12.0 * kH);
  // The parabola closing s - (closing - end) s^2 from s = 0 to 1.
  double most = end;
  const double s = 0.5 * closing / (closing - end);
  if (closing > 0.0 && s > 0.0 && s < 1.0) most = s * (closing - (closing - end) * s);
  return most;
}

bool ReferenceGdp::goes_through(int digit, const DigitAngles& angle) const {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    if (gap(digit, k, angle, 1e-9) == 0.0) return true;
  }
  return false;
}

bool ReferenceGdp::nearer_pushes(int digit, int k, const DigitAngles& gdp, const DigitAngles& hcp,
                                 const ReferenceState& at) const {
  for (int nearer = 0; nearer < k; ++nearer) {
    const ReferenceRecord& other = at.record[idx(segment_index(digit, nearer))];
    if (other.active && penetration(digit, nearer, other, gdp, hcp) - other.offset > 0.0) return true;
  }
  return false;
}

ReferenceGdp::Begin ReferenceGdp::begin(const ReferenceState& at, int digit) const {
  Begin out;
  const DigitAngles gdp = digit_angles(at.angle, digit);
  const DigitAngles hcp = digit_angles(at.hcp_angle, digit);
  out.lagged = at.started[idx(digit)] && gdp != hcp;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const ReferenceRecord& record = at.record[idx(segment_index(digit, k))];
    if (!record.active || at.inside[idx(digit)]) continue;
    out.depth[idx(k)] = std::max(0.0, penetration(digit, k, record, gdp, hcp) - record.offset);
  }
  return out;
}

double ReferenceGdp::faded(int digit, int k, const ReferenceRecord& record, double deep,
                           const DigitAngles& gdp, const DigitAngles& from, const DigitAngles& to) const {
  if (!record.fades) return record.offset;
  const double now = penetration(digit, k, record, gdp, to);
  if (now <= 0.0) return 0.0;
  constexpr double kShare = 0.2;  // "for each millimetre ... by 0.2 mm"
  const double gone = (pose(digit, k, to) * record.p_S - pose(digit, k, from) * record.p_S).norm();
  const double aside = now > deep ? std::max(0.0, gone - (now - deep)) : gone;
  const double left = std::max(0.0, record.offset - kShare * aside);
  return now < deep ? left * now / deep : left;
}

void ReferenceGdp::set_offset(int digit, int k, const Begin& start, const DigitAngles& gdp,
                              const DigitAngles& hcp, const DigitAngles& hcp_end,
                              ReferenceRecord& fresh) const {
  if (parameters_.depth == DepthOrigin::kS1) return;
  const bool pushes = nearer_pushes(digit, k, gdp, hcp, state);
  if (!pushes && !start.lagged) return;
  fresh.offset = std::max(0.0, penetration(digit, k, fresh, gdp, hcp) - start.depth[idx(k)]);
  fresh.fades = !pushes || !nearer_pushes(digit, k, gdp, hcp_end, state);
}

ReferencePatch ReferenceGdp::patch(int digit, int k, const DigitAngles& angle,
                                   const DigitAngles* rate) const {
  const double margin = parameters_.margin + 1e-12;  // of what was found at the margin, to rounding
  ReferencePatch out;
  std::vector<Pair> pairs;
  for_each_pair(digit, k, angle, margin + kTieBand, [&](const Pair& pair) {
    pairs.push_back(pair);
    return margin + kTieBand;
  });
  std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
  if (rate != nullptr) {
    // Walls that the segment does not run into are left out.
    const auto closes = [&](const Pair& p) {
      return closing_speed(digit, k, angle, *rate, p.direction(), p.on_a);
    };
    double fastest = 0.0;
    Vec3& lead = out.lead_direction;
    for (const Pair& pair : pairs) {
      if (pair.distance > margin || closes(pair) <= fastest) continue;
      fastest = closes(pair);
      lead = pair.direction();
      out.lead = pair.on_a;
      out.leads = true;
    }
    for (const Pair& pair : pairs) {
      if (pair.distance > margin || closes(pair) < (1.0 - 1e-6) * fastest) continue;
      out.lead_extent = std::max(out.lead_extent, (pair.on_a - out.lead).norm());
    }
    if (fastest > 0.0) {
      std::erase_if(pairs, [&](const Pair& pair) {
        return angle_apart(pair.direction(), lead) > kFarthestTurn && closes(pair) < 0.5 * fastest;
      });
    }
  }
  if (pairs.empty() || pairs.front().distance > margin) return out;
  out.any = true;
  out.distance = pairs.front().distance;
  const double limit = out.distance + kTieBand;
  std::erase_if(pairs, [&](const Pair& pair) { return pair.distance > limit; });

  // Places: pairs whose points lie together on both bodies. They count in the direction of the nearest.
  const double together = std::sqrt(limit * limit - out.distance * out.distance);
  const auto apart = [](const Pair& x, const Pair& y) {
    return std::max((x.on_a - y.on_a).norm(), (x.on_b - y.on_b).norm());
  };
  std::vector<Pair> place;
  std::vector<std::size_t> place_of;
  Vec3 on_object = Vec3::Zero();
  Vec3 direction = Vec3::Zero();
  double weight = 0.0;
  for (const Pair& pair : pairs) {
    const std::array<Vec3, 3>& theirs = object_[pair.theirs].corner;
    Region region = tied_place(pair.a, theirs, {pair.on_a, pair.on_b}, limit);
    region.weight *= (limit - pair.distance) / kTieBand;
    std::size_t at = 0;
    while (at < place.size() && apart(place[at], pair) > together) ++at;
    if (at == place.size()) place.push_back(pair);
    place_of.push_back(at);
    out.on_segment += region.weight * region.on_a;
    on_object += region.weight * region.on_b;
    direction += region.weight * place[at].direction();
    weight += region.weight;
  }
  for (std::size_t x = 0; x < pairs.size(); ++x) {
    for (std::size_t y = 0; y < x; ++y) {
      out.extent = std::max(out.extent, (pairs[x].on_a - pairs[y].on_a).norm());
      const bool clear = place_of[x] == place_of[y] ? apart(pairs[x], pairs[y]) < 0.999 * together
                                                    : apart(pairs[x], pairs[y]) > 1.001 * together;
      if (!clear) out.doubt = std::max(out.doubt, angle_apart(pairs[x].direction(), pairs[y].direction()));
    }
  }
  out.on_segment /= weight;
  on_object /= weight;
  out.n_c = direction.norm() > 0.1 * weight ? Vec3(direction.normalized()) : pairs.front().direction();
  out.force_normal = parameters_.normal == ForceNormal::kContact
                         ? out.n_c
                         : object_normal(pairs, on_object, out.n_c, out.normal_doubt);
  return out;
}

Vec3 ReferenceGdp::object_normal(const std::vector<Pair>& tied, const Vec3& contact, const Vec3& n_c,
                                 double& doubt) const {
  struct Foot {
    std::size_t triangle;
    Vec3 at;
    Vec3 normal;
    double apart;
  };
  std::vector<Foot> feet;
  for (const Pair& pair : tied) {
    if (std::any_of(feet.begin(), feet.end(), [&](const Foot& f) { return f.triangle == pair.theirs; }))
      continue;
    const ThreeCorners& t = object_[pair.theirs].corner;
    Vec3 at;
    if (!foot_inside(contact, t, at)) {
      at = on_edge(contact, t[0], t[1]);
      for (const Vec3& x : {on_edge(contact, t[1], t[2]), on_edge(contact, t[2], t[0])})
        if ((x - contact).norm() < (at - contact).norm()) at = x;
    }
    Vec3 normal = Vec3::Zero();
    const double area = (t[1] - t[0]).cross(t[2] - t[0]).norm();
    for (std::size_t i = 0; i < 3; ++i) {
      const double share = (t[(i + 1) % 3] - at).cross(t[(i + 2) % 3] - at).norm() / area;
      normal += share * normals_.corner[pair.theirs][i];
    }
    normal.normalize();
    // Weights shift by no more than the way beside the triangle, in heights of it.
    double longest = 0.0;
    double spread = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, (t[(i + 1) % 3] - t[i]).norm());
      spread = std::max(
          spread, angle_apart(normals_.corner[pair.theirs][i], normals_.corner[pair.theirs][(i + 1) % 3]));
    }
    doubt += spread * std::min(1.0, 3.0 * (at - contact).norm() * longest / area);
    if (normal.dot(n_c) < 0.0) normal = -normal;
    feet.push_back({pair.theirs, at, normal, (at - contact).norm()});
  }
  const Foot& main = *std::min_element(feet.begin(), feet.end(),
                                       [](const Foot& x, const Foot& y) { return x.apart < y.apart; });
  std::vector<Vec3> fan = {main.normal};
  const auto add = [&](const Vec3& v, double share) {
    const Vec3 mixed = main.normal + share * (v - main.normal);
    if (share > 0.0 && mixed.norm() > 1e-9) fan.push_back(mixed.normalized());
  };
  for (const Foot& foot : feet) {
    const double share = std::clamp(1.0 - (foot.apart - main.apart) / (kEdgeWidth + main.apart), 0.0, 1.0);
    add(foot.normal, share);
    const ThreeCorners& t = object_[foot.triangle].corner;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((normals_.open_edges[foot.triangle] >> i & 1U) == 0) continue;
      const Vec3 edge = (t[(i + 1) % 3] - t[i]).normalized();
      const Vec3 to_opposite = t[(i + 2) % 3] - t[i];
      const Vec3 inward = (to_opposite - to_opposite.dot(edge) * edge).normalized();
      const double depth = inward.dot(foot.at - t[i]);
      add(-inward, share * std::clamp(1.0 - depth / kEdgeWidth, 0.0, 1.0));
    }
  }
  const Vec3 n = nearest_in(fan, n_c);
  if (angle_apart(n, n_c) <= kFarthestTurn) return n;
  const Vec3 axis = n_c.cross(n);
  return axis.norm() > 1e-12 ? Vec3(rotation_about(axis.normalized(), kFarthestTurn) * n_c) : n_c;
}

void ReferenceGdp::tick(const JointArray& hcp, const std::array<bool, kDigits>& measured) {
  stops_.clear();
  for (int d = 0; d < kDigits; ++d) tick_digit(d, digit_angles(hcp, d), measured[idx(d)]);
  state.hcp_angle = hcp;
}

void ReferenceGdp::tick_digit(int digit, const DigitAngles& hcp, bool measured) {
  const auto record = [&](int k) -> ReferenceRecord& { return state.record[idx(segment_index(digit, k))]; };
  const DigitAngles hcp_from = state.started[idx(digit)] ? digit_angles(state.hcp_angle, digit) : hcp;
  const DigitAngles from = digit_angles(state.angle, digit);
  DigitAngles angle = from;
  int fixed = 0;
  const Begin start_of_tick = begin(state, digit);
  std::array<DigitAngles, kSegmentsPerDigit> known{};  // the HCP for which d0 of each record is known
  known.fill(digit_angles(state.hcp_angle, digit));
  const auto fade = [&](int k, double deep) {
    record(k).offset = faded(digit, k, record(k), deep, angle, known[idx(k)], hcp);
    known[idx(k)] = hcp;
  };
  const auto deep_as_known = [&](int k) { return penetration(digit, k, record(k), angle, known[idx(k)]); };
  for (int k = 0; k < kSegmentsPerDigit; ++k) {  // 1. Depth
    if (!record(k).active) continue;
    const double deep = deep_as_known(k);
    record(k).along = record(k).along && goes_through(digit, hcp);
    fade(k, deep);
    if (penetration(digit, k, record(k), angle, hcp) - record(k).offset > 0.0) fixed = k + 2;
  }
  double s = 0.0;
  while (fixed < kJointsPerDigit) {
    DigitAngles rate{};
    for (int i = fixed; i < kJointsPerDigit; ++i) rate[idx(i)] = hcp[idx(i)] - from[idx(i)];
    const int first = first_moved(rate);
    if (first == kSegmentsPerDigit) break;
    DigitAngles start = from;  // 2. Advance: what is fixed stays where it stopped
    std::copy(angle.begin(), angle.begin() + fixed, start.begin());
    const ReferenceStop stop = first_stop(digit, start, rate, s);
    if (stop.s > s) {
      for (int k = first; k < kSegmentsPerDigit; ++k) record(k).active = false;
    }
    s = stop.s;
    for (int i = fixed; i < kJointsPerDigit; ++i) angle[idx(i)] = s < 1.0 ? stop.angle[idx(i)] : hcp[idx(i)];
    if (stop.segment < 0) break;
    stops_.push_back(stop);
    ReferenceRecord& deciding = record(stop.segment);  // 3. Stop
    if (deciding.active) {
      fade(stop.segment, deep_as_known(stop.segment));
      const double deep = penetration(digit, stop.segment, deciding, angle, hcp);
      if (deep <= 0.0 || (deep <= deciding.offset && !nearer_pushes(digit, stop.segment, angle, hcp, state)))
        deciding.active = false;
    }
    const DigitAngles hcp_now = along(
        hcp_from,
        [&] {
          DigitAngles way{};
          for (std::size_t i = 0; i < way.size(); ++i) way[i] = hcp[i] - hcp_from[i];
          return way;
        }(),
        s);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if (record(k).active) continue;
      const ReferencePatch found = patch(digit, k, angle, k == stop.segment ? &rate : nullptr);
      if (!found.any) continue;
      ReferenceRecord fresh{
          true, pose(digit, k, angle).inverse() * found.on_segment, found.n_c, found.force_normal, 0.0, false,
          false};
      if (k == stop.segment && parameters_.depth == DepthOrigin::kContinuous)
        fresh.along =
            penetration(digit, k, fresh, angle, hcp) <= 0.0 && found.leads && goes_through(digit, hcp);
      if (fresh.along) {
        fresh.p_S = pose(digit, k, angle).inverse() * found.lead;
        fresh.n_c = fresh.force_normal = found.lead_direction;
      }
      set_offset(digit, k, start_of_tick, angle, hcp_now, hcp, fresh);
      record(k) = fresh;
      known[idx(k)] = hcp_now;
    }
    fixed = stop.segment + 2;  // 4. Go on
  }
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    if (record(k).active) fade(k, deep_as_known(k));
  }
  for (int i = 0; i < kJointsPerDigit; ++i) state.angle[idx(joint_index(digit, i))] = angle[idx(i)];
  const bool clear = angle == hcp;
  state.inside[idx(digit)] = !clear && (state.inside[idx(digit)] || !state.started[idx(digit)]);
  state.started[idx(digit)] = state.started[idx(digit)] || measured;
}

ReferenceCommand ReferenceGdp::command(const ReferenceState& at, const ForceLawParameters& law,
                                       const LimitParameters& limits) const {
  ReferenceCommand out;
  for (int d = 0; d < kDigits; ++d) {
    const DigitAngles gdp = digit_angles(at.angle, d);
    const DigitAngles hcp = digit_angles(at.hcp_angle, d);
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const ReferenceRecord& record = at.record[idx(segment_index(d, k))];
      if (!record.active || at.inside[idx(d)]) continue;
      double force = law.stiffness * std::max(0.0, penetration(d, k, record, gdp, hcp) - record.offset);
      if (limits.fingertip_force_enabled) force = std::min(force, limits.fingertip_force);
      out.force[idx(segment_index(d, k))] = force;
      sum += force * record.force_normal;
    }
    const bool too_much = limits.fingertip_force_enabled && sum.norm() > limits.fingertip_force;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      double& force = out.force[idx(segment_index(d, k))];
      if (too_much) force *= limits.fingertip_force / sum.norm();
      if (!(force > 0.0)) continue;
      // Virtual work: the torque of a joint is the force's work for a small turn of it, by a difference.
      const ReferenceRecord& record = at.record[idx(segment_index(d, k))];
      for (int i = 0; i < kJointsPerDigit; ++i) {
        constexpr double kH = 1e-5;
        DigitAngles plus = gdp;
        DigitAngles minus = gdp;
        plus[idx(i)] += kH;
        minus[idx(i)] -= kH;
        const Vec3 moved = pose(d, k, plus) * record.p_S - pose(d, k, minus) * record.p_S;
        out.torque[idx(joint_index(d, i))] += force * record.force_normal.dot(moved) / (2.0 * kH);
      }
    }
  }
  return out;
}

}  // namespace phalanx::test
