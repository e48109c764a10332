// SPDX-License-Identifier: Apache-2.0
// Every option of `lumen convert` with every kind of input and output: it changes the output, or it is refused with
// the name of what it needs.
#include <map>
#include <set>

#include "converters/engine/file_format.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

const std::vector<std::string> kOutputs = {"out/o.lumen.json", "out/o.lumen", "out/o.glb",
                                           "out/o.stl",        "out/o.obj",   "out/o.swc"};

/// A place in one of the vessels of apart.nrrd.
constexpr const char* kInOne = "3,3,0";

/// Options that another must accompany.
const std::map<std::string, std::pair<std::string, std::string>> kCompanions = {
    {"seeds-frame", {"seeds", "seeds.json"}},
    {"seeds-unit", {"seeds", "seeds.json"}},
    {"seeds-only", {"seeds", "seeds.json"}},
    {"axes", {"seeds", "seeds.json"}},
    {"min-trials", {"seeds", "seeds.json"}},
    {"max-trials", {"seeds", "seeds.json"}},
    {"random-seed", {"seeds", "seeds.json"}},
    {"step", {"seeds", "seeds.json"}},
    {"look-ahead", {"seeds", "seeds.json"}},
    {"branch-offset", {"seeds", "seeds.json"}},
    {"max-nodes", {"seeds", "seeds.json"}},
    {"only-connected", {"root", kInOne}},
    {"centerline-frame", {"centerline", "truth.swc"}},
    {"centerline-unit", {"centerline", "truth.swc"}},
    {"cohesion-scale", {"cohesion-weight", "1e-3"}},
    {"cell", {"patches", "true"}},
    {"touching", {"thickness", "1"}},
    {"draco-position-bits", {"draco", "true"}},
    {"draco-normal-bits", {"draco", "true"}}};

/// Inputs on which an option makes a difference, where it makes none on the usual ones.
const std::map<std::string, std::vector<Input>>& specialInputs() {
  static const Given none, mask = {{"mask", "true"}};
  static const std::map<std::string, std::vector<Input>> inputs = {
      {"seeds", {{"tube.nrrd", none, engine::kFileImage}}},
      {"seeds-only", {{"apart.nrrd", {{"seeds", "one.json"}}, engine::kFileImage}}},
      {"root",
       {{"tube.nrrd", none, engine::kFileImage},
        {"labels.nrrd", mask, engine::kFileLabels},
        {"plain.stl", none, engine::kPlainMesh},
        {"vessels.scn", {{"mesh", "tip"}}, engine::kScene}}},
      {"only-connected",
       {{"apart.nrrd", none, engine::kFileImage},
        {"apart.stl", none, engine::kPlainMesh},
        {"apart-labels.nrrd", mask, engine::kFileLabels}}},
      {"corrections", {{"tube.nrrd", none, engine::kFileImage}}},
      {"label", {{"apart-labels.nrrd", none, engine::kFileLabels}}},
      {"labels", {{"apart-labels.nrrd", none, engine::kFileLabels}}},
      {"label-map",
       {{"tube.nrrd", none, engine::kFileImage}, {"labels.nrrd", mask, engine::kFileLabels}}},
      {"label-table", {{"halves.nii", mask, engine::kFileLabels}}},
      {"volume-index", {{"times.nii", none, engine::kFileImage}}},
      {"series", {{"series", none, engine::kDicomImage}}},
      {"allow-detached",
       {{"header/tube.nhdr", none, engine::kFileImage},
        {"header/vessels.scn", {{"mesh", "tip"}}, engine::kScene}}},
      {"gap", {{"two.lumen", none, engine::kFittedCase}}},
      {"touching", {{"apart.lumen", none, engine::kFittedCase}}},
      {"skin",
       {{"moving-case.lumen.json", none, engine::kFittedCase},
        {"moving-tracked.lumen.json", none, engine::kUnfittedCase}}},
      {"time",
       {{"moving-case.lumen.json", none, engine::kFittedCase},
        {"moving-tracked.lumen.json", none, engine::kUnfittedCase}}},
      // labels that are recognised by their voxels are such without it
      {"mask", {{"tube.nrrd", none, engine::kFileImage}}},
      {"mesh-per", {{"two.lumen", none, engine::kFittedCase}}}};
  return inputs;
}

const std::string kFirstMesh = kOutputs[2];
const std::set<std::string> kShowsItsStage = {"inlier-band", "iso-level"};

const std::set<std::string> kChoosesLabels = {"mask", "label", "labels", "label-table"};

}  // namespace

class OptionScopeTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    const Given seeds = {{"seeds", "seeds.json"}, {"seeds-only", "true"}};
    m_inputs = {{"tube.nrrd", seeds, engine::kFileImage},
                {"labels.nrrd", {{"mask", "true"}}, engine::kFileLabels},
                {"labels.nrrd", {}, engine::kFileLabels},  // by their voxels
                {"plain.stl", {}, engine::kPlainMesh},
                {"vessels.scn", {{"mesh", "tip"}}, engine::kScene},
                {"truth.swc", {}, engine::kCenterline},
                {"tracked.lumen", {}, engine::kUnfittedCase},
                {"case.lumen", {}, engine::kFittedCase}};
    if (m_hasDicom) m_inputs.push_back({"series", {{"series", "1"}}, engine::kDicomImage});
  }

  /// Rows of options whose effect depends on inputs and outputs.
  [[nodiscard]] std::vector<const OptionRow*> rows() const {
    std::vector<const OptionRow*> found;
    for (const OptionRow& row : m_convert.table->rows())
      if (!row.isArgument && row.name != "from" && row.name != "to") found.push_back(&row);
    return found;
  }

  static ContentMask detectContent(const std::string& output) {
    return engine::outputContent(engine::outputFormat(output, ""));
  }

  /// Whether the row claims that it counts for the pair.
  static bool claims(const OptionRow& row, const Input& input, const std::string& output) {
    const ContentMask written = detectContent(output);
    ContentMask read = input.content;
    // a case gets models for a mesh alone
    if (read == engine::kUnfittedCase && (written & engine::kAllMeshes) == 0)
      read = engine::kFittedCase;
    // an image becomes labels by these options
    if (kChoosesLabels.contains(row.name) && read == engine::kFileImage) read = engine::kFileLabels;
    if (kChoosesLabels.contains(row.name) && read == engine::kDicomImage)
      read = engine::kDicomLabels;
    return (row.inputs & read) != 0 && (row.outputs & written) != 0;
  }

  /// Whether other pairs show that the option counts for this one.
  ///
  /// - A stage records its values in the case, and the other outputs are made of it: one option of
  ///   each stage shows that they are.
  /// - A .lumen holds all that a .lumen.json does, glTF and OBJ all that plain STL does.
  /// - Names of branches show in all outputs but plain STL, which has none.
  /// - A mesh is written of the case, whatever that came from: the case that is taken as it is
  ///   shows each mesh, the other inputs one.
  static bool isShownByAnother(const OptionRow& row, const Input& input,
                               const std::string& output) {
    if (!row.recordKey.empty() && !kShowsItsStage.contains(row.name))
      return output != kOutputs.front();
    if (row.name == "label-table" && output.ends_with(".stl")) return true;
    const ContentMask written = detectContent(output);
    if (row.outputs == kAnyContent && row.name != "label-table" &&
        (written & (engine::kBinaryCase | engine::kGltf | engine::kOtherMesh)) != 0)
      return true;
    const bool isOfMesh = (row.outputs & ~engine::kAllMeshes) == 0;
    return isOfMesh && input.content != engine::kFittedCase && output != kFirstMesh &&
           (row.outputs & engine::kGltf) != 0;
  }

  /// Whether the input is recognised as labels, unless seeds are given, which the option needs.
  static bool isByVoxels(const Input& input, const std::string& option) {
    const auto companion = kCompanions.find(option);
    return input.content == engine::kFileLabels && input.options.empty() &&
           (option == "seeds" ||
            (companion != kCompanions.end() && companion->second.first == "seeds"));
  }

  /// The options of a run, with this one or without it.
  static Given optionsOf(const Input& input, const std::string& option, bool isGiven) {
    Given options;
    for (const auto& [name, value] : input.options)
      if (name != option) options.emplace_back(name, value);
    const auto companion = kCompanions.find(option);
    const auto isThere = [&](const std::string& name) {
      return std::any_of(options.begin(), options.end(),
                         [&](const auto& one) { return one.first == name; });
    };
    if (companion != kCompanions.end() && !isThere(companion->second.first))
      options.push_back(companion->second);
    if (isGiven) options.emplace_back(option, sampleOf(option));
    // hints on a vessel that is found may do no more than name it
    if (isGiven && option == "seeds") options.emplace_back("seeds-only", "true");
    return options;
  }

  [[nodiscard]] Effect made(const Input& input, const std::string& output,
                            const Given& options) const {
    Effect effect = effectOf(operationOf("convert", {input.file, output}, options));
    // answers hold times, which no option decides: that of repeats is all that is compared
    effect.answer = effect.answer.find("\"repeats\":{") != std::string::npos ? "repeats" : "";
    return effect;
  }

  engine::BoundCommand m_convert = m_engine.find("convert");
  std::vector<Input> m_inputs;
};

TEST_F(OptionScopeTest, EveryOptionOfConvertHasASample) {
  for (const OptionRow* const row : rows()) EXPECT_NE(sampleOf(row->name), "") << row->name;
}

TEST_F(OptionScopeTest, AnOptionThatWouldDoNothingIsRefusedByName) {
  std::size_t refused = 0;
  for (const OptionRow* const row : rows())
    for (const Input& input : m_inputs)
      for (const std::string& output : kOutputs) {
        if (claims(*row, input, output) || isByVoxels(input, row->name)) continue;
        const Effect effect = made(input, output, optionsOf(input, row->name, true));
        EXPECT_TRUE(isRefusal(effect.error))
            << row->name << " with " << input.file << " and " << output << ": " << effect.error;
        EXPECT_TRUE(effect.files.empty());
        ++refused;
      }
  EXPECT_GT(refused, 2000U);
}

TEST_F(OptionScopeTest, AnOptionThatIsTakenChangesEveryOutputThatItIsFor) {
  std::map<std::string, Effect> usual;
  std::size_t taken = 0;
  for (const OptionRow* const row : rows()) {
    const auto special = specialInputs().find(row->name);
    for (const Input& input : special != specialInputs().end() ? special->second : m_inputs)
      for (const std::string& output : kOutputs) {
        if (!claims(*row, input, output) || isShownByAnother(*row, input, output)) continue;
        const Given without = optionsOf(input, row->name, false);
        std::string key = output + " " + input.file;
        for (const auto& [name, value] : without) key += " " + name + "=" + value;
        if (!usual.contains(key)) usual[key] = made(input, output, without);
        const Effect effect = made(input, output, optionsOf(input, row->name, true));
        EXPECT_FALSE(effect == usual[key])
            << row->name << " with " << input.file << " and " << output << ": " << effect.error;
        ++taken;
      }
  }
  EXPECT_GT(taken, 300U);
}

TEST_F(OptionScopeTest, AnOptionWithoutItsCompanionIsRefused) {
  for (const auto& [option, companion] : kCompanions) {
    if (option == "cohesion-scale") continue;  // it needs one for centerlines alone
    const std::string input = option.starts_with("center") ? "plain.stl"
                              : companion.first == "seeds" || companion.first == "root"
                                  ? "tube.nrrd"
                                  : "case.lumen";
    const Effect effect =
        effectOf(operationOf("convert", {input, "out/o.glb"}, {{option, sampleOf(option)}}));
    EXPECT_NE(effect.error.find("--" + option + " does nothing without --"), std::string::npos)
        << effect.error;
    EXPECT_NE(effect.error.find("--" + companion.first), std::string::npos) << effect.error;
  }
}

}  // namespace lumen::test
