// SPDX-License-Identifier: Apache-2.0
// Every option of `lumen convert` changes the outputs that it is for, and is refused with the name of what it needs for
// all other inputs and outputs.
#include <map>
#include <set>

#include "converters/base/run_program.h"
#include "converters/engine/file_format.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

/// Volume meshes need lumen-netgen in PATH.
const bool kHasNetgen = convert::installedProgram("lumen-netgen").has_value();

const std::vector<std::string> kOutputs = [] {
  std::vector<std::string> outputs = {"out/o.lumen.json", "out/o.lumen", "out/o.glb",
                                      "out/o.stl",        "out/o.obj",   "out/o.swc"};
  if (kHasNetgen) outputs.emplace_back("out/o.vtu");
  return outputs;
}();

/// A place in one of the vessels of apart.nrrd.
constexpr const char* kInOne = "3,3,0";

/// Options that another must accompany.
const std::map<std::string, std::pair<std::string, std::string>> kCompanions = [] {
  std::map<std::string, std::pair<std::string, std::string>> companions = {
      {"only-connected", {"root", kInOne}},
      {"cohesion-scale", {"cohesion-weight", "1e-3"}},
      {"cell", {"patches", "true"}},
      {"touching", {"thickness", "1"}},
      {"draco-position-bits", {"draco", "true"}},
      {"draco-normal-bits", {"draco", "true"}}};
  for (const char* const name :
       {"seeds-frame", "seeds-unit", "seeds-only", "axes", "min-trials", "max-trials",
        "random-seed", "step", "look-ahead", "branch-offset", "max-nodes"})
    companions[name] = {"seeds", "seeds.json"};
  for (const char* const name : {"role", "only-labelled"})
    companions[name] = {"label-map", "halves.nii"};
  for (const char* const name : {"centerline-frame", "centerline-unit"})
    companions[name] = {"centerline", "truth.swc"};
  return companions;
}();

/// Inputs on which an option makes a difference, where it makes none on the usual ones: trials with the
/// option's name as that of the command.
constexpr const char* kSpecialInputs = R"(
seeds tube.nrrd
seeds-only apart.nrrd --seeds one.json
root tube.nrrd
root labels.nrrd --mask true
root plain.stl
root vessels.scn --mesh tip
root truth.swc
only-connected apart.nrrd
only-connected apart.stl
only-connected apart-labels.nrrd --mask true
corrections tube.nrrd
label apart-labels.nrrd
labels apart-labels.nrrd
label-map tube.nrrd
label-map labels.nrrd --mask true
label-table halves.nii --mask true
role tube.nrrd
role labels.nrrd --mask true
native cta.nrrd
only-labelled apart.nrrd --label-map one-label.nrrd
only-labelled apart-labels.nrrd --mask true --label-map one-label.nrrd
volume-index times.nii
series series
fill-gaps gapped
allow-detached header/tube.nhdr
allow-detached header/vessels.scn --mesh tip
gap two.lumen
touching apart.lumen
skin moving-case.lumen.json
skin moving-tracked.lumen.json
time moving-case.lumen.json
time moving-tracked.lumen.json
mask tube.nrrd
mesh-per two.lumen
)";

/// Whether all pairs of inputs and outputs are tried with each option, or one, another for each.
enum class Pairs { All, One };

const std::string kFirstMesh = kOutputs[2];
const std::set<std::string> kShowsItsStage = {"inlier-band", "iso-level"};

const std::set<std::string> kChoosesLabels = {"mask", "label", "labels", "label-table"};

}  // namespace

class OptionScopeTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    for (const Trial& one : trialsOf("i tube.nrrd --seeds seeds.json --seeds-only true\n"
                                     "i labels.nrrd --mask true\n"
                                     "i labels.nrrd\n"  // by their voxels
                                     "i plain.stl\n"
                                     "i vessels.scn --mesh tip\n"
                                     "i truth.swc\n"
                                     "i tracked.lumen\n"
                                     "i case.lumen\n"))
      m_inputs.push_back(inputOf(one.operation));
    if (m_hasDicom) m_inputs.push_back({"series", {{"series", "1"}}, engine::kDicomImage});
    for (const Trial& one : trialsOf(kSpecialInputs))
      m_special[one.operation.name].push_back(inputOf(one.operation));
  }

  static Input inputOf(const Operation& operation) {
    const std::string& file = operation.arguments.front();
    const auto has = [&file](const char* word) { return file.find(word) != std::string::npos; };
    Input input{file, {}, engine::kUnfittedCase};
    if (!has("tracked"))
      input.content =
          engine::inputContent(engine::inputFormat(file, ""), has("labels") || has("halves"));
    for (const auto& [name, values] : operation.options)
      input.options.emplace_back(name, values.front());
    return input;
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
    const bool isOfNames =
        row.name == "label-map" || row.name == "label-table" || row.name == "role";
    if (isOfNames && output.ends_with(".stl")) return true;
    const ContentMask written = detectContent(output);
    if (row.outputs == kAnyContent && row.name != "label-table" &&
        (written & (engine::kBinaryCase | engine::kGltf | engine::kOtherMesh | engine::kCells)) !=
            0)
      return true;
    const bool isOfMesh = (row.outputs & ~engine::kAllMeshes) == 0;
    const bool isShownByFirst =
        output != kFirstMesh && (row.outputs & (engine::kGltf | engine::kCells)) != 0;
    return isOfMesh && input.content != engine::kFittedCase && isShownByFirst;
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

  /// Those of the inputs and outputs that `isWanted` takes for the row, or one of them.
  template <class Wanted>
  std::vector<std::pair<Input, std::string>> pairsFor(const std::vector<Input>& inputs, Pairs pairs,
                                                      const Wanted& isWanted) {
    std::vector<std::pair<Input, std::string>> found;
    for (const Input& input : inputs)
      for (const std::string& output : kOutputs)
        if (isWanted(input, output)) found.emplace_back(input, output);
    if (pairs == Pairs::All || found.size() < 2) return found;
    return {found[m_turn++ % found.size()]};
  }

  void expectRefusals(Pairs pairs) {
    for (const OptionRow* const row : rows()) {
      const auto isIdle = [&](const Input& input, const std::string& output) {
        return !claims(*row, input, output) && !isByVoxels(input, row->name);
      };
      for (const auto& [input, output] : pairsFor(m_inputs, pairs, isIdle)) {
        const Effect effect = made(input, output, optionsOf(input, row->name, true));
        EXPECT_TRUE(isRefusal(effect.error))
            << row->name << " with " << input.file << " and " << output << ": " << effect.error;
        EXPECT_TRUE(effect.files.empty());
      }
    }
  }

  void expectChanges(Pairs pairs) {
    std::map<std::string, Effect> usual;
    for (const OptionRow* const row : rows()) {
      const auto counts = [&](const Input& input, const std::string& output) {
        return claims(*row, input, output) && !isShownByAnother(*row, input, output);
      };
      const auto special = m_special.find(row->name);
      const auto tried =
          pairsFor(special != m_special.end() ? special->second : m_inputs, pairs, counts);
      EXPECT_FALSE(tried.empty() &&
                   (m_hasDicom || (row->name != "series" && row->name != "fill-gaps")) &&
                   (kHasNetgen || row->outputs != engine::kCells))
          << row->name;
      for (const auto& [input, output] : tried) {
        const Given without = optionsOf(input, row->name, false);
        std::string key = output + " " + input.file;
        for (const auto& [name, value] : without) key += " " + name + "=" + value;
        if (!usual.contains(key)) usual[key] = made(input, output, without);
        const Effect effect = made(input, output, optionsOf(input, row->name, true));
        EXPECT_FALSE(effect == usual[key])
            << row->name << " with " << input.file << " and " << output << ": " << effect.error;
      }
    }
  }

  engine::BoundCommand m_convert = m_engine.find("convert");
  std::vector<Input> m_inputs;
  std::map<std::string, std::vector<Input>> m_special;  ///< by the option

private:
  std::size_t m_turn = 0;
};

TEST_F(OptionScopeTest, EveryOptionOfConvertHasASample) {
  for (const OptionRow* const row : rows()) EXPECT_NE(sampleOf(row->name), "") << row->name;
}

TEST_F(OptionScopeTest, AnOptionThatWouldDoNothingIsRefusedByName) {
  expectRefusals(Pairs::One);
}

TEST_F(OptionScopeTest, AnOptionIsRefusedWithEveryInputAndOutputThatItIsNotFor) {
  expectRefusals(Pairs::All);
}

TEST_F(OptionScopeTest, AnOptionThatIsTakenChangesAnOutputThatItIsFor) {
  expectChanges(Pairs::One);
}

TEST_F(OptionScopeTest, AnOptionThatIsTakenChangesEveryOutputThatItIsFor) {
  expectChanges(Pairs::All);
}

TEST_F(OptionScopeTest, AnOptionWithoutItsCompanionIsRefused) {
  for (const auto& [option, companion] : kCompanions) {
    if (option == "cohesion-scale") continue;  // it needs one for centerlines alone
    const std::string input =
        option.starts_with("center") ? "plain.stl"
        : companion.first == "seeds" || companion.first == "root" || companion.first == "label-map"
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
