// SPDX-License-Identifier: Apache-2.0
// lumen picture: a case as a PNG.
#include <array>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <vector>

#include "converters/app/command.h"
#include "converters/app/file_access.h"
#include "converters/app/option_group.h"
#include "converters/app/report.h"
#include "converters/app/stages.h"
#include "converters/app/value_checks.h"
#include "converters/common/error.h"
#include "converters/picture/draw_case.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

using convert::ColourBy, convert::View;

const std::map<std::string, View> kViews = {
    {"best", View::Best},        {"anterior", View::Anterior}, {"posterior", View::Posterior},
    {"left", View::Left},        {"right", View::Right},       {"superior", View::Superior},
    {"inferior", View::Inferior}};
const std::map<std::string, ColourBy> kColours = {{"vessel", ColourBy::Vessel},
                                                  {"branch", ColourBy::Branch},
                                                  {"radius", ColourBy::Radius},
                                                  {"confidence", ColourBy::Confidence}};
constexpr int kMostPixels = 10000;  // across and down: 800 MB of samples
constexpr int kMostFrames = 999;

void writePng(const convert::Picture& picture, const std::string& file) {
  const std::string png = convert::encodePng(picture);
  const auto done =
      formats::writeFileAtomically(std::as_bytes(std::span(png.data(), png.size())), file);
  if (!done) throw failed(done.error().message);
}

/// "head.png" and 3 give "head-003.png".
std::string frameName(const std::string& file, int frame) {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "-%03d", frame);
  const std::size_t dot = file.rfind('.');
  return file.substr(0, dot) + number.data() + file.substr(dot);
}

class PictureCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "picture"; }
  [[nodiscard]] std::string summary() const override {
    return "Draw a case as a PNG, without a display";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen picture head.lumen head.png --view left --colour radius\n"
           "  lumen picture head.lumen head.png --volume head.nrrd\n"
           "  lumen picture head.lumen turn.png --turntable 36";
  }

  void bind(CLI::App& app) override {
    addFile(app, "CASE", m_input, "Case, with models");
    addFile(app, "PNG", m_output, "Picture to write");
    OptionGroup group(app, "Picture");
    group.addChoice("--view", m_options.view, kViews,
                    "From which side of the patient; best: along the direction in which the "
                    "vessels extend least");
    group.addChoice("--colour", m_options.colour, kColours, "What colours show");
    app.add_option_function<std::string>(
           "--size", [this](const std::string& text) { setSize(text); },
           "Width and height in pixels")
        ->type_name("WxH")
        ->group("Picture")
        ->default_str("1000x800");
    addFile(app, "--volume", m_volume, "Volume whose projection is drawn behind the vessels")
        ->required(false)
        ->group("Picture");
    group
        .add("--turntable", m_frames, "N",
             "Write N pictures, NAME-000.png and so on, turned about the axis from foot to head; "
             "0: one, not turned")
        ->check(wholeIn(0, kMostFrames));
    addVolumeOptions(app, m_volumeOptions);
  }

  int run(Context& context) override {
    if (!m_output.ends_with(".png"))
      throw Error(ErrorKind::Usage, formats::printable(m_output) +
                                        ": found a name without .png, expected one with it");
    const formats::Case value = readCase(m_input);
    if (!value.models)
      throw invalidInput(
          m_input +
          ": this case has no models, so there is no surface to draw; lumen fit makes them");
    std::optional<convert::Volume> volume;
    if (!m_volume.empty())
      volume = loadVolume(m_volume, inputFormat(m_volume, ""), m_volumeOptions, context.progress);
    context.interrupts.watchOutput(m_output);
    std::vector<std::string> files;
    for (int frame = 0; frame < std::max(1, m_frames); ++frame) {
      convert::PictureOptions options = m_options;
      if (m_frames > 0) options.turn = 2 * std::numbers::pi * frame / m_frames;
      files.push_back(m_frames > 0 ? frameName(m_output, frame) : m_output);
      writePng(convert::drawCase(value, options, volume ? &*volume : nullptr, context.progress),
               files.back());
    }
    report(files, context);
    return 0;
  }

private:
  void setSize(const std::string& text) {
    static const std::regex kSize("([0-9]{1,5})x([0-9]{1,5})");
    std::smatch parts;
    if (std::regex_match(text, parts, kSize)) {
      m_options.width = std::stoi(parts[1]);
      m_options.height = std::stoi(parts[2]);
      if (m_options.width >= 16 && m_options.height >= 16 && m_options.width <= kMostPixels &&
          m_options.height <= kMostPixels)
        return;
    }
    throw Error(ErrorKind::Usage, "--size: found " + formats::printable(text) +
                                      ", expected WxH with numbers from 16 to " +
                                      std::to_string(kMostPixels));
  }

  void report(const std::vector<std::string>& files, const Context& context) const {
    if (context.common.json) {
      answerJson(Json{{"files", files}, {"width", m_options.width}, {"height", m_options.height}});
    } else if (!context.common.quiet) {
      answer(formats::printable(files.front()) + ": " + std::to_string(m_options.width) + " by " +
             std::to_string(m_options.height) + " pixels" +
             (files.size() > 1 ? ", and " + std::to_string(files.size() - 1) + " more" : "") +
             "\n");
    }
  }

  std::string m_input, m_output, m_volume;
  int m_frames = 0;
  convert::PictureOptions m_options;
  VolumeArguments m_volumeOptions;
};

}  // namespace

std::unique_ptr<Command> makePictureCommand() {
  return std::make_unique<PictureCommand>();
}

}  // namespace lumen::app
