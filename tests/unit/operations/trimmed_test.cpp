// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/trimmed.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/validate.h"
#include "tests/unit/operations/sample_cases.h"

namespace lumen::operations {
namespace {

/// The centres of a node's blobs.
std::vector<formats::Vec3f> blobsOf(const formats::Case& value, std::uint32_t node) {
  const formats::BlobbyModels& models = *value.models;
  return {models.centre.begin() + models.offset[node],
          models.centre.begin() + models.offset[node + 1]};
}

TEST(Trimmed, AThinVesselIsGoneAndTheModelsWhereItWasAreFittedAgain) {
  const formats::Case fork = samples::fittedFork();
  ASSERT_EQ(fork.tree.branches.size(), 2U);
  const auto at = static_cast<std::uint32_t>(fork.tree.branches[1].parentNode);
  Progress silent;
  const TrimmedCase made = trimmed(fork, {1.5, 0}, "fork", Context{silent});
  ASSERT_EQ(made.ends.size(), 1U);
  EXPECT_TRUE(made.ends[0].isWhole);
  EXPECT_EQ(made.value.tree.branches.size(), 1U);
  EXPECT_TRUE(formats::validate(made.value));
  ASSERT_EQ(made.value.tree.centre[at], fork.tree.centre[at]);
  EXPECT_NE(blobsOf(made.value, at), blobsOf(fork, at));
  EXPECT_EQ(blobsOf(made.value, 0), blobsOf(fork, 0));
}

TEST(Trimmed, ACaseWithoutModelsGetsNone) {
  formats::Case fork = samples::fittedFork();
  fork.models.reset();
  Progress silent;
  const TrimmedCase made = trimmed(fork, {1.5, 0}, "fork", Context{silent});
  EXPECT_EQ(made.ends.size(), 1U);
  EXPECT_FALSE(made.value.models);
}

TEST(Trimmed, LimitsThatLeaveNothingAreRefusedWithTheName) {
  Progress silent;
  const std::string fault = samples::faultOf([&] {
    (void)trimmed(samples::fittedFork(), {5, 0}, "fork", Context{silent});
  });
  EXPECT_TRUE(fault.starts_with("fork: all vessels are thinner than 5 mm")) << fault;
}

}  // namespace
}  // namespace lumen::operations
