// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/xray/lumen_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kBall = 2;          // radii: a model's wall in its own cell does not reach beyond
constexpr double kStepRadii = 0.25;  // between samples of the distance
constexpr int kSecants = 3;          // refinements of a change of sign
constexpr int kRowsOfTile = 8;

/// Half-space, X . across <= level, in which a node's power is at most that of a neighbour.
struct Side {
  Vector3d across;
  double level;
};

struct Ball {
  std::uint32_t node = 0;
  Vector3d centre = Vector3d::Zero();  ///< from the source
  double radius = 0;                   ///< of the node, mm
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;  ///< pixels that may see it, the last ones excluded
  std::vector<Side> sides;
};

/// The pixels, of `count`, whose rays may meet a ball: `offset` and `depth` of its centre from the
/// source; `sign`: of the pixels' direction.
std::pair<int, int> pixelsOf(double offset, double depth, double ball, double sign, int count,
                             const XrayView& view) {
  const double angle = std::atan2(sign * offset, depth);
  const double half = std::asin(std::min(1.0, ball / std::hypot(offset, depth)));
  const auto at = [&](double a) {
    const double place = view.sourceToDetector * std::tan(std::clamp(a, -1.57, 1.57)) / view.pixel;
    return std::clamp(place + 0.5 * count, -1.0, count + 1.0);
  };
  return {std::max(0, static_cast<int>(std::floor(at(angle - half) - 0.5))),
          std::min(count, static_cast<int>(std::ceil(at(angle + half) + 0.5)))};
}

std::vector<Ball> ballsOf(const formats::CenterlineTree& tree, const blob_model* model,
                          const XrayView& view) {
  std::vector<Ball> balls(tree.nodeCount());
  const Vector3d source = view.source(), right = view.right(), up = view.up(),
                 towards = view.towards();
  for (std::uint32_t n = 0; n < balls.size(); ++n) {
    Ball& ball = balls[n];
    ball.node = n;
    ball.radius = double{tree.radius[n]};
    ball.centre = toEigen(tree.centre[n]) - source;
    const double depth = towards.dot(ball.centre), reach = kBall * ball.radius;
    std::tie(ball.x0, ball.x1) =
        pixelsOf(right.dot(ball.centre), depth, reach, 1, view.width, view);
    std::tie(ball.y0, ball.y1) = pixelsOf(up.dot(ball.centre), depth, reach, -1, view.height, view);
    std::vector<std::uint32_t> neighbours(blob_model_neighbours(model, n, nullptr, 0));
    blob_model_neighbours(model, n, neighbours.data(), neighbours.size());
    for (const std::uint32_t other : neighbours) {
      const Vector3d across = toEigen(tree.centre[other]) - toEigen(tree.centre[n]);
      const double r = double{tree.radius[other]};
      ball.sides.push_back(
          {across, 0.5 * (across.squaredNorm() - r * r + ball.radius * ball.radius) +
                       across.dot(ball.centre)});
    }
  }
  return balls;
}

/// A ray through a ball's cell, and its samples among those of the batch.
struct Passage {
  std::uint32_t pixel = 0;  ///< of the tile
  Vector3d direction = Vector3d::Zero();
  double from = 0, step = 0;  ///< mm
  std::size_t first = 0;
  std::uint32_t samples = 0;
};

/// A change of sign between two places, at which the distance is `low` and `high`.
struct Change {
  std::uint32_t passage = 0;
  double from = 0, to = 0, low = 0, high = 0, at = 0;
};

/// Places on rays whose distances are asked for at once.
class Batch {
public:
  Batch(const blob_model* model, const Vector3d& source) : m_model(model), m_source(source) {}

  void clear() { m_point.clear(); }
  [[nodiscard]] std::size_t size() const { return m_point.size(); }
  void add(const Vector3d& direction, double along) {
    m_point.push_back(m_source + along * direction);
  }
  /// The distances of all places; the cursor of each is held at the node.
  const std::vector<double>& ask(std::uint32_t node) {
    m_distance.resize(m_point.size());
    m_cursor.assign(m_point.size(), node);
    if (m_point.empty()) return m_distance;
    blob_columns columns = blob_columns_default();
    columns.count = m_point.size();
    for (int a = 0; a < 3; ++a) columns.point[a] = m_point[0].data() + a;
    columns.point_stride = sizeof(Vector3d);
    columns.cursor = m_cursor.data();
    columns.distance = m_distance.data();
    blob_query_columns(m_model, BLOB_BLENDED | BLOB_HOLD, &columns);
    return m_distance;
  }

private:
  const blob_model* m_model;
  Vector3d m_source;
  std::vector<Vector3d> m_point;
  std::vector<std::uint32_t> m_cursor;
  std::vector<double> m_distance;
};

struct PixelChord {
  std::uint32_t pixel = 0;
  Chord chord;
};

/// Some rows of the detector.
class Tile {
public:
  Tile(const XrayView& view, const blob_model* model, int firstRow, int lastRow)
      : m_view(view),
        m_first(firstRow),
        m_last(lastRow),
        m_batch(model, view.source()),
        m_finer(model, view.source()) {
    for (int y = firstRow; y < lastRow; ++y)
      for (int x = 0; x < view.width; ++x)
        m_direction.push_back((view.pixelPlace(x, y) - view.source()).normalized());
  }

  void meet(const Ball& ball) {
    m_passages.clear();
    m_batch.clear();
    for (int y = std::max(ball.y0, m_first); y < std::min(ball.y1, m_last); ++y)
      for (int x = ball.x0; x < ball.x1; ++x) enter(ball, pixelOf(x, y));
    const std::vector<double>& distance = m_batch.ask(ball.node);
    m_changes.clear();
    for (std::uint32_t p = 0; p < m_passages.size(); ++p) findChanges(p, distance);
    for (int i = 0; i < kSecants; ++i) refine(ball.node);
    addChords(distance);
  }

  void hand(const TakeRay& take) {
    std::sort(m_chords.begin(), m_chords.end(), [](const PixelChord& a, const PixelChord& b) {
      return std::tie(a.pixel, a.chord.from, a.chord.to) <
             std::tie(b.pixel, b.chord.from, b.chord.to);
    });
    std::vector<Chord> merged;
    auto next = m_chords.begin();
    for (int y = m_first; y < m_last; ++y)
      for (int x = 0; x < m_view.width; ++x) {
        merged.clear();
        for (; next != m_chords.end() && next->pixel == pixelOf(x, y); ++next) {
          if (!merged.empty() && next->chord.from <= merged.back().to)
            merged.back().to = std::max(merged.back().to, next->chord.to);
          else
            merged.push_back(next->chord);
        }
        take(x, y, merged);
      }
  }

private:
  [[nodiscard]] std::uint32_t pixelOf(int x, int y) const {
    return static_cast<std::uint32_t>((y - m_first) * m_view.width + x);
  }

  /// Samples where the ray of a pixel runs in the ball and on the near side of all neighbours.
  void enter(const Ball& ball, std::uint32_t pixel) {
    const Vector3d& direction = m_direction[pixel];
    const double middle = direction.dot(ball.centre), reach = kBall * ball.radius;
    const double rest = reach * reach - (ball.centre.squaredNorm() - middle * middle);
    if (!(rest > 0)) return;
    double from = middle - std::sqrt(rest), to = middle + std::sqrt(rest);
    for (const Side& side : ball.sides) {
      const double slope = side.across.dot(direction);
      if (slope > 0)
        to = std::min(to, side.level / slope);
      else if (slope < 0)
        from = std::max(from, side.level / slope);
      else if (side.level < 0)
        return;
      if (!(from < to)) return;
    }
    const auto steps =
        static_cast<std::uint32_t>(std::ceil((to - from) / (kStepRadii * ball.radius)));
    Passage& passage = m_passages.emplace_back();
    passage = {pixel, direction, from, (to - from) / steps, m_batch.size(), steps + 1};
    for (std::uint32_t i = 0; i <= steps; ++i) m_batch.add(direction, from + i * passage.step);
  }

  void findChanges(std::uint32_t index, const std::vector<double>& distance) {
    const Passage& p = m_passages[index];
    for (std::uint32_t i = 0; i + 1 < p.samples; ++i) {
      const double low = distance[p.first + i], high = distance[p.first + i + 1];
      if ((low < 0) == (high < 0)) continue;
      m_changes.push_back({index, p.from + i * p.step, p.from + (i + 1) * p.step, low, high, 0});
      setSecant(m_changes.back());
    }
  }

  static void setSecant(Change& c) { c.at = c.from + (c.to - c.from) * c.low / (c.low - c.high); }

  void refine(std::uint32_t node) {
    m_finer.clear();
    for (const Change& c : m_changes) m_finer.add(m_passages[c.passage].direction, c.at);
    const std::vector<double>& distance = m_finer.ask(node);
    for (std::size_t i = 0; i < m_changes.size(); ++i) {
      Change& c = m_changes[i];
      if ((distance[i] < 0) == (c.low < 0))
        c.from = c.at, c.low = distance[i];
      else
        c.to = c.at, c.high = distance[i];
      if (c.low != c.high) setSecant(c);
    }
  }

  void addChords(const std::vector<double>& distance) {
    auto change = m_changes.begin();
    for (std::uint32_t index = 0; index < m_passages.size(); ++index) {
      const Passage& p = m_passages[index];
      bool isInside = distance[p.first] < 0;
      double from = p.from;
      for (; change != m_changes.end() && change->passage == index; ++change) {
        if (isInside) m_chords.push_back({p.pixel, {from, change->at}});
        from = change->at;
        isInside = !isInside;
      }
      if (isInside) m_chords.push_back({p.pixel, {from, p.from + p.step * (p.samples - 1)}});
    }
  }

  const XrayView& m_view;
  int m_first, m_last;
  std::vector<Vector3d> m_direction;
  Batch m_batch, m_finer;
  std::vector<Passage> m_passages;
  std::vector<Change> m_changes;
  std::vector<PixelChord> m_chords;
};

}  // namespace

LumenRays::LumenRays(const formats::Case& source)
    : m_tree(source.tree), m_model(openModels(source)) {}

void LumenRays::cast(const XrayView& view, Progress& progress, const TakeRay& take) const {
  requireBetween(m_tree, view);
  const std::vector<Ball> balls = ballsOf(m_tree, m_model.get(), view);
  const int tiles = (view.height + kRowsOfTile - 1) / kRowsOfTile;
  tbb::parallel_for(0, tiles, [&](int index) {
    const int first = index * kRowsOfTile, last = std::min(view.height, first + kRowsOfTile);
    Tile tile(view, m_model.get(), first, last);
    for (const Ball& ball : balls) {
      if (progress.cancelled()) return;
      if (ball.y0 < last && ball.y1 > first) tile.meet(ball);
    }
    tile.hand(take);
  });
  progress.check();
}

}  // namespace lumen::convert
