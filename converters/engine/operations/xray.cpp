// SPDX-License-Identifier: Apache-2.0
// lumen xray: the picture that a C-arm takes of a case.
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/xray_of.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class XrayCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "xray"; }
  [[nodiscard]] std::string summary() const override {
    return "Take an X-ray of a case with contrast agent in its vessels";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen xray head.lumen head.png --lao 30 --cra 20\n"
           "  lumen xray chest.lumen chest.png --volume chest-ct.nii.gz --photons 20000\n"
           "  lumen xray head.lumen dsa.nrrd --subtract --size 1024x1024";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_input, "Case, with models");
    table.argument("OUT", &m_output,
                   "Picture to write, .png: the more is attenuated, the darker; or volume of one "
                   "slice, " +
                       formatEndings(canWriteVolume) +
                       ": -ln of the share of the energy that arrives, in the place of the "
                       "detector");
    addTimeRow(table, m_time);
    addViewRows(table);
    addPhysicsRows(table);
  }

  Answer run(const RunContext& context) override {
    const bool isPicture = m_output.path().extension() == ".png";
    requireInScope(*context.table, {}, context.progress);
    if (m_options.view.sourceToDetector <= m_options.view.sourceToIsocentre)
      throw Error(ErrorKind::Usage, "--detector-distance: found " +
                                        shownNumber(m_options.view.sourceToDetector) +
                                        ", expected more than --source-distance, " +
                                        shownNumber(m_options.view.sourceToIsocentre));
    requireInput(m_input, "case");
    const FileFormat* const format =
        isPicture ? nullptr : &volumeOutputFormat(m_output, "an X-ray");
    requireWritable(m_output,
                    isPicture ? convert::ContentKind::Other : convert::ContentKind::Volume);
    if (!m_isocentre.empty()) m_options.isocentre = placeIn(m_isocentre);
    const formats::Case value =
        atTime(readCase(m_input), m_time, m_input.name(), *context.table, context.progress);
    std::optional<convert::Volume> scan;
    if (!m_around.empty()) scan.emplace(volumeAround(context.progress));
    const convert::XrayImage image =
        operations::xrayOf(value, m_input.name(), m_options,
                           {scan ? &*scan : nullptr, m_around.name()}, operationContext(context));
    if (isPicture)
      writeText(convert::encodePng(convert::shadedXray(image)), m_output);
    else
      format->writeVolume(convert::detectorVolume(image), m_output);
    return report(image);
  }

private:
  void addViewRows(OptionTable& table) {
    convert::XrayView& view = m_options.view;
    table.group("C-arm");
    table
        .add(
            "lao", &view.primary, "DEG",
            "Angle of the detector from in front towards the patient's left; negative: right (RAO)")
        .in(NumberRange{-180, 180});
    table
        .add("cra", &view.secondary, "DEG",
             "Angle of the detector towards the head; negative: towards the feet (CAU)")
        .in(NumberRange{-90, 90});
    table
        .add("isocentre", &m_isocentre, "X,Y,Z",
             "Place about which the arm turns, mm, LPS [middle of the vessels]")
        .alsoCalled("isocenter")
        .checkedBy(placeFault);
    table.add("source-distance", &view.sourceToIsocentre, "MM", "From the source to the isocentre")
        .in(NumberRange{100, 5000});
    table.add("detector-distance", &view.sourceToDetector, "MM", "From the source to the detector")
        .in(NumberRange{100, 10000});
    table
        .add(
            "size",
            [&view](const std::vector<std::string>& texts) {
              std::tie(view.width, view.height) = pictureSize(texts.back());
            },
            "WxH", "Width and height in pixels")
        .defaults("512x512");
    table
        .add("pixel", &view.pixel, "MM",
             "Side of a pixel of the detector; 0: the vessels are in the picture at any angles")
        .in(NumberRange{0, 100});
  }

  void addPhysicsRows(OptionTable& table) {
    table.group("Radiation");
    table.add("kv", &m_options.peak, "KV", "Peak voltage of the tube").in(NumberRange{30, 150});
    table.add("filter", &m_options.filter, "MM", "Aluminium before the tube")
        .in(NumberRange{0, 50});
    table.add("iodine", &m_options.iodine, "MG", "Iodine in the lumen, mg/ml; 0: no contrast agent")
        .in(NumberRange{0, 1000});
    table.add("tissue", &m_options.tissue, "MM", "Water on each ray, in a volume's place")
        .in(NumberRange{0, 1000})
        .notBeside(kOption.volume.name);
    table.file(kOption.volume.name, m_around,
               "Computed tomography around the vessels; what it shows within them does not count");
    table
        .add("scatter", &m_options.scatter, "SHARE",
             "Scattered over primary radiation, even over the picture")
        .in(NumberRange{0, 100});
    table
        .add("photons", &m_options.photons, "N",
             "Photons of the bare beam for each pixel, of which noise follows; 0: without noise")
        .in(NumberRange{0, 1e12});
    table.add("random-seed", &m_options.seed, "K", "Seed of the random numbers of the noise")
        .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})
        .onlyWith("photons");
    table.flag("subtract", m_options.isSubtracted,
               "Less the same picture without contrast agent (DSA)");
  }

  [[nodiscard]] convert::Volume volumeAround(Progress& progress) const {
    requireInput(m_around, "volume");
    const FileFormat& format = inputFormat(m_around, "");
    if (format.kind != FormatKind::Volume)
      throw unsupported(m_around.name() + ": expected a volume: " + kOption.volume.shown() +
                        " is computed tomography around the vessels");
    return readVolumeFile(m_around, format, VolumeArguments{}, progress);
  }

  [[nodiscard]] Answer report(const convert::XrayImage& image) const {
    const convert::XrayView& view = image.view;
    const double millilitres = image.lumenVolume / 1000;
    Json json;
    json["file"] = m_output.name();
    json["width"] = view.width;
    json["height"] = view.height;
    json["pixel_mm"] = jsonNumber(view.pixel);
    json["lao_deg"] = jsonNumber(view.primary);
    json["cra_deg"] = jsonNumber(view.secondary);
    json["isocentre"] = vectorJson(view.isocentre);
    json["source"] = vectorJson(view.source());
    json["detector"] = vectorJson(view.source() + view.sourceToDetector * view.towards());
    json["right"] = vectorJson(view.right());
    json["up"] = vectorJson(view.up());
    json["mean_energy_kev"] = jsonNumber(image.meanEnergy);
    json["longest_path_mm"] = jsonNumber(image.longest);
    json["lumen_share"] = jsonNumber(image.lumenShare);
    json["lumen_ml"] = jsonNumber(millilitres);
    json["iodine_mg"] = jsonNumber(millilitres * m_options.iodine);
    return {std::move(json), formats::printable(m_output.name()) + ": " +
                                 std::to_string(view.width) + " by " + std::to_string(view.height) +
                                 " pixels of " + shownNumber(view.pixel, 3) + " mm, lumen up to " +
                                 fixedText(image.longest, 1) + " mm deep, " +
                                 fixedText(millilitres, 2) + " ml of it in the picture\n"};
  }

  InputFile m_input, m_around;
  OutputFile m_output;
  std::optional<double> m_time;
  std::string m_isocentre;
  convert::XrayOptions m_options;
};

}  // namespace

std::unique_ptr<Command> makeXrayCommand() {
  return std::make_unique<XrayCommand>();
}

}  // namespace lumen::engine
