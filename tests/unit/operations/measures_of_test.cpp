// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/measures_of.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/operations/sample_cases.h"

namespace lumen::operations {
namespace {

class MeasureListener : public Progress {
public:
  void begin(std::string_view stage, std::size_t) override { heard.emplace_back(stage); }
  void end() override { heard.emplace_back("end"); }
  std::vector<std::string> heard;
};

TEST(MeasuresOf, TablesAreThoseOfTheMeasures) {
  const formats::Case fork = samples::fittedFork();
  MeasureListener listener;
  const CaseMeasures measures = measuresOf(fork, {}, Context{listener});
  ASSERT_EQ(measures.values.vessels.size(), 2U);
  EXPECT_NEAR(measures.values.vessels[0].meanRadius.value, 2, 0.1);
  EXPECT_NEAR(measures.values.vessels[1].meanRadius.value, 1, 0.1);
  ASSERT_EQ(measures.tables.size(), convert::kMeasureKinds);
  const auto vessels =
      std::find_if(measures.tables.begin(), measures.tables.end(),
                   [](const convert::MeasureTable& table) { return table.kind == "vessels"; });
  ASSERT_NE(vessels, measures.tables.end());
  ASSERT_EQ(vessels->rows.size(), 2U);
  const auto column = std::find(vessels->values.begin(), vessels->values.end(), "mean_radius_mm");
  ASSERT_NE(column, vessels->values.end());
  EXPECT_EQ(
      vessels->rows[1].values[static_cast<std::size_t>(column - vessels->values.begin())].value,
      measures.values.vessels[1].meanRadius.value);
  ASSERT_GE(listener.heard.size(), 2U);
  EXPECT_EQ(listener.heard.front(), "measure");
  EXPECT_EQ(listener.heard.back(), "end");
}

TEST(MeasuresOf, StationsLieAtTheStepOfTheOptions) {
  Progress silent;
  const CaseMeasures measures = measuresOf(samples::fittedFork(), {2.0}, Context{silent});
  ASSERT_GT(measures.values.stations.size(), 2U);
  EXPECT_NEAR(measures.values.stations[1].along.value, 2, 1e-6);
}

}  // namespace
}  // namespace lumen::operations
