// SPDX-License-Identifier: Apache-2.0
// The blended field in doubles: against libblob, which has it in floats, and against its
// definition.
#include "formats/field/blended_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blob.h"
#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "tree.h"

namespace lumen::field {
namespace {

using blob::test::Model;
using blob::test::Point;
using blob::test::Tree;

BlendedField fieldOf(const Tree& tree) {
  const blob_model_def def = tree.definition();
  const blob_blobs& blobs = def.blobs;
  return {{def.node_count, def.centre, def.radius, def.parent, def.link_count, def.link},
          {static_cast<Kernel>(blobs.kernel), blobs.kernel_parameter, blobs.iso_level, blobs.offset,
           blobs.centre, blobs.width}};
}

Tree withKernel(Tree tree, blob_kernel kernel) {
  tree.kernel = kernel;
  tree.parameter = usualParameter(static_cast<Kernel>(kernel));
  return tree;
}

// Fork, bend, helix, and two tubes that touch: models disagree by a tenth.
std::vector<Tree> trees() {
  using namespace blob::test;
  return {tube(12, 0.1), fork(0.5, 0.1), bend(0.1), kissing(0.0), helix(60, 0.1)};
}

// Random places in the lumen and to half a radius outside, with the node that they lie nearest to.
struct Place {
  Vec at;
  std::uint32_t node;
};

std::vector<Place> placesIn(const Tree& tree, const BlendedField& field, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Place> places;
  for (int n = 0; n < count; ++n) {
    const auto near = static_cast<std::uint32_t>(random() % tree.centre.size());
    const double reach = 1.5 * tree.radius[near] / std::sqrt(3.0);
    const auto& c = tree.centre[near];
    const Vec at{c[0] + reach * share(random), c[1] + reach * share(random),
                 c[2] + reach * share(random)};
    places.push_back({at, field.follow(at, near)});
  }
  return places;
}

blob_sample samplePlace(const Model& model, std::uint32_t flags, const Place& place) {
  blob_sample sample;
  const double p[3] = {place.at.x, place.at.y, place.at.z};
  std::uint32_t cursor = place.node;
  blob_query(model.get(), flags | BLOB_HOLD, p, &cursor, &sample);
  return sample;
}

void expectSame(const Jet<1>& jet, const blob_sample& sample) {
  EXPECT_NEAR(jet.value, sample.value, 3e-6 * (jet.value + 0.01));
  const double slope = std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(jet.gradient[i], sample.gradient[i], 2e-5 * (slope + 0.1));
}

class FieldOfKernel : public testing::TestWithParam<blob_kernel> {};

TEST_P(FieldOfKernel, LocalIsThatOfLibblob) {
  for (const Tree& shape : trees()) {
    const Tree tree = withKernel(shape, GetParam());
    const Model model = tree.build();
    const BlendedField field = fieldOf(tree);
    for (const Place& place : placesIn(tree, field, 300))
      expectSame(field.local(place.at, place.node), samplePlace(model, BLOB_LOCAL, place));
  }
}

TEST_P(FieldOfKernel, BlendedIsThatOfEveryBackEnd) {
  for (const Tree& shape : trees()) {
    const Tree tree = withKernel(shape, GetParam());
    const BlendedField field = fieldOf(tree);
    for (const blob_simd simd : {BLOB_SIMD_SCALAR, BLOB_SIMD_BEST}) {
      const Model model = tree.build(simd);
      for (const Place& place : placesIn(tree, field, 300))
        expectSame(field.blended(place.at, place.node), samplePlace(model, BLOB_BLENDED, place));
    }
  }
}

TEST_P(FieldOfKernel, TheHessianIsTheSlopeOfTheGradient) {
  constexpr double kStep = 1e-5;
  const Tree tree = withKernel(blob::test::fork(0.5, 0.1), GetParam());
  const BlendedField field = fieldOf(tree);
  for (const Place& place : placesIn(tree, field, 200)) {
    const Vec step{kStep, 0, 0};
    const Jet<2> here = field.blended<2>(place.at, place.node);
    const Jet<1> low = field.blended(place.at - step, place.node);
    const Jet<1> high = field.blended(place.at + step, place.node);
    const int entries[3] = {0, 3, 4};  // xx, xy, xz
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(here.hessian[entries[i]], (high.gradient[i] - low.gradient[i]) / (2 * kStep),
                  2e-3 * (1 + std::abs(here.hessian[entries[i]])));
  }
}

INSTANTIATE_TEST_SUITE_P(All, FieldOfKernel,
                         testing::Values(BLOB_CAUCHY, BLOB_GAUSSIAN, BLOB_QUARTIC,
                                         BLOB_SOFT_OBJECT));

TEST(BlendedField, NeighboursAreThoseOfLibblob) {
  for (const Tree& tree : trees()) {
    const Model model = tree.build();
    const BlendedField field = fieldOf(tree);
    for (std::uint32_t i = 0; i < field.nodeCount(); ++i) {
      std::vector<std::uint32_t> other(256);
      other.resize(blob_model_neighbours(model.get(), i, other.data(), other.size()));
      EXPECT_TRUE(std::ranges::equal(field.neighbours(i), other)) << i;
    }
  }
}

TEST(BlendedField, CursorsGoWhereThoseOfLibblobGo) {
  for (const Tree& tree : trees()) {
    const Model model = tree.build();
    const BlendedField field = fieldOf(tree);
    for (const Place& place : placesIn(tree, field, 300)) {
      const double p[3] = {place.at.x, place.at.y, place.at.z};
      EXPECT_EQ(field.locate(place.at), blob_cursor_locate(model.get(), p));
      EXPECT_EQ(field.follow(place.at, 0), blob_cursor_follow(model.get(), p, 0));
    }
  }
}

// Where the cursor of a walk changes, f and its gradient do not.
TEST(BlendedField, NothingJumpsAtSeams) {
  for (const Tree& tree : trees()) {
    const BlendedField field = fieldOf(tree);
    int seams = 0;
    for (const Place& place : placesIn(tree, field, 2000))
      for (const std::uint32_t other : field.neighbours(place.node)) {
        const auto powerOf = [&](std::uint32_t k, const Vec& x) {
          const double* c = field.centre(k);
          const Vec fromCentre = x - Vec{c[0], c[1], c[2]};
          return dot(fromCentre, fromCentre) - double{tree.radius[k]} * tree.radius[k];
        };
        // onto the radical plane, along the line of centres
        const double *a = field.centre(place.node), *b = field.centre(other);
        const Vec axis{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const double excess = powerOf(other, place.at) - powerOf(place.node, place.at);
        const Vec seam = place.at + (0.5 * excess / dot(axis, axis)) * axis;
        if (field.follow(seam, place.node) != place.node && field.follow(seam, place.node) != other)
          continue;  // some third node is nearer there
        ++seams;
        const Jet<1> here = field.blended(seam, place.node), there = field.blended(seam, other);
        EXPECT_NEAR(here.value, there.value, 1e-12);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(here.gradient[i], there.gradient[i], 1e-10);
      }
    EXPECT_GT(seams, 1000);
  }
}

// A chain of five nodes of which only the ends have blobs.
Tree sparseChain() {
  Tree tree;
  for (int i = 0; i < 5; ++i) {
    tree.addNode({0.6 * i, 0, 0}, 1, i - 1);
    if (i == 0 || i == 4) tree.addBlob({0.6 * i, 0, 0}, 0.5 + 0.1 * i);
  }
  return tree;
}

TEST(BlendedField, ANodeWithoutBlobsBorrowsThoseOfTheNearestAlongTheTree) {
  const BlendedField field = fieldOf(sparseChain());
  EXPECT_EQ(field.lender(1), 0U);
  EXPECT_EQ(field.lender(2), 0U);  // as near to 4: the lower index
  EXPECT_EQ(field.lender(3), 4U);
}

TEST(BlendedField, BorrowedBlobsStayWhereTheyAre) {
  const BlendedField field = fieldOf(sparseChain());
  const Vec p{0.7, 0.4, 0.1};
  EXPECT_EQ(field.local(p, 1).value, field.local(p, 0).value);
}

TEST(BlendedField, WithoutBlobsInTheComponentTheFieldIsZero) {
  Tree tree = sparseChain();
  const std::int32_t alone = tree.addNode({0, 3, 0}, 1);
  const BlendedField field = fieldOf(tree);
  const auto node = static_cast<std::uint32_t>(alone);
  EXPECT_EQ(field.lender(node), kNowhere);
  EXPECT_EQ(field.blended({0, 3, 0}, node).value, 0.0);
}

TEST(BlendedField, ALinkJoinsAsAnEdgeDoes) {
  Tree tree = blob::test::kissing(0.0);
  const std::uint32_t a = 10, b = 40;
  EXPECT_FALSE(std::ranges::binary_search(fieldOf(tree).neighbours(a), b));
  tree.links.push_back({a, b});
  EXPECT_TRUE(std::ranges::binary_search(fieldOf(tree).neighbours(a), b));
}

TEST(BlendedField, AVesselThatTouchesHasNoSay) {
  const Tree both = blob::test::kissing(0.0);
  Tree one = both;
  const std::size_t nodes = 30, blobs = both.offset[nodes];
  one.centre.resize(nodes);
  one.radius.resize(nodes);
  one.parent.resize(nodes);
  one.offset.resize(nodes + 1);
  one.blobCentre.resize(blobs);
  one.blobWidth.resize(blobs);
  const BlendedField alone = fieldOf(one), touched = fieldOf(both);
  for (double x = 0; x < 17; x += 0.21) {
    const Vec p{x, 0.95, 0.05};
    const std::uint32_t node = alone.follow(p, 15);
    ASSERT_EQ(touched.follow(p, 15), node);
    EXPECT_EQ(touched.blended(p, node).value, alone.blended(p, node).value);
  }
}

TEST(BlendedField, FarFromEveryWeightTheHeldNodesOwnModelAnswers) {
  const Tree tree = blob::test::tube(12, 0.1);
  const BlendedField field = fieldOf(tree);
  const Vec p{6, 0.2, 0};  // twelve radii from node 0
  EXPECT_EQ(field.blended(p, 0).value, field.local(p, 0).value);
}

}  // namespace
}  // namespace lumen::field

// The field of a case.
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
