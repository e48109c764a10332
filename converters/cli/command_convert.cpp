// SPDX-License-Identifier: Apache-2.0
// lumen convert: a volume, tracked and fitted, a centerline, fitted, or a case, as a case, a mesh or a
// centerline.
#include "converters/base/error.h"
#include "converters/cli/command.h"
#include "converters/cli/mesh_options.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/engine/reachable.h"
#include "converters/engine/report.h"
#include "converters/engine/stages.h"
#include "converters/engine/surface_report.h"
#include "converters/engine/track_report.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/surface/patches/cell_size.h"

namespace lumen::app {

namespace {

class ConvertCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "convert"; }
  [[nodiscard]] std::string summary() const override {
    return "Turn a volume, a surface, or a case, into a case or a mesh";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen convert head.nrrd head.lumen --seeds head-seeds.json\n"
           "  lumen convert head.lumen head.glb --color radius\n"
           "  lumen convert aorta.stl aorta.lumen --centerline aorta-centerline.vtp\n"
           "  lumen convert labels.nii.gz arteries.lumen --labels 1=ica,2=mca\n"
           "  lumen convert arteries.swc arteries.lumen";
  }

  void bind(CLI::App& app) override {
    addFile(app, "INPUT", m_input,
            "Volume (" + formatTitles(canReadVolume) + "), surface of vessels (" +
                formatTitles(canReadMesh) + "), centerline (" + formatTitles(canReadCenterline) +
                "; also a folder of curves) or case");
    addFile(app, "OUTPUT", m_output,
            "Case, " + formatEndings(canWriteCase) + "; or mesh, which holds the surface of the " +
                "vessels and no more, " + formatEndings(canWriteMesh) +
                "; or centerline, which holds the tree and its radii and no more, " +
                formatEndings(canWriteCenterline));
    app.add_option("--from", m_from, "Format of INPUT, whatever its name")->type_name("F");
    app.add_option("--to", m_to, "Format of OUTPUT, whatever its name")->type_name("F");
    addVolumeOptions(app, m_volume);
    addCenterlineOptions(app, m_centerline);
    addTrackOptions(app, m_track);
    addCenterlineOptions(app, m_mesh);
    addSceneOptions(app, m_mesh);
    addMaskOptions(app, m_mask);
    addFitOptions(app, m_fit);
    addMeshOptions(app, m_outputOptions);
    addEncodingOptions(app, m_outputOptions.encoding);
  }

  int run(Context& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = outputFormat(m_output, m_to);
    requireInput(m_input, "input");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (m_mask.isGiven())
      requireLabels(from);
    else if (from.kind == FormatKind::Volume)
      m_seeds = loadSeeds(m_track);
    requireWritable(m_output, contentKind(to));
    context.interrupts.watchOutput(m_output);

    formats::Case value = load(from, context.progress);
    complete(value, from, to, context.progress);
    context.progress.check();
    const std::optional<Reach> reach = reachOf(value, context.progress);
    warnOfClosed(reach, context.progress);
    const auto surface = to.writeCase(value, m_output, m_outputOptions, context.progress);
    report(value, reach, surface, context);
    return 0;
  }

private:
  /// Refuses labels of what has none, and seeds beside labels.
  void requireLabels(const FileFormat& from) const {
    if (from.kind != FormatKind::Volume)
      throw Error(ErrorKind::Usage, m_input + ": --mask, --label and --labels are for volumes");
    if (!m_track.seeds.empty())
      throw Error(ErrorKind::Usage,
                  "--seeds are for images; vessels of labels are found without them");
  }

  formats::Case load(const FileFormat& from, Progress& progress) {
    if (from.kind == FormatKind::Mesh)
      return caseOfMeshFile(m_input, from, meshArguments(), progress);
    if (from.kind == FormatKind::Case) {
      if (!m_track.seeds.empty())
        progress.warn("--seeds is ignored: " + m_input + " is a case, already tracked");
      // rounding makes another case; another encoding does not
      return m_outputOptions.encoding.pointBits != 0 ? readParentCase(m_input)
                                                     : from.readCase(m_input);
    }
    if (from.kind == FormatKind::Centerline) {
      const auto loaded = loadCenterline(m_input, from, m_volume, m_centerline, progress);
      // there is no voxel that a mesh could take its cells from
      double& cell = m_outputOptions.polygonise.cell;
      const double thinnest = convert::extentOf(loaded.file).least;
      if (cell == 0 && thinnest > 0) cell = convert::coarsestCellFor(thinnest);
      return convert::caseOfCenterline(loaded.file, m_input);
    }
    if (m_mask.isGiven()) return caseOfMaskFile(m_input, from, m_volume, m_mask, progress);
    const convert::Volume volume = loadVolume(m_input, from, m_volume, progress);
    convert::TrackResult tracked = trackSeeds(volume, m_seeds, m_track, progress);
    m_remarks = std::move(static_cast<convert::TrackRemarks&>(tracked));
    return std::move(tracked.result);
  }

  [[nodiscard]] MeshArguments meshArguments() const {
    MeshArguments arguments = m_mesh;
    arguments.unit = m_volume.unit;
    arguments.scene.allowDetached = m_volume.allowDetached;
    return arguments;
  }

  /// A tracked volume gets its models, and so does a mesh; so does a case that has none when they are needed for a
  /// mesh.
  void complete(formats::Case& value, const FileFormat& from, const FileFormat& to,
                Progress& progress) {
    const bool meshNeedsModels = to.kind == FormatKind::Mesh && !value.models;
    if (meshNeedsModels && !value.points)
      throw invalidInput(m_input +
                         ": this case has neither models nor wall points to fit them to, "
                         "so there is no surface to make a mesh of");
    const bool isNew = from.kind != FormatKind::Case;
    if (isNew || meshNeedsModels)
      convert::fit(value, fitOptionsFor(value, m_fit.options()), progress);
  }

  void report(const formats::Case& value, const std::optional<Reach>& reach,
              const std::optional<convert::SurfaceReport>& surface, const Context& context) {
    if (context.common.json) {
      Json json = caseSummary(value);
      json["reachable"] = reachJson(reach);
      json["surface"] = surfaceJson(surface, value);
      answerJson(withRemarks(std::move(json), m_remarks));
    } else if (!context.common.quiet) {
      answer(caseLine(m_output, value) + reachLine(reach) + surfaceLines(surface, value) +
             endLines(m_remarks));
    }
  }

  std::string m_input, m_output, m_from, m_to;
  VolumeArguments m_volume;
  CenterlineArguments m_centerline;
  TrackArguments m_track;
  FitArguments m_fit;
  MeshArguments m_mesh;
  MaskArguments m_mask;
  OutputOptions m_outputOptions;
  std::vector<convert::SeedBranch> m_seeds;
  convert::TrackRemarks m_remarks;
};

}  // namespace

std::unique_ptr<Command> makeConvertCommand() {
  return std::make_unique<ConvertCommand>();
}

}  // namespace lumen::app
