// SPDX-License-Identifier: Apache-2.0
// lumen seeds: the vessels of a volume, or the seeds that a case holds, for a person to edit.
#include "converters/io/seeds/seeds.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/operations/tracked_vessels.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

/// Places of the clicks on a vessel, as shares of its nodes: the first near where it begins.
constexpr double kShares[] = {0.15, 0.5, 0.85};

/// Clicks on the vessels of a case; an aneurysm has one at each of its nodes.
std::vector<convert::SeedBranch> seedsOn(const formats::Case& value) {
  const formats::CenterlineTree& tree = value.tree;
  std::vector<convert::SeedBranch> seeds;
  for (const formats::Branch& branch : tree.branches) {
    convert::SeedBranch seed;
    seed.label = branch.label;
    seed.kind = branch.kind;
    const int above = tree.parent[branch.firstNode];
    if (above >= 0) seed.parent = tree.branches[tree.branch[static_cast<std::size_t>(above)]].label;
    const auto add = [&](std::uint32_t node) {
      seed.points.push_back({toEigen(tree.centre[node]), static_cast<double>(tree.radius[node])});
    };
    const std::uint32_t last = branch.nodeCount - 1;
    if (branch.kind == formats::BranchKind::Aneurysm)
      for (std::uint32_t i = 0; i <= last; ++i) add(branch.firstNode + i);
    else
      for (const double share : kShares)
        add(branch.firstNode + static_cast<std::uint32_t>(share * static_cast<double>(last)));
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

class SeedsCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "seeds"; }
  [[nodiscard]] std::string summary() const override {
    return "Write the vessels of a volume, or the seeds that a case holds, as seeds to edit";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen seeds head.nrrd head.mrk.json        # curves that 3D Slicer shows\n"
           "  lumen convert head.nrrd head.lumen --seeds head.mrk.json\n"
           "  lumen seeds head.lumen kept.mrk.json        # the seeds that the case holds";
  }

  void addRows(OptionTable& table) override {
    table.argument("INPUT", &m_input, "Volume or case");
    table.argument(
        "OUT", &m_output,
        "Seeds to write: curves of 3D Slicer if it ends in .mrk.json, else lumen's JSON");
    addVolumeRows(table, m_volume);
    table.scope(kImage);
    table.group("Tracking");
    m_options.word = optionWord();
    m_options.addFoundRows(table);
    table.scope(kAnyContent);
    table.group("");
    addFormatRow(table, "from", m_from, "INPUT");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    requireInput(m_input, "volume or case");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind != FormatKind::Volume && from.kind != FormatKind::Case) {
      const std::string other = convert::notA(convert::ContentKind::Volume, m_input);
      throw unsupported(
          m_input.name() + ": " +
          (other.empty() ? "this is no volume and no case, which lumen seeds reads" : other));
    }
    requireInScope(*context.table,
                   {inputContent(from, false), kAnyContent, m_input.name(), m_output.name()},
                   context.progress);
    requireWritable(m_output, convert::ContentKind::Seeds);
    return from.kind == FormatKind::Case ? writeKept(from.readCase(m_input))
                                         : writeFound(from, context.progress);
  }

private:
  [[nodiscard]] Answer answer(const std::vector<convert::SeedBranch>& seeds, Json length,
                              const std::string& one, const std::string& many) const {
    writeText(convert::encodeSeeds(seeds, m_output.path()), m_output);
    Json json;
    json["seeds"] = seeds.size();
    json["length_mm"] = std::move(length);
    return {json, m_output.name() + ": " + counted(seeds.size(), one, many) + "\n"};
  }

  [[nodiscard]] Answer writeFound(const FileFormat& from, Progress& progress) const {
    const convert::Volume volume = loadVolume(m_input, from, m_volume, progress);
    const formats::Case found =
        operations::findAndTrack(volume, m_input.name(), {m_options}, operationContext(progress))
            .result;
    return answer(seedsOn(found), caseSummary(found)["length_mm"], "vessel", "vessels");
  }

  /// The seeds that the case holds, whether they are tracked or wait.
  [[nodiscard]] Answer writeKept(const formats::Case& value) const {
    std::vector<convert::SeedBranch> seeds = convert::seedsOf(value, m_input.name(), optionWord());
    if (seeds.empty()) throw failed(formats::printable(m_input.name()) + ": it holds no seeds");
    for (convert::SeedBranch& seed : seeds) seed.isTracked = false;  // counts in a case alone
    convert::dropOtherParents(seeds);
    return answer(seeds, nullptr, "seed", "seeds");
  }

  InputFile m_input;
  OutputFile m_output;
  std::string m_from;
  VolumeArguments m_volume;
  convert::TrackOptions m_options;
};

}  // namespace

std::unique_ptr<Command> makeSeedsCommand() {
  return std::make_unique<SeedsCommand>();
}

}  // namespace lumen::engine
