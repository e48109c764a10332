// SPDX-License-Identifier: Apache-2.0
// Options of all commands that would do nothing beside the files or the other options of a run: each
// is refused with the name of what it needs.
#include <algorithm>
#include <sstream>

#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

/// Runs, and below each a sentence of its error.
constexpr const char* kRefusals = R"(track tube.nrrd out/t.lumen --label-table table.csv
  --label-table does nothing without --label-map
track tube.nrrd out/t.lumen --role 1=bone
  --role does nothing without --label-map
track tube.nrrd out/t.lumen --only-labelled true
  --only-labelled does nothing without --label-map
track tube.nrrd out/t.lumen --label-map labels.nrrd --role 7=bone
  --role: no label map has the label 7
track tube.nrrd out/t.lumen --label-map labels.nrrd --role 1=bones
  --role: found 1=bones, expected a label by its name or number, = and its role: unknown, vessel
info labels.nrrd --role 1=bone
  --role does nothing without --voxels
track tube.nrrd out/t.lumen --only-connected true
  --only-connected does nothing without --seeds or --root
seeds tube.nrrd out/s.json --step 0.4
  --step: there is no such option
info truth.swc --centerline-frame ras
  --centerline-frame: there is no such option
info tube.nrrd --frame ras
  --frame is for meshes or centerlines, and
info case.lumen --chunks true --from lumen
  --from does nothing with --chunks
info tracked.lumen --surface true
  --surface is for cases with models, and tracked.lumen has none
report tracked.lumen out/r.html --volume tube.nrrd --point-spread 1
  --point-spread is for cases with models, and tracked.lumen has none
report case.lumen out/r.html --point-spread 1
  --point-spread does nothing without --volume
report case.lumen out/r.html --from nrrd
  --from does nothing without --volume
phantom tube out/p.nrrd --tree truth.swc
  tube and --tree are two phantoms, expected one
phantom out/p.nrrd --tree truth.swc --size 40
  --size does nothing with --tree
phantom tube out/p.nrrd --into tube.nrrd
  --into does nothing without --tree
phantom out/p.nrrd --tree truth.swc --contrast 200
  --contrast does nothing without --into
phantom out/p.nrrd --tree truth.swc --into scan.nrrd --noise 0.1
  --noise does nothing with --into
phantom out/p.nrrd --tree truth.swc --into scan.nrrd --vein-contrast 90
  --vein-contrast does nothing without --veins
phantom out/p.nrrd --tree truth.swc --into scan.nrrd --move 500,0,0
  no vessel of the trees lies in the body
phantom tube out/p.nrrd --size 32 --clicks careless
  --clicks does nothing without --seeds
phantom tube out/p.nrrd --size 32 --phases 3
  --phases does nothing without --motion
phantom tube out/p.nrrd --size 32 --click-drawing 2
  --click-drawing does nothing without --seeds
fit tracked.lumen out/f.lumen --kernel quartic --kernel-parameter 0.3
  --kernel-parameter does nothing with --kernel quartic, which has no parameter
fit tracked.lumen out/f.lumen --cohesion-weight 0 --cohesion-scale 3
  --cohesion-scale does nothing with --cohesion-weight 0
fit tracked.lumen out/f.lumen --spacing 0.2
  --spacing does nothing without --image
fit tracked.lumen out/f.lumen --seam-sweeps 0 --seam-weight 3
  --seam-weight does nothing with --seam-sweeps 0
convert truth.swc out/f.lumen --cohesion-scale 3
  --cohesion-scale does nothing without --cohesion-weight
convert labels.nrrd out/f.lumen --inlier-rate 0.6
  --inlier-rate is for volumes of grey values, and labels.nrrd is none of these
convert case.lumen out/o.glb --edge 0.3 --edge-max 0.4
  --edge-max does nothing with --edge in mm
convert case.lumen out/o.glb --edge-min 0.1 --edge 0.3
  --edge-min does nothing with --edge in mm
convert case.lumen out/o.glb --patches false --cell 0.4
  --cell does nothing without --patches
convert tree.lumen out/o.lumen --point-bits 8
  --point-bits is for cases with wall points, and tree.lumen has none
convert tube.nrrd out/o.swc --iso-level 0.2
  --iso-level is for writing meshes, .lumen or .lumen.json, and out/o.swc is none of these
library add out/lib case.lumen --synthetic true --only true
  --only does nothing without --replace
library add out/lib tree.lumen --synthetic true --picture left
  this case has no models, so there is nothing for --picture
view case.lumen --html-volume true
  --html-volume does nothing without --html
view case.lumen --html out/v.html --html-volume true
  --html-volume is for a volume beside the case, and case.lumen has none
view tree.lumen --html out/v.html --html-points true
  --html-points is for cases with wall points, and tree.lumen has none
view case.lumen --html out/v.html --port 1234
  exclude one another
view case.lumen --serverless out/site
  --serverless writes the page alone, into which people drop their files
view --serverless out/site --html out/v.html
  --html does nothing with --serverless
view --serverless out/site --crop 1,9,1,9,1,9
  --crop does nothing with --serverless
)";

}  // namespace

class RefusalScopeTest : public ScopeTest {
protected:
  /// Runs the command with each row of its table that is not for the content, and returns how many.
  std::size_t refusedFor(const std::string& command, const std::vector<std::string>& arguments,
                         const Given& stated, ContentMask content) const {
    std::size_t count = 0;
    const engine::BoundCommand bound = m_engine.find(command);
    if (!bound.command) return 0;
    for (const OptionRow& row : bound.table->rows()) {
      if (row.isArgument || (row.inputs & content) != 0) continue;
      Given options = stated;
      std::erase_if(options, [&](const auto& one) {
        return std::ranges::find(row.excludes, one.first) != row.excludes.end();
      });
      options.emplace_back(row.name, row.isFlag() ? "true" : sampleOf(row.name));
      const Effect effect = effectOf(operationOf(command, arguments, options));
      EXPECT_TRUE(effect.error.starts_with("--" + row.name + " is for "))
          << command << " " << arguments.front() << " --" << row.name << ": " << effect.error;
      ++count;
    }
    return count;
  }
};

TEST_F(RefusalScopeTest, AnOptionForOtherFilesIsRefusedByEveryCommand) {
  std::vector<Input> inputs = {{"tube.nrrd", {}, engine::kFileImage},
                               {"plain.stl", {}, engine::kPlainMesh},
                               {"header/vessels.scn", {}, engine::kScene},
                               {"truth.swc", {}, engine::kCenterline},
                               {"case.lumen", {}, engine::kFittedCase}};
  if (m_hasDicom) inputs.push_back({"series", {}, engine::kDicomImage});
  std::size_t count = 0;
  for (const Input& input : inputs) {
    count += refusedFor("info", {input.file}, {}, input.content);
    // a case may lie beside each of them
    count += refusedFor("view", {input.file}, {{"html", "out/v.html"}},
                        input.content | engine::kFittedCase);
    if (input.content == engine::kFittedCase)
      count += refusedFor("seeds", {input.file, "out/s.json"}, {}, input.content);
    if ((input.content & engine::kVolumes) == 0) continue;
    const Given volume = {{"volume", input.file}};
    count += refusedFor("track", {input.file, "out/t.lumen"}, {}, input.content);
    count += refusedFor("seeds", {input.file, "out/s.json"}, {}, input.content);
    count += refusedFor("check", {input.file, "case.lumen"}, {}, input.content);
    count += refusedFor("picture", {"case.lumen", "out/p.png"}, volume, input.content);
    count += refusedFor("report", {"case.lumen", "out/r.html"}, volume, input.content);
  }
  EXPECT_GT(count, 40U);
}

TEST_F(RefusalScopeTest, AnOptionThatWouldDoNothingIsRefusedWithWhatItNeeds) {
  if (m_engine.find("library init").command)
    make({"library", "init", "lib", "--title", "Tubes", "--licence", "CC0-1.0"});
  std::istringstream lines(kRefusals);
  for (std::string line, sentence; std::getline(lines, line) && std::getline(lines, sentence);) {
    const Operation operation = trialsOf(line).front().operation;
    if (!m_engine.find(operation.name).command) continue;  // built without libraries or viewer
    const bool isLibrary = operation.name.starts_with("library");
    const Effect effect = effectOf(
        operation, isLibrary ? std::vector<std::string>{"lib"} : std::vector<std::string>{});
    EXPECT_NE(effect.error.find(sentence.substr(2)), std::string::npos)
        << line << ": " << effect.error << "\nexpected: " << sentence;
  }
}

TEST_F(RefusalScopeTest, EveryOptionOfChunksIsRefused) {
  const engine::BoundCommand info = m_engine.find("info");
  for (const OptionRow& row : info.table->rows()) {
    if (row.isArgument || row.name == "chunks") continue;
    const Given options = {{"chunks", "true"},
                           {row.name, row.isFlag()         ? "true"
                                      : row.name == "from" ? "lumen"
                                                           : sampleOf(row.name)}};
    EXPECT_TRUE(isRefusal(effectOf(operationOf("info", {"case.lumen"}, options)).error))
        << row.name;
  }
}

TEST_F(RefusalScopeTest, EveryOptionOfAVolumeNeedsTheVolume) {
  for (const char* const command : {"picture", "report"}) {
    const std::string output = command == std::string("picture") ? "out/p.png" : "out/r.html";
    const engine::BoundCommand bound = m_engine.find(command);
    for (const OptionRow& row : bound.table->rows()) {
      if (row.isArgument || row.group != "Volume") continue;
      const Effect effect =
          effectOf(operationOf(command, {"case.lumen", output}, {{row.name, sampleOf(row.name)}}));
      EXPECT_EQ(effect.error, "--" + row.name + " does nothing without --volume");
    }
  }
}

}  // namespace lumen::test
