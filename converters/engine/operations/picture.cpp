// SPDX-License-Identifier: Apache-2.0
// lumen picture: a case as a PNG.
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/draw/picture/draw_case.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::ColorBy, convert::View;

const std::map<std::string, View> kViews = {
    {"best", View::Best},        {"anterior", View::Anterior}, {"posterior", View::Posterior},
    {"left", View::Left},        {"right", View::Right},       {"superior", View::Superior},
    {"inferior", View::Inferior}};
const std::map<std::string, ColorBy> kColours = {{"vessel", ColorBy::None},
                                                 {"branch", ColorBy::Branch},
                                                 {"radius", ColorBy::Radius},
                                                 {"confidence", ColorBy::Confidence}};
constexpr int kLeastPixels = 16, kMostPixels = 4096;  // across and down: 1.6 GB of samples
constexpr int kMostFrames = 360;                      // one for each degree

/// "head.png" and 3 give "head-003.png".
std::string frameName(const std::string& file, int frame) {
  const std::size_t dot = file.rfind('.');
  return file.substr(0, dot) + "-" + paddedNumber(static_cast<std::uint64_t>(frame), 3) +
         file.substr(dot);
}

/// Files that appear together, when all of them are written: until then none of them does.
class PendingPictures {
public:
  void add(const convert::Picture& picture, const std::string& file) {
    auto pending = formats::PendingFile::beside(file);
    if (!pending) throw failed(pending.error().message);
    writeNewFile(convert::encodePng(picture), pending->path(), file);
    m_pending.push_back(std::move(*pending));
    m_names.push_back(file);
  }
  void commit() {
    for (formats::PendingFile& file : m_pending)
      if (const auto done = file.commit(); !done) throw failed(done.error().message);
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return m_names; }

private:
  std::vector<formats::PendingFile> m_pending;
  std::vector<std::string> m_names;
};

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

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_input, "Case, with models");
    table.argument("PNG", &m_output, "Picture to write");
    addTimeRow(table, m_time);
    table.group("Picture");
    table.choice("view", m_options.view, kViews,
                 "From which side of the patient; best: along the direction in which the "
                 "vessels extend least");
    table.choice(kOption.colour.name, m_options.colour, kColours, "Quantity that the colours show")
        .alsoCalled("color");
    table
        .add(
            "size", [this](const std::vector<std::string>& texts) { setSize(texts.back()); }, "WxH",
            "Width and height in pixels; below 160, without scale and sides")
        .defaults("1000x800");
    table.file(kOption.volume.name, m_volume,
               "Volume whose projection is drawn behind the vessels");
    table
        .add("turntable", &m_frames, "N",
             "Write N pictures, NAME-000.png and so on, turned about the picture's upright axis, "
             "all in one scale; they appear together when the last is drawn. 0: one, not turned")
        .in(WholeRange{0, kMostFrames});
    addVolumeRows(table, m_volumeOptions, kOption.volume.name);
  }

  Answer run(const RunContext& context) override {
    if (!m_output.ends_with(".png"))
      throw Error(ErrorKind::Usage,
                  formats::printable(m_output) +
                      ": found a name without .png, expected one with it, after that of the case");
    requireInScope(*context.table, {}, context.progress);
    requireInput(m_input, "case");
    requireWritable(m_frames > 0 ? frameName(m_output, 0) : m_output, convert::ContentKind::Other);
    const formats::Case value =
        atTime(readCase(m_input), m_time, m_input, *context.table, context.progress);
    std::optional<convert::Volume> volume;
    if (!m_volume.empty()) volume = volumeBehind(context);
    PendingPictures pictures;
    draw(value, volume ? &*volume : nullptr, pictures, context.progress);
    if (m_frames > 0) warnOfOlder(context.progress);
    context.progress.check();
    pictures.commit();
    return report(pictures.names());
  }

private:
  [[nodiscard]] convert::Volume volumeBehind(const RunContext& context) const {
    requireInput(m_volume, "volume");
    const FileFormat& format = inputFormat(m_volume, "");
    if (format.kind != FormatKind::Volume)
      throw unsupported(
          m_volume + ": found a " + (format.kind == FormatKind::Mesh ? "mesh" : "case") +
          ", expected a volume: " + kOption.volume.shown() + " is drawn behind the vessels");
    requireInScope(*context.table, {inputContent(format, false), kAnyContent, m_volume, {}},
                   context.progress);
    return loadVolume(m_volume, format, m_volumeOptions, context.progress);
  }

  void draw(const formats::Case& value, const convert::Volume* volume, PendingPictures& pictures,
            Progress& progress) const {
    std::optional<convert::CasePainter> painter;
    naming(m_input, [&] { painter.emplace(value); });
    if (volume) naming(m_volume, [&] { painter->setVolume(*volume, progress); });
    naming(m_input, [&] { drawFrames(*painter, pictures, progress); });
  }

  /// Adds the file's name to the start of an error about it.
  template <class Work>
  static void naming(const std::string& file, const Work& work) {
    try {
      work();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      throw invalidInput(file + ": " + error.what());
    }
  }

  void drawFrames(const convert::CasePainter& painter, PendingPictures& pictures,
                  Progress& progress) const {
    convert::PictureOptions options = m_options;
    options.allTurns = m_frames > 0;
    const int count = std::max(1, m_frames);
    progress.detail("drawing " + std::to_string(count) + " of " + std::to_string(options.width) +
                    " by " + std::to_string(options.height) + " pixels");
    progress.begin("pictures", static_cast<std::size_t>(count));
    for (int frame = 0; frame < count; ++frame) {
      options.turn = 2 * std::numbers::pi * frame / count;
      pictures.add(painter.draw(options, progress),
                   m_frames > 0 ? frameName(m_output, frame) : m_output);
      progress.advance();
    }
    progress.end();
  }

  /// Frames that this run does not replace are of another turntable.
  void warnOfOlder(Progress& progress) const {
    const std::string next = frameName(m_output, m_frames);
    if (std::filesystem::exists(next))
      progress.warn(
          formats::printable(next) +
          ": found a frame of an older turntable, which stays; remove it, and those after it");
  }

  void setSize(const std::string& text) {
    static const std::regex kSize("([0-9]{1,5})x([0-9]{1,5})");
    const auto fits = [](int pixels) { return pixels >= kLeastPixels && pixels <= kMostPixels; };
    std::smatch parts;
    if (std::regex_match(text, parts, kSize)) {
      m_options.width = std::stoi(parts[1]);
      m_options.height = std::stoi(parts[2]);
      if (fits(m_options.width) && fits(m_options.height)) return;
    }
    throw Error(ErrorKind::Usage, "--size: found " + formats::printable(text) +
                                      ", expected WxH with numbers from " +
                                      std::to_string(kLeastPixels) + " to " +
                                      std::to_string(kMostPixels) + ", such as 1000x800");
  }

  [[nodiscard]] Answer report(const std::vector<std::string>& files) const {
    const std::string more =
        files.size() > 1 ? ", and " + std::to_string(files.size() - 1) + " more" : "";
    return {Json{{"files", files}, {"width", m_options.width}, {"height", m_options.height}},
            formats::printable(files.front()) + ": " + std::to_string(m_options.width) + " by " +
                std::to_string(m_options.height) + " pixels" + more + "\n"};
  }

  std::string m_input, m_output, m_volume;
  int m_frames = 0;
  std::optional<double> m_time;
  convert::PictureOptions m_options;
  VolumeArguments m_volumeOptions;
};

}  // namespace

std::unique_ptr<Command> makePictureCommand() {
  return std::make_unique<PictureCommand>();
}

}  // namespace lumen::engine
