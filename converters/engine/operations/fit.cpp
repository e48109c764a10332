// SPDX-License-Identifier: Apache-2.0
// lumen fit: blobby models for a tracked case.
#include "converters/stages/fitting/fit.h"

#include "converters/base/shown_text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/image_fit.h"

namespace lumen::engine {

namespace {

Json imageJson(const std::optional<convert::ImageFitReport>& report) {
  if (!report) return nullptr;
  return {{"nodes", report->nodes}, {"kept", report->kept}, {"blur_mm", jsonNumber(report->blur)}};
}

std::string imageLine(const std::string& file,
                      const std::optional<convert::ImageFitReport>& report) {
  if (!report) return {};
  return formats::printable(file) + ": " + counted(report->nodes, "node", "nodes") +
         " fitted to the image, " + std::to_string(report->kept) + " left as they were; blur " +
         fixedText(report->blur, 3) + " mm\n";
}

class FitCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "fit"; }
  [[nodiscard]] std::string summary() const override {
    return "Fit blobby models to the wall points of a tracked case";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen fit tracked.lumen fitted.lumen --accuracy 0.2\n"
           "  lumen fit head.lumen head-image.lumen --image head.nrrd   # thin or noisy vessels";
  }

  void addRows(OptionTable& table) override {
    table.argument("IN", &m_input, "Case with wall points");
    table.argument("OUT", &m_output,
                   "Case to write, " + formatEndings(canWriteCase) + "; may be IN");
    addFitRows(table, m_fit);
    addFormatRow(table, "to", m_to, "OUT");
    table.file("image", m_image,
               "First move the wall points of vessels, and their centres and radii, to where the "
               "blurred image of the vessels is most like this volume: the one that the case was "
               "tracked in");
    addFormatRow(table, "from", m_from, "the image");
    table.find("from")->onlyWith("image");
    addVolumeRows(table, m_volume, "image");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "the fitted tree");
    requireInput(m_input, "case file");
    requireInScope(*context.table, {}, context.progress);
    requireWritable(m_output, convert::ContentKind::Case);

    const FileFormat* from = m_image.empty() ? nullptr : &imageFormat();
    formats::Case value = readParentCase(m_input);
    if (!value.points)
      throw invalidInput(m_input.name() +
                         ": this case has no wall points to fit to; lumen track makes one "
                         "that has");
    std::optional<convert::ImageFitReport> image;
    if (from != nullptr) {
      operations::ImageFittedCase made = operations::fittedToImage(
          std::move(value), m_input.name(),
          {loadVolume(m_image, *from, m_volume, context.progress), m_image.name()}, m_fit,
          operationContext(context));
      value = std::move(made.value);
      image = made.report;
    } else {
      convert::fit(value, m_fit, context.progress);
    }
    const std::optional<convert::Reach> reach = convert::measureReach(value, context.progress);
    convert::warnOfClosed(reach, context.progress);
    to.writeCase(value, m_output, {}, context.progress);
    Json json = caseSummary(value);
    json["reachable"] = reachJson(reach);
    json["image"] = imageJson(image);
    return {std::move(json), imageLine(m_image.name(), image) + caseLine(m_output.name(), value) +
                                 convert::reachLine(reach)};
  }

private:
  [[nodiscard]] const FileFormat& imageFormat() const {
    requireInput(m_image, "volume");
    const FileFormat& from = inputFormat(m_image, m_from);
    if (from.kind != FormatKind::Volume)
      throw unsupported(m_image.name() + ": this is no volume; expected the one that " +
                        m_input.name() + " was tracked in");
    return from;
  }

  InputFile m_input, m_image;
  OutputFile m_output;
  std::string m_to, m_from;
  VolumeArguments m_volume;
  convert::FitOptions m_fit;
};

}  // namespace

std::unique_ptr<Command> makeFitCommand() {
  return std::make_unique<FitCommand>();
}

}  // namespace lumen::engine
