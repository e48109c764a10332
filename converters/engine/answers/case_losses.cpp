// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/case_losses.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/export/shared/tree_losses.h"
#include "converters/stages/surface/patches/cell_size.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::BranchLosses;
using convert::Patches;

/// "branch "a" has", "branches "a", "b" and 7 more have".
std::string subject(const std::vector<std::string>& labels) {
  constexpr std::size_t kNamed = 5;
  std::string text = labels.size() == 1 ? "branch" : "branches";
  for (std::size_t i = 0; i < std::min(labels.size(), kNamed); ++i)
    text += (i == 0 ? " \"" : ", \"") + formats::printable(labels[i]) + "\"";
  if (labels.size() > kNamed) text += " and " + std::to_string(labels.size() - kNamed) + " more";
  return text + (labels.size() == 1 ? " has" : " have");
}

/// Two digits, rounded down.
std::string atMost(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return shownNumber(std::floor(value / unit) * unit);
}

/// Advice on losses at nodes of at least the radius `thinnest`, mm. `promise`: the effect of finer
/// cells.
std::string advice(double thinnest, double cell, const std::string& promise) {
  const double coarsest = convert::coarsestCellFor(thinnest);
  if (cell <= coarsest)
    return "; their models do not agree on a surface there, and finer cells do not help";
  return "; cells of " + atMost(cell) + " mm are too coarse there: --cell " + atMost(coarsest) +
         " or less " + promise;
}

std::string missingText(const Patches& patches, double cell) {
  std::vector<std::string> coarse, bare;
  double thinnest = INFINITY;
  for (std::size_t b = 0; b < patches.losses.size(); ++b) {
    const BranchLosses& losses = patches.losses[b];
    if (losses.triangles > 0) continue;
    (losses.any() ? coarse : bare).push_back(patches.surface.labels[b]);
    if (losses.any()) thinnest = std::min(thinnest, losses.thinnest);
  }
  std::string text;
  if (!coarse.empty())
    text += subject(coarse) + " no surface in it" + advice(thinnest, cell, "keeps it");
  if (!bare.empty())
    text += (text.empty() ? "" : "; ") + subject(bare) +
            " no models, so no surface in it; lumen fit makes models";
  return text;
}

std::string holesText(const Patches& patches, double cell) {
  std::vector<std::string> torn;
  std::size_t nodes = 0, triangles = 0;
  double thinnest = INFINITY;
  for (std::size_t b = 0; b < patches.losses.size(); ++b) {
    const BranchLosses& losses = patches.losses[b];
    if (losses.triangles == 0 || !losses.any()) continue;
    torn.push_back(patches.surface.labels[b]);
    nodes += losses.missedNodes;
    triangles += losses.lostTriangles;
    thinnest = std::min(thinnest, losses.thinnest);
  }
  if (torn.empty()) return "";
  return subject(torn) + " holes (" + counted(nodes, "node", "nodes") + " without surface, " +
         counted(triangles, "triangle", "triangles") + " dropped)" +
         advice(thinnest, cell, "may close them");
}

}  // namespace

void reportLosses(const Patches& patches, const std::string& file, double cell,
                  Progress& progress) {
  for (const std::string& text : {missingText(patches, cell), holesText(patches, cell)})
    if (!text.empty()) progress.warn(formats::printable(file) + ": " + text);
}

void reportTreeLosses(const formats::Case& value, const std::string& file, Progress& progress) {
  for (const std::string& loss : treeLosses(value.tree))
    progress.warn(formats::printable(file) + ": " + loss);
}

}  // namespace lumen::engine
