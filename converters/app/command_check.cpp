// SPDX-License-Identifier: Apache-2.0
// lumen check: the agreement of a case with its volume.
#include <cmath>

#include "converters/app/command.h"
#include "converters/app/file_access.h"
#include "converters/app/report.h"
#include "converters/app/stages.h"
#include "converters/check/check.h"
#include "converters/check/overlay.h"
#include "converters/common/vectors.h"
#include "converters/volume/write_volume.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

using formats::printable;

constexpr std::size_t kPlacesShown = 10;  // of each kind; --json has all

Json offsetsJson(const convert::Offsets& o, double voxel) {
  Json json;
  json["samples"] = o.samples;
  json["beside_others"] = o.beside;
  json["outside_volume"] = o.outside;
  for (const auto& [unit, size] : {std::pair{"offset_mm", 1.0}, std::pair{"offset_voxels", voxel}})
    json[unit] = {{"median", jsonNumber(o.median / size)},
                  {"median_absolute", jsonNumber(o.absoluteMedian / size)},
                  {"p90_absolute", jsonNumber(o.absoluteP90 / size)},
                  {"median_uncorrected", jsonNumber(o.uncorrectedMedian / size)}};
  json["beyond_voxel_share"] = jsonNumber(o.beyondVoxel);
  json["no_edge_share"] = jsonNumber(o.noEdge);
  json["wrong_polarity_share"] = jsonNumber(o.wrongPolarity);
  return json;
}

Json placesJson(const convert::Places& places, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::Place& place : places.places) {
    const auto& p = place.position;
    json.push_back({{"position", {p.x(), p.y(), p.z()}},
                    {"length_mm", jsonNumber(place.length)},
                    {"radius_mm", jsonNumber(place.radius)},
                    {"volume_mm3", jsonNumber(place.volume)},
                    {"voxels", place.voxels},
                    {"branch", tree.branches[tree.branch[place.node]].label},
                    {"node", place.node}});
  }
  return json;
}

double share(double part, double whole) {
  return whole > 0 ? part / whole : NAN;
}

Json checkJson(const convert::CheckReport& report, const formats::CenterlineTree& tree,
               const std::string& source) {
  Json json;
  json["source"] = source;
  json["voxel_size_mm"] = jsonNumber(report.voxelSize);
  json["point_spread_mm"] = jsonNumber(report.options.pointSpread);
  json["nodes_outside"] = report.nodesOutside;
  json["wall"] = offsetsJson(report.offsets, report.voxelSize);
  json["lumen_mm3"] = jsonNumber(report.lumenVolume);
  json["dark_share"] = jsonNumber(share(report.dark.volume, report.lumenVolume));
  json["dark_places"] = placesJson(report.dark, tree);
  json["missing_share"] =
      jsonNumber(share(report.missing.volume, report.missing.volume + report.lumenVolume));
  json["missing_places"] = placesJson(report.missing, tree);
  json["branches"] = Json::array();
  for (const auto& branch : report.branches) {
    Json entry;
    entry["label"] = branch.label;
    entry["wall"] = offsetsJson(branch.offsets, report.voxelSize);
    json["branches"].push_back(std::move(entry));
  }
  return json;
}

std::string percent(double value) {
  return std::isfinite(value) ? fixed(100 * value, 1) + " %" : "-";
}

std::vector<std::string> offsetsRow(const std::string& label, const convert::Offsets& o,
                                    double voxel) {
  return {label,
          std::to_string(o.samples),
          fixed(o.median, 3),
          fixed(o.median / voxel, 2),
          fixed(o.absoluteMedian / voxel, 2),
          fixed(o.absoluteP90 / voxel, 2),
          percent(o.beyondVoxel),
          percent(o.noEdge),
          percent(o.wrongPolarity),
          std::to_string(o.beside)};
}

std::string at(const Eigen::Vector3d& p) {
  return "(" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
}

/// "a vessel of 12.3 mm and radius 0.8 mm at (x, y, z), beside aca-4"
std::string placeText(const convert::Place& place, const formats::CenterlineTree& tree) {
  constexpr double kSlender = 3;  // radii: what is shorter is no vessel to the eye
  const std::string kind = place.length > kSlender * place.radius ? "a vessel" : "a region";
  return kind + " of " + fixed(place.length, 1) + " mm and radius " + fixed(place.radius, 1) +
         " mm at " + at(place.position) + ", beside " +
         printable(tree.branches[tree.branch[place.node]].label);
}

std::string missingText(const convert::Places& missing, const formats::CenterlineTree& tree) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kPlacesShown, missing.places.size()); ++i)
    text += placeText(missing.places[i], tree) + " is not in the case\n";
  if (missing.places.size() > kPlacesShown)
    text +=
        counted(missing.places.size() - kPlacesShown, "smaller place is", "smaller places are") +
        " not in the case; --json lists them\n";
  return text;
}

std::string darkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  std::string text = percent(share(report.dark.volume, report.lumenVolume)) +
                     " of the lumen's volume is dark and farther than a voxel from its wall\n";
  for (std::size_t i = 0; i < std::min(kPlacesShown, report.dark.places.size()); ++i) {
    const convert::Place& place = report.dark.places[i];
    text += "the lumen of " + printable(tree.branches[tree.branch[place.node]].label) + " at " +
            at(place.position) + " is dark over " + fixed(place.volume, 1) + " mm3\n";
  }
  return text;
}

std::string checkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"branch", "samples", "offset", "voxels", "median", "p90", "beyond", "no edge",
                  "reversed", "beside"});
  for (const auto& branch : report.branches)
    rows.push_back(offsetsRow(printable(branch.label), branch.offsets, report.voxelSize));
  rows.push_back(offsetsRow("(all)", report.offsets, report.voxelSize));
  return alignColumns(rows) +
         "\noffset of the wall from the half-maximum edge: median in mm and voxels, positive where "
         "the model\nis too wide; median and 90th percentile of its size in voxels. Shares of the "
         "samples: farther than\na voxel, without an edge, dark inside and bright outside. Beside: "
         "samples where another part of the\ntree begins, not judged. One voxel is " +
         fixed(report.voxelSize, 3) + " mm; blur taken as " + fixed(report.options.pointSpread, 3) +
         " mm.\n\n" + darkText(report, tree) + missingText(report.missing, tree);
}

class CheckCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "check"; }
  [[nodiscard]] std::string summary() const override {
    return "Agreement of a case with its volume: wall, dark lumen, missing vessels";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen check head.nrrd head.lumen --overlay head.png --mask head-lumen.nrrd";
  }

  void bind(CLI::App& app) override {
    app.add_option("VOLUME", m_input, formatTitles(canReadVolume))->required()->configurable(false);
    app.add_option("CASE", m_case, "The case that was made from it")
        ->required()
        ->configurable(false);
    addVolumeOptions(app, m_volume);
    app.add_option("--overlay", m_overlay,
                   "Also write projections of the volume with the tree, as PNG")
        ->type_name("FILE")
        ->configurable(false);
    app.add_option("--mask", m_mask,
                   "Also write the lumen as a volume of labels, 1 for the first branch: " +
                       formatEndings(canWriteVolume))
        ->type_name("FILE")
        ->configurable(false);
    app.add_option("--point-spread", m_pointSpread,
                   "Blur of the volume, a standard deviation in mm: it displaces the edges of thin "
                   "vessels; 0 takes them as they are seen [what the case records, else 0]")
        ->type_name("MM")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--from", m_from, "Format of VOLUME, whatever its name")->type_name("F");
  }

  int run(Context& context) override {
    requireInput(m_input, "volume");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind != FormatKind::Volume)
      throw unsupported(m_input +
                        ": this is a case; lumen check takes the volume first, then the "
                        "case");
    const FileFormat* mask =
        m_mask.empty() ? nullptr : &volumeOutputFormat(m_mask, "what --mask makes");
    checkOutputs(context);
    const formats::Case value = readCase(m_case);
    if (!value.models || value.tree.nodeCount() == 0)
      throw invalidInput(m_case +
                         ": has no models, so it has no wall to check; lumen fit makes them");
    const convert::Volume volume = loadVolume(m_input, from, m_volume, context.progress);
    const std::string source = checkSource(volume, value, context);

    convert::EdgeOptions options = convert::recordedEdgeOptions(value);
    if (m_pointSpread) options.pointSpread = *m_pointSpread;
    const convert::CheckResult result = checked(volume, value, options, context);
    if (const std::size_t outside = result.report.nodesOutside; outside > 0)
      context.progress.warn(m_case + ": " + std::to_string(outside) + " of its " +
                            counted(value.tree.nodeCount(), "node lies", "nodes lie") +
                            " outside of " + m_input);
    if (mask != nullptr)
      mask->writeVolume(convert::labelVolume(volume.geometry, value.tree, result.lumen), m_mask);
    if (!m_overlay.empty())
      writeText(convert::encodePng(convert::drawOverlay(volume, value.tree, result.report)),
                m_overlay);
    if (context.common.json)
      answerJson(checkJson(result.report, value.tree, source));
    else
      answer(checkText(result.report, value.tree));
    return 0;
  }

private:
  /// Refuses what could not be written in the end, and what would be lost.
  void checkOutputs(Context& context) const {
    if (!m_mask.empty() && m_mask == m_overlay)
      throw Error(ErrorKind::Usage, m_mask + ": this name is given to two outputs");
    const std::pair<const std::string&, ContentKind> outputs[] = {{m_overlay, ContentKind::Other},
                                                                  {m_mask, ContentKind::Volume}};
    for (const auto& [output, kind] : outputs) {
      if (output.empty()) continue;
      std::error_code missing;
      for (const std::string& input : {m_input, m_case})
        if (std::filesystem::equivalent(input, output, missing))
          throw Error(ErrorKind::Usage,
                      output + ": this is an input; lumen check would overwrite it");
      requireWritable(output, kind);
      context.interrupts.watchOutput(output);
    }
  }

  /// "same", "unknown", or what of the volume differs from the case's source.
  std::string checkSource(const convert::Volume& volume, const formats::Case& value,
                          const Context& context) const {
    if (!value.metadata.source) return "unknown";
    const auto difference =
        convert::sourceDifference(convert::describeSource(volume), *value.metadata.source);
    if (!difference) return "same";
    const std::string text = m_case + ": was made from another volume: its " + difference->what +
                             " was " + difference->expected + ", that of " + m_input + " is " +
                             difference->found;
    context.progress.warn(text);
    return "other " + difference->what;
  }

  convert::CheckResult checked(const convert::Volume& volume, const formats::Case& value,
                               const convert::EdgeOptions& options, Context& context) const {
    try {
      return convert::checkCase(volume, value, options, context.progress);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      throw invalidInput(m_case + " and " + m_input + ": " + error.what());
    }
  }

  std::string m_input, m_case, m_overlay, m_mask, m_from;
  std::optional<double> m_pointSpread;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makeCheckCommand() {
  return std::make_unique<CheckCommand>();
}

}  // namespace lumen::app
