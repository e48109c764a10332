// SPDX-License-Identifier: Apache-2.0
// Declared in measures.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/sac_shape.h"
#include "converters/judge/measure/sac_tree.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/judge/measure/vessel_measures.h"
#include "converters/judge/measure/wall.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kMarginRadii = 1.5;  // radii of the vessel: the box beyond the sac's points
constexpr double kTipShare = 0.95;    // of the reach: places that make the dome's axis
// Voxels: standard deviation of the neck plane along its normal. A crease that is as sharp as the
// point-spread function leaves it is a good half of a voxel wide.
constexpr double kNeckVoxels = 0.5;
// Standard deviation of the rim's place, in standard deviations of the volume's blur: that of an even
// distribution between 0 and 1.8. The half level of a blurred wedge lies 0.55 of them from its edge
// along one side at a right angle, and 1.8 at 40 degrees, the crease of a ball of 1.5 necks.
constexpr double kRimBlurs = 0.5;
constexpr double kSdOfRadius = 0.03;  // of a vessel's radius in the tree, as a share
constexpr double kPerRadian = 180 / std::numbers::pi;

constexpr std::string_view kNoField = "the case has no models: fit it first";
constexpr std::string_view kNoVessel = "the aneurysm hangs on no vessel";
constexpr std::string_view kNoNeck = "no plane separates the aneurysm from its vessels";
constexpr std::string_view kNoArm = "no vessel goes on beyond the neck";

/// The values of a sac, in the order of Values::kIn.
enum Value : std::size_t {
  NeckDiameter,
  NeckArea,
  Height,
  Reach,
  Width,
  Volume,
  Area,
  Aspect,
  Size,
  Bottleneck,
  Undulation,
  Ellipticity,
  NonSphericity,
  kValues
};
using Values = std::array<double, kValues>;

// 0 for half a ball without its flat face (M. L. Raghavan et al., 2005).
double roundness(double volume, double area) {
  return 1 - std::cbrt(18 * std::numbers::pi * volume * volume) / area;
}

Values valuesOf(const DomeShape& dome, double vessel) {
  Values v{};
  v[NeckDiameter] = dome.neckDiameter;
  v[NeckArea] = dome.neckArea;
  v[Height] = dome.height;
  v[Reach] = dome.reach;
  v[Width] = dome.width;
  v[Volume] = dome.volume;
  v[Area] = dome.area;
  v[Aspect] = dome.height / dome.neckDiameter;
  v[Size] = dome.reach / vessel;
  v[Bottleneck] = dome.width / dome.neckDiameter;
  v[Undulation] = 1 - dome.volume / dome.hullVolume;
  v[Ellipticity] = roundness(dome.hullVolume, dome.hullArea);
  v[NonSphericity] = roundness(dome.volume, dome.area);
  return v;
}

/// Adds the squares of changes that independent errors make.
class Spread {
public:
  explicit Spread(const Values& values) : m_values(values) {}
  void add(const Values& changed) {
    for (std::size_t i = 0; i < kValues; ++i)
      m_square[i] += (changed[i] - m_values[i]) * (changed[i] - m_values[i]);
  }
  [[nodiscard]] double sd(std::size_t i) const { return std::sqrt(m_square[i]); }

private:
  Values m_values;
  Values m_square{};
};

// The dome with its wall farther out everywhere.
DomeShape grown(const DomeShape& dome, double by) {
  DomeShape out = dome;
  out.volume += dome.area * by;
  out.hullVolume += dome.hullArea * by;
  out.area += 4 * dome.area / dome.width * by;
  out.hullArea += 4 * dome.hullArea / dome.width * by;
  out.neckArea += std::numbers::pi * dome.neckDiameter * by;
  out.neckDiameter += 2 * by;
  out.width += 2 * by;
  out.height += by;
  out.reach += by;
  return out;
}

// The dome with its rim farther out.
DomeShape widened(const DomeShape& dome, double by) {
  DomeShape out = dome;
  out.neckArea += std::numbers::pi * dome.neckDiameter * by;
  out.neckDiameter += 2 * by;
  return out;
}

/// Measures one sac.
class SacSurvey {
public:
  SacSurvey(const formats::Case& source, const field::BlendedField& field, const WallNoise& noise,
            const SacTree& sac, const Progress& progress)
      : m_source(source), m_field(field), m_noise(noise), m_sac(sac), m_progress(progress) {}

  void run(SacMeasures& out) {
    const LocalField local(m_source.tree, m_field, m_sac.nodes, boxOfSac());
    const BoxedField boxed{local.box(), [&](const Vector3d& p) { return local.value(p); }};
    const double step = kNeckVoxels * m_source.metadata.voxelSize.value_or(0);
    const std::optional<SacShape> sac =
        findSacShape(boxed, placeOf(local), toEigen(m_source.tree.centre[m_sac.widest]),
                     m_sac.radius, step, m_progress);
    if (!sac) return leaveOut(out, kNoNeck);
    const DomeShape& shape = sac->shape;
    out.place = shape.neckCentre;
    out.neckNormal = sac->neck.normal;
    out.tip = shape.tip;
    out.rim = sac->dome.rim;
    const std::vector<SacVessel> vessels =
        vesselsAtNeck(m_source.tree, m_sac,
                      std::max(0.5 * shape.neckDiameter,
                               static_cast<double>(m_source.tree.radius[attachment()])));
    out.position = vessels.size() > 2 ? "bifurcation" : "side-wall";
    fill(out, *sac, vessels);
    addInflow(out, sac->dome, shape, vessels, step);
  }

  static void leaveOut(SacMeasures& out, std::string_view reason) {
    for (Measured* m :
         {&out.neckDiameter, &out.neckArea, &out.height, &out.reach, &out.width, &out.volume,
          &out.area, &out.aspectRatio, &out.sizeRatio, &out.bottleneckFactor, &out.undulation,
          &out.ellipticity, &out.nonSphericity, &out.inflowAngle})
      *m = notDefined(reason);
  }

private:
  [[nodiscard]] std::uint32_t attachment() const {
    return static_cast<std::uint32_t>(m_sac.attachment);
  }

  // Around the sac's balls and wall points, and the vessel at its neck.
  [[nodiscard]] Box3d boxOfSac() const {
    const formats::CenterlineTree& tree = m_source.tree;
    const double margin = kMarginRadii * static_cast<double>(tree.radius[attachment()]);
    Box3d box;
    for (const std::uint32_t n : m_sac.nodes) {
      box.add(toEigen(tree.centre[n]), static_cast<double>(tree.radius[n]) + margin);
      if (!m_source.points) continue;
      for (std::uint32_t p = m_source.points->offset[n]; p < m_source.points->offset[n + 1]; ++p)
        box.add(toEigen(m_source.points->position[p]), margin);
    }
    box.add(toEigen(tree.centre[attachment()]), 2 * margin);
    return box;
  }

  [[nodiscard]] NeckPlace placeOf(const LocalField& local) const {
    const formats::CenterlineTree& tree = m_source.tree;
    NeckPlace place{toEigen(tree.centre[attachment()]), m_sac.middle, {}};
    for (const std::uint32_t n : local.nodes())
      if (!std::binary_search(m_sac.nodes.begin(), m_sac.nodes.end(), n) &&
          local.box().contains(toEigen(tree.centre[n])))
        place.axes.push_back(toEigen(tree.centre[n]));
    return place;
  }

  // Each kind of error moves the values by itself: the whole wall, single places of it, the neck
  // plane, and the vessels.
  void fill(SacMeasures& out, const SacShape& sac, const std::vector<SacVessel>& vessels) const {
    const DomeShape& shape = sac.shape;
    double vessel = 0;
    for (const SacVessel& v : vessels) vessel += v.diameter / static_cast<double>(vessels.size());
    const double mean = m_noise.ofMean(m_sac.widest), single = m_noise.ofPlace(m_sac.widest);
    const Values values = valuesOf(shape, vessel);
    Spread spread(values);
    spread.add(valuesOf(grown(shape, mean), vessel));
    DomeShape uneven = shape;
    uneven.height += single;
    uneven.reach += single;
    spread.add(valuesOf(uneven, vessel));
    uneven = shape;
    uneven.width += 2 * single;
    uneven.hullVolume += shape.hullArea * single;
    spread.add(valuesOf(uneven, vessel));
    spread.add(valuesOf(sac.moved, vessel));
    spread.add(valuesOf(widened(shape, kRimBlurs * recordedBlur(m_source.metadata)), vessel));
    spread.add(valuesOf(
        shape, vessel * (1 + kSdOfRadius / std::sqrt(std::max<std::size_t>(1, vessels.size())))));
    const std::array<Measured*, kValues> outs = {
        &out.neckDiameter, &out.neckArea,         &out.height,     &out.reach,
        &out.width,        &out.volume,           &out.area,       &out.aspectRatio,
        &out.sizeRatio,    &out.bottleneckFactor, &out.undulation, &out.ellipticity,
        &out.nonSphericity};
    for (std::size_t i = 0; i < kValues; ++i) *outs[i] = measured(values[i], spread.sd(i));
    if (vessels.empty()) out.sizeRatio = notDefined(kNoArm);
  }

  // Between the vessel that leads to the neck, along the blood's way, and the line from the neck's
  // centre to the dome's tip (H. Baharoglu et al., 2010).
  void addInflow(SacMeasures& out, const DomeSurface& dome, const DomeShape& shape,
                 const std::vector<SacVessel>& vessels, double step) const {
    out.inflowAngle = notDefined(kNoArm);
    if (vessels.empty() || vessels.front().node > attachment()) return;
    Vector3d tip = Vector3d::Zero();
    std::size_t count = 0;
    for (const Vector3d& p : dome.mesh.position)
      if ((p - shape.neckCentre).norm() >= kTipShare * shape.reach) {
        tip += p - shape.neckCentre;
        ++count;
      }
    tip /= static_cast<double>(std::max<std::size_t>(count, 1));
    const Vector3d flow = -vessels.front().away;
    const double angle = std::atan2(flow.cross(tip).norm(), flow.dot(tip));
    // the tip's own place, and the ends of the vessel's stretch
    const double single = m_noise.ofPlace(m_sac.widest);
    const double sd =
        std::hypot(std::hypot(step, single) / shape.reach, single / vessels.front().diameter);
    out.inflowAngle = measured(kPerRadian * angle, kPerRadian * sd);
  }

  const formats::Case& m_source;
  const field::BlendedField& m_field;
  const WallNoise& m_noise;
  const SacTree& m_sac;
  const Progress& m_progress;
};

}  // namespace

std::vector<SacMeasures> measureSacs(const formats::Case& source, const WallNoise* noise,
                                     const Progress& progress) {
  const std::vector<SacTree> sacs = findSacs(source.tree);
  std::vector<SacMeasures> out(sacs.size());
  std::optional<field::BlendedField> field;
  if (!sacs.empty() && noise != nullptr) field.emplace(formats::caseField(source));
  for (std::size_t i = 0; i < sacs.size(); ++i) {
    out[i].branch = sacs[i].branches.front();
    out[i].place = sacs[i].middle;
    if (!field)
      SacSurvey::leaveOut(out[i], kNoField);
    else if (sacs[i].attachment == formats::kNoParent)
      SacSurvey::leaveOut(out[i], kNoVessel);
    else
      SacSurvey(source, *field, *noise, sacs[i], progress).run(out[i]);
  }
  return out;
}

}  // namespace lumen::convert
