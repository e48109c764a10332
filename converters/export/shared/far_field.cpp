// SPDX-License-Identifier: Apache-2.0
// Declared in grid_shortcuts.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/grid_shortcuts.h"

namespace lumen::convert {

namespace {

constexpr int kCoarse = 4;  // samples of the grid along a cell: 64 of them share eight corners
/// Diagonals of a cell from its corners to the wall, from which on it is far: its points are then
/// a fifth of it from the wall or more.
constexpr double kFarDiagonals = 1.2;
constexpr int kRounds = 2;  // of taking feet from neighbours and moving them to their own places
constexpr int kMostEvaluations = 8, kMostMoves = 24;  // for a point, and for a corner
/// Shares of the radius at the wall: a foot is done if it lies this near to the wall, and if a step
/// along it would gain no more. The remaining error is of third order.
constexpr double kOffWall = 1e-3, kGain = 1e-4;
constexpr double kLongestStep = 1;  // of the radius at the wall
constexpr double kFlat = 0.02;      // least eigenvalue that a step is divided by
constexpr double kTiny = 1e-12;     // mm
constexpr double kNearer =
    1 - 1e-6;                     // of a distance: a foot is taken from a neighbour if it is less
constexpr double kLonger = 1e-4;  // of the radius: as far may a foot be beyond the one it began at
constexpr std::size_t kTogether = 32;

/// Points as libblob takes them: three doubles each.
const double (*packed(const std::vector<Eigen::Vector3d>& points))[3] {
  return reinterpret_cast<const double(*)[3]>(points.data());
}

/// Neighbours of a corner that a sweep in the order of the corners has passed.
constexpr std::array<std::array<int, 3>, 13> kPassed = {{{-1, 0, 0},
                                                         {-1, -1, 0},
                                                         {0, -1, 0},
                                                         {1, -1, 0},
                                                         {-1, -1, -1},
                                                         {0, -1, -1},
                                                         {1, -1, -1},
                                                         {-1, 0, -1},
                                                         {0, 0, -1},
                                                         {1, 0, -1},
                                                         {-1, 1, -1},
                                                         {0, 1, -1},
                                                         {1, 1, -1}}};

}  // namespace

struct FarField::Search {
  Eigen::Vector3d point;
  const Foot* from = nullptr;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the foot so far
  std::uint32_t node = 0;                        ///< its node
  double distance = -1;                          ///< mm; below 0: not found
  bool isOver = false;
};

std::size_t FarField::indexOf(int i, int j, int k) const {
  return (static_cast<std::size_t>(k) * static_cast<std::size_t>(m_lattice.size[1]) +
          static_cast<std::size_t>(j)) *
             static_cast<std::size_t>(m_lattice.size[0]) +
         static_cast<std::size_t>(i);
}

FarField::FarField(const GridSource& source, const Lattice& fine, Progress& progress)
    : m_vessels(source.vessels), m_lattice(fine) {
  m_lattice.spacing = kCoarse * fine.spacing;
  for (int& size : m_lattice.size) size = (size - 1 + kCoarse - 1) / kCoarse + 1;
  m_feet.resize(m_lattice.count());
  sampleCorners(source, progress);
  for (int round = 0; round < kRounds; ++round) takeFeetOfNeighbours(progress);
  m_isFar.assign(m_feet.size(), 0);
  const double far = kFarDiagonals * std::sqrt(3.0) * m_lattice.spacing;
  for (int k = 0; k + 1 < m_lattice.size[2]; ++k)
    for (int j = 0; j + 1 < m_lattice.size[1]; ++j)
      for (int i = 0; i + 1 < m_lattice.size[0]; ++i) {
        bool isFar = true;
        for (int corner = 0; corner < 8 && isFar; ++corner) {
          const Foot& foot =
              m_feet[indexOf(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2))];
          isFar = foot.distance > far;
        }
        m_isFar[indexOf(i, j, k)] = isFar ? 1 : 0;
      }
}

void FarField::sampleCorners(const GridSource& source, Progress& progress) {
  const auto nx = static_cast<std::size_t>(m_lattice.size[0]),
             ny = static_cast<std::size_t>(m_lattice.size[1]);
  tbb::parallel_for(std::size_t{0}, m_feet.size() / nx, [&](std::size_t row) {
    progress.check();
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < nx; ++i) points.push_back(m_lattice.at(i, row % ny, row / ny));
    std::vector<WallDistance> answers(nx);
    std::vector<WallFoot> found(nx);
    for (std::size_t begin = 0; begin < nx; begin += kTogether) {
      const std::size_t count = std::min(kTogether, nx - begin);
      const auto part = [&](auto& all) { return std::span(all).subspan(begin, count); };
      source.ask(part(points), part(answers), part(found));
    }
    for (std::size_t i = 0; i < nx; ++i) {
      Foot& foot = m_feet[row * nx + i];
      foot.distance = static_cast<double>(answers[i].distance);
      foot.at = points[i] - foot.distance * found[i].normal;
      foot.node = found[i].node;
      if (!(foot.distance > 0) || !settle(foot)) continue;
      foot.distance = std::min(foot.distance, (points[i] - foot.at).norm());
    }
  });
}

bool FarField::settle(Foot& foot) const {
  foot.isUsable = false;
  blob_sample at;
  for (int n = 0; n < kMostEvaluations; ++n) {
    blob_query(&m_vessels.model(), BLOB_BLENDED, foot.at.data(), &foot.node, &at);
    foot.at -= at.distance * Eigen::Vector3d(at.normal);
    const double radius = static_cast<double>(m_vessels.tree().radius[foot.node]);
    if (std::abs(at.distance) > kOffWall * radius) continue;
    measureBend(foot);
    break;
  }
  return foot.isUsable;
}

void FarField::measureBend(Foot& foot) const {
  std::uint32_t cursor = foot.node;
  blob_hessian local;
  blob_query_hessian(&m_vessels.model(), BLOB_BLENDED, foot.at.data(), &cursor, &local);
  const Eigen::Vector3d gradient(local.gradient);
  const double slope = gradient.norm();
  foot.isUsable = slope > 0;
  if (!foot.isUsable) return;
  const double* h = local.hessian;
  Eigen::Matrix3d hessian;
  hessian << h[0], h[3], h[4], h[3], h[1], h[5], h[4], h[5], h[2];
  foot.normal = -gradient / slope;
  foot.across = foot.normal.unitOrthogonal();
  const Eigen::Vector3d other = foot.normal.cross(foot.across);
  foot.bend[0] = -foot.across.dot(hessian * foot.across) / slope;
  foot.bend[1] = -foot.across.dot(hessian * other) / slope;
  foot.bend[2] = -other.dot(hessian * other) / slope;
}

void FarField::sweep(bool isBackward) {
  const auto inside = [](int at, int size) { return at >= 0 && at < size; };
  const int sign = isBackward ? -1 : 1;
  for (std::size_t n = 0; n < m_feet.size(); ++n) {
    const std::size_t at = isBackward ? m_feet.size() - 1 - n : n;
    Foot& own = m_feet[at];
    if (own.distance <= 0) continue;
    const auto nx = static_cast<std::size_t>(m_lattice.size[0]),
               ny = static_cast<std::size_t>(m_lattice.size[1]);
    const int i = static_cast<int>(at % nx), j = static_cast<int>(at / nx % ny),
              k = static_cast<int>(at / nx / ny);
    const Eigen::Vector3d place = m_lattice.at(at % nx, at / nx % ny, at / nx / ny);
    for (const auto& [x, y, z] : kPassed) {
      const int a = i + sign * x, b = j + sign * y, c = k + sign * z;
      if (!inside(a, m_lattice.size[0]) || !inside(b, m_lattice.size[1]) ||
          !inside(c, m_lattice.size[2]))
        continue;
      const Foot& other = m_feet[indexOf(a, b, c)];
      const double distance = (place - other.at).norm();
      if (!other.isUsable || distance >= kNearer * own.distance) continue;
      own = other;
      own.distance = distance;
      own.isInPlace = false;
    }
  }
}

void FarField::takeFeetOfNeighbours(const Progress& progress) {
  sweep(false);
  sweep(true);
  const auto nx = static_cast<std::size_t>(m_lattice.size[0]),
             ny = static_cast<std::size_t>(m_lattice.size[1]);
  tbb::parallel_for(std::size_t{0}, m_feet.size() / nx, [&](std::size_t row) {
    progress.check();
    for (std::size_t i = 0; i < nx; ++i) {
      Foot& foot = m_feet[row * nx + i];
      if (foot.isUsable && !foot.isInPlace)
        moveToItsPlace(m_lattice.at(i, row % ny, row / ny), foot);
    }
  });
}

void FarField::moveToItsPlace(const Eigen::Vector3d& corner, Foot& foot) const {
  Foot moved = foot;
  for (int n = 0; n < kMostMoves && moved.isUsable; ++n) {
    std::array<Search, 1> one{{{corner, &moved}}};
    search(one, 1);
    moved.at = one[0].at;
    moved.node = one[0].node;
    if (!settle(moved) || one[0].distance < 0) continue;
    moved.distance = (corner - moved.at).norm();
    const double radius = static_cast<double>(m_vessels.tree().radius[moved.node]);
    if (moved.distance < foot.distance + kLonger * radius) foot = moved;
    foot.isInPlace = true;
    return;
  }
}

FarField::Step FarField::stepAlong(const Foot& foot, double distance,
                                   const Eigen::Vector3d& along) {
  const Eigen::Vector3d other = foot.normal.cross(foot.across);
  const double a = 1 + distance * foot.bend[0], b = distance * foot.bend[1],
               c = 1 + distance * foot.bend[2];
  const double x = along.dot(foot.across), y = along.dot(other);
  const double mean = 0.5 * (a + c), root = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  const double determinant = a * c - b * b;
  if (mean - root > kFlat)
    return {((c * x - b * y) * foot.across + (a * y - b * x) * other) / determinant, true};
  // the foot is not nearest along one direction, which is followed downhill
  const double angle = 0.5 * std::atan2(2 * b, a - c), p = std::cos(angle), q = std::sin(angle);
  const double first = (p * x + q * y) / std::max(std::abs(mean + root), kFlat),
               second = (p * y - q * x) / std::max(std::abs(mean - root), kFlat);
  return {(first * p - second * q) * foot.across + (first * q + second * p) * other, false};
}

void FarField::improve(Search& search, const Eigen::Vector3d& at, double above,
                       const Eigen::Vector3d& normal, std::uint32_t node) const {
  const double radius = static_cast<double>(m_vessels.tree().radius[node]);
  const Eigen::Vector3d foot = at - above * normal, to = search.point - foot;
  const double distance = to.dot(normal);
  const Eigen::Vector3d along = to - distance * normal;
  const Step step = stepAlong(*search.from, distance, along);
  const double length = step.along.norm();
  search.isOver = !(distance > 0);
  search.at = foot + std::min(1.0, kLongestStep * radius / std::max(length, kTiny)) * step.along;
  search.node = node;
  const double gain = along.dot(step.along);  // twice that of the distance, times it
  if (search.isOver || !step.isSound || std::abs(above) > kOffWall * radius ||
      std::abs(gain) > 2 * kGain * radius * distance)
    return;
  search.isOver = true;
  const double found = std::sqrt(std::max(0.0, to.squaredNorm() - gain));
  if (found < (search.point - search.from->at).norm() + kLonger * radius) search.distance = found;
}

void FarField::search(std::span<Search> searches, int evaluations) const {
  std::vector<Eigen::Vector3d> places;
  std::vector<std::uint32_t> cursors;
  std::vector<blob_sample> samples;
  std::vector<Search*> open;
  for (Search& one : searches) {
    const Eigen::Vector3d to = one.point - one.from->at;
    const double distance = to.dot(one.from->normal);
    const Eigen::Vector3d along = to - distance * one.from->normal;
    const Step step = stepAlong(*one.from, distance, along);
    const double radius = static_cast<double>(m_vessels.tree().radius[one.from->node]);
    const double longest = kLongestStep * radius / std::max(step.along.norm(), kTiny);
    one.at = one.from->at + std::min(1.0, longest) * step.along;
    one.node = one.from->node;
    open.push_back(&one);
  }
  for (int n = 0; n < evaluations && !open.empty(); ++n) {
    places.clear();
    cursors.clear();
    for (const Search* one : open) {
      places.push_back(one->at);
      cursors.push_back(one->node);
    }
    samples.resize(open.size());
    blob_query_many(&m_vessels.model(), BLOB_BLENDED, open.size(), packed(places), cursors.data(),
                    samples.data());
    for (std::size_t k = 0; k < open.size(); ++k)
      improve(*open[k], places[k], samples[k].distance, Eigen::Vector3d(samples[k].normal),
              samples[k].node);
    std::erase_if(open, [](const Search* one) { return one->isOver; });
  }
}

const FarField::Foot* FarField::startOf(const Eigen::Vector3d& point) const {
  std::array<int, 3> cell{};
  for (int a = 0; a < 3; ++a) {
    const double at = (point[a] - m_lattice.first[a]) / m_lattice.spacing;
    const int last = m_lattice.size[static_cast<std::size_t>(a)] - 2;
    if (!(at >= 0 && at <= last + 1)) return nullptr;
    cell[static_cast<std::size_t>(a)] = std::min(static_cast<int>(at), last);
  }
  if (m_isFar[indexOf(cell[0], cell[1], cell[2])] == 0) return nullptr;
  const Foot* best = nullptr;
  double least = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Foot& foot = m_feet[indexOf(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                                      cell[2] + (corner >> 2))];
    const double distance = (point - foot.at).squaredNorm();
    if (!foot.isUsable || (best && distance >= least)) continue;
    best = &foot;
    least = distance;
  }
  return best;
}

void FarField::answer(std::span<const Eigen::Vector3d> points, std::span<WallDistance> answers,
                      std::span<char> isAnswered) const {
  std::vector<Search> searches;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    answers[i].distance = std::numeric_limits<float>::infinity();
    isAnswered[i] = 0;
    const Foot* start = startOf(points[i]);
    if (!start) continue;
    searches.push_back({points[i], start});
    chosen.push_back(i);
  }
  search(searches, kMostEvaluations);
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const Search& one = searches[n];
    const bool isFound = one.distance >= 0;
    const double distance = isFound ? one.distance : (one.point - one.from->at).norm();
    answers[chosen[n]] = {static_cast<float>(distance),
                          m_vessels.tree().branch[isFound ? one.node : one.from->node]};
    isAnswered[chosen[n]] = isFound ? 1 : 0;
  }
}

}  // namespace lumen::convert
