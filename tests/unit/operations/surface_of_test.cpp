// SPDX-License-Identifier: Apache-2.0
// Remarks on parts that a surface lacks.
#include "converters/operations/surface_of.h"

#include <string>

#include <gtest/gtest.h>

namespace lumen::operations {
namespace {

class Warnings : public Progress {
public:
  void warn(std::string_view message) override { text += message; }
  std::string text;
};

/// Report on a branch whose losses are at nodes of a quarter of a millimetre or more, which
/// cells up to a millimetre resolve.
std::string reportedFor(double cell, bool hasSurface) {
  convert::Patches patches;
  patches.surface.labels = {"thin"};
  patches.losses = {{9, hasSurface ? 100U : 0U, 2, 5, 0.25}};
  Warnings warnings;
  warnOfLosses(patches, "out.glb", cell, Context{warnings});
  return warnings.text;
}

TEST(LossReport, AsksForFinerCellsOnlyWhereTheseWereTooCoarse) {
  for (const bool hasSurface : {false, true}) {
    const std::string coarse = reportedFor(1.5, hasSurface);
    EXPECT_NE(coarse.find("cells of 1.5 mm are too coarse there: cell 1 or less"),
              std::string::npos)
        << coarse;
    for (const double cell : {1.0, 0.5}) {
      const std::string fine = reportedFor(cell, hasSurface);
      EXPECT_NE(fine.find("finer cells do not help"), std::string::npos) << fine;
      EXPECT_EQ(fine.find("are too coarse"), std::string::npos) << fine;
    }
  }
}

}  // namespace
}  // namespace lumen::operations
