// SPDX-License-Identifier: Apache-2.0
// lumen phantom: a synthetic angiogram with its truth and its seeds.
#include "converters/phantom/phantom.h"

#include <algorithm>

#include "converters/app/command.h"
#include "converters/app/file_access.h"
#include "converters/app/report.h"
#include "converters/seeds/seeds.h"
#include "converters/volume/write_volume.h"

namespace lumen::app {

namespace {

class PhantomCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "phantom"; }
  [[nodiscard]] std::string summary() const override {
    return "Make a synthetic angiogram with a known truth";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen phantom bifurcation fork.nrrd --truth fork-truth.lumen --seeds fork-seeds.json";
  }

  void bind(CLI::App& app) override {
    std::string names;
    for (const auto& known : convert::phantomNames()) names += (names.empty() ? "" : ", ") + known;
    app.add_option("NAME", m_options.name, names)->required()->configurable(false);
    app.add_option("OUT", m_output, "Volume to write: .nrrd, .nii, .nii.gz or .mha")
        ->required()
        ->configurable(false);
    app.add_option("--truth", m_truth, "Also write the true tree, as a case")->type_name("FILE");
    app.add_option("--seeds", m_seeds, "Also write the seeds that a user would click")
        ->type_name("FILE");
    addPhantomOptions(app, m_options);
  }

  int run(Context& context) override {
    const FileFormat* truthFormat = checkOutputs(context);
    const convert::Phantom phantom = convert::makePhantom(m_options, context.progress);
    context.progress.begin("writing", 0);
    convert::writeVolume(phantom.volume, m_output);
    if (truthFormat != nullptr) writeCase(phantom.truth, m_truth, *truthFormat);
    if (!m_seeds.empty()) convert::writeSeeds(phantom.seeds, m_seeds);
    context.progress.end();
    report(phantom, context);
    return 0;
  }

private:
  /// Refuses what could not be written in the end; gives the format of --truth, or null without
  /// one.
  const FileFormat* checkOutputs(Context& context) const {
    const auto& known = convert::phantomNames();
    if (std::find(known.begin(), known.end(), m_options.name) == known.end())
      throw Error(ErrorKind::Usage, m_options.name +
                                        ": there is no such phantom; lumen phantom "
                                        "--help lists them");
    if (!convert::isVolumePath(m_output))
      throw unsupported(m_output + ": a phantom is written as .nrrd, .nii, .nii.gz or .mha");
    const FileFormat* truthFormat = nullptr;
    if (!m_truth.empty()) {
      truthFormat = &outputFormat(m_truth, "");
      if (truthFormat->kind != FormatKind::Case)
        throw unsupported(m_truth + ": the truth is written as a case, .lumen or .lumen.json");
    }
    for (const std::string& output : {m_output, m_truth, m_seeds}) {
      if (output.empty()) continue;
      requireWritable(output);
      context.interrupts.watchOutput(output);
    }
    return truthFormat;
  }

  void report(const convert::Phantom& phantom, const Context& context) const {
    const auto& size = phantom.volume.geometry.size;
    if (context.common.json) {
      Json json = caseSummary(phantom.truth);
      json["size"] = size;
      json["voxel_size_mm"] = jsonNumber(phantom.volume.geometry.voxelSize());
      json["seeds"] = phantom.seeds.size();
      answerJson(json);
    } else if (!context.common.quiet) {
      answer(m_output + ": " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
             std::to_string(size[2]) + " voxels of " +
             fixed(phantom.volume.geometry.voxelSize(), 3) + " mm, " +
             std::to_string(phantom.truth.tree.branches.size()) + " true branches, " +
             fixed(totalLength(phantom.truth.tree), 1) + " mm\n");
    }
  }

  convert::PhantomOptions m_options;
  std::string m_output, m_truth, m_seeds;
};

}  // namespace

std::unique_ptr<Command> makePhantomCommand() {
  return std::make_unique<PhantomCommand>();
}

}  // namespace lumen::app
