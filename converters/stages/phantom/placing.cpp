// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/placing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "converters/geometry/box.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostPieces = 600;  // of vessels, by which a place is judged
constexpr int kCoarse = 24;               // places along each axis of the volume's middle half
constexpr int kFine = 4;                  // mm around the best of them, in steps of 1 mm
constexpr double kInRadians = std::numbers::pi / 180;

struct Piece {
  Vector3d middle;  // mm
  double length = 0;
};

// Pieces of the vessels, in the order of the files.
std::vector<Piece> piecesOf(const std::vector<CenterlineFile>& files) {
  std::vector<Piece> all;
  for (const CenterlineFile& file : files)
    for (const CenterlinePoint& point : file.points) {
      if (point.parent == kNoPoint) continue;
      const Vector3d& from = file.points[static_cast<std::size_t>(point.parent)].position;
      all.push_back({0.5 * (from + point.position), (point.position - from).norm()});
    }
  const std::size_t step = all.size() / kMostPieces + 1;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < all.size(); i += step) pieces.push_back(all[i]);
  return pieces;
}

// The length of vessel in soft tissue if all pieces are moved.
double lengthInTissue(const std::vector<Piece>& pieces, const Vector3d& move, const Volume& scan,
                      const ScanLook& look) {
  const CellBox cells = scan.geometry.cells();
  double length = 0;
  for (const Piece& piece : pieces) {
    const auto cell = cells.nearest(scan.geometry.indexFromWorld(piece.middle + move));
    if (cell && look.isSoft(valueAt(scan, cells.index(*cell)))) length += piece.length;
  }
  return length;
}

// The best of the moves `start` + step * (-count .. count); the one nearest to `start` wins a tie.
Vector3d bestMove(const std::vector<Piece>& pieces, const Vector3d& start, const Vector3d& step,
                  int count, const Volume& scan, const ScanLook& look, const Progress& progress) {
  Vector3d best = start;
  double most = -1, away = 0;
  const CellBox tries = CellBox::between(Cell::Constant(-count), Cell::Constant(count));
  tries.forEach([&](const Cell& at) {
    progress.check();
    const double length =
        lengthInTissue(pieces, start + step.cwiseProduct(at.cast<double>()), scan, look);
    const auto distance = static_cast<double>(at.squaredNorm());
    if (length < most || (length == most && distance >= away)) return;
    most = length;
    away = distance;
    best = start + step.cwiseProduct(at.cast<double>());
  });
  return best;
}

Vector3d findMove(const std::vector<Piece>& pieces, const Vector3d& middle, const Volume& scan,
                  const ScanLook& look, const Progress& progress) {
  const VolumeGeometry& geometry = scan.geometry;
  const Vector3d far = geometry.cells().high().cast<double>();
  const Vector3d extent = (geometry.direction * geometry.spacing.cwiseProduct(far)).cwiseAbs();
  const Vector3d start = geometry.worldFromIndex(0.5 * far) - middle;
  const Vector3d coarse =
      bestMove(pieces, start, extent / (2 * kCoarse), kCoarse / 2, scan, look, progress);
  return bestMove(pieces, coarse, Vector3d::Ones(), kFine, scan, look, progress);
}

}  // namespace

void Placement::apply(CenterlineFile& file) const {
  for (CenterlinePoint& point : file.points)
    point.position = middle + turn * (point.position - middle) + move;
}

Placement placeTrees(const std::vector<CenterlineFile>& files, const Vector3d& degrees,
                     const std::optional<Vector3d>& move, const Volume& scan, const ScanLook& look,
                     const Progress& progress) {
  Box3d box;
  for (const CenterlineFile& file : files)
    for (const CenterlinePoint& point : file.points) box.add(point.position, point.radius);
  Placement placement;
  placement.middle = 0.5 * (box.low + box.high);
  for (int a = 0; a < 3; ++a)
    placement.turn =
        Eigen::AngleAxisd(kInRadians * degrees[a], Vector3d::Unit(a)).toRotationMatrix() *
        placement.turn;
  if (move) {
    placement.move = *move;
    return placement;
  }
  std::vector<Piece> pieces = piecesOf(files);
  for (Piece& piece : pieces)
    piece.middle = placement.middle + placement.turn * (piece.middle - placement.middle);
  placement.move = findMove(pieces, placement.middle, scan, look, progress);
  return placement;
}

BodyVessels cutToBody(const std::vector<SmoothVessel>& vessels, const VolumeGeometry& geometry,
                      const std::vector<std::uint8_t>& outerAir) {
  BodyVessels body;
  const CellBox cells = geometry.cells();
  const auto isInside = [&](const Vector3d& place) {
    const Vector3d index = geometry.indexFromWorld(place);
    return geometry.containsIndex(index) && outerAir[cells.index(*cells.nearest(index))] == 0;
  };
  for (std::size_t v = 0; v < vessels.size(); ++v) {
    const Path& path = vessels[v].path;
    double kept = 0;
    for (std::size_t first = 0; first < path.size();) {
      std::size_t end = first;
      while (end < path.size() && isInside(path[end].position)) ++end;
      Path stretch(path.begin() + static_cast<std::ptrdiff_t>(first),
                   path.begin() + static_cast<std::ptrdiff_t>(end));
      if (stretch.size() > 1) {
        kept += pathLength(stretch);
        body.stretches.push_back({static_cast<std::int32_t>(v), first == 0, std::move(stretch)});
      }
      first = end + 1;
    }
    body.lost += pathLength(path) - kept;
  }
  return body;
}

}  // namespace lumen::convert
