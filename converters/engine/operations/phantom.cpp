// SPDX-License-Identifier: Apache-2.0
// lumen phantom: a synthetic angiogram with its truth and its seeds.
#include "converters/stages/phantom/phantom.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "converters/base/text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/seeds/seeds.h"
#include "converters/judge/measure/vessel_length.h"
#include "converters/stages/phantom/into_scan.h"

namespace lumen::engine {

namespace {

Json numbersOf(const Eigen::Vector3d& v) {
  return Json::array({jsonNumber(v.x()), jsonNumber(v.y()), jsonNumber(v.z())});
}

class PhantomCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "phantom"; }
  [[nodiscard]] std::string summary() const override {
    return "Make a synthetic angiogram with a known truth";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen phantom bifurcation fork.nrrd --truth fork-truth.lumen --seeds "
           "fork-seeds.json\n"
           "  lumen phantom --tree arteries.swc arteries.nrrd --voxel 0.3 --seeds "
           "arteries-seeds.json\n"
           "  lumen phantom --tree arteries.swc --into head-ct.nrrd --turn 90,0,0 drawn.nrrd "
           "--truth drawn-truth.lumen";
  }

  void addRows(OptionTable& table) override {
    // with --tree the first name is that of the output: sortArguments() decides which is which
    table
        .argument("NAME", &m_options.name,
                  alternatives(convert::phantomNames()) + "; left out with --tree")
        .isRequired = false;
    table
        .argument("OUT", &m_output,
                  "Volume to write: " + formatEndings(canWriteVolume) +
                      "; with --motion the first of OUT-00, "
                      "OUT-01 and so on")
        .isRequired = false;
    table.file("tree", m_tree,
               "Draw the arteries of this SWC file, lengths in mm, instead of a named phantom");
    table.file("truth", m_truth, "Also write the true tree, as a case");
    table.file("seeds", m_seeds, "Also write the seeds that a user would click");
    m_options.word = optionWord();
    m_options.addRows(table);
    addIntoRows(table);
  }

  Answer run(const RunContext& context) override {
    sortArguments(context.memory);
    requireInScope(*context.table, {}, context.progress);
    const Outputs outputs = checkOutputs();
    if (!m_into.empty()) return drawInto(outputs, context.progress);
    const convert::Phantom phantom = convert::makePhantom(
        m_options,
        [&](int phase, const convert::Volume& volume) {
          outputs.volume.writeVolume(volume, volumeOf(outputs.volume, phase));
        },
        context.progress);
    writeFiles(phantom, outputs, context.progress);
    return report(phantom);
  }

private:
  struct Outputs {
    const FileFormat& volume;
    const FileFormat* truth;  ///< null without --truth
  };

  /// Options of trees in a scan, beside which those of the image do nothing.
  void addIntoRows(OptionTable& table) {
    table.group("Into a scan");
    table
        .file("into", m_into,
              "Draw the tree into this volume, a scan with air and soft tissue such as a CT, with "
              "the point spread and the noise that are measured in it")
        .onlyWith("tree");
    table.file("veins", m_veins, "Draw the veins of this SWC file, too, in the frame of the tree")
        .onlyWith("into");
    m_intoOptions.addRows(table);
    table
        .add("move", &m_move, "X,Y,Z",
             "Displacement of the trees, mm, LPS [the one with which the most of them lies in soft "
             "tissue]")
        .checkedBy(placeFault)
        .onlyWith("into");
    table
        .add("turn", &m_turn, "X,Y,Z",
             "Degrees by which the trees are turned about x, y and z, one after the other, around "
             "their middle [0,0,0]")
        .checkedBy(placeFault)
        .onlyWith("into");
    for (const char* const name :
         {"voxel", "slice-thickness", "clutter", "noise", "bias", "psf", "motion"})
      table.find(name)->notBeside("into");
  }

  Answer drawInto(const Outputs& outputs, Progress& progress) {
    m_intoOptions.veins = m_veins;
    if (!m_move.empty()) m_intoOptions.move = placeIn(m_move);
    if (!m_turn.empty()) m_intoOptions.turn = placeIn(m_turn);
    requireInput(m_into, "volume");
    const FileFormat& from = inputFormat(m_into, "");
    if (from.kind != FormatKind::Volume)
      throw unsupported(m_into.name() + ": expected a volume, into which the tree is drawn");
    const convert::IntoResult drawn =
        convert::drawIntoScan(m_options, m_intoOptions,
                              readVolumeFile(m_into, from, VolumeArguments{}, progress), progress);
    writeFiles(drawn.phantom, outputs, progress);
    Answer answer = report(drawn.phantom);
    answer.json["scan"] = {{"tissue", jsonNumber(drawn.look.tissue)},
                           {"noise", jsonNumber(drawn.look.noise)},
                           {"point_spread_mm", numbersOf(drawn.look.spread)},
                           {"move_mm", numbersOf(drawn.move)},
                           {"outside_mm", jsonNumber(drawn.lost)}};
    answer.text += m_into.name() + ": soft tissue of " + shownNumber(drawn.look.tissue, 4) +
                   " with noise of " + shownNumber(drawn.look.noise, 3) + ", point spread " +
                   joinedNumbers(drawn.look.spread, " x ", 3) + " mm; trees moved by " +
                   joinedNumbers(drawn.move, ",", 5) + " mm, " + fixedText(drawn.lost, 1) +
                   " mm of them lie outside of the body and are left out\n";
    return answer;
  }

  void writeFiles(const convert::Phantom& phantom, const Outputs& outputs,
                  Progress& progress) const {
    progress.begin("writing", 0);
    outputs.volume.writeVolume(phantom.volume, volumeOf(outputs.volume, 0));
    if (outputs.truth != nullptr) outputs.truth->writeCase(phantom.truth, m_truth, {}, progress);
    if (!m_seeds.empty()) writeText(convert::encodeSeeds(phantom.seeds, m_seeds.path()), m_seeds);
    progress.end();
  }

  /// OUT itself, or with a motion OUT with the number of the phase before its ending.
  [[nodiscard]] OutputFile volumeOf(const FileFormat& format, int phase) const {
    if (m_options.motion == convert::PhantomMotion::None) return m_output;
    return numberedName(m_output.name(), format, static_cast<std::size_t>(phase));
  }

  void sortArguments(MemoryFiles* memory) {
    const std::string usage = "; usage: lumen phantom NAME OUT, or lumen phantom --tree FILE OUT";
    if (!m_tree.empty()) {
      if (!m_output.empty())
        throw Error(ErrorKind::Usage,
                    m_options.name + " and --tree are two phantoms, expected one" + usage);
      m_options.tree = m_tree;
      const std::string out = std::exchange(m_options.name, {});
      m_output = memory ? memory->output(out) : OutputFile(out);
    } else if (m_options.name.empty()) {
      throw Error(ErrorKind::Usage, std::string("NAME is missing") + usage);
    } else {
      const std::vector<std::string>& known = convert::phantomNames();
      if (std::find(known.begin(), known.end(), m_options.name) == known.end())
        throw Error(ErrorKind::Usage, "NAME: found " + m_options.name + ", expected " +
                                          alternatives(known) + didYouMean(m_options.name, known));
    }
    if (m_output.empty()) throw Error(ErrorKind::Usage, std::string("OUT is missing") + usage);
  }

  /// Refuses outputs that could not be written in the end.
  [[nodiscard]] Outputs checkOutputs() const {
    const Outputs outputs{volumeOutputFormat(m_output, "a phantom"),
                          m_truth.empty() ? nullptr : &caseOutputFormat(m_truth, "", "the truth")};
    std::vector<std::pair<OutputFile, convert::ContentKind>> files = {
        {m_truth, convert::ContentKind::Case}, {m_seeds, convert::ContentKind::Seeds}};
    const int volumes = m_options.motion == convert::PhantomMotion::None ? 1 : m_options.phases;
    for (int phase = 0; phase < volumes; ++phase)
      files.emplace_back(volumeOf(outputs.volume, phase), convert::ContentKind::Volume);
    for (auto file = files.begin(); file != files.end(); ++file) {
      const auto& [output, kind] = *file;
      if (output.empty()) continue;
      for (auto earlier = files.begin(); earlier != file; ++earlier)
        if (earlier->first.path() == output.path())
          throw Error(ErrorKind::Usage, output.name() + ": this name is given to two outputs");
      requireWritable(output, kind);
    }
    return outputs;
  }

  [[nodiscard]] Answer report(const convert::Phantom& phantom) const {
    const auto& size = phantom.volume.geometry.size;
    Json json = caseSummary(phantom.truth);
    json["size"] = size;
    json["voxel_size_mm"] = jsonNumber(phantom.volume.geometry.voxelSize());
    json["seeds"] = phantom.seeds.size();
    json["scan"] = nullptr;
    json["phases"] = phantom.truth.motion ? phantom.truth.motion->time.size() : 1;
    return {std::move(json),
            shownVolumes(phantom) + ": " + joinedNumbers(size, " x ") + " voxels of " +
                fixedText(phantom.volume.geometry.voxelSize(), 3) + " mm, " +
                std::to_string(phantom.truth.tree.branches.size()) + " true branches, " +
                fixedText(convert::vesselLengths(phantom.truth.tree).total, 1) + " mm\n"};
  }

  [[nodiscard]] std::string shownVolumes(const convert::Phantom& phantom) const {
    if (!phantom.truth.motion) return m_output.name();
    const FileFormat& format = volumeOutputFormat(m_output, "a phantom");
    return volumeOf(format, 0).name() + " to " + volumeOf(format, m_options.phases - 1).name();
  }

  convert::PhantomOptions m_options;
  convert::IntoOptions m_intoOptions;
  InputFile m_into;
  std::string m_tree, m_veins, m_move, m_turn;
  OutputFile m_output, m_truth, m_seeds;
};

}  // namespace

std::unique_ptr<Command> makePhantomCommand() {
  return std::make_unique<PhantomCommand>();
}

}  // namespace lumen::engine
