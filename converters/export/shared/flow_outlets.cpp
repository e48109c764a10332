// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/flow_outlets.h"

#include <cstddef>
#include <utility>

#include "converters/base/csv_rows.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/network.h"
#include "converters/export/shared/target.h"

namespace lumen::convert {

std::string OutletRow::why() const {
  const std::string tipText = fixedText(tip, 2);
  std::string text = "its last stretch";
  if (tipText != fixedText(radius, 2)) text += ", not its tip of " + tipText + " mm";
  return takesRest ? text + "; pressure 0, so the rest flows there" : text;
}

std::vector<OutletRow> outletRows(const FlowNetwork& network) {
  constexpr double kMillilitres = 1e6;  // in a m^3
  std::vector<OutletRow> rows;
  for (const FlowTree& tree : network.trees) {
    double inflow = 0;
    for (const std::uint32_t inlet : tree.inlets) inflow += network.joints[inlet].inflow;
    const std::vector<double> shares = outletShares(network, tree);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const std::uint32_t outlet = tree.outlets[k];
      rows.push_back({outlet, network.joints[outlet].name, endCalibre(network, outlet),
                      endRadius(network, outlet), shares[k], kMillilitres * inflow * shares[k]});
    }
  }
  return rows;
}

std::string outletTable(const std::vector<OutletRow>& outlets) {
  std::string text = "outlet,radius_mm,tip_radius_mm,share,flow_ml_s,why\n";
  for (const OutletRow& row : outlets)
    text += csvCell(row.name) + "," + numberText(row.radius) + "," + numberText(row.tip) + "," +
            numberText(row.share) + "," + numberText(row.flow) + "," + csvCell(row.why()) + "\n";
  return text;
}

std::vector<Warning> outletWarnings(const FlowNetwork& network,
                                    const std::vector<OutletRow>& outlets) {
  constexpr double kShort = 0.02, kMuch = 0.25;  // of the tree's length, and of its flow
  std::vector<double> length(network.trees.size(), 0.0);
  for (const FlowSegment& segment : network.segments)
    length[network.joints[segment.to].tree] += segment.length();
  std::vector<Warning> warnings;
  for (const OutletRow& row : outlets) {
    const FlowJoint& outlet = network.joints[row.joint];
    const double own = network.segments[outlet.in.front()].length();
    if (row.share <= kMuch || own >= kShort * length[outlet.tree]) continue;
    warnings.push_back({WarningCode::FlowDoubt,
                        row.name + " takes " + fixedText(100 * row.share, 0) +
                            " % of the flow of its tree, and its vessel is " + shownFigure(own) +
                            " mm of " + shownFigure(length[outlet.tree]) + " mm",
                        "lumen trim removes it, if it is no vessel",
                        {outlet.place}});
  }
  return warnings;
}

void addOutlets(const FlowNetwork& network, ExportResult& result) {
  result.outlets = outletRows(network);
  result.warnings = pressureWarnings(network);
  for (Warning& warning : outletWarnings(network, result.outlets))
    result.warnings.push_back(std::move(warning));
  result.files.push_back({"outlets.csv", outletTable(result.outlets),
                          "radius, share and flow of each outlet, ml/s, and the reason", ""});
}

}  // namespace lumen::convert
