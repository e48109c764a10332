// SPDX-License-Identifier: Apache-2.0
// Every option of the commands but convert, export and phantom, whose options are in tests of their
// own: it changes what the command answers or writes.
#include <algorithm>
#include <map>
#include <set>

#include "converters/engine/file_format.h"
#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

/// Runs of a command, each with one option more than `stated`.
struct Trial {
  std::string command;
  std::vector<std::string> arguments;
  Given stated;  ///< given in both runs
  Given tried;
};

const Given kSeeds = {{"seeds", "seeds.json"}, {"seeds-only", "true"}};
const std::string kDigest(64, 'a');

const std::vector<Trial> kVolumeTrials = {
    {"track",
     {"tube.nrrd", "out/t.lumen.json"},
     kSeeds,
     {{"crop", "2,29,2,29,2,29"},
      {"spacing", "0.21"},
      {"unit", "cm"},
      {"seeds-frame", "ras"},
      {"seeds-unit", "cm"},
      {"root", "3.1,3.1,5.8"},
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
      {"repeat", "1"}}},
    {"track", {"tube.nrrd", "out/t.lumen.json"}, {}, {{"label-map", "halves.nii"}}},
    {"track",
     {"tube.nrrd", "out/t.lumen.json"},
     {{"label-map", "halves.nii"}},
     {{"label-table", "table.csv"}}},
    {"track", {"two.nrrd", "out/t.lumen.json"}, {}, {{"seeds", "two.json"}}},
    {"track",
     {"apart.nrrd", "out/t.lumen.json"},
     {{"seeds", "one.json"}},
     {{"seeds-only", "true"}}},
    {"track",
     {"apart.nrrd", "out/t.lumen.json"},
     {{"root", "3,3,0"}},
     {{"only-connected", "true"}}},
    {"track", {"times.nii", "out/t.lumen.json"}, {}, {{"volume-index", "1"}}},
    {"track", {"header/tube.nhdr", "out/t.lumen.json"}, {}, {{"allow-detached", "."}}},
    {"track", {"volume", "out/t.lumen.json"}, {}, {{"from", "nrrd"}}},
    {"track", {"tube.nrrd", "out/t.data"}, kSeeds, {{"to", "lumen"}}},
    // seeds hold no record of a value that happens to change no vessel
    {"seeds",
     {"tube.nrrd", "out/s.json"},
     {},
     {{"crop", "2,29,2,29,2,29"},
      {"spacing", "0.21"},
      {"unit", "cm"},
      {"dark", "true"},
      {"inlier-rate", "0.999"},
      {"inlier-band", "0.05"},
      {"rays", "42"},
      {"samples", "16"},
      {"noise-margin", "100"},
      {"point-spread", "0.4"},
      {"smoothing", "0.3"},
      {"repeat", "1"}}},
    // cylinders are drawn at random only where noise leaves gaps between the others
    {"seeds",
     {"noisy.nrrd", "out/s.json"},
     {},
     {{"axes", "21"}, {"min-trials", "3"}, {"random-seed", "2"}}},
    {"seeds", {"times.nii", "out/s.json"}, {}, {{"volume-index", "1"}}},
    {"seeds", {"header/tube.nhdr", "out/s.json"}, {}, {{"allow-detached", "."}}},
    {"seeds", {"volume", "out/s.json"}, {}, {{"from", "nrrd"}}},
    {"info",
     {"tube.nrrd"},
     {},
     {{"crop", "2,29,2,29,2,29"}, {"spacing", "0.21"}, {"unit", "cm"}, {"voxels", "true"}}},
    {"info", {"times.nii"}, {}, {{"volume-index", "1"}}},
    {"info", {"header/tube.nhdr"}, {}, {{"allow-detached", "."}}},
    {"info", {"header/vessels-only.scn"}, {}, {{"allow-detached", "."}}},
    {"info", {"plain.stl"}, {}, {{"unit", "cm"}}},
    {"info", {"truth.swc"}, {}, {{"unit", "cm"}}},
    {"info", {"case.lumen"}, {}, {{"chunks", "true"}}},
    {"info", {"case.lumen"}, {}, {{"surface", "true"}}},
    {"info", {"volume"}, {}, {{"from", "nrrd"}}},
    {"check",
     {"tube.nrrd", "case.lumen"},
     {},
     {{"crop", "2,29,2,29,2,29"},
      {"spacing", "0.21"},
      {"unit", "cm"},
      {"point-spread", "0.5"},
      {"profile", "flow"},
      {"overlay", "out/o.png"},
      {"mask", "out/m.nrrd"}}},
    {"check", {"times.nii", "case.lumen"}, {}, {{"volume-index", "1"}}},
    {"check", {"tube.nrrd", "moving-case.lumen.json"}, {}, {{"time", "1"}}},
    {"check", {"header/tube.nhdr", "case.lumen"}, {}, {{"allow-detached", "."}}},
    {"check", {"volume", "case.lumen"}, {}, {{"from", "nrrd"}}},
    {"picture",
     {"case.lumen", "out/p.png"},
     {{"size", "160x120"}},
     {{"view", "left"}, {"colour", "radius"}, {"volume", "tube.nrrd"}, {"turntable", "2"}}},
    {"picture", {"case.lumen", "out/p.png"}, {}, {{"size", "160x120"}}},
    {"picture", {"moving-case.lumen.json", "out/p.png"}, {{"size", "160x120"}}, {{"time", "1"}}},
    {"picture",
     {"case.lumen", "out/p.png"},
     {{"size", "160x120"}, {"volume", "tube.nrrd"}},
     {{"crop", "2,20,2,20,2,20"}, {"spacing", "0.21"}, {"unit", "cm"}}},
    {"picture",
     {"case.lumen", "out/p.png"},
     {{"size", "160x120"}, {"volume", "times.nii"}},
     {{"volume-index", "1"}}},
    {"picture",
     {"case.lumen", "out/p.png"},
     {{"size", "160x120"}, {"volume", "header/tube.nhdr"}},
     {{"allow-detached", "."}}},
    {"report", {"tracked.lumen", "out/r.html"}, {}, {{"title", "A tube"}, {"volume", "tube.nrrd"}}},
    {"report", {"case.lumen", "out/r.html"}, {{"volume", "tube.nrrd"}}, {{"point-spread", "0.5"}}},
    // a case without models has no pictures, which take the time
    {"report",
     {"tracked.lumen", "out/r.html"},
     {{"volume", "tube.nrrd"}},
     {{"crop", "2,20,2,20,2,20"}, {"spacing", "0.21"}, {"unit", "cm"}}},
    {"report", {"tracked.lumen", "out/r.html"}, {{"volume", "times.nii"}}, {{"volume-index", "1"}}},
    {"report",
     {"tracked.lumen", "out/r.html"},
     {{"volume", "header/tube.nhdr"}},
     {{"allow-detached", "."}}},
    {"report", {"tracked.lumen", "out/r.html"}, {{"volume", "volume"}}, {{"from", "nrrd"}}},
    {"report", {"moving-tracked.lumen.json", "out/r.html"}, {}, {{"time", "1"}}},
};

const std::vector<Trial> kCaseTrials = {
    {"fit",
     {"tracked.lumen", "out/f.lumen.json"},
     {},
     {{"kernel", "gaussian"},
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
      {"min-width", "0.03"}}},
    {"fit", {"tracked.lumen", "out/f.data"}, {}, {{"to", "lumen"}}},
    {"fit", {"tracked.lumen", "out/f.lumen.json"}, {}, {{"image", "tube.nrrd"}}},
    {"fit",
     {"tracked.lumen", "out/f.lumen.json"},
     {{"image", "tube.nrrd"}},
     {{"crop", "2,20,2,20,2,20"}, {"spacing", "0.21"}, {"unit", "cm"}}},
    {"fit",
     {"tracked.lumen", "out/f.lumen.json"},
     {{"image", "times.nii"}},
     {{"volume-index", "1"}}},
    {"fit",
     {"tracked.lumen", "out/f.lumen.json"},
     {{"image", "header/tube.nhdr"}},
     {{"allow-detached", "."}}},
    {"fit", {"tracked.lumen", "out/f.lumen.json"}, {{"image", "volume"}}, {{"from", "nrrd"}}},
    {"motion",
     {"tracked.lumen", "tube.nrrd"},
     {{"out", "out/m.lumen.json"}},
     {{"period", "0.8"},
      {"times", "0.5"},
      {"reach", "2"},
      {"crop", "2,20,2,20,2,20"},
      {"spacing", "0.21"},
      {"unit", "cm"}}},
    {"motion",
     {"tracked.lumen", "times.nii"},
     {{"out", "out/m.lumen.json"}},
     {{"volume-index", "1"}}},
    {"motion",
     {"tracked.lumen", "times.nii"},
     {{"out", "out/m.lumen.json"}, {"period", "2"}},
     {{"frames", "2"}}},
    {"motion",
     {"tracked.lumen", "header/tube.nhdr"},
     {{"out", "out/m.lumen.json"}},
     {{"allow-detached", "."}}},
    {"motion", {"tracked.lumen", "volume"}, {{"out", "out/m.lumen.json"}}, {{"from", "nrrd"}}},
    {"trim", {"ends.lumen", "out/t.lumen.json"}, {{"min-length", "1"}}, {{"min-radius", "0.5"}}},
    {"trim", {"ends.lumen", "out/t.lumen.json"}, {{"min-radius", "0.1"}}, {{"min-length", "3"}}},
    {"trim", {"ends.lumen", "out/t.data"}, {{"min-radius", "0.1"}}, {{"to", "lumen"}}},
    {"measure",
     {"case.lumen"},
     {},
     {{"out", "out/measures.csv"}, {"step", "0.3"}, {"against", "tracked.lumen"}}},
    {"measure", {"moving-case.lumen.json"}, {}, {{"time", "1"}}},
    {"validate", {"tree.lumen"}, {}, {{"surface", "true"}}},
    {"validate", {"person.lumen.json"}, {}, {{"privacy", "true"}}},
    {"validate", {"person.lumen.json"}, {{"privacy", "true"}}, {{"max-issues", "0"}}},
    {"library init",
     {"out/new"},
     {{"title", "A"},
      {"licence", "MIT"},
      {"date", "2026-11-22"},
      {"id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4"}},
     {{"title", "B"},
      {"licence", "CC0-1.0"},
      {"date", "2026-11-23"},
      {"id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a5"},
      {"description", "D"},
      {"publisher", "P"}}},
    {"library add",
     {"out/lib", "case.lumen"},
     {{"date", "2026-11-22"}, {"synthetic", "true"}, {"picture", "none"}, {"no-surface", "true"}},
     {{"id", "one"},
      {"date", "2026-11-23"},
      {"about", "about.json"},
      {"title", "T"},
      {"description", "D"},
      {"anatomy", "A"},
      {"code", "FMA:3947:Internal carotid artery"},
      {"laterality", "left"},
      {"modality", "XA"},
      {"licence", "MIT"},
      {"attribution", "A"},
      {"doi", "10.5281/zenodo.1234"},
      {"origin", "O"},
      {"consent", "C"},
      {"deidentification", "D"},
      {"synthetic", "false"},
      {"no-surface", "false"},
      {"picture", "left"},
      {"turntable", "1"},
      {"export", "svzerod"},
      {"report", "true"},
      {"viewer", "true"},
      {"file", "table.csv"},
      {"recipe", kDigest}}},
    {"library add",
     {"out/lib", "two.lumen"},
     {{"date", "2026-11-22"},
      {"synthetic", "true"},
      {"picture", "none"},
      {"no-surface", "true"},
      {"id", "tube"}},
     {{"replace", "true"}}},
    {"library add",
     {"out/lib", "two.lumen"},
     {{"date", "2026-11-22"},
      {"synthetic", "true"},
      {"picture", "none"},
      {"no-surface", "true"},
      {"id", "tube"},
      {"replace", "true"}},
     {{"only", "true"}}},
    {"library update",
     {"out/lib", "tube"},
     {{"date", "2026-11-22"}, {"title", "T"}},
     {{"date", "2026-11-23"},
      {"about", "about.json"},
      {"title", "U"},
      {"description", "D"},
      {"anatomy", "A"},
      {"code", "FMA:3947:Internal carotid artery"},
      {"laterality", "left"},
      {"modality", "XA"},
      {"licence", "MIT"},
      {"attribution", "A"},
      {"doi", "10.5281/zenodo.1234"},
      {"origin", "O"},
      {"consent", "C"},
      {"deidentification", "D"}}},
    {"library remove", {"out/lib", "tube"}, {{"date", "2026-11-22"}}, {{"date", "2026-11-23"}}},
    {"library check", {"out/lib"}, {}, {{"resume", "out/journal"}}},
    {"library check", {"out/hurt"}, {}, {{"max-faults", "0"}}},
    {"library extract",
     {"out/lib", "out/new"},
     {{"case", "tube"}, {"date", "2026-11-22"}, {"id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4"}},
     {{"case", "none"},
      {"title", "T"},
      {"date", "2026-11-23"},
      {"id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a5"}}},
    {"library verify",
     {"out/hurt"},
     {{"key", "publisher.pub"}, {"no-state", "true"}},
     {{"key", "table.csv"}, {"identity", "publisher"}, {"max-faults", "0"}}},
};

/// Options that are not tried here, and the reason.
const std::map<std::string, std::string> kElsewhere = {
    {"check series", "as of track, below"},
    {"fit series", "as of track, below"},
    {"motion out", "where the case goes"},
    {"motion series", "as of track, below"},
    {"info series", "as of track, below"},
    {"picture series", "as of track, below"},
    {"report series", "as of track, below"},
    {"seeds series", "as of track, below"},
    {"track series", "needs DICOM"},
    {"seeds max-trials", "bounds work that ends before"},
    {"seeds aneurysm-gradient", "needs an aneurysm"},
    {"seeds even-blur", "needs uneven voxels"},
    {"library build jobs", "changes the time alone"},
    {"library build keep-going", "tests/library/check_build.py"},
    {"library build profile", "tests/library/check_quality.py"},
    {"library build accept", "tests/library/check_quality.py"},
    {"library update synthetic", "the case of the test is synthetic; as of library add"},
    {"library build work", "a place for work, gone at the end; tests/library/check_build.py"},
    {"library build resume", "tests/pipelines/check_rows.py"},
    {"library build rows", "tests/pipelines/check_rows.py"},
    {"library build make-only", "tests/pipelines/check_rows.py"},
    {"library build collect", "tests/pipelines/check_rows.py"},
    {"library build status", "tests/pipelines/check_rows.py"},
    {"library sample jobs", "changes the time alone"},
    {"library sample work", "tests/library/check_sample.py"},
    {"library sample patients", "tests/library/check_sample.py"},
    {"library sample size", "tests/library/check_sample.py"},
    {"library sign key", "needs a program to sign; tests/library/check_trust.py"},
    {"library sign resume", "needs a program to sign; tests/library/check_trust.py"},
    {"library verify state", "needs a signature; tests/library/check_trust.py"},
    {"library verify no-state", "needs a signature; tests/library/check_trust.py"}};

const std::set<std::string> kOtherTests = {"convert", "export", "phantom", "view"};

}  // namespace

class CommandScopeTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    namespace fs = std::filesystem;
    fs::copy_file("tube.nrrd", "volume");
    make({"phantom", "bifurcation", "noisy.nrrd", "--size", "64", "--noise", "0.25"});
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
          "--picture", "left", "--title", "A tube", "--date", "2026-11-22"});
    fs::copy("lib", "hurt", fs::copy_options::recursive);
    fs::remove("hurt/data/tube/case.lumen");
  }

  /// The effect of a run on copies of the libraries, where it may write.
  [[nodiscard]] Effect effectOfTrial(const Trial& trial, const Given& tried) const {
    Given options;
    for (const auto& [name, value] : trial.stated)
      if (std::none_of(tried.begin(), tried.end(),
                       [&name = name](const auto& one) { return one.first == name; }))
        options.emplace_back(name, value);
    options.insert(options.end(), tried.begin(), tried.end());
    const bool isLibrary = trial.command.starts_with("library");
    return effectOf(
        operationOf(trial.command, trial.arguments, options),
        isLibrary ? std::vector<std::string>{"lib", "hurt"} : std::vector<std::string>{});
  }

  void expectEffects(const std::vector<Trial>& trials) const {
    for (const Trial& trial : trials) {
      if (!m_engine.find(trial.command).command) continue;  // built without libraries
      const Effect usual = effectOfTrial(trial, {});
      for (const auto& one : trial.tried) {
        const Effect effect = effectOfTrial(trial, {one});
        EXPECT_FALSE(effect == usual) << trial.command << " " << trial.arguments.front() << " --"
                                      << one.first << " " << one.second << ": " << effect.error;
      }
    }
  }
};

TEST_F(CommandScopeTest, EveryOptionIsTried) {
  std::set<std::string> tried;
  for (const auto* const trials : {&kVolumeTrials, &kCaseTrials})
    for (const Trial& trial : *trials)
      for (const auto& [name, value] : trial.tried) tried.insert(trial.command + " " + name);
  for (const auto& [command, table] : m_engine.commands())
    for (const OptionRow& row : table->rows()) {
      if (row.isArgument || kOtherTests.contains(command->name())) continue;
      const std::string name = command->name() + " " + row.name;
      EXPECT_TRUE(tried.contains(name) != kElsewhere.contains(name)) << name;
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
  for (const Trial& trial : std::vector<Trial>{
           {"track", {"series", "out/t.lumen.json"}, {}, {}},
           {"seeds", {"series", "out/s.json"}, {}, {}},
           {"info", {"series"}, {{"voxels", "true"}}, {}},
           {"check", {"series", "case.lumen"}, {}, {}},
           {"picture", {"case.lumen", "out/p.png"}, {{"volume", "series"}}, {}},
           {"report", {"tracked.lumen", "out/r.html"}, {{"volume", "series"}}, {}}}) {
    const Effect first = effectOfTrial(trial, {{"series", "1"}});
    EXPECT_EQ(first.error, "") << trial.command;
    EXPECT_FALSE(first == effectOfTrial(trial, {{"series", "2"}})) << trial.command;
  }
}

}  // namespace lumen::test
