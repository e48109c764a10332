// SPDX-License-Identifier: Apache-2.0
// A wrong argument is refused before any work. All rows of all commands are swept, as the program lists
// them: each number and word with values that it does not take, each file with names of what is missing, of
// another kind or in the way. A refusal is late if a stage of progress had begun or voxels had been read by then.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <sys/stat.h>

#include "tests/cli/scope_inputs.h"

namespace lumen::test {

namespace {

/// Runs of each command in which its options count, all of them together where that is possible.
constexpr const char* kRuns = R"(
convert tube.nrrd out/o.glb --seeds seeds.json --seeds-only true --root 3.1,3.1,5.8 --corrections corrected.lumen.json --label-map halves.nii --label-table table.csv --role 1=bone
convert cta.nrrd out/o.lumen --native plain.nrrd
convert labels.nrrd out/o.lumen.json --mask true --label-map halves.nii --label-table table.csv
convert halves.nii out/o.lumen.json --label-table table.csv
convert header/tube.nhdr out/o.lumen --allow-detached .
convert plain.stl out/o.stl --centerline truth.swc
convert vessels.scn out/o.stl --mesh tip
convert truth.swc out/o.lumen
convert case.lumen out/o.glb
track tube.nrrd out/t.lumen --seeds seeds.json --seeds-only true --label-map halves.nii --label-table table.csv
track cta.nrrd out/t.lumen --native plain.nrrd
seeds tube.nrrd out/s.json
fit tracked.lumen out/f.lumen --image tube.nrrd
check tube.nrrd case.lumen --overlay out/o.png --mask out/m.nrrd --profile flow
compare case.lumen tree.lumen
info halves.nii --voxels true --label-table table.csv
info plain.stl
info case.lumen --accept seen --out out/i.lumen
picture case.lumen out/p.png --size 80x60 --volume tube.nrrd
xray case.lumen out/x.png --size 40x30 --volume cta.nrrd --isocentre 0,0,0 --photons 100
report tracked.lumen out/r.html --volume tube.nrrd
phantom tube out/p.nrrd --size 32 --truth out/t.lumen --seeds out/s.json
phantom out/p.nrrd --tree apart.swc --into scan.nrrd --veins apart.swc --truth out/t.lumen
motion tracked.lumen tube.nrrd tube.nrrd --out out/m.lumen
trim ends.lumen out/t.lumen --min-length 1
ends case.lumen --root 2 --out out/e.lumen
names case.lumen --rename root=a --names names.csv --table out/n.csv --out out/n.lumen
measure case.lumen two.lumen --out out/measures.csv
measure case.lumen --against tracked.lumen --out out/measures
validate tree.lumen case.lumen
export svzerod apart.lumen out/folder
batch list.csv out/batch --jobs 1 --profile none
view tube.nrrd case.lumen --html out/v.html
view case.lumen --serverless out/site
view tube.nrrd --no-browser true --label-map halves.nii --label-table table.csv
completion bash
library init out/new --title A --licence MIT
library add out/lib two.lumen --synthetic true --about about.json --file table.csv --picture none
library update out/lib tube --about about.json
library remove out/lib tube
library list out/lib
library index out/lib
library check out/lib --resume out/journal
library extract out/lib out/new --case tube
library build list.csv out/lib --jobs 1 --work out/work
library sample out/sample --patients 1 --size 128 --work out/work
library sign out/lib --key publisher.pub --resume out/journal
library verify out/lib --key publisher.pub --state out/state.json
)";

/// Names that are wrong as inputs and as outputs: a folder that is missing, a file as a folder, a file system
/// that takes none.
const std::vector<std::string> kWrongPlaces = {"absent/absent", "table.csv/absent",
                                               "/proc/absent/absent"};
/// Names that are wrong as inputs alone.
const std::vector<std::string> kWrongInputs = {"absent", "empty", "noise", "some", "pipe"};

/// Remembers the work that was begun.
class Watched : public Progress {
public:
  void begin(std::string_view stage, std::size_t /*total*/) override {
    const bool isSecond = std::exchange(m_hasBegun, true);
    if (isSecond || stage != "reading") m_work.emplace_back(stage);
  }
  void end() override { m_work.emplace_back("the end of reading"); }
  /// Stages but a first one of reading, in which the content of an input may be refused.
  [[nodiscard]] const std::vector<std::string>& work() const { return m_work; }

private:
  bool m_hasBegun = false;
  std::vector<std::string> m_work;
};

/// A run that was refused, or not.
struct Refusal {
  std::string error;              ///< empty if the run succeeded
  std::vector<std::string> work;  ///< that was done before
};

template <class... Kinds>
bool holds(const OptionRow& row) {
  return (std::holds_alternative<Kinds>(row.target) || ...);
}

bool isInput(const OptionRow& row) {
  return holds<InputFile*, std::vector<InputFile>*>(row);
}

/// Whether values of the row are names of files or folders that are opened. Those of --allow-detached are
/// compared with the name that a header states.
bool isFile(const OptionRow& row) {
  const bool isName = row.check && contains(row.check("-"), "the name of a file");
  return isInput(row) || holds<OutputFile*>(row) || (isName && row.name != "allow-detached");
}

/// Values that the row does not take, whatever is in files.
std::vector<std::string> wrongValues(const OptionRow& row) {
  if (!row.words.empty()) return {"no-such-word", ""};
  if (!row.numbers.empty()) return {"x", "-1"};
  if (row.whole) {
    std::vector<std::string> values = {"x", "1.5", "nan", std::to_string(row.whole->low - 1)};
    if (row.whole->high < std::numeric_limits<std::int32_t>::max())
      values.push_back(std::to_string(row.whole->high + 1));
    return values;
  }
  if (row.range) return {"x", "nan", "inf", "1e400", "-1e300", "1e300"};
  return {};
}

/// Names that are wrong in the role of the row. A command may make a folder with those above it.
std::vector<std::string> wrongNames(const OptionRow& row) {
  std::vector<std::string> names = kWrongPlaces;
  if (!isInput(row) && !holds<OutputFile*>(row)) names.erase(names.begin());
  if (isInput(row)) names.insert(names.end(), kWrongInputs.begin(), kWrongInputs.end());
  return names;
}

}  // namespace

class EarlyRefusalTest : public ScopeTest {
protected:
  void SetUp() override {
    ScopeTest::SetUp();
    fillOnce("early refusals", [this] { makeOthers(); });
    ASSERT_EQ(mkfifo("pipe", 0600), 0);
  }

  void makeOthers() const {
    namespace fs = std::filesystem;
    write("about.json", "{\"title\": \"About\"}");
    write("names.csv", "name,new_name\nroot,b\n");
    write("list.csv", "input,id,title,synthetic,seeds\ntube.nrrd,one,One,true,seeds.json\n");
    write("publisher.pub",
          "untrusted comment: minisign public key 4399E96D31EC718D\n"
          "RWSNcewxbemZQ25UeTL5oHtBrhmRV2EuLdlY1eRmmzTCIaWAcV1UKXaI\n");
    write("empty", "");
    write("noise", std::string(400, '\x7f') + "no format at all");
    fs::create_directories(path("some"));
    write("some/text", "no format at all");
    if (!m_engine.find("library init").command) return;
    make({"library", "init", "lib", "--title", "Tubes", "--licence", "CC0-1.0"});
    make({"library", "add", "lib", "case.lumen", "--synthetic", "--id", "tube", "--no-surface",
          "--picture", "none", "--title", "Tube"});
  }

  [[nodiscard]] Refusal refusalOf(const Operation& operation) const {
    namespace fs = std::filesystem;
    fs::remove_all("out");
    fs::create_directory("out");
    if (operation.name.starts_with("library"))
      fs::copy("lib", "out/lib", fs::copy_options::recursive);
    Watched progress;
    Refusal refusal;
    engine::RunContext context{m_engine, progress};
    context.answerEarly = [&progress](const engine::Answer&) { progress.cancel(); };
    try {
      refusal.error = m_engine.run(operation, context).code == 0 ? "" : "the answer is a refusal";
    } catch (const std::exception& error) {
      refusal.error = error.what();
    }
    refusal.work = progress.work();
    return refusal;
  }

  /// The run with one argument of it, counted from 0, replaced.
  static Operation withArgument(Operation operation, std::size_t place, const std::string& value) {
    operation.arguments.at(place) = value;
    return operation;
  }

  /// Expects that the run was refused, and before any work.
  static void expectEarly(const Refusal& refusal, const std::string& what) {
    EXPECT_NE(refusal.error, "") << what << " is taken";
    if (refusal.error.empty()) return;
    const std::string last = refusal.work.empty() ? "" : refusal.work.back();
    EXPECT_EQ(last, "") << what << " is refused late, after " << last << ": " << refusal.error;
  }

  std::vector<Trial> m_runs = trialsOf(kRuns);
};

TEST_F(EarlyRefusalTest, EveryCommandIsSwept) {
  std::set<std::string> swept;
  for (const Trial& run : m_runs) swept.insert(run.operation.name);
  for (const auto& [command, table] : m_engine.commands())
    EXPECT_TRUE(swept.contains(command->name())) << command->name();
}

TEST_F(EarlyRefusalTest, ANumberOrWordIsRefusedAsItIsRead) {
  std::size_t count = 0;
  for (const auto& [command, table] : m_engine.commands())
    for (OptionRow& row : table->rows())
      for (const std::string& value : wrongValues(row)) {
        const bool isInRange = row.range && row.range->holds(std::strtod(value.c_str(), nullptr));
        if (isInRange) continue;
        ++count;
        EXPECT_THROW(row.set({value}), Error)
            << command->name() << " " << row.shownName() << " " << value;
      }
  EXPECT_GT(count, 500U);
}

TEST_F(EarlyRefusalTest, AFileIsLookedAtBeforeAnyWork) {
  for (const Trial& run : m_runs) {
    const engine::BoundCommand bound = m_engine.find(run.operation.name);
    if (!bound.command) continue;  // built without libraries or viewer
    for (const auto& [name, values] : run.operation.options) {
      const OptionRow& row = *bound.table->find(name);
      if (!isFile(row)) continue;
      for (const std::string& value : wrongNames(row))
        expectEarly(refusalOf(withOption(run.operation, {name, value})),
                    run.operation.name + " " + run.operation.arguments.front() + " --" + name +
                        " " + value);
    }
  }
}

TEST_F(EarlyRefusalTest, AnArgumentIsLookedAtBeforeAnyWork) {
  for (const Trial& run : m_runs) {
    const engine::BoundCommand bound = m_engine.find(run.operation.name);
    if (!bound.command) continue;
    std::vector<const OptionRow*> rows;
    for (const OptionRow& row : bound.table->rows())
      if (row.isArgument) rows.push_back(&row);
    for (std::size_t i = 0; i < run.operation.arguments.size(); ++i) {
      const OptionRow& row = *rows[std::min(i, rows.size() - 1)];
      if (!isFile(row)) continue;
      for (const std::string& value : wrongNames(row))
        expectEarly(refusalOf(withArgument(run.operation, i, value)),
                    run.operation.name + " " + value + " as " + row.name + " " + std::to_string(i));
    }
  }
}

TEST_F(EarlyRefusalTest, EveryFileOfAnOptionIsSwept) {
  std::set<std::string> swept;
  for (const Trial& run : m_runs)
    for (const auto& [name, values] : run.operation.options)
      swept.insert(run.operation.name + " " + name);
  for (const auto& [command, table] : m_engine.commands())
    for (const OptionRow& row : table->rows())
      if (!row.isArgument && isFile(row)) {
        EXPECT_TRUE(swept.contains(command->name() + " " + row.name))
            << command->name() << " --" << row.name << " is in none of the runs above";
      }
}

}  // namespace lumen::test
