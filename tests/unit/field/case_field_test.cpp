// SPDX-License-Identifier: Apache-2.0
// The field of a case.
#include "formats/case/case_field.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/blobby.h"

namespace lumen::formats {
namespace {

// Three nodes in a row with two blobs each, and a fourth that a link joins to the first.
Case smallCase() {
  Case result;
  CenterlineTree& tree = result.tree;
  BlobbyModels models;
  for (int i = 0; i < 4; ++i) {
    const float x = 0.6f * static_cast<float>(i);
    tree.centre.push_back({x, 0.1f, -0.2f});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(1.0f + 0.05f * static_cast<float>(i));
    tree.height.push_back(0.6f);
    tree.parent.push_back(i < 3 ? i - 1 : kNoParent);
    tree.branch.push_back(0);
    models.offset.push_back(static_cast<std::uint32_t>(models.width.size()));
    for (const float y : {-0.2f, 0.3f}) {
      models.centre.push_back({x, y, 0});
      models.width.push_back(0.5f);
    }
  }
  models.offset.push_back(static_cast<std::uint32_t>(models.width.size()));
  tree.links = {{0, 3}};
  result.models = models;
  return result;
}

TEST(CaseField, TheLocalFieldIsTheReferencesOwn) {
  const Case value = smallCase();
  const field::BlendedField blended = caseField(value);
  for (std::uint32_t node = 0; node < 4; ++node) {
    const FieldValue expected = evaluateField(*value.models, node, {0.4, 0.5, 0.6});
    const field::Jet<1> found = blended.local({0.4, 0.5, 0.6}, node);
    EXPECT_NEAR(found.value, expected.f, 1e-15);
    EXPECT_NEAR(found.gradient[1], expected.gradient.y, 1e-15);
  }
}

TEST(CaseField, ParentsAndLinksAreEdges) {
  const field::BlendedField blended = caseField(smallCase());
  const auto around = blended.neighbours(0);
  EXPECT_EQ(std::vector(around.begin(), around.end()), (std::vector<std::uint32_t>{1, 2, 3}));
}

}  // namespace
}  // namespace lumen::formats
