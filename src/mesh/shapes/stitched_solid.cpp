// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/stitched_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "mesh/shapes/annulus.h"
#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/wall_hole.h"

namespace phalanx::mesh {
namespace {

struct Row {
  double t = 0.0;
  int around = 0;
};

/// Rows between the poles, and which of them bound the wall.
struct Rows {
  std::vector<Row> rows;
  std::size_t wall_first = 0;
  std::size_t wall_last = 0;
};

/// Returns the number of points around a row of radius r: `around` on and near the wall, halved towards the
/// axis while the edges would be too short.
int count_around(double r, double widest, const Resolution& resolution) {
  constexpr double kNarrowest = 0.36;  // shortest edge, relative to that at the widest place
  double n = resolution.around;
  while (n >= 8.0 && r / n < kNarrowest * widest / resolution.around) n *= 0.5;
  return round_to(n, 4, 4);
}

Rows lay_rows(const RevolvedSurface& surface, const Resolution& resolution) {
  const auto curve = [&](double t) {
    const Eigen::Vector2d rz = surface.profile(t);
    return Vec3{rz.x(), 0.0, rz.y()};
  };
  const int pieces = static_cast<int>(surface.least_bands.size());
  double widest = 0.0;
  for (int t = surface.wall_begin; t <= surface.wall_end; ++t)
    widest = std::max(widest, surface.profile(t).x());
  Rows out;
  for (int piece = 0; piece < pieces; ++piece) {
    const double length = arc_length(curve, piece, piece + 1);
    const int bands =
        round_to(length / resolution.edge, 1, surface.least_bands[static_cast<std::size_t>(piece)]);
    const bool wall = piece >= surface.wall_begin && piece < surface.wall_end;
    if (piece == surface.wall_begin) out.wall_first = out.rows.size() - 1;
    if (wall) out.rows.back().around = resolution.around;
    const std::vector<double> at = equal_arcs(curve, piece, piece + 1, bands);
    for (std::size_t i = 1; i < at.size(); ++i) {
      const bool pole = piece + 1 == pieces && i + 1 == at.size();
      const int around =
          wall ? resolution.around : count_around(surface.profile(at[i]).x(), widest, resolution);
      if (!pole) out.rows.push_back({at[i], around});
    }
    if (piece + 1 == surface.wall_end) out.wall_last = out.rows.size() - 1;
  }
  return out;
}

/// Returns v at which the curve of constant a crosses the wall between v = 1/2 (outside) and v
/// = `end` (inside).
std::optional<double> crossing(const RevolvedSurface& surface, const Tube& tube, double a, double end) {
  const auto outside = [&](double v) { return surface.outside_wall(tube.point(a, v)); };
  constexpr int kSteps = 48;
  double out = 0.5;
  for (int i = 1; i <= kSteps; ++i) {
    double in = 0.5 + (end - 0.5) * i / kSteps;
    if (outside(in) > 0.0) {
      out = in;
      continue;
    }
    for (;;) {
      const double middle = 0.5 * (out + in);
      if (middle == out || middle == in) return in;
      (outside(middle) > 0.0 ? out : in) = middle;
    }
  }
  // An end may touch the wall up to rounding.
  constexpr double kTouch = 1e-9;
  if (outside(end) < kTouch) return end;
  return std::nullopt;
}

std::optional<TubeCurves> lay_curves(const RevolvedSurface& surface, const Tube& tube, int around) {
  TubeCurves curves;
  curves.a = equal_arcs([&](double a) { return tube.point(a, 0.5); }, 0.0, 1.0, around);
  curves.a.pop_back();
  curves.a[curves.a.size() / 2] = 0.5;
  for (const double a : curves.a) {
    const auto from = crossing(surface, tube, a, 0.0);
    const auto to = tube.returns ? crossing(surface, tube, a, 1.0) : std::optional<double>(1.0);
    if (!from || !to) return std::nullopt;
    curves.start.push_back(*from);
    curves.end.push_back(*to);
  }
  return curves;
}

class Stitcher {
 public:
  Stitcher(const RevolvedSurface& surface, const Resolution& resolution)
      : surface_(surface), resolution_(resolution), rows_(lay_rows(surface, resolution)) {}

  bool add_tube(const Tube& tube, CurveCache::value_type& known_curves) {
    const auto section = [&](double a) { return tube.point(a, 0.5); };
    const double perimeter = arc_length(section, 0.0, 1.0);
    const int around = round_to(perimeter / resolution_.edge, 2, tube.least_around);
    auto known = known_curves.find(around);
    if (known == known_curves.end())
      known = known_curves.emplace(around, lay_curves(surface_, tube, around)).first;
    if (!known->second) return false;
    const auto& [a, start, end] = *known->second;
    const std::size_t n = a.size();
    const auto at = [&](std::size_t k, double w) {
      return tube.point(a[k], start[k] + w * (end[k] - start[k]));
    };
    // Rings have equal spacing along the mean of the tube's two sides.
    const auto spine = [&](double w) { return Vec3(0.5 * (at(0, w) + at(n / 2, w))); };
    const double length = arc_length(spine, 0.0, 1.0);
    const double along_edge = std::sqrt(resolution_.edge * perimeter / around);
    const int along = round_to(length / along_edge, 1, tube.least_along);
    std::vector<double> w = equal_arcs(spine, 0.0, 1.0, along);
    if (tube.keep) {
      const double kept = (*tube.keep - start[n / 2]) / (end[n / 2] - start[n / 2]);
      auto nearest = std::min_element(w.begin() + 1, w.end() - 1, [&](double x, double y) {
        return std::abs(x - kept) < std::abs(y - kept);
      });
      *nearest = kept;
    }
    std::vector<Ring> rings;
    for (const double wi : w)
      rings.push_back(
          builder_.ring(static_cast<int>(n), [&](int k) { return at(static_cast<std::size_t>(k), wi); }));

    // Seen from outside, the tube's start must run counter-clockwise on the wall. Its end
    // then runs clockwise.
    PlaneLoop first = on_wall(rings.front());
    if (area(first) < 0.0) {
      for (Ring& ring : rings) std::reverse(ring.begin(), ring.end());
      first = on_wall(rings.front());
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) builder_.strip(rings[i], rings[i + 1]);
    loops_.push_back(std::move(first));
    if (tube.returns) {
      loops_.push_back(on_wall(Ring(rings.back().rbegin(), rings.back().rend())));
    } else {
      close_tip(rings.back());
    }
    return true;
  }

  std::optional<TriangleMesh> finish() {
    for (const Row& row : rows_.rows) {
      rings_.push_back(builder_.ring(
          row.around, [&](int j) { return surface_.point(static_cast<double>(j) / row.around, row.t); }));
    }
    std::vector<Hole> holes;
    for (const PlaneLoop& loop : loops_) {
      auto hole = best_hole(loop);
      if (!hole) return std::nullopt;
      // Whole cells must remain between two holes. Otherwise the surface would pinch to a point or
      // an edge there.
      for (const Hole& other : holes)
        if (touch(*hole, other)) return std::nullopt;
      holes.push_back(std::move(*hole));
    }
    const std::int32_t lower = builder_.vertex(surface_.point(0.0, 0.0));
    const std::int32_t upper =
        builder_.vertex(surface_.point(0.0, static_cast<double>(surface_.least_bands.size())));
    builder_.close_below(lower, rings_.front());
    for (std::size_t i = 0; i + 1 < rings_.size(); ++i) {
      if (i < rows_.wall_first || i >= rows_.wall_last) {
        builder_.strip(rings_[i], rings_[i + 1]);
        continue;
      }
      const int band = static_cast<int>(i - rows_.wall_first);
      builder_.strip(rings_[i], rings_[i + 1], [&](int column) {
        return std::any_of(holes.begin(), holes.end(),
                           [&](const Hole& hole) { return hole.cuts(band, column, resolution_.around); });
      });
    }
    builder_.close_above(rings_.back(), upper);
    for (const Hole& hole : holes)
      for (const Triangle& t : hole.filling) builder_.triangle(t[0], t[1], t[2]);
    return builder_.take();
  }

 private:
  [[nodiscard]] int wall_bands() const { return static_cast<int>(rows_.wall_last - rows_.wall_first); }

  /// Returns the places of a ring's vertices in the wall's (column, row) plane. Columns are unwrapped about
  /// the ring's first vertex.
  PlaneLoop on_wall(const Ring& ring) const {
    PlaneLoop loop{ring, {}};
    for (const std::int32_t i : ring) {
      const Eigen::Vector2d wt = surface_.locate_on_wall(builder_.at(i));
      double column = wt.x() * resolution_.around;
      if (!loop.at.empty())
        column -= resolution_.around * std::round((column - loop.at.front().x()) / resolution_.around);
      const auto first = rows_.rows.begin() + static_cast<std::ptrdiff_t>(rows_.wall_first);
      const auto last = rows_.rows.begin() + static_cast<std::ptrdiff_t>(rows_.wall_last);
      auto above =
          std::upper_bound(first + 1, last, wt.y(), [](double t, const Row& row) { return t < row.t; });
      const auto below = above - 1;
      const double within = (wt.y() - below->t) / (above->t - below->t);
      loop.at.emplace_back(column, static_cast<double>(below - first) + within);
    }
    return loop;
  }

  static double area(const PlaneLoop& loop) {
    double twice = 0.0;
    for (std::size_t k = 0; k < loop.at.size(); ++k) {
      const auto& p = loop.at[k];
      const auto& q = loop.at[(k + 1) % loop.at.size()];
      twice += p.x() * q.y() - p.y() * q.x();
    }
    return 0.5 * twice;
  }

  /// Returns the hole for a tube's end whose filling has the best triangles, among a few margins.
  [[nodiscard]] std::optional<Hole> best_hole(const PlaneLoop& loop) const {
    std::optional<Hole> best;
    double thinnest = std::numeric_limits<double>::infinity();
    for (const double wider : {1.0, 1.3, 1.6, 1.9}) {
      auto hole = cut_hole(loop.at, wall_bands(), wider * resolution_.margin);
      if (!hole || hole->widest() >= resolution_.around) continue;
      PlaneLoop outer;
      for (const auto& [column, row] : boundary(*hole)) {
        const int n = resolution_.around;
        const Ring& ring = rings_[rows_.wall_first + static_cast<std::size_t>(row)];
        outer.ring.push_back(ring[static_cast<std::size_t>(((column % n) + n) % n)]);
        outer.at.emplace_back(column, row);
      }
      auto filling = fill_annulus(builder_, outer, loop);
      if (!filling || !(filling->thinnest < thinnest)) continue;
      thinnest = filling->thinnest;
      hole->filling = std::move(filling->triangles);
      best = std::move(hole);
    }
    return best;
  }

  bool touch(const Hole& a, const Hole& b) const {
    const int n = resolution_.around;
    for (const auto& [band, cut] : a.bands)
      for (int db = -1; db <= 1; ++db)
        for (int c = cut.begin - 1; c <= cut.end; ++c)
          if (b.cuts(band + db, ((c % n) + n) % n, n)) return true;
    return false;
  }

  /// Adds a flat disc of concentric rings inside `rim`.
  void close_tip(const Ring& rim) {
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t i : rim) centre += builder_.at(i);
    centre /= static_cast<double>(rim.size());
    double radius = 0.0;
    for (const std::int32_t i : rim) radius = std::max(radius, (builder_.at(i) - centre).norm());
    const int bands = round_to(radius / resolution_.edge, 1, 1);
    Ring last = rim;
    for (int k = bands - 1; k >= 1; --k) {
      std::size_t step = 1;  // fewer points towards the centre, if they divide the rim's
      while (rim.size() % (2 * step) == 0 && rim.size() / (2 * step) >= 4 &&
             static_cast<double>(k) / bands * static_cast<double>(step) < 0.36)
        step *= 2;
      Ring ring = builder_.ring(static_cast<int>(rim.size() / step), [&](int j) {
        const Vec3 p = builder_.at(rim[static_cast<std::size_t>(j) * step]);
        return Vec3(centre + (p - centre) * k / bands);
      });
      builder_.strip(last, ring);
      last = std::move(ring);
    }
    builder_.close_above(last, builder_.vertex(centre));
  }

  const RevolvedSurface& surface_;
  Resolution resolution_;
  Rows rows_;
  MeshBuilder builder_;
  std::vector<PlaneLoop> loops_;  // ends of the tubes on the wall
  std::vector<Ring> rings_;       // rings of the body
};

}  // namespace

std::optional<TriangleMesh> build_stitched_solid(const RevolvedSurface& surface,
                                                 const std::vector<Tube>& tubes, const Resolution& resolution,
                                                 CurveCache& cache) {
  cache.resize(tubes.size());
  Stitcher stitcher(surface, resolution);
  for (std::size_t i = 0; i < tubes.size(); ++i)
    if (!stitcher.add_tube(tubes[i], cache[i])) return std::nullopt;
  return stitcher.finish();
}

}  // namespace phalanx::mesh
