// SPDX-License-Identifier: Apache-2.0
// Every option of every command changes what the command answers or writes. Options of convert and of
// export are in tests of their own.
#include <algorithm>
#include <map>
#include <set>

#include "converters/stages/phantom/phantom.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

/// A run of a command, and below it options, each of which changes its effect.
constexpr const char* kVolumeTrials = R"(
track tube.nrrd out/t.lumen.json --seeds seeds.json --seeds-only true
  --crop 2,29,2,29,2,29 --spacing 0.21 --unit cm --seeds-frame ras --seeds-unit cm --dark true
  --root 3.1,3.1,5.8 --inlier-rate 0.6 --inlier-band 0.12 --rays 42 --axes 21 --samples 64
  --min-trials 100 --max-trials 400 --step 0.4 --noise-margin 1.5 --look-ahead 2
  --branch-offset 1.5 --aneurysm-gradient 0.4 --point-spread 0.1 --smoothing 0.17
  --even-blur false --max-nodes 1000 --random-seed 2 --repeat 1
track cta.nrrd out/t.lumen.json
  --native plain.nrrd
track tube.nrrd out/t.lumen.json
  --label-map halves.nii
track tube.nrrd out/t.lumen.json --label-map halves.nii
  --label-table table.csv --role 1=bone
track apart.nrrd out/t.lumen.json --label-map one-label.nrrd
  --only-labelled true
track two.nrrd out/t.lumen.json
  --seeds two.json
track apart.nrrd out/t.lumen.json --seeds one.json
  --seeds-only true
track apart.nrrd out/t.lumen.json --root 3,3,0
  --only-connected true
track times.nii out/t.lumen.json
  --volume-index 1
track header/tube.nhdr out/t.lumen.json
  --allow-detached .
track volume out/t.lumen.json
  --from nrrd
track tube.nrrd out/t.data --seeds seeds.json --seeds-only true
  --to lumen
seeds tube.nrrd out/s.json
  --crop 2,29,2,29,2,29 --spacing 0.21 --unit cm --dark true --inlier-rate 0.999
  --inlier-band 0.05 --rays 42 --samples 16 --noise-margin 100 --point-spread 0.4
  --smoothing 0.3 --repeat 1
seeds times.nii out/s.json
  --volume-index 1
seeds header/tube.nhdr out/s.json
  --allow-detached .
seeds volume out/s.json
  --from nrrd
info tube.nrrd
  --crop 2,29,2,29,2,29 --spacing 0.21 --unit cm --voxels true
info halves.nii --voxels true
  --label-table table.csv --role 1=bone
info times.nii
  --volume-index 1
info header/tube.nhdr
  --allow-detached .
info header/vessels-only.scn
  --allow-detached .
info plain.stl
  --unit cm --frame ras
info truth.swc
  --unit cm
info case.lumen
  --chunks true --surface true
info volume
  --from nrrd
check tube.nrrd case.lumen
  --crop 2,29,2,29,2,29 --spacing 0.21 --unit cm --point-spread 0.5 --profile flow
  --overlay out/o.png --mask out/m.nrrd
check times.nii case.lumen
  --volume-index 1
check tube.nrrd moving-case.lumen.json
  --time 1
check header/tube.nhdr case.lumen
  --allow-detached .
check volume case.lumen
  --from nrrd
picture case.lumen out/p.png
  --size 80x60
picture case.lumen out/p.png --size 80x60
  --view left --colour radius --volume tube.nrrd --turntable 2
picture moving-case.lumen.json out/p.png --size 80x60
  --time 1
picture case.lumen out/p.png --size 80x60 --volume tube.nrrd
  --crop 2,20,2,20,2,20 --spacing 0.21 --unit cm
picture case.lumen out/p.png --size 80x60 --volume times.nii
  --volume-index 1
picture case.lumen out/p.png --size 80x60 --volume header/tube.nhdr
  --allow-detached .
xray case.lumen out/x.png
  --size 40x30
xray case.lumen out/x.png --size 40x30
  --lao 10 --cra 20 --isocentre 0,0,0 --source-distance 700 --detector-distance 1100 --pixel 0.2
xray case.lumen out/x.nrrd --size 40x30
  --volume cta.nrrd
xray case.lumen out/x.nrrd --size 40x30
  --kv 90 --filter 3 --iodine 200 --tissue 100 --scatter 0.5 --photons 1000 --subtract true
xray case.lumen out/x.nrrd --size 40x30 --photons 100
  --random-seed 2
xray moving-case.lumen.json out/x.png --size 40x30
  --time 1
report tracked.lumen out/r.html
  --title Tube --volume tube.nrrd
report case.lumen out/r.html --volume tube.nrrd
  --point-spread 0.5
report tracked.lumen out/r.html --volume tube.nrrd
  --crop 2,20,2,20,2,20 --spacing 0.21 --unit cm
report tracked.lumen out/r.html --volume times.nii
  --volume-index 1
report tracked.lumen out/r.html --volume header/tube.nhdr
  --allow-detached .
report tracked.lumen out/r.html --volume volume
  --from nrrd
report moving-tracked.lumen.json out/r.html
  --time 1
phantom tube out/p.nrrd --size 32 --seeds out/s.json
  --size 40 --voxel 0.23 --slice-thickness 0.95 --fade 0.5 --clutter bone --noise 0.2 --bias 0.3
  --psf 1 --seed 2 --clicks careless --click-drawing 2 --motion heart --truth out/t.lumen
  --seeds out/q.json
phantom willis out/p.nrrd --size 32 --truth out/t.lumen
  --without Acom
phantom hepatic out/p.nrrd --size 32 --motion breath --phases 3
  --phases 2
phantom out/p.nrrd --seeds out/s.json --tree fork.swc
  --tree truth.swc --voxel 0.23 --noise 0.2 --motion heart --into scan.nrrd
phantom out/p.nrrd --truth out/t.lumen --tree apart.swc --into scan.nrrd --veins fork.swc
  --contrast 200 --vein-contrast 90 --move 20,18,19 --turn 0,0,90 --veins apart.swc
)";

constexpr const char* kCaseTrials = R"(
fit tracked.lumen out/f.lumen.json
  --kernel gaussian --kernel-parameter 0.3 --cohesion-weight 1e-4 --curvature-weight 1e-2
  --cohesion-scale 3 --max-subdivisions 2 --neighbourhood 1 --seam-sweeps 1 --seam-weight 32
  --iso-level 0.15 --accuracy 0.5 --max-distance 30 --min-width 0.03 --image tube.nrrd
fit tracked.lumen out/f.data
  --to lumen
fit tracked.lumen out/f.lumen.json --image tube.nrrd
  --crop 2,20,2,20,2,20 --spacing 0.21 --unit cm
fit tracked.lumen out/f.lumen.json --image times.nii
  --volume-index 1
fit tracked.lumen out/f.lumen.json --image header/tube.nhdr
  --allow-detached .
fit tracked.lumen out/f.lumen.json --image volume
  --from nrrd
motion tracked.lumen tube.nrrd --out out/m.lumen.json
  --period 0.8 --times 0.5 --reach 2 --crop 2,20,2,20,2,20 --spacing 0.21 --unit cm
motion tracked.lumen times.nii --out out/m.lumen.json
  --volume-index 1
motion tracked.lumen times.nii --out out/m.lumen.json --period 2
  --frames 2
motion tracked.lumen header/tube.nhdr --out out/m.lumen.json
  --allow-detached .
motion tracked.lumen volume --out out/m.lumen.json
  --from nrrd
trim ends.lumen out/t.lumen.json --min-length 1
  --min-radius 0.5
trim ends.lumen out/t.lumen.json --min-radius 0.1
  --min-length 3
  --taper 0.9
  --stub 3
trim ends.lumen out/t.data --min-radius 0.1
  --to lumen
info case.lumen --accept seen --out out/i.lumen.json
  --accept looked --out out/j.lumen.json
info case.lumen --accept seen --out out/i.data
  --to lumen
ends case.lumen --root 2 --out out/e.lumen.json
  --root 1 --out out/f.lumen.json
ends case.lumen --root 2 --out out/e.data
  --to lumen
names case.lumen
  --table out/n.csv
names case.lumen --rename root=a --out out/n.lumen.json
  --rename root=b --out out/o.lumen.json
names case.lumen --rename root=a --out out/n.data
  --to lumen
measure case.lumen
  --out out/measures.csv --step 0.3 --against tracked.lumen
measure moving-case.lumen.json
  --time 1
validate tree.lumen
  --surface true
validate person.lumen.json
  --privacy true
validate person.lumen.json --privacy true
  --max-issues 0
library init out/new --title A --licence MIT --date 2026-11-22
  --id 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4
  --title B --licence CC0-1.0 --date 2026-11-23 --id 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a5
  --description D --publisher P
library add out/lib case.lumen --date 2026-11-22 --synthetic true --picture none --no-surface true
  --id one --date 2026-11-23 --about about.json --title T --description D --anatomy A
  --code FMA:3947:carotid --laterality left --modality XA --licence MIT --attribution A
  --doi 10.5281/zenodo.1234 --origin O --consent C --deidentification D --synthetic false
  --no-surface false --picture left --turntable 1 --export svzerod --report true --viewer true
  --file table.csv
  --recipe aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa
library add out/lib two.lumen --date 2026-11-22 --synthetic true --picture none --no-surface true --id tube
  --replace true
library add out/lib two.lumen --date 2026-11-22 --synthetic true --picture none --no-surface true --id tube --replace true
  --only true
library update out/lib tube --date 2026-11-22 --title T
  --date 2026-11-23 --about about.json --title U --description D --anatomy A
  --code FMA:3947:carotid --laterality left --modality XA --licence MIT --attribution A
  --doi 10.5281/zenodo.1234 --origin O --consent C --deidentification D
library remove out/lib tube --date 2026-11-22
  --date 2026-11-23
library check out/lib
  --resume out/journal
library check out/hurt
  --max-faults 0
library extract out/lib out/new --case tube --date 2026-11-22 --id 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4
  --case none --title T --date 2026-11-23 --id 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a5
library verify out/hurt --key publisher.pub --no-state true
  --key table.csv --identity publisher --max-faults 0
)";

/// Options that are not tried here, by the reason.
const std::map<std::string, std::set<std::string>> kElsewhere = {
    {"needs DICOM: below",
     {"check series", "fit series", "motion series", "info series", "picture series",
      "report series", "seeds series", "track series", "check fill-gaps", "fit fill-gaps",
      "motion fill-gaps", "info fill-gaps", "picture fill-gaps", "report fill-gaps",
      "seeds fill-gaps", "track fill-gaps"}},
    {"needs another volume, or bounds work that ends before",
     {"seeds max-trials", "seeds aneurysm-gradient", "seeds even-blur"}},
    {"batch_test and names_test",
     {"batch jobs", "batch profile", "batch accept", "batch option", "batch rows", "names names",
      "names anatomy"}},
    {"tests/library and tests/pipelines",
     {"motion out",
      "library build jobs",
      "library build keep-going",
      "library build profile",
      "library build accept",
      "library update synthetic",
      "library build work",
      "library build resume",
      "library build rows",
      "library build make-only",
      "library build collect",
      "library build status",
      "library sample jobs",
      "library sample work",
      "library sample patients",
      "library sample size",
      "library sign key",
      "library sign resume",
      "library verify state",
      "library verify no-state"}}};

const std::set<std::string> kOtherTests = {"convert", "export", "view"};

}  // namespace

class CommandScopeTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    fillOnce("scope of commands", [this] { makeOthers(); });
  }

  void makeOthers() const {
    namespace fs = std::filesystem;
    fs::copy_file("tube.nrrd", "volume");
    write("fork.swc", "1 0 0 0 0 .6 -1\n2 0 6 0 0 .6 1\n3 0 10 2 0 .5 2\n4 0 10 -3 0 .4 2\n");
    // cylinders are drawn at random only where noise leaves gaps between the others
    write("header/vessels-only.scn",
          "<Node name=\"root\"><MeshSTLLoader filename=\"../plain.stl\"/></Node>\n");
    write("about.json", "{\"title\": \"About\", \"description\": \"A tube to try\"}");
    make({"convert", "case.lumen", "person.lumen.json"});
    std::string text = read("person.lumen.json");
    const std::string label = "\"label\": \"root\"";
    ASSERT_NE(text.find(label), std::string::npos);
    text.replace(text.find(label), label.size(), "\"label\": \"born 1.2.1950\"");
    write("person.lumen.json", text);
    write("publisher.pub",
          "untrusted comment: minisign public key 4399E96D31EC718D\n"
          "RWSNcewxbemZQ25UeTL5oHtBrhmRV2EuLdlY1eRmmzTCIaWAcV1UKXaI\n");
    if (!m_engine.find("library init").command) return;
    make({"library", "init", "lib", "--title", "Tubes", "--licence", "CC0-1.0", "--date",
          "2026-11-22", "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4"});
    make({"library", "add", "lib", "case.lumen", "--synthetic", "--id", "tube", "--no-surface",
          "--picture", "left", "--title", "Tube", "--date", "2026-11-22"});
    fs::copy("lib", "hurt", fs::copy_options::recursive);
    fs::remove("hurt/data/tube/case.lumen");
  }

  /// The effect of a run on copies of the libraries, where it may write.
  [[nodiscard]] Effect effectOfTrial(const Operation& operation) const {
    const bool isLibrary = operation.name.starts_with("library");
    return effectOf(operation, isLibrary ? std::vector<std::string>{"lib", "hurt"}
                                         : std::vector<std::string>{});
  }

  void expectEffects(const char* trials) const {
    for (const Trial& trial : trialsOf(trials)) {
      if (!m_engine.find(trial.operation.name).command) continue;  // built without libraries
      const Effect usual = effectOfTrial(trial.operation);
      for (const auto& one : trial.tried) {
        const Effect effect = effectOfTrial(withOption(trial.operation, one));
        EXPECT_FALSE(effect == usual)
            << trial.operation.name << " " << trial.operation.arguments.front() << " --"
            << one.first << " " << one.second << ": " << effect.error;
      }
    }
  }
};

TEST_F(CommandScopeTest, EveryOptionIsTried) {
  std::set<std::string> tried, elsewhere;
  for (const char* const trials : {kVolumeTrials, kCaseTrials})
    for (const Trial& trial : trialsOf(trials))
      for (const auto& [name, value] : trial.tried) tried.insert(trial.operation.name + " " + name);
  for (const auto& [reason, names] : kElsewhere) elsewhere.insert(names.begin(), names.end());
  for (const auto& [command, table] : m_engine.commands())
    for (const OptionRow& row : table->rows()) {
      if (row.isArgument || kOtherTests.contains(command->name())) continue;
      const std::string name = command->name() + " " + row.name;
      EXPECT_TRUE(tried.contains(name) != elsewhere.contains(name)) << name;
    }
}

TEST_F(CommandScopeTest, AnOptionOfACommandThatReadsVolumesChangesItsAnswer) {
  expectEffects(kVolumeTrials);
}

TEST_F(CommandScopeTest, AnOptionOfACommandOfCasesChangesItsAnswer) {
  expectEffects(kCaseTrials);
}

TEST_F(CommandScopeTest, ASeriesOfDicomIsChosenByEveryCommandThatReadsVolumes) {
  if (!m_hasDicom) GTEST_SKIP() << "lumen was built without DICOM";
  for (const Trial& trial : trialsOf("track series out/t.lumen.json\n"
                                     "seeds series out/s.json\n"
                                     "info series --voxels true\n"
                                     "check series case.lumen\n"
                                     "picture case.lumen out/p.png --volume series --size 80x60\n"
                                     "report tracked.lumen out/r.html --volume series\n")) {
    const Effect first = effectOf(withOption(trial.operation, {"series", "1"}));
    EXPECT_EQ(first.error, "") << trial.operation.name;
    EXPECT_FALSE(first == effectOf(withOption(trial.operation, {"series", "2"})))
        << trial.operation.name;
    Operation gapped = trial.operation;
    for (std::string& argument : gapped.arguments)
      if (argument == "series") argument = "gapped";
    for (auto& [name, values] : gapped.options)
      std::replace(values.begin(), values.end(), std::string("series"), std::string("gapped"));
    const Effect refused = effectOf(gapped);
    EXPECT_NE(refused.error.find("--fill-gaps"), std::string::npos) << refused.error;
    EXPECT_EQ(effectOf(withOption(gapped, {"fill-gaps", "true"})).error, "") << gapped.name;
  }
}

TEST_F(CommandScopeTest, EveryOptionChangesEveryPhantom) {
  const Given options = {
      {"size", "40"},         {"voxel", "0.23"},       {"slice-thickness", "0.95"},
      {"fade", "0.5"},        {"clutter", "bone"},     {"clutter", "vein"},
      {"clutter", "streaks"}, {"clutter", "stent"},    {"clutter", "void"},
      {"noise", "0.2"},       {"bias", "0.3"},         {"psf", "1"},
      {"seed", "2"},          {"clicks", "careless"},  {"click-drawing", "2"},
      {"motion", "heart"},    {"truth", "out/t.lumen"}};
  for (const std::string& name : convert::phantomNames()) {
    const bool isLarge = name == "patient";  // it needs 128 voxels
    const Operation operation =
        operationOf("phantom", {name, "out/p.nrrd"},
                    {{"size", isLarge ? "128" : "32"}, {"seeds", "out/s.json"}});
    const Effect usual = effectOf(operation);
    EXPECT_EQ(usual.error, "") << name;
    for (const auto& option : options)
      if (!isLarge || option.first == "seed" || option.first == "clicks") {
        Effect effect = effectOf(withOption(operation, option));
        effect.answer = usual.answer;  // it states the size
        EXPECT_FALSE(effect == usual) << name << " --" << option.first << " " << option.second;
      }
  }
}

}  // namespace lumen::test
