// SPDX-License-Identifier: Apache-2.0
// The table and the page of a batch, and what its rows are taken to need.
#include "converters/library/batch/batch.h"

#include <gtest/gtest.h>

#include "converters/library/batch/batch_tables.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace {

BatchResult resultOf(const std::string& id, BatchEnd end) {
  BatchResult result;
  result.id = id;
  result.name = "scans/" + id + ".nrrd";
  result.end = end;
  if (end != BatchEnd::Passed) result.why = "why, \"" + id + "\" <b>";
  if (end == BatchEnd::NeedsPerson) result.at = "--at=1,2,3";
  result.figures = BatchFigures{4, 2, 1, 120.26, 0.4567, 3.21};
  return result;
}

}  // namespace

TEST(BatchTables, ARowHasTheFiguresOfItsCaseAlone) {
  const std::string table =
      batchTable({resultOf("a", BatchEnd::Passed), resultOf("b", BatchEnd::NeedsPerson),
                  resultOf("c", BatchEnd::NoVessels)});
  EXPECT_EQ(table,
            "id,input,state,why,vessels,trees,links,length_mm,radius_min_mm,radius_max_mm,"
            "warnings,seconds,view\n"
            "a,scans/a.nrrd,passed,,4,2,1,120.3,0.457,3.210,0,0.0,\n"
            "b,scans/b.nrrd,needs a person,\"why, \"\"b\"\" <b>\",4,2,1,120.3,0.457,3.210,0,0.0,"
            "\"lumen view scans/b.nrrd b.lumen --at=1,2,3\"\n"
            "c,scans/c.nrrd,no vessels,\"why, \"\"c\"\" <b>\",,,,,,,0,0.0,\n");
  EXPECT_EQ(passedList({resultOf("a", BatchEnd::Passed), resultOf("b", BatchEnd::NeedsPerson)}),
            "input,id\na.lumen,a\n");
}

TEST(BatchTables, ThePageHasFaultsFirstAndNoMarkupOfOthers) {
  const std::string page =
      batchPage({resultOf("good", BatchEnd::Passed), resultOf("bad", BatchEnd::Failed)}, "nowhere");
  EXPECT_LT(page.find("scans/bad.nrrd"), page.find("scans/good.nrrd"));
  EXPECT_NE(page.find("&quot;bad&quot; &lt;b&gt;"), std::string::npos);
  EXPECT_NE(page.find("href=\"good.lumen\""), std::string::npos);
  EXPECT_EQ(page.find("href=\"bad.lumen\""), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

// Memory of `lumen convert` as /usr/bin/time measured it on the volumes of tests: MB.
TEST(Batch, ARowIsTakenToNeedTheMemoryThatItNeeds) {
  const auto megabytes = [](std::uint64_t voxels) {
    return static_cast<double>(batchMemory(voxels)) / 1e6;
  };
  EXPECT_NEAR(megabytes(137'640), 68.0, 0.07 * 68.0);      // a fistula, MR
  EXPECT_NEAR(megabytes(2'479'680), 142.1, 0.07 * 142.1);  // a chest, CT
  EXPECT_GT(megabytes(2'097'834), 101.1);                  // an aorta, MR
  EXPECT_GT(megabytes(16'777'216), 274.7);                 // a head, 3D rotational angiography
  EXPECT_GT(megabytes(134'217'728), 1030);                 // a synthetic patient of 512^3
}

}  // namespace lumen::convert
