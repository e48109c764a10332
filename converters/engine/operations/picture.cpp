// SPDX-License-Identifier: Apache-2.0
// lumen picture: a case as a PNG.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/pictures_of.h"
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
                                                 {"confidence", ColorBy::Confidence},
                                                 {"system", ColorBy::System}};
constexpr int kMostFrames = 360;  // one for each degree

/// Files that appear together, when all of them are written: until then none of them does.
class PendingPictures {
public:
  /// One output of that name, or the files of a turntable: "head.png" gives "head-003.png".
  PendingPictures(OutputFile file, bool isTurntable)
      : m_file(std::move(file)), m_isTurntable(isTurntable) {}

  [[nodiscard]] std::string nameOf(std::size_t frame) const {
    const std::string name = m_file.name();
    if (!m_isTurntable) return name;
    const std::size_t dot = name.rfind('.');
    return name.substr(0, dot) + "-" + paddedNumber(frame, 3) + name.substr(dot);
  }
  void add(const convert::Picture& picture) {
    const std::string file = nameOf(m_names.size());
    m_names.push_back(file);
    if (m_file.bytes() != nullptr && !m_isTurntable)
      return writeText(convert::encodePng(picture), m_file);
    auto pending = formats::PendingFile::beside(file);
    if (!pending) throw failed(pending.error().message);
    writeNewFile(convert::encodePng(picture), pending->path(), file);
    m_pending.push_back(std::move(*pending));
  }
  /// Warns of a frame that this run does not replace: it is of another turntable.
  void warnOfOlder(Progress& progress) const {
    const std::string next = nameOf(m_names.size());
    if (m_isTurntable && std::filesystem::exists(next))
      warn(progress,
           about(formats::printable(next),
                 {WarningCode::PictureOld, "found a frame of an older turntable, which stays",
                  "remove it, and those after it"}));
  }
  void commit() {
    for (formats::PendingFile& file : m_pending)
      if (const auto done = file.commit(); !done) throw failed(done.error().message);
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return m_names; }

private:
  OutputFile m_file;
  bool m_isTurntable;
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
    convert::PictureOptions& picture = m_options.picture;
    table.group("Picture");
    table.choice("view", picture.view, kViews,
                 "From which side of the patient; best: along the direction in which the "
                 "vessels extend least");
    table
        .choice(kOption.colour.name, picture.colour, kColours,
                "Quantity that the colours show; vessel: the system where the case states one")
        .alsoCalled("color");
    table
        .add(
            "size",
            [&picture](const std::vector<std::string>& texts) {
              std::tie(picture.width, picture.height) = pictureSize(texts.back());
            },
            "WxH", "Width and height in pixels; below 160, without scale and sides")
        .defaults("1000x800");
    table.file(kOption.volume.name, m_behind,
               "Volume whose projection is drawn behind the vessels");
    table
        .add("turntable", &m_options.turns, "N",
             "Write N pictures, NAME-000.png and so on, turned about the picture's upright axis, "
             "all in one scale; they appear together when the last is drawn. 0: one, not turned")
        .in(WholeRange{0, kMostFrames});
    addVolumeRows(table, m_volume, kOption.volume.name);
  }

  Answer run(const RunContext& context) override {
    if (m_output.path().extension() != ".png")
      throw Error(ErrorKind::Usage,
                  formats::printable(m_output.name()) +
                      ": found a name without .png, expected one with it, after that of the case");
    requireInScope(*context.table, {}, context.progress);
    requireInput(m_input, "case");
    PendingPictures pictures(m_output, m_options.turns > 0);
    requireWritable(m_options.turns > 0 ? OutputFile(pictures.nameOf(0)) : m_output,
                    convert::ContentKind::Other);
    const formats::Case value =
        atTime(readCase(m_input), m_time, m_input.name(), *context.table, context.progress);
    std::optional<convert::Volume> volume;
    operations::PicturesOptions options = m_options;
    options.behindName = m_behind.name();
    if (!m_behind.empty()) options.behind = &volume.emplace(volumeBehind(context));
    operations::picturesOf(
        value, m_input.name(), options, [&](const convert::Picture& drawn) { pictures.add(drawn); },
        operationContext(context));
    pictures.warnOfOlder(context.progress);
    context.progress.check();
    pictures.commit();
    return report(pictures.names());
  }

private:
  [[nodiscard]] convert::Volume volumeBehind(const RunContext& context) const {
    requireInput(m_behind, "volume");
    const FileFormat& format = inputFormat(m_behind, "");
    if (format.kind != FormatKind::Volume)
      throw unsupported(
          m_behind.name() + ": found a " + (format.kind == FormatKind::Mesh ? "mesh" : "case") +
          ", expected a volume: " + kOption.volume.shown() + " is drawn behind the vessels");
    requireInScope(*context.table, {inputContent(format, false), kAnyContent, m_behind.name(), {}},
                   context.progress);
    return loadVolume(m_behind, format, m_volume, context.progress);
  }

  [[nodiscard]] Answer report(const std::vector<std::string>& files) const {
    const auto& [width, height] = std::tie(m_options.picture.width, m_options.picture.height);
    const std::string more =
        files.size() > 1 ? ", and " + std::to_string(files.size() - 1) + " more" : "";
    return {Json{{"files", files}, {"width", width}, {"height", height}},
            formats::printable(files.front()) + ": " + std::to_string(width) + " by " +
                std::to_string(height) + " pixels" + more + "\n"};
  }

  InputFile m_input, m_behind;
  OutputFile m_output;
  std::optional<double> m_time;
  operations::PicturesOptions m_options;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makePictureCommand() {
  return std::make_unique<PictureCommand>();
}

}  // namespace lumen::engine
