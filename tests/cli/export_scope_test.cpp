// SPDX-License-Identifier: Apache-2.0
// Every option of `lumen export` with every target: it changes the folder, or it is refused with the
// targets that take it, or with what it needs.
#include <algorithm>
#include <map>
#include <set>

#include "converters/base/run_program.h"
#include "converters/export/export_case.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

using convert::ExportTarget;

/// A value of each option that differs from its default for the case below. The edge is shorter than
/// those that the walls of game engines and Isaac, 0.4 and 0.2 radii thick, ask for.
const std::map<std::string, std::string> kValues = {{"unit", "m"},
                                                    {"up", "y"},
                                                    {"edge", "0.2r"},
                                                    {"max-error", "0.3"},
                                                    {"triangles", "500"},
                                                    {"extend", "2r"},
                                                    {"thickness", "0.3r"},
                                                    {"max-pieces", "1"},
                                                    {"grid", "0.9"},
                                                    {"format", "nifti"},
                                                    {"band", "0.5"},
                                                    {"half", "true"},
                                                    {"per-branch", "true"},
                                                    {"exact", "true"},
                                                    {"wall", "grid"},
                                                    {"dialect", "v23.06"},
                                                    {"instrument", "catheter"},
                                                    {"step", "0.2"},
                                                    {"inlets", "vessel1=3"},
                                                    {"keep-ends", "true"},
                                                    {"cells", "coarse"},
                                                    {"flow", "pulsatile"},
                                                    {"insert", "vessel2"},
                                                    {"layers", "2"},
                                                    {"growth", "1.6"},
                                                    {"layer-height", "0.02r"}};

const std::set<std::string> kOfCells = {"layers", "growth", "layer-height"};

/// Options of a target that another must accompany.
Given companionsOf(const std::string& target, const std::string& option) {
  if (option == "half") return {{"format", "vdb"}};
  if (option == "unit" && target == "grid") return {{"format", "cdf"}};
  if (option == "grid" && target == "sofa") return {{"wall", "grid"}};
  if (kOfCells.contains(option) && target == "openfoam") return {{"cells", "prisms"}};
  return {};
}

bool takes(const ExportTarget& target, const std::string& option) {
  if (option == "unit") return target.units.size() > 1;
  if (option == "up") return target.axes.size() > 1;
  return std::any_of(target.options.begin(), target.options.end(),
                     [&](const convert::TakenOption& one) { return option == one.name; });
}

/// A value that the target does not take.
std::string foreignValue(const ExportTarget& target, const std::string& option) {
  if (option == "up") return target.axes.front() == convert::Axes::Lsa ? "z" : "y";
  if (option == "unit") return target.units.front() == convert::LengthUnit::Metre ? "cm" : "m";
  return kValues.at(option);
}

}  // namespace

class ExportScopeTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    fillOnce("scope of export", [this] { makeCases(); });
  }

  void makeCases() const {
    write("fork.swc",
          "1 0 0 0 0 2 -1\n2 0 10 0 0 2 1\n3 0 20 0 0 2 2\n4 0 28 6 0 1.5 2\n5 0 34 12 0 1.5 4\n");
    make({"convert", "fork.swc", "fork.lumen"});
    write("long.swc", "1 0 0 0 0 .6 -1\n2 0 30 0 0 .6 1\n3 0 60 0 0 .6 2\n");
    make({"convert", "long.swc", "long.lumen"});
    write("taper.swc", "1 0 0 0 0 2 -1\n2 0 20 0 0 2 1\n3 0 28 0 0 2 2\n4 0 30 0 0 1 3\n");
    make({"convert", "taper.swc", "taper.lumen"});
  }

  /// Those of the targets. --time is one of the case: motion_test.cpp.
  [[nodiscard]] std::vector<std::string> options() const {
    std::vector<std::string> names;
    for (const OptionRow& row : m_export.table->rows())
      if (!row.isArgument && row.name != "list" && row.name != "time") names.push_back(row.name);
    return names;
  }

  /// A bound on pieces counts for a vessel that is longer than one piece.
  [[nodiscard]] static std::string caseFor(const std::string& option) {
    if (option == "keep-ends") return "taper.lumen";
    return option == "max-pieces" || kOfCells.contains(option) ? "long.lumen" : "fork.lumen";
  }

  [[nodiscard]] Effect exported(const ExportTarget& target, const Given& given,
                                const std::string& file = "fork.lumen") const {
    Effect effect =
        effectOf(operationOf("export", {std::string(target.name), file, "out/folder"}, given));
    effect.answer.clear();
    return effect;
  }

  void expectChange(const ExportTarget& target, const std::string& option) {
    const std::string name(target.name), file = caseFor(option);
    if (kOfCells.contains(option) && !convert::installedProgram("lumen-netgen")) return;
    Given given = companionsOf(name, option);
    const auto key = std::make_pair(name + file, given);
    if (!m_usual.contains(key)) m_usual[key] = exported(target, given, file);
    EXPECT_EQ(m_usual[key].error, "") << name;
    std::string value = kValues.at(option);
    if (option == "unit") value = convert::unitName(target.units.back());
    if (option == "up") value = target.axes.back() == convert::Axes::Lsa ? "y" : "z";
    given.emplace_back(option, value);
    EXPECT_FALSE(exported(target, given, file) == m_usual[key])
        << name << " --" << option << " " << value;
  }

  std::map<std::pair<std::string, Given>, Effect> m_usual;  ///< of a target, a case and options
  engine::BoundCommand m_export = m_engine.find("export");
};

TEST_F(ExportScopeTest, AnOptionThatATargetDoesNotTakeIsRefusedByName) {
  for (const ExportTarget& target : convert::exportTargets())
    for (const std::string& option : options()) {
      if (takes(target, option)) continue;
      const std::string name(target.name),
          error = exported(target, {{option, foreignValue(target, option)}}).error;
      const bool isChoice = option == "unit" || option == "up";  // refused with the target's own
      EXPECT_TRUE(error.starts_with("--" + option + (isChoice ? ": found " : " is for "))) << error;
      EXPECT_NE(error.find((isChoice ? "which is what " : ", not for ") + name), std::string::npos)
          << error;
    }
}

TEST_F(ExportScopeTest, AnOptionThatATargetTakesChangesTheFolderOfOne) {
  std::size_t turn = 0;
  for (const std::string& option : options()) {
    std::vector<const ExportTarget*> takers;
    for (const ExportTarget& target : convert::exportTargets())
      if (takes(target, option)) takers.push_back(&target);
    ASSERT_FALSE(takers.empty()) << option;
    expectChange(*takers[turn++ % takers.size()], option);
  }
}

TEST_F(ExportScopeTest, AnOptionThatATargetTakesChangesItsFolder) {
  for (const ExportTarget& target : convert::exportTargets())
    for (const std::string& option : options())
      if (takes(target, option)) expectChange(target, option);
}

TEST_F(ExportScopeTest, AnOptionWithoutItsCompanionIsRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> lines = {
      {{"grid", "half", "true"}, "--half does nothing without --format vdb"},
      {{"sofa", "grid", "0.5"}, "--grid does nothing without --wall grid"}};
  for (const auto& [words, sentence] : lines) {
    const Operation operation =
        operationOf("export", {words[0], "fork.lumen", "out/folder"}, {{words[1], words[2]}});
    EXPECT_EQ(effectOf(operation).error, sentence);
  }
}

TEST_F(ExportScopeTest, TheListTakesNoOption) {
  for (const std::string& option : options())
    EXPECT_EQ(
        effectOf(operationOf("export", {}, {{"list", "true"}, {option, kValues.at(option)}})).error,
        "--" + option + " does nothing with --list");
}

TEST_F(ExportScopeTest, NoTrianglesAreDroppedWhereZeroIsAsked) {
  const auto& targets = convert::exportTargets();
  const auto cathsim = std::find_if(targets.begin(), targets.end(),
                                    [](const ExportTarget& one) { return one.name == "cathsim"; });
  const Effect usual = exported(*cathsim, {{"edge", "2r"}});
  EXPECT_EQ(usual.error, "");
  EXPECT_FALSE(exported(*cathsim, {{"edge", "2r"}, {"max-error", "0"}}) == usual);
}

}  // namespace lumen::test
