// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/draw_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/draw/picture/marks.h"
#include "converters/draw/picture/trace.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/judge/check/check.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

namespace {

constexpr int kSamples = 2;            // across a pixel, and down
constexpr std::size_t kOfLegend = 64;  // colours
constexpr double kCoarse = 0.125;  // share of the pixels, each way: enough for the levels of grey
constexpr Rgb kPaper = {250, 250, 250}, kInk = {60, 60, 60}, kInkOnVolume = {230, 230, 230};
constexpr std::array<float, 3> kVessel = {0.62F, 0.07F, 0.06F};

/// Linear light of each node, and its meaning.
struct Colours {
  std::vector<Light> ofNode;
  Legend legend;  ///< without colours: none is needed
};

std::vector<Light> computeLight(const SurfaceMesh& values, const ColorScale& scale) {
  std::vector<Light> colours;
  for (const Color& c : vertexColors(values, scale))
    colours.emplace_back(float(c[0]) / 65535, float(c[1]) / 65535, float(c[2]) / 65535);
  return colours;
}

Legend makeLegend(const ColorScale& scale) {
  const bool isRadius = scale.by == ColorBy::Radius;
  Legend legend;
  legend.title = isRadius ? "radius, mm" : "confidence, share";
  const double low = double{scale.low}, high = double{scale.high};
  const double middle = isRadius ? std::sqrt(low * high) : 0.5 * (low + high);
  legend.values = {shownNumber(low, 3)};
  if (high > low)
    legend.values.insert(legend.values.end(), {shownNumber(middle, 3), shownNumber(high, 3)});
  SurfaceMesh steps;
  steps.position.resize(kOfLegend);
  for (std::size_t i = 0; i < kOfLegend; ++i) {
    const double share = static_cast<double>(i) / (kOfLegend - 1);
    const auto value = static_cast<float>(isRadius ? low * std::pow(high / low, share)
                                                   : low + share * (high - low));
    (isRadius ? steps.radius : steps.confidence).push_back(value);
  }
  for (const Light& c : computeLight(steps, scale))
    legend.colours.push_back({encodeSrgb(c[0]), encodeSrgb(c[1]), encodeSrgb(c[2])});
  return legend;
}

/// The systems that a case has, each with its colour.
Legend makeSystemLegend(const std::vector<formats::VesselSystem>& systems,
                        const ColorScale& scale) {
  Legend legend;
  legend.title = "system";
  SurfaceMesh steps;
  for (std::size_t i = 0; i < formats::kVesselSystemCount; ++i) {
    const auto system = static_cast<formats::VesselSystem>(i);
    if (std::find(systems.begin(), systems.end(), system) == systems.end()) continue;
    legend.values.emplace_back(formats::kVesselSystemNames[i]);
    steps.branch.push_back(static_cast<std::uint32_t>(steps.systems.size()));
    steps.systems.push_back(system);
  }
  for (const Light& c : computeLight(steps, scale))
    legend.colours.push_back({encodeSrgb(c[0]), encodeSrgb(c[1]), encodeSrgb(c[2])});
  return legend;
}

/// Colours of a mesh with a vertex at each node.
Colours computeColours(const formats::Case& source, ColorBy by) {
  const formats::CenterlineTree& tree = source.tree;
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(source);
  if (by == ColorBy::None && !systems.empty()) by = ColorBy::System;
  if (by == ColorBy::System && systems.empty())
    throw invalidInput(kOption.colour.shown() +
                       " system: the case states no system of its vessels, which comes with a "
                       "label map; expected vessel, branch or radius");
  if (by == ColorBy::None)
    return {{tree.nodeCount(), Light(kVessel[0], kVessel[1], kVessel[2])}, {}};
  if (by == ColorBy::Confidence && tree.inlierRate.empty())
    throw invalidInput(kOption.colour.shown() +
                       " confidence: no node of the case states how much of its wall was found, as "
                       "in cases that were not tracked; expected vessel, branch or radius");
  SurfaceMesh nodes;
  nodes.position.resize(tree.nodeCount());
  nodes.radius = tree.radius;
  nodes.branch = tree.branch;
  nodes.confidence = tree.inlierRate;
  nodes.systems = systems;
  const ColorScale scale = measureColorScale(nodes, by);
  if (by == ColorBy::System) return {computeLight(nodes, scale), makeSystemLegend(systems, scale)};
  return {computeLight(nodes, scale), by == ColorBy::Branch ? Legend{} : makeLegend(scale)};
}

Framing makeFraming(const PictureOptions& options) {
  const int room = options.marks ? roomForMarks(options.width, options.height) : 0;
  return {options.view,  options.turn,   options.allTurns,
          options.width, options.height, static_cast<double>(room)};
}

const formats::Case& drawable(const formats::Case& source) {
  if (!source.models)
    throw invalidInput(
        "this case has no models, so there is no surface to draw; lumen fit makes them of wall "
        "points, lumen convert of the "
        "volume and its seeds");
  if (source.tree.nodeCount() == 0)
    throw invalidInput("this case has no node, so there is nothing to draw");
  return source;
}

}  // namespace

CasePainter::CasePainter(const formats::Case& source)
    : m_source(drawable(source)), m_tracer(source) {}

void CasePainter::setVolume(const Volume& volume, Progress& progress) {
  requireOverlap(volume, m_source.tree);
  m_projector.emplace(volume, progress);
}

Picture CasePainter::background(const PictureOptions& options, const Camera& camera,
                                Progress& progress) const {
  if (!m_projector) return {camera.width, camera.height, kPaper};
  PictureOptions unturned = options;
  unturned.turn = 0;
  const Camera coarse = cameraFor(m_source.tree, makeFraming(unturned)).scaled(kCoarse);
  const GreyWindow window = chooseWindow(m_projector->greatest(coarse, progress));
  return greyPicture(m_projector->greatest(camera, progress), camera.width, camera.height, window);
}

Picture CasePainter::draw(const PictureOptions& options, Progress& progress) const {
  const formats::CenterlineTree& tree = m_source.tree;
  const Colours colours = computeColours(m_source, options.colour);
  const Framing framing = makeFraming(options);
  const Camera camera = cameraFor(tree, framing);
  const Camera fine = camera.scaled(kSamples);
  Picture picture = shade(m_tracer.trace(fine, progress), fine, colours.ofNode,
                          background(options, camera, progress), kSamples);
  if (framing.margin > 0) {
    const Rgb& ink = m_projector ? kInkOnVolume : kInk;
    drawScaleBar(picture, camera, ink);
    drawSides(picture, camera, ink);
    if (!colours.legend.colours.empty()) drawLegend(picture, colours.legend, ink);
  }
  return picture;
}

Picture drawCase(const formats::Case& source, const PictureOptions& options, const Volume* volume,
                 Progress& progress) {
  CasePainter painter(source);
  if (volume) painter.setVolume(*volume, progress);
  return painter.draw(options, progress);
}

}  // namespace lumen::convert
