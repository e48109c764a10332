// SPDX-License-Identifier: Apache-2.0
// Remarks on parts that a surface lacks.
#include "converters/operations/surface_of.h"

#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"

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

convert::SurfaceReport reportOfContact() {
  convert::SurfaceReport report;
  report.cuts = {{1, 2, 3}};
  return report;
}

std::size_t warningsOf(const formats::Case& value) {
  Progress silent;
  return surfaceWarnings(reportOfContact(), value, Context{silent}).size();
}

TEST(AcceptedContacts, AreNoWarningUntilTheCaseChanges) {
  formats::Case value;
  EXPECT_EQ(warningsOf(value), 1U);
  acceptContacts(value.metadata, "looked at");
  EXPECT_EQ(warningsOf(value), 0U);
  recordEdit(value.metadata, "deleted \"b\"");
  EXPECT_EQ(warningsOf(value), 1U);
  EXPECT_FALSE(acceptedContacts(value.metadata));
}

TEST(AcceptedContacts, HaveTheReasonThatWasGivenLast) {
  formats::Case value;
  acceptContacts(value.metadata, "looked at");
  acceptContacts(value.metadata, "a vein");
  EXPECT_EQ(acceptedContacts(value.metadata), "a vein");
  EXPECT_EQ(value.metadata.steps.size(), 1U);
  EXPECT_THROW(acceptContacts(value.metadata, "  "), Error);
}

}  // namespace
}  // namespace lumen::operations
