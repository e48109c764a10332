// SPDX-License-Identifier: Apache-2.0
#include "shape_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "convolution_shapes.h"
#include "formats/case/blobby.h"

namespace lumen::reproduce {
namespace {

using convert::fitting::Blob;

/// Blobs evenly along the skeleton; two in one place would have a radius of 1 mm.
std::vector<Blob> startOf(const ConvolutionShape& shape, const Vector3d& centre,
                          const convert::fitting::EnergyParameters& energy) {
  const double width =
      formats::widthForRadius(energy.kernel, energy.kernelParameter, 1, energy.isoLevel, 2);
  const auto last = static_cast<double>(shape.skeleton.size() - 1);
  std::vector<Blob> blobs;
  for (std::size_t i = 0; i < shape.startBlobs; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(shape.startBlobs);
    const Vector3d p = shape.skeleton[static_cast<std::size_t>(std::lround(share * last))] - centre;
    blobs.push_back({p.x(), p.y(), p.z(), width});
  }
  return blobs;
}

}  // namespace

formats::BlobbyModels fitShape(const ConvolutionShape& shape, const std::vector<Vector3d>& points,
                               const convert::fitting::LocalModelOptions& options) {
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : shape.skeleton) centre += p;
  centre /= static_cast<double>(shape.skeleton.size());
  std::vector<formats::Vec3d> local;
  for (const Vector3d& p : points) {
    const Vector3d q = p - centre;
    local.push_back({q.x(), q.y(), q.z()});
  }
  const std::vector<Blob> start = startOf(shape, centre, options.energy);
  convert::fitting::FitWorkspace workspace;
  const convert::fitting::NodeData node{local, 1, {1, 0, 0}, {}, start};
  formats::BlobbyModels out;
  for (const Blob& b : fitLocalModel(options, node, Progress(), workspace).blobs) {
    const Vector3d c = Vector3d(b.x, b.y, b.z) + centre;
    out.centre.push_back(
        {static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())});
    out.width.push_back(static_cast<float>(b.width));
  }
  out.offset = {0, static_cast<std::uint32_t>(out.width.size())};
  return out;
}

std::vector<Vector3d> withNoise(const ConvolutionShape& shape, std::vector<Vector3d> points,
                                double noise, Random random) {
  for (Vector3d& p : points) {
    p -= noise * random.normal() * shape.surface().at(p).gradient.normalized();
  }
  return points;
}

namespace {

constexpr std::size_t kSamples = 1000;

/// Begin and end, as indices, of the arcs or segments of a skeleton: the bifurcation has two.
std::vector<std::pair<std::size_t, std::size_t>> findParts(const ConvolutionShape& shape) {
  const std::size_t count = shape.skeleton.size();
  if (shape.name != "bifurcation") return {{0, count}};
  return {{0, count / 2}, {count / 2, count}};
}

/// The middle of the circle through the ends and the middle of a part; nothing for a segment.
std::optional<Vector3d> circleOf(const std::vector<Vector3d>& line, std::size_t first,
                                 std::size_t end) {
  const Vector3d &a = line[first], &b = line[first + (end - first) / 2], &c = line[end - 1];
  const Vector3d u = b - a, v = c - a, n = u.cross(v);
  if (n.squaredNorm() < 1e-12) return {};
  return a + (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2 * n.squaredNorm());
}

/// Displacements of the surface along its outward normal at `at`, one column for every change.
Eigen::MatrixXd computeShifts(const ConvolutionShape& shape,
                              const std::vector<ShapeChange>& changes,
                              const std::vector<Vector3d>& at) {
  Eigen::MatrixXd shifts = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(at.size()),
                                                 static_cast<Eigen::Index>(changes.size()));
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double slope = shape.surface().at(at[k]).gradient.norm();
    for (std::size_t j = 0; j < shape.skeleton.size(); ++j) {
      const double width = shape.model.width[j];
      const Vector3d delta = (at[k] - shape.skeleton[j]) / width;
      const double x = delta.squaredNorm();
      const auto phi = formats::evaluateKernel(shape.model.kernel, shape.model.kernelParameter, x);
      for (std::size_t i = 0; i < changes.size(); ++i) {
        const double rise = -2 * phi.d1 * delta.dot(changes[i].velocity[j]) +
                            (phi.phi - 2 * phi.d1 * x) * changes[i].widthRate[j];
        shifts(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) += rise / slope;
      }
    }
  }
  return shifts;
}

}  // namespace

std::vector<ShapeChange> makeFamily(const ConvolutionShape& shape) {
  std::vector<ShapeChange> changes;
  const std::vector<Vector3d>& line = shape.skeleton;
  for (const auto& [first, end] : findParts(shape)) {
    const auto add = [&, from = first, to = end](const auto& velocity, double widthRate) {
      ShapeChange change{std::vector<Vector3d>(line.size(), Vector3d::Zero()),
                         std::vector<double>(line.size(), 0.0)};
      for (std::size_t j = from; j < to; ++j) {
        change.velocity[j] = velocity(j);
        change.widthRate[j] = widthRate;
      }
      changes.push_back(change);
    };
    for (int axis = 0; axis < 3; ++axis) {
      add([axis](std::size_t) { return Vector3d(Vector3d::Unit(axis)); }, 0);
      add([&](std::size_t j) { return Vector3d(Vector3d::Unit(axis).cross(line[j])); }, 0);
    }
    const auto circle = circleOf(line, first, end);
    const Vector3d middle = line[first + (end - first) / 2];
    const auto share = [from = first, to = end](std::size_t j) {
      return (static_cast<double>(j - from) / static_cast<double>(to - from - 1)) - 0.5;
    };
    if (circle) {
      const Vector3d axis = (line[first] - *circle).cross(middle - *circle).normalized();
      add([&](std::size_t j) { return Vector3d(line[j] - *circle); }, 0);
      add([&](std::size_t j) { return Vector3d(share(j) * axis.cross(line[j] - *circle)); }, 0);
    } else {
      add([&](std::size_t j) { return Vector3d(line[j] - middle); }, 0);
    }
    add([](std::size_t) { return Vector3d(Vector3d::Zero()); }, 1);
  }
  return changes;
}

FamilyFit::FamilyFit(const ConvolutionShape& shape, const std::vector<Vector3d>& points,
                     Random random) {
  const std::vector<ShapeChange> changes = makeFamily(shape);
  // changes that hardly move the surface, such as the spin of a capsule, are none
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-6);
  solver.compute(computeShifts(shape, changes, points));
  m_solve = solver.pseudoInverse();
  m_rank = static_cast<std::size_t>(solver.rank());
  ParticleOptions options;
  options.count = kSamples;
  std::vector<Vector3d> samples = sampleSurface(
      shape.surface(), [&](Random& r) { return besideSkeleton(shape.skeleton, r); }, options,
      random);
  std::erase_if(samples, [&](const Vector3d& p) { return !shape.contains(p); });
  m_shifts = computeShifts(shape, changes, samples);
}

std::vector<double> FamilyFit::distances(const Eigen::VectorXd& noise) const {
  const Eigen::VectorXd shift = m_shifts * (m_solve * noise);
  std::vector<double> out;
  for (const double d : shift) out.push_back(std::abs(d));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace lumen::reproduce
