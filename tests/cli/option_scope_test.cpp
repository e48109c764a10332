// SPDX-License-Identifier: Apache-2.0
// Every option of `lumen convert` with every kind of input and output: it changes the output, or it is refused with
// the name of what it needs.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/command.h"
#include "converters/engine/file_format.h"
#include "converters/engine/scope.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

namespace fs = std::filesystem;
using engine::Surroundings;

/// A value of each option that differs from its default and makes sense for a straight tube.
const std::map<std::string, std::string> kSamples = {{"from", ""},  // stated by the inputs below
                                                     {"to", ""},
                                                     {"series", "1"},
                                                     {"volume-index", "0"},
                                                     {"crop", "2,29,2,29,2,29"},
                                                     {"spacing", "0.21"},
                                                     {"unit", "cm"},
                                                     {"allow-detached", "."},
                                                     {"frame", "ras"},
                                                     {"seeds", "seeds.json"},
                                                     {"seeds-frame", "ras"},
                                                     {"seeds-unit", "cm"},
                                                     {"root", "3.9,3.9,3.9"},
                                                     {"only-connected", "true"},
                                                     {"seeds-only", "true"},
                                                     {"dark", "true"},
                                                     {"inlier-rate", "0.6"},
                                                     {"inlier-band", "0.12"},
                                                     {"rays", "42"},
                                                     {"axes", "21"},
                                                     {"samples", "64"},
                                                     {"min-trials", "100"},
                                                     {"max-trials", "400"},
                                                     {"step", "0.4"},
                                                     {"noise-margin", "1.5"},
                                                     {"look-ahead", "2"},
                                                     {"branch-offset", "1.5"},
                                                     {"aneurysm-gradient", "0.4"},
                                                     {"point-spread", "0.1"},
                                                     {"smoothing", "0.17"},
                                                     {"even-blur", "false"},
                                                     {"max-nodes", "1000"},
                                                     {"random-seed", "2"},
                                                     {"repeat", "1"},
                                                     {"centerline", "truth.swc"},
                                                     {"centerline-frame", "ras"},
                                                     {"centerline-unit", "cm"},
                                                     {"mesh", "vessel"},
                                                     {"mask", "true"},
                                                     {"label", "1"},
                                                     {"labels", "1=artery"},
                                                     {"label-map", "labels.nrrd"},
                                                     {"label-table", "topcow"},
                                                     {"kernel", "gaussian"},
                                                     {"kernel-parameter", "0.3"},
                                                     {"cohesion-weight", "1e-4"},
                                                     {"curvature-weight", "1e-2"},
                                                     {"cohesion-scale", "3"},
                                                     {"max-subdivisions", "2"},
                                                     {"neighbourhood", "1"},
                                                     {"seam-sweeps", "1"},
                                                     {"seam-weight", "32"},
                                                     {"iso-level", "0.15"},
                                                     {"accuracy", "0.5"},
                                                     {"max-distance", "30"},
                                                     {"min-width", "0.03"},
                                                     {"edge", "0.4r"},
                                                     {"extend", "2r"},
                                                     {"thickness", "0.2r"},
                                                     {"max-error", "0.02"},
                                                     {"edge-min", "0.6"},
                                                     {"edge-max", "0.03"},
                                                     {"gap", "0.05"},
                                                     {"open", "true"},
                                                     {"patches", "true"},
                                                     {"cell", "0.4"},
                                                     {"lod", "2"},
                                                     {"mesh-per", "branch"},
                                                     {"colour", "radius"},
                                                     {"meshopt", "true"},
                                                     {"draco", "true"},
                                                     {"draco-position-bits", "12"},
                                                     {"draco-normal-bits", "8"},
                                                     {"stl-solids", "true"},
                                                     {"compress", "true"},
                                                     {"point-bits", "12"}};

/// Options that another must accompany.
const std::map<std::string, std::pair<std::string, std::string>> kCompanions = {
    {"centerline-frame", {"centerline", "truth.swc"}},
    {"centerline-unit", {"centerline", "truth.swc"}},
    {"cell", {"patches", "true"}},
    {"draco-position-bits", {"draco", "true"}},
    {"draco-normal-bits", {"draco", "true"}}};

/// Options that the inputs state already, that cannot change a straight tube, or whose effect other tests show: permissions, restatements of what a
/// file says already, distances between vessels of which there is one, choices that fail on this data, and series of
/// DICOM.
const std::set<std::string> kWithoutEffectHere = {
    "seeds-only", "allow-detached", "gap",  "label", "label-map", "mask", "mesh-per",
    "mesh",       "only-connected", "root", "seeds", "series"};

struct Input {
  std::string file;
  std::vector<std::pair<std::string, std::string>> options;  ///< that it needs
  ContentMask content;
};

class OptionScopeTest : public CliTest {
protected:
  void SetUp() override {
    ASSERT_EQ(lumen({"phantom", "tube", "tube.nrrd", "--size", "32", "--truth", "truth.lumen",
                     "--seeds", "seeds.json"})
                  .code,
              0);
    for (const char* const file : {"case.lumen", "plain.stl"})
      ASSERT_EQ(lumen({"convert", "tube.nrrd", file, "--seeds", "seeds.json"}).code, 0);
    ASSERT_EQ(lumen({"track", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
    ASSERT_EQ(lumen({"convert", "truth.lumen", "truth.swc"}).code, 0);
    ASSERT_EQ(lumen({"check", "tube.nrrd", "case.lumen", "--mask", "labels.nrrd"}).code, 0);
    m_inputs = {{"tube.nrrd", {{"seeds", "seeds.json"}}, engine::kFileImage},
                {"labels.nrrd", {{"mask", "true"}}, engine::kFileLabels},
                {"plain.stl", {}, engine::kPlainMesh},
                {"truth.swc", {}, engine::kCenterline},
                {"tracked.lumen", {}, engine::kUnfittedCase},
                {"case.lumen", {}, engine::kFittedCase}};
    m_before = fs::current_path();
    fs::current_path(path(""));
  }
  void TearDown() override { fs::current_path(m_before); }

  /// The bytes of the output, or the message of a refusal.
  [[nodiscard]] std::pair<std::string, std::string> made(const Input& input,
                                                         const std::string& output,
                                                         const std::string& option,
                                                         bool isGiven = true) const {
    Operation operation{"convert", {input.file, output}, {}};
    for (const auto& [name, value] : input.options)
      if (name != option) operation.with(name, value);
    if (const auto other = kCompanions.find(option); other != kCompanions.end())
      operation.with(other->second.first, other->second.second);
    if (isGiven) operation.with(option, kSamples.at(option));
    Progress progress;
    fs::remove(output);
    try {
      (void)m_engine.run(operation, Surroundings{m_engine, progress});
    } catch (const Error& error) {
      EXPECT_FALSE(fs::exists(output)) << option << " " << input.file << " " << output;
      return {"", error.what()};
    }
    return {read(output), ""};
  }

  engine::Engine m_engine = engine::makeEngine();
  engine::BoundCommand m_convert = m_engine.find("convert");
  std::vector<Input> m_inputs;
  fs::path m_before;
};

const std::vector<std::string> kOutputs = {"o.lumen.json", "o.lumen", "o.glb",
                                           "o.stl",        "o.obj",   "o.swc"};

}  // namespace

TEST_F(OptionScopeTest, EveryOptionOfConvertHasASample) {
  for (const OptionRow& row : m_convert.table->rows()) {
    EXPECT_TRUE(row.isArgument || kSamples.contains(row.name)) << row.name;
  }
}

TEST_F(OptionScopeTest, AnOptionThatWouldDoNothingIsRefusedByName) {
  std::size_t refused = 0;
  for (const OptionRow& row : m_convert.table->rows()) {
    if (row.isArgument || kSamples.at(row.name).empty()) continue;
    for (const Input& input : m_inputs)
      for (const std::string& output : kOutputs) {
        const ContentMask content = engine::outputContent(engine::outputFormat(output, ""));
        const bool isTaken = (row.inputs & input.content) != 0 && (row.outputs & content) != 0;
        // a case is fitted only for a mesh; labels are labels only by these options
        if (isTaken || input.content == engine::kUnfittedCase || row.group == "Surface") continue;
        const std::string message = made(input, output, row.name).second;
        EXPECT_TRUE(message.find(" is for ") != std::string::npos ||
                    message.find(" exclude one another") != std::string::npos)
            << row.name << " with " << input.file << " and " << output << ": " << message;
        ++refused;
      }
  }
  EXPECT_GT(refused, 1000U);
}

TEST_F(OptionScopeTest, AnOptionThatIsTakenChangesTheOutputOrFails) {
  std::map<std::string, std::string> usual;
  std::set<std::string> effective;
  for (const OptionRow& row : m_convert.table->rows()) {
    if (row.isArgument || kSamples.at(row.name).empty()) continue;
    for (const Input& input : m_inputs) {
      if (effective.contains(row.name)) break;
      for (const std::string& output : kOutputs) {
        const auto [bytes, message] = made(input, output, row.name);
        if (message.starts_with(row.shownName() + " is for ") ||
            message.find("exclude one another") != std::string::npos)
          continue;
        const std::string key =
            input.file + output + (kCompanions.contains(row.name) ? row.name : "");
        if (!usual.contains(key)) usual[key] = made(input, output, row.name, false).first;
        if (!message.empty() || bytes != usual[key]) effective.insert(row.name);
        break;
      }
    }
    EXPECT_TRUE(effective.contains(row.name) || kWithoutEffectHere.contains(row.name)) << row.name;
  }
}

TEST_F(OptionScopeTest, AnOptionWithoutItsCompanionIsRefused) {
  for (const auto& [option, companion] : kCompanions) {
    const Outcome run = lumen({"convert", option.starts_with("center") ? "plain.stl" : "case.lumen",
                               "o.glb", "--" + option, kSamples.at(option)});
    EXPECT_EQ(run.code, 2) << option;
    EXPECT_NE(run.err.find("--" + option + " does nothing without --" + companion.first),
              std::string::npos)
        << run.err;
  }
}

}  // namespace lumen::test
