// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/fit_to_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/base/warning.h"
#include "converters/stages/fitting/image/section_fit.h"
#include "formats/case/node_origin.h"

namespace lumen::convert::fitting {

namespace {

/// Blur and noise are measured on vessels of at least kWideBlurs blurs in radius, at most kMostWide
/// nodes of them, and at least kFewestWide.
constexpr std::size_t kMostWide = 256, kFewestWide = 8;
constexpr double kWideBlurs = 2.5;
/// Radius, in blurs, from which on a vessel's image determines its contrast beside its radius.
constexpr double kNarrowBlurs = 2.0;
/// Standard deviations of the contrast, as shares: of a first guess, and of a narrower vessel.
constexpr double kGuessedContrast = 0.5, kNarrowContrast = 0.05;
/// The least standard deviation of a measured contrast, as a share of it: no lumen is even.
constexpr double kLeastContrast = 0.03;
/// Distance of a voxel from the wall, in blurs, and the rank of the background's level, of a first
/// guess of the contrast, and the fewest voxels on either side.
constexpr double kGuessBlurs = 1.5, kGuessRank = 0.4;
constexpr std::size_t kFewestVoxels = 4;
/// Sweeps over all nodes, and further ones over those beside which another vessel runs.
constexpr int kSweeps = 2, kTouchingSweeps = 2;
/// The noise, in contrasts, up to which a stretch has its least length; beyond, it grows with the
/// power of the noise that balances it against the curvature that a local quadratic cannot follow
/// (J. Fan, I. Gijbels, Local polynomial modelling and its applications, 1996), up to a bound.
constexpr double kCalm = 0.05, kStretchPower = 2.0 / 5, kMostStretch = 2;
/// A fit counts if its contrast is at least this share of the expected one, its centre lies within
/// this share of the old radius and a blur, its radius is known to this share, and is at most this
/// many times the old one.
constexpr double kFaint = 0.3, kMovedShare = 0.6, kUncertain = 0.4, kSwollen = 2.0;
/// The widest vessel that is fitted, in voxels: rays see the walls of wider ones as well, and all
/// voxels around a node are visited.
constexpr double kWidestVoxels = 64;
/// The share of the wall that must be closed.
constexpr double kClosedShare = 0.5;
/// Rings of wall points at these shares of half the height, and the spacing of points in a ring.
constexpr double kRings[] = {-0.5, 0, 0.5};
constexpr double kPointVoxels = 0.75;
constexpr int kFewestPoints = 12, kMostPoints = 48;

double precisionOf(const Estimate& e) {
  return 1 / (e.deviation * e.deviation);
}

}  // namespace

ImageFit::ImageFit(const formats::Case& value, const Volume& volume, bool dark, double blur,
                   Progress& progress)
    : m_case(value),
      m_sections(value, volume, dark, blur),
      m_progress(progress),
      m_fits(value.tree.nodeCount()) {
  chooseNodes();
}

void ImageFit::run() {
  m_progress.begin("image", kSweeps * m_due.size());
  guessContrast();
  measureVolume();
  for (int i = 0; i < kSweeps; ++i) {
    sweep(m_due);
    if (m_isFirst) m_spread = measureSpread(m_sections, m_fits, m_due);
    m_isFirst = false;
  }
  const std::vector<std::uint32_t> touching = touchingNodes();
  for (int i = 0; i < kTouchingSweeps; ++i) sweep(touching);
  m_progress.end();
}

bool ImageFit::isNarrow(double radius) const {
  return radius < kNarrowBlurs * m_sections.blur();
}

/// Nodes of vessels that were measured, and bridged ones between two of these in one branch; but
/// none whose wall was changed by hand, none that was given, and none whose centre lies in a vessel that it is joined to.
void ImageFit::chooseNodes() {
  const formats::CenterlineTree& tree = m_case.tree;
  const auto origins = formats::readNodeOrigins(m_case);
  const std::vector<bool> edited = formats::readEditedWalls(m_case);
  const auto isMeasured = [&](std::uint32_t i) {
    return origins[i] == formats::NodeOrigin::Measured;
  };
  const auto isInside = [&](std::uint32_t i) {
    const auto others = m_sections.others(i);
    return std::any_of(others.begin(), others.end(), [&](const Sections::Other& other) {
      return other.isJoined && (toEigen(tree.centre[i]) - toEigen(tree.centre[other.node])).norm() <
                                   double{tree.radius[other.node]};
    });
  };
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel) continue;
    std::uint32_t first = branch.firstNode, end = first + branch.nodeCount;
    while (first < end && !isMeasured(first)) ++first;
    while (end > first && !isMeasured(end - 1)) --end;
    for (std::uint32_t i = first; i < end; ++i)
      if (!edited[i] && double{tree.radius[i]} < kWidestVoxels * m_sections.voxel() &&
          origins[i] != formats::NodeOrigin::Given && !isInside(i))
        m_due.push_back(i);
  }
}

/// First contrasts, of vessels that are wide enough: from the voxels well inside of the wall to
/// those well outside.
void ImageFit::guessContrast() {
  std::vector<Estimate> measured(m_fits.size());
  const double apart = kGuessBlurs * m_sections.blur();
  tbb::parallel_for(std::size_t{0}, m_due.size(), [&](std::size_t i) {
    m_progress.check();
    const double radius = m_sections[m_due[i]].outline.radius;
    std::vector<double> in, out;
    for (const SectionVoxel& v : m_sections.voxels(m_due[i])) {
      const double r = v.place.norm();
      if (r < radius - apart) in.push_back(v.value);
      if (r > radius + apart) out.push_back(v.value);
    }
    if (std::min(in.size(), out.size()) < kFewestVoxels) return;
    const double contrast = upperMedian(in) - lowerQuantile(out, kGuessRank);
    if (contrast > 0) measured[m_due[i]] = {contrast, contrast};
  });
  m_expected = contrastAlong(m_case.tree, measured, m_sections.voxel());
  if (m_expected.empty())
    throw invalidInput(
        "no vessel is wide enough to show its contrast; expected one whose radius "
        "is two voxels or more");
  for (std::uint32_t i = 0; i < m_fits.size(); ++i) {
    m_expected[i].deviation = kGuessedContrast * m_expected[i].value;
    m_sections[i].contrast = m_expected[i].value;
  }
}

std::vector<std::uint32_t> ImageFit::widestNodes() const {
  std::vector<std::uint32_t> wide, chosen;
  for (const std::uint32_t node : m_due)
    if (m_sections[node].outline.radius > kWideBlurs * m_sections.blur()) wide.push_back(node);
  const std::size_t step = std::max<std::size_t>(1, wide.size() / kMostWide);
  for (std::size_t i = 0; i < wide.size(); i += step) chosen.push_back(wide[i]);
  return chosen;
}

/// Blur, noise and contrasts, as medians over the widest vessels.
void ImageFit::measureVolume() {
  const std::vector<std::uint32_t> wide = widestNodes();
  fitNodes(wide, true);
  std::vector<double> blurs, noise;
  for (const std::uint32_t node : wide) {
    const SectionFit& f = m_fits[node];
    if (!f.isValid) continue;
    blurs.push_back(f.blur);
    noise.push_back(f.noise / f.contrast.value);
  }
  if (blurs.size() >= kFewestWide) {
    m_sections.setBlur(m_sections.blur() * upperMedian(blurs));
    shareContrast();
    const double excess = std::max(upperMedian(noise) / kCalm, 1.0);
    m_sections.setStretch(std::min(std::pow(excess, kStretchPower), kMostStretch));
  }
  for (const std::uint32_t node : wide) m_fits[node].isValid = false;
}

void ImageFit::sweep(const std::vector<std::uint32_t>& nodes) {
  fitNodes(nodes, false);
  for (const std::uint32_t node : nodes)
    if (m_fits[node].isValid) m_sections[node].outline = m_fits[node].outline;
  shareContrast();
}

void ImageFit::fitNodes(const std::vector<std::uint32_t>& nodes, bool fitsBlur) {
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    m_progress.check();
    const std::uint32_t node = nodes[i];
    const NodeSection& s = m_sections[node];
    const SectionPrior prior{s.outline,
                             s.bend,
                             m_spread,
                             m_expected[node],
                             m_sections.covariance(node),
                             m_isFirst || !m_fits[node].isValid,
                             fitsBlur};
    m_fits[node] = fitSection(m_sections.voxels(node), prior);
    if (fitsBlur) return;
    m_fits[node].isValid &= isBelievable(node);
    m_progress.advance();
  });
}

bool ImageFit::isBelievable(std::uint32_t node) const {
  const SectionFit& f = m_fits[node];
  const double old = double{m_case.tree.radius[node]};
  return f.contrast.value > kFaint * m_expected[node].value &&
         f.outline.centre.norm() < kMovedShare * old + m_sections.blur() &&
         f.radius.deviation < kUncertain * f.outline.radius && f.outline.radius < kSwollen * old;
}

/// A fit's contrast without its prior; a deviation of 0 where that decided, or the vessel is too
/// narrow.
Estimate ImageFit::ownContrast(std::uint32_t node) const {
  const SectionFit& f = m_fits[node];
  if (!f.isValid || isNarrow(f.outline.radius)) return {};
  const double all = precisionOf(f.contrast), prior = precisionOf(m_expected[node]);
  if (!(all > prior)) return {};
  const double own = all - prior;
  const double value = (f.contrast.value * all - m_expected[node].value * prior) / own;
  if (!(value > 0)) return {};
  return {value, std::hypot(1 / std::sqrt(own), kLeastContrast * value)};
}

/// Expected contrasts become those that the fits along the tree give.
void ImageFit::shareContrast() {
  std::vector<Estimate> measured(m_fits.size());
  for (const std::uint32_t node : m_due) measured[node] = ownContrast(node);
  std::vector<Estimate> expected = contrastAlong(m_case.tree, measured, m_sections.voxel());
  if (expected.empty()) return;
  m_expected = std::move(expected);
  for (std::uint32_t i = 0; i < m_fits.size(); ++i) {
    Estimate& e = m_expected[i];
    if (isNarrow(m_sections[i].outline.radius))
      e.deviation = std::min(e.deviation, kNarrowContrast * e.value);
    m_sections[i].contrast = m_fits[i].isValid ? m_fits[i].contrast.value : e.value;
  }
}

/// Nodes beside which another vessel runs whose wall is not joined to theirs.
std::vector<std::uint32_t> ImageFit::touchingNodes() const {
  std::vector<std::uint32_t> touching;
  for (const std::uint32_t node : m_due) {
    const auto others = m_sections.others(node);
    if (std::any_of(others.begin(), others.end(), [](const auto& o) { return !o.isJoined; }))
      touching.push_back(node);
  }
  return touching;
}

std::vector<formats::Vec3f> ImageFit::wallPoints(std::uint32_t node) const {
  const NodeSection& s = m_sections[node];
  std::vector<Sections::Other> others = m_sections.others(node);
  const double turn = 2 * std::numbers::pi;
  const int count =
      std::clamp(static_cast<int>(turn * s.outline.radius / (kPointVoxels * m_sections.voxel())),
                 kFewestPoints, kMostPoints);
  const double half = 0.5 * double{m_case.tree.height[node]};
  std::vector<formats::Vec3f> points;
  for (const double share : kRings)
    for (int k = 0; k < count; ++k) {
      const Eigen::Vector3d p = s.wall(turn * k / count, std::clamp(share * half, s.low, s.high));
      if (!m_sections.isOpen(others, p)) points.push_back(toVec3f(p));
    }
  const double all = static_cast<double>(std::size(kRings)) * count;
  if (static_cast<double>(points.size()) < kClosedShare * all) points.clear();
  return points;
}

}  // namespace lumen::convert::fitting

namespace lumen::convert {

namespace {

/// The blur of a volume whose slices are as thick as they are apart, in voxels: its own box and a
/// scanner of half a voxel.
constexpr double kUsualBlur = 0.6;

constexpr const char* kImageExtension = "LUMEN_image";
constexpr const char* kDeviationArray = "LUMEN_image.deviation";

/// The section's place and size, as the tree states them.
void moveNode(formats::CenterlineTree& tree, std::uint32_t node,
              const fitting::NodeSection& section) {
  const fitting::Outline& o = section.outline;
  tree.centre[node] = toVec3f(section.origin + o.centre.x() * section.u + o.centre.y() * section.v);
  tree.radius[node] = static_cast<float>(std::sqrt(o.area() / std::numbers::pi));
}

/// Replaces the node array of a case by standard deviations of radii, mm; 0 where none is known.
void setDeviations(formats::Case& value, std::vector<float> deviations) {
  auto& used = value.metadata.extensionsUsed;
  std::erase_if(value.nodeArrays, [](const auto& array) { return array.name == kDeviationArray; });
  std::erase(used, kImageExtension);
  used.emplace_back(kImageExtension);
  value.nodeArrays.push_back({kDeviationArray, 1, "mm", std::move(deviations)});
}

}  // namespace

ImageFitOptions recordedImageFit(const formats::Case& value, const Volume& volume) {
  ImageFitOptions options;
  options.blur = kUsualBlur * volume.geometry.spacing.minCoeff();
  if (const formats::Step* step = lastStep(value.metadata, "track"))
    if (const auto dark = step->parameters.find("dark"); dark != step->parameters.end())
      if (const auto* is = std::get_if<bool>(&dark->second)) options.dark = *is;
  return options;
}

ImageFitReport fitToImage(formats::Case& target, const Volume& volume,
                          const ImageFitOptions& options, Progress& progress) {
  if (!target.points)
    throw invalidInput("the case has no wall points; expected a tracked case with its points");
  fitting::ImageFit fit(target, volume, options.dark, options.blur, progress);
  fit.run();
  ImageFitReport report;
  report.blur = fit.blur();
  const formats::PointSets& old = *target.points;
  formats::CenterlineTree tree = target.tree;
  auto origins = formats::readNodeOrigins(target);
  formats::PointSets points;
  points.offset.push_back(0);
  std::vector<float> deviations(tree.nodeCount(), 0.0F);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    std::vector<formats::Vec3f> wall;
    if (fit.isFitted(i)) wall = fit.wallPoints(i);
    if (wall.empty()) {
      wall.assign(old.position.begin() + old.offset[i], old.position.begin() + old.offset[i + 1]);
      ++report.kept;
    } else {
      moveNode(tree, i, fit.section(i));
      origins[i] = formats::NodeOrigin::Measured;
      deviations[i] = static_cast<float>(fit.deviation(i));
      ++report.nodes;
    }
    points.position.insert(points.position.end(), wall.begin(), wall.end());
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  target.tree = std::move(tree);
  if (target.motion)
    warn(progress, {WarningCode::ImageMotion,
                    "the motion is dropped, because its poses are those of the centres before"});
  target.motion.reset();
  target.points = std::move(points);
  target.metadata.pointQuantisation.reset();
  formats::setNodeOrigins(target, origins);
  setDeviations(target, std::move(deviations));
  target.metadata.steps.push_back(
      {"fit-image", "lumen " LUMEN_VERSION, {{"blur", report.blur}, {"dark", options.dark}}});
  return report;
}

}  // namespace lumen::convert
