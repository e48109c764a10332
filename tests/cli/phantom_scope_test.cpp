// SPDX-License-Identifier: Apache-2.0
// Every option of `lumen phantom` with every phantom: it changes what is written.
#include <algorithm>

#include "converters/stages/phantom/phantom.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

class PhantomScopeTest : public ScopeTest {
protected:
  [[nodiscard]] Effect drawn(const std::string& name, const Given& options) const {
    std::vector<std::string> arguments = {name, "out/p.nrrd"};
    if (name == "--tree") arguments = {"out/p.nrrd"};
    Given given = options;
    const auto isGiven = [&](const std::string& option) {
      return std::any_of(options.begin(), options.end(),
                         [&](const auto& one) { return one.first == option; });
    };
    if (name == "--tree")
      given.emplace_back("tree", "fork.swc");
    else if (!isGiven("size"))
      given.emplace_back("size", name == "patient" ? "128" : "32");
    if (!isGiven("seeds")) given.emplace_back("seeds", "out/s.json");
    Effect effect = effectOf(operationOf("phantom", arguments, given));
    effect.answer.clear();
    return effect;
  }
};

TEST_F(PhantomScopeTest, EveryOptionChangesEveryPhantom) {
  const Given options = {
      {"size", "40"},         {"voxel", "0.23"},        {"slice-thickness", "0.95"},
      {"fade", "0.5"},        {"clutter", "bone"},      {"clutter", "vein"},
      {"clutter", "streaks"}, {"clutter", "stent"},     {"clutter", "void"},
      {"noise", "0.2"},       {"bias", "0.3"},          {"psf", "1"},
      {"seed", "2"},          {"clicks", "careless"},   {"click-drawing", "2"},
      {"motion", "heart"},    {"truth", "out/t.lumen"}, {"seeds", "out/q.json"}};
  write("fork.swc", "1 0 0 0 0 .6 -1\n2 0 6 0 0 .6 1\n3 0 10 2 0 .5 2\n4 0 10 -3 0 .4 2\n");
  std::vector<std::string> names = convert::phantomNames();
  names.emplace_back("--tree");
  for (const std::string& name : names) {
    const Effect usual = drawn(name, {});
    EXPECT_EQ(usual.error, "") << name;
    for (const auto& option : options) {
      if (name == "--tree" && option.first == "size") continue;  // refused, above
      // it needs 128 voxels, and differs from the others in how its tree is made
      if (name == "patient" && option.first != "seed" && option.first != "clicks") continue;
      EXPECT_FALSE(drawn(name, {option}) == usual)
          << name << " --" << option.first << " " << option.second;
    }
  }
}

TEST_F(PhantomScopeTest, TheNumberOfPhasesChangesAMotion) {
  const std::pair<std::string, std::string> motion = {"motion", "breath"};
  EXPECT_FALSE(drawn("hepatic", {motion, {"phases", "3"}}) ==
               drawn("hepatic", {motion, {"phases", "2"}}));
}

TEST_F(PhantomScopeTest, EveryOptionIsTried) {
  const engine::BoundCommand phantom = m_engine.find("phantom");
  for (const OptionRow& row : phantom.table->rows()) {
    static const std::vector<std::string> known = {
        "tree",  "truth", "seeds", "size", "voxel",  "slice-thickness", "fade",   "clutter",
        "noise", "bias",  "psf",   "seed", "clicks", "click-drawing",   "motion", "phases"};
    EXPECT_TRUE(row.isArgument || std::find(known.begin(), known.end(), row.name) != known.end())
        << row.name;
  }
}

}  // namespace lumen::test
