// SPDX-License-Identifier: Apache-2.0
#include "converters/picture/draw_case.h"

#include <cstddef>
#include <map>
#include <vector>

#include "converters/common/error.h"
#include "converters/mesh/vertex_color.h"
#include "converters/picture/shade.h"
#include "converters/picture/trace.h"
#include "converters/picture/volume_behind.h"
#include "formats/case/binary_encode.h"

namespace lumen::convert {

namespace {

constexpr int kSamples = 2;  // across a pixel, and down
constexpr Rgb kPaper = {250, 250, 250}, kInk = {60, 60, 60}, kInkOnVolume = {230, 230, 230};

/// Linear light of each node: as colours of a mesh with a vertex at each.
std::vector<Light> coloursOf(const formats::CenterlineTree& tree, ColourBy by) {
  static const std::map<ColourBy, ColorBy> kOfMeshes = {
      {ColourBy::Branch, ColorBy::Branch},
      {ColourBy::Radius, ColorBy::Radius},
      {ColourBy::Confidence, ColorBy::Confidence}};
  const auto found = kOfMeshes.find(by);
  if (found == kOfMeshes.end()) return {tree.nodeCount(), Light(0.62F, 0.07F, 0.06F)};
  SurfaceMesh nodes;
  nodes.position.resize(tree.nodeCount());
  nodes.radius = tree.radius;
  nodes.branch = tree.branch;
  nodes.confidence = tree.inlierRate;
  std::vector<Light> colours;
  for (const Color& c : colorsOf(nodes, scaleOf(nodes, found->second)))
    colours.emplace_back(float(c[0]) / 65535, float(c[1]) / 65535, float(c[2]) / 65535);
  return colours;
}

}  // namespace

Picture drawCase(const formats::Case& source, const PictureOptions& options, const Volume* volume,
                 Progress& progress) {
  if (!source.models || source.tree.nodeCount() == 0)
    throw invalidInput(
        "this case has no models, so there is no surface to draw; lumen fit makes them");
  const std::vector<Light> colours = coloursOf(source.tree, options.colour);
  const Camera fine = cameraFor(source.tree, options.view, options.turn, kSamples * options.width,
                                kSamples * options.height);
  const TracedSurface surface =
      traceSurface(source.tree, formats::encodeBinary(source), fine, progress);
  Picture background(options.width, options.height, kPaper);
  if (volume) {
    Camera coarse = fine;
    coarse.width = options.width;
    coarse.height = options.height;
    coarse.scale = fine.scale / kSamples;
    background = volumeBehind(*volume, coarse, progress);
  }
  Picture picture = shade(surface, fine, colours, background, kSamples);
  drawScaleBar(picture, fine.scale / kSamples, volume ? kInkOnVolume : kInk);
  return picture;
}

}  // namespace lumen::convert
