// SPDX-License-Identifier: Apache-2.0
// lumen convert: a volume, tracked and fitted, a centerline, fitted, or a case, as a case, a mesh
// or a centerline.
#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/answers/track_answer.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/file_access.h"
#include "converters/engine/hinted_tracking.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/engine/mesh_options.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/stages/editing/edit_request.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class ConvertCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "convert"; }
  [[nodiscard]] std::string summary() const override {
    return "Turn a volume, a surface, or a case, into a case or a mesh";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen convert head.nrrd head.lumen --seeds head-seeds.json\n"
           "  lumen convert head.lumen head.glb --colour radius\n"
           "  lumen convert aorta.stl aorta.lumen --centerline aorta-centerline.vtp\n"
           "  lumen convert labels.nii.gz arteries.lumen --labels 1=ica,2=mca\n"
           "  lumen convert arteries.swc arteries.lumen\n"
           "  lumen convert heart.lumen systole.lumen --time 0.3";
  }

  void addRows(OptionTable& table) override {
    table.argument("INPUT", &m_input,
                   "Volume (" + formatTitles(canReadVolume) + "), surface of vessels (" +
                       formatTitles(canReadMesh) + "), centerline (" +
                       formatTitles(canReadCenterline) + "; also a folder of curves) or case");
    table.argument("OUTPUT", &m_output,
                   "Case, " + formatEndings(canWriteCase) +
                       "; or mesh, which holds the surface of the " + "vessels and no more, " +
                       formatEndings(canWriteMesh) +
                       "; or centerline, which holds the tree and its radii and no more, " +
                       formatEndings(canWriteCenterline));
    addFormatRow(table, "from", m_from, "INPUT");
    addFormatRow(table, "to", m_to, "OUTPUT");
    addVolumeRows(table, m_volume);
    addCenterlineRows(table, m_centerline);
    addTrackRows(table, m_track);
    table
        .file("corrections", m_corrected,
              "Repeat the manual corrections of this case of the same volume, each at its place; "
              "corrections that no longer fit are reported, and the case keeps them")
        .forInputs(kImage);
    addMeshRows(table, m_mesh);
    addMaskRows(table, m_mask);
    addFitRows(table, m_fit);
    addMeshFileRows(table, m_outputOptions);
    addEncodingRows(table, m_outputOptions.encoding);
    addTimeRow(table, m_time).forInputs(kCases).inGroup("");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = outputFormat(m_output, m_to);
    requireInput(m_input, "input");
    const FileFormat& from = inputFormat(m_input, m_from);
    m_contents = {inputContent(from, m_mask.isGiven()), outputContent(to), m_input, m_output};
    if (from.kind != FormatKind::Case) requireInScope(*context.table, m_contents, context.progress);
    if (from.kind == FormatKind::Volume && !m_track.seeds.empty()) m_seeds = loadSeeds(m_track);
    if (!m_corrected.empty()) requireInput(m_corrected, "corrected case");
    requireWritable(m_output, contentKind(to));

    formats::Case value = load(from, context);
    requirePoints(value, context);
    if (from.kind == FormatKind::Case) requireMotion(value, context);
    complete(value, from, to, context);
    context.progress.check();
    const std::optional<convert::Reach> reach = convert::measureReach(value, context.progress);
    convert::warnOfClosed(reach, context.progress);
    const auto surface = to.writeCase(value, m_output, m_outputOptions, context.progress);
    return report(value, reach, surface);
  }

private:
  formats::Case load(const FileFormat& from, const RunContext& context) {
    Progress& progress = context.progress;
    if (from.kind == FormatKind::Mesh) {
      CaseOfMeshFile made = caseOfMeshFile(m_input, from, meshArguments(), progress);
      m_meshFrame = std::move(made.frame);
      applyRoots(made.value, m_input, m_track);
      return std::move(made.value);
    }
    if (from.kind == FormatKind::Case) {
      // rounding and motion make another case; another encoding does not
      const bool isOther = m_time || m_outputOptions.encoding.pointBits != 0;
      return atTime(isOther ? readParentCase(m_input) : from.readCase(m_input), m_time, m_input,
                    *context.table, progress);
    }
    if (from.kind == FormatKind::Centerline) {
      const auto loaded = loadCenterline(m_input, from, m_volume, m_centerline, progress);
      // there is no voxel that a mesh could take its cells from
      double& cell = m_outputOptions.polygonise.cell;
      const double thinnest = convert::measureExtent(loaded.file).least;
      if (cell == 0 && thinnest > 0) cell = convert::coarsestCellFor(thinnest);
      return convert::caseOfCenterline(loaded.file, m_input);
    }
    const convert::Volume volume = readVolumeFile(m_input, from, m_volume, progress);
    if (m_mask.isGiven()) return caseOfLabels(volume, progress);
    if (m_seeds.empty() && convert::holdsLabels(volume)) {
      progress.detail(m_input + ": its voxels are labels, and all but 0 are taken for vessels");
      m_contents.input = inputContent(from, true);
      requireInScope(*context.table, m_contents, progress);
      return caseOfLabels(volume, progress);
    }
    if (!m_seeds.empty()) warnOfVoxels(volume, m_input, progress);
    convert::TrackResult tracked = trackVessels(volume, m_input, m_seeds, m_track, progress);
    if (!m_mask.labelMap.empty())
      nameByLabelMap(volume, m_input, m_mask, tracked.result, tracked.ends, progress);
    m_repetition = repeatTracks(volume, m_input, m_seeds, m_track, tracked.result, progress);
    if (!m_corrected.empty()) replay(tracked.result, progress);
    m_remarks = std::move(static_cast<convert::TrackRemarks&>(tracked));
    return std::move(tracked.result);
  }

  void replay(formats::Case& target, Progress& progress) {
    m_replayed = convert::replayEdits(readCase(m_corrected), target);
    for (const convert::LeftEdit& left : m_replayed->left)
      progress.warn(m_corrected + ": a correction is not made again: " + left.sentence + ": " +
                    left.why);
  }

  [[nodiscard]] Json replayedJson() const {
    if (!m_replayed) return nullptr;
    Json left = Json::array();
    for (const convert::LeftEdit& one : m_replayed->left)
      left.push_back({{"sentence", one.sentence}, {"why", one.why}});
    return {{"made", m_replayed->made}, {"left", std::move(left)}};
  }

  [[nodiscard]] std::string replayedLine() const {
    if (!m_replayed) return {};
    return counted(m_replayed->made.size(), "correction", "corrections") + " made again, " +
           std::to_string(m_replayed->left.size()) + " left\n";
  }

  [[nodiscard]] formats::Case caseOfLabels(const convert::Volume& volume, Progress& progress) {
    formats::Case made = caseOfMask(volume, m_input, m_mask, progress);
    if (!m_mask.labelMap.empty())
      nameByLabelMap(volume, m_input, m_mask, made, m_remarks.ends, progress);
    applyRoots(made, m_input, m_track);
    return made;
  }

  /// Refuses to round wall points that a case does not have.
  void requirePoints(const formats::Case& value, const RunContext& context) const {
    const OptionRow& row = *context.table->find("point-bits");
    if (row.isGiven && (!value.points || value.points->position.empty()))
      refuseUnused(
          row, "is for cases with wall points, and " + formats::printable(m_input) + " has none",
          context.progress);
  }

  /// Refuses to leave out a motion that a case does not have.
  void requireMotion(const formats::Case& value, const RunContext& context) const {
    const OptionRow& row = *context.table->find("skin");
    if (row.isGiven && !value.motion)
      refuseUnused(row,
                   "is for cases with a motion, and " + formats::printable(m_input) + " has none",
                   context.progress);
  }

  [[nodiscard]] MeshArguments meshArguments() const {
    MeshArguments arguments = m_mesh;
    arguments.unit = m_volume.unit;
    arguments.scene.allowDetached = m_volume.allowDetached;
    return arguments;
  }

  /// A tracked volume gets its models, and so does a mesh; so does a case that has none when they
  /// are needed for a mesh.
  void complete(formats::Case& value, const FileFormat& from, const FileFormat& to,
                const RunContext& context) {
    const bool meshNeedsModels = to.kind == FormatKind::Mesh && !value.models;
    if (meshNeedsModels && !value.points)
      throw invalidInput(m_input +
                         ": this case has neither models nor wall points to fit them to, "
                         "so there is no surface to make a mesh of");
    const bool isNew = from.kind != FormatKind::Case;
    if (!isNew) {
      if (meshNeedsModels) m_contents.input = kUnfittedCase;
      requireInScope(*context.table, m_contents, context.progress);
    }
    if (isNew || meshNeedsModels) fit(value, context);
  }

  void fit(formats::Case& value, const RunContext& context) const {
    convert::FitOptions options = fitOptionsFor(value, m_fit);
    if (context.table->find(kOption.cohesionWeight.name)->isGiven)
      options.cohesionWeight = m_fit.cohesionWeight;
    const OptionRow& scale = *context.table->find("cohesion-scale");
    if (scale.isGiven && !(options.cohesionWeight > 0))
      refuseUnused(scale,
                   "does nothing without " + kOption.cohesionWeight.shown() +
                       ", which is 0 for a case without voxels",
                   context.progress);
    convert::fit(value, options, context.progress);
  }

  [[nodiscard]] Answer report(const formats::Case& value,
                              const std::optional<convert::Reach>& reach,
                              const std::optional<convert::SurfaceReport>& surface) const {
    Json json = caseSummary(value);
    json["reachable"] = reachJson(reach);
    json["surface"] = surfaceJson(surface, value);
    json["mesh"] = meshFrameJson(m_meshFrame);
    json["repeats"] = repetitionJson(m_repetition, value);
    json["corrections"] = replayedJson();
    return {withRemarks(std::move(json), m_remarks),
            caseLine(m_output, value) + replayedLine() + meshFrameLine(m_meshFrame) +
                convert::reachLine(reach) + surfaceLines(surface, value) +
                repetitionLines(m_repetition) + endLines(m_remarks)};
  }

  std::string m_input, m_output, m_from, m_to, m_corrected;
  std::optional<convert::ReplayedEdits> m_replayed;
  VolumeArguments m_volume;
  CenterlineArguments m_centerline;
  TrackArguments m_track;
  convert::FitOptions m_fit;
  std::optional<double> m_time;
  MeshArguments m_mesh;
  std::optional<MeshFrame> m_meshFrame;  ///< none for other inputs
  MaskArguments m_mask;
  OutputOptions m_outputOptions;
  FileContents m_contents;
  std::vector<convert::SeedBranch> m_seeds;
  convert::TrackRemarks m_remarks;
  std::optional<convert::Repetition> m_repetition;
};

}  // namespace

std::unique_ptr<Command> makeConvertCommand() {
  return std::make_unique<ConvertCommand>();
}

}  // namespace lumen::engine
