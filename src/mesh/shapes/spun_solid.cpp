// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/spun_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mesh/shapes/mesh_builder.h"

namespace phalanx::mesh {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Length along a piece over f, sampled once.
class ArcTable {
 public:
  explicit ArcTable(const ProfilePiece& piece) {
    Eigen::Vector2d last = piece.rz(0.0);
    for (int i = 1; i <= kParts; ++i) {
      const Eigen::Vector2d p = piece.rz(static_cast<double>(i) / kParts);
      length_.push_back(length_.back() + (p - last).norm());
      last = p;
    }
  }
  [[nodiscard]] double length() const { return length_.back(); }
  /// Returns f at the share s of the length.
  [[nodiscard]] double at(double s) const {
    const double wanted = s * length();
    const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, wanted);
    const auto k = static_cast<double>(above - length_.begin() - 1);
    return (k + (wanted - *(above - 1)) / (*above - *(above - 1))) / kParts;
  }

 private:
  static constexpr int kParts = 512;
  std::vector<double> length_{0.0};
};

struct SpunRow {
  std::size_t piece;
  double f;
  int around;
};

struct Grid {
  int around = 0;     // at the widest place
  double edge = 0.0;  // along the profile [m]
};

class Spinner {
 public:
  Spinner(const SpunShape& shape, bool smooth) : shape_(shape), smooth_(smooth) {
    for (const ProfilePiece& piece : shape.pieces()) {
      tables_.emplace_back(piece);
      for (int i = 0; i <= 8; ++i) {
        const Eigen::Vector2d rz = piece.rz(i / 8.0);
        const Eigen::Vector2d next = piece.rz(std::min(1.0, (i + 1) / 8.0));
        widest_ = std::max(widest_, rz.x());
        area_ += kTurn * 0.5 * (rz.x() + next.x()) * (next - rz).norm();
      }
    }
  }

  /// Returns all rows between the poles.
  [[nodiscard]] std::vector<SpunRow> rows(const Grid& grid) const {
    std::vector<SpunRow> rows;
    const std::size_t pieces = shape_.pieces().size();
    for (std::size_t p = 0; p < pieces; ++p) {
      const int bands = std::max(least_bands(shape_.pieces()[p]),
                                 static_cast<int>(std::lround(tables_[p].length() / grid.edge)));
      for (int i = 1; i <= bands; ++i) {
        if (p + 1 == pieces && i == bands) break;  // the pole
        const double f = i == bands ? 1.0 : tables_[p].at(static_cast<double>(i) / bands);
        rows.push_back({p, f, count_around(shape_.pieces()[p].rz(f).x(), grid.around)});
      }
    }
    return rows;
  }

  [[nodiscard]] static int count(const std::vector<SpunRow>& rows) {
    int triangles = rows.front().around + rows.back().around;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) triangles += rows[i].around + rows[i + 1].around;
    return triangles;
  }

  /// Returns the grid nearest to the wanted count. Among grids within 2 % it is the one with
  /// the squarest cells.
  [[nodiscard]] Grid choose(int triangles) const {
    const int step = shape_.has_lobes() ? 8 : 4;
    const double square = std::sqrt(2.0 * area_ / triangles);
    const int middle = round_to(kTurn * widest_ / square, step, least_around());
    Grid best;
    double least_cost = std::numeric_limits<double>::infinity();
    for (int around = std::max(least_around(), middle - 3 * step); around <= middle + 3 * step;
         around += step) {
      const double cell = kTurn * widest_ / around;
      for (double stretch = 0.4; stretch < 60.0; stretch *= 1.04) {
        const Grid grid{around, cell * stretch};
        const double miss = std::abs(static_cast<double>(count(rows(grid))) - triangles) / triangles;
        const double cost = (miss > 0.02 ? 100.0 * miss : 0.0) + std::abs(std::log(stretch));
        if (cost < least_cost) {
          least_cost = cost;
          best = grid;
        }
        if (grid.edge > longest()) break;  // longer edges change nothing
      }
    }
    return best;
  }

  [[nodiscard]] TriangleMesh build(const Grid& grid) const {
    const auto direction = [](int j, int n) { return unit_circle(j, n); };
    MeshBuilder builder;
    const std::size_t last_piece = shape_.pieces().size() - 1;
    const std::int32_t lower = builder.vertex(shape_.point({1.0, 0.0}, 0, 0.0));
    Ring last;
    for (const SpunRow& row : rows(grid)) {
      Ring ring = builder.ring(
          row.around, [&](int j) { return shape_.point(direction(j, row.around), row.piece, row.f); });
      if (last.empty()) {
        builder.close_below(lower, ring);
      } else {
        builder.strip(last, ring);
      }
      last = std::move(ring);
    }
    builder.close_above(last, builder.vertex(shape_.point({1.0, 0.0}, last_piece, 1.0)));
    return builder.take();
  }

 private:
  /// Returns the least number of bands of a piece. In a smooth solid neighbours meet below 30 degrees, with a
  /// reserve for uneven curvature.
  [[nodiscard]] int least_bands(const ProfilePiece& piece) const {
    constexpr double kSmooth = 23.0 * std::numbers::pi / 180.0;
    constexpr double kCoarse = 46.0 * std::numbers::pi / 180.0;
    return std::max(1, static_cast<int>(std::ceil(piece.turn / (smooth_ ? kSmooth : kCoarse) - 1e-9)));
  }
  [[nodiscard]] int least_around() const {
    if (shape_.has_lobes()) return smooth_ ? 48 : 16;
    return smooth_ ? 16 : 8;
  }
  [[nodiscard]] double longest() const {
    double length = 0.0;
    for (const ArcTable& table : tables_) length = std::max(length, table.length());
    return 2.0 * length;
  }
  /// Returns the number of points around a row. It is halved towards the axis while the edges would be too
  /// short, unless that would break a round part.
  [[nodiscard]] int count_around(double r, int around) const {
    constexpr double kNarrowest = 0.36;  // shortest edge, relative to that at the widest place
    const int step = shape_.has_lobes() ? 8 : 4;
    const int least = std::min(around, least_around());
    double n = around;
    while (0.5 * n >= least && r / n < kNarrowest * widest_ / around) n *= 0.5;
    return round_to(n, step, least);
  }

  const SpunShape& shape_;
  bool smooth_;
  std::vector<ArcTable> tables_;
  double widest_ = 0.0;
  double area_ = 0.0;
};

}  // namespace

TriangleMesh make_spun_solid(const SpunShape& shape, int triangles, const char* maker) {
  require_triangles(triangles, maker);
  constexpr double kNearEnough = 0.10;
  const Spinner smooth(shape, true);
  const Grid grid = smooth.choose(triangles);
  const double count = Spinner::count(smooth.rows(grid));
  if (std::abs(count - triangles) <= kNearEnough * triangles) return smooth.build(grid);
  const Spinner coarse(shape, false);
  return coarse.build(coarse.choose(triangles));
}

}  // namespace phalanx::mesh
