// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/prepare_case.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/privacy.h"
#include "converters/base/relayed_progress.h"
#include "converters/base/sha256.h"
#include "converters/base/warning.h"
#include "converters/draw/picture/draw_case.h"
#include "converters/draw/raster/picture.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/export_options.h"
#include "converters/engine/file_access.h"
#include "converters/export/export_case.h"
#include "converters/io/mesh/write_gltf.h"
#include "converters/judge/facts/reachable.h"
#include "converters/library/index/change.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record_of_case.h"
#include "converters/operations/naming.h"
#include "converters/operations/report_of.h"
#include "converters/operations/surface_of.h"
#include "formats/case/case_file.h"
#include "formats/container/container.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

void addOnce(std::vector<std::string>& words, const std::string& word) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

/// A file of the library comes along under its name unless the user gives another of this name.
void keepFile(const std::filesystem::path& file, std::vector<std::string>& files) {
  if (std::none_of(files.begin(), files.end(), [&](const std::string& given) {
        return std::filesystem::path(given).filename() == file.filename();
      }))
    files.push_back(file.string());
}

}  // namespace

std::optional<convert::CaseRecord> replacedVersion(const std::filesystem::path& library,
                                                   const std::string& id) {
  const convert::LibraryFile before = convert::openLibrary(library);
  const convert::LibraryEntry* const entry = convert::findCase(before, id);
  if (entry == nullptr) return {};
  return convert::openRecord(library, *entry);
}

void keepWishes(const convert::CaseRecord& before, const std::filesystem::path& library,
                bool keepsViews, bool keepsTurntable, CaseWishes& wishes) {
  const std::filesystem::path folder = library / convert::kPayload / before.id;
  const std::vector<std::string>& views = pictureViews();
  bool hasSurface = false;
  for (const convert::RecordedFile& file : before.files) {
    const std::string& path = file.path;
    const auto isPicture = [&](const std::string& view) {
      return path == "picture-" + view + ".png";
    };
    if (file.role == "export") addOnce(wishes.targets, file.target);
    hasSurface = hasSurface || file.role == "surface";
    wishes.report = wishes.report || path == "report.html";
    wishes.viewer = wishes.viewer || path == "view.html";
    if (keepsTurntable && path.starts_with("turntable/")) ++wishes.turntable;
    const auto view = std::find_if(views.begin(), views.end(), isPicture);
    if (keepsViews && view != views.end()) addOnce(wishes.views, *view);
    if (path.starts_with("files/")) keepFile(folder / path, wishes.files);
  }
  wishes.surface = wishes.surface && hasSurface;
}

namespace {

namespace fs = std::filesystem;
using convert::IncomingCase, convert::View;
using formats::printable;

constexpr std::size_t kShortDigest = 12;
constexpr std::array<int, 2> kThumbnail = {400, 320}, kPicture = {1000, 800}, kFrame = {500, 400};

const std::map<std::string, View>& viewsByName() {
  static const std::map<std::string, View> views = {
      {"best", View::Best},        {"anterior", View::Anterior}, {"posterior", View::Posterior},
      {"left", View::Left},        {"right", View::Right},       {"superior", View::Superior},
      {"inferior", View::Inferior}};
  return views;
}

std::string_view asText(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Path of a file below files/.
std::string pathOfFile(const std::string& file) {
  return "files/" + fs::path(file).filename().string();
}

std::string idOfDigest(const std::string& digest) {
  return "case-" + digest.substr(0, kShortDigest);
}

/// The bytes of the case as the library has them.
std::pair<std::vector<std::byte>, formats::Case> binaryCase(const fs::path& file) {
  auto [bytes, value] = readCaseAndBytes(file);
  if (!formats::hasContainerMagic(bytes)) bytes = formats::encodeBinary(value);
  return {std::move(bytes), std::move(value)};
}

/// Refuses wishes that do not depend on the case.
void checkWishes(const CaseWishes& wishes) {
  std::set<std::string> targets;
  for (const std::string& target : wishes.targets) {
    exportTarget(target);
    if (!targets.insert(target).second)
      throw Error(ErrorKind::Usage, "--export " + target + ": is given twice");
  }
  for (const std::string& file : wishes.files) {
    requireInput(file, "file");
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      throw invalidInput(printable(file) + ": is no regular file, and only such come along");
    if (!convert::isRecordedPath(pathOfFile(file)))
      throw invalidInput(printable(file) +
                         ": a library cannot have a file of this name; expected " +
                         convert::kPathRule);
  }
}

/// Refuses wishes that need models, for a case without.
void requireModels(const CaseWishes& wishes, const std::string& file) {
  const auto refuse = [&](const std::string& option) {
    throw invalidInput(printable(file) + ": this case has no models, so there is nothing for " +
                       option + "; lumen fit makes them");
  };
  for (const std::string& target : wishes.targets)
    if (exportTarget(target).needsModels) refuse("--export " + target);
  if (wishes.areViewsAsked) refuse("--picture");
  if (wishes.turntable > 0) refuse("--turntable");
  if (wishes.viewer) refuse("--viewer");
}

void warnOfFindings(const std::string& where, const std::vector<PrivacyFinding>& findings,
                    Progress& progress) {
  for (const PrivacyFinding& finding : findings)
    warn(progress, {WarningCode::PersonalText,
                    printable(where + ": at \"" + finding.pointer + "\": " + finding.message +
                              " (" + std::string(finding.code) + ")"),
                    "look before giving it away"});
}

void addPicture(const formats::Case& value, View view, std::optional<double> turn,
                std::array<int, 2> size, const std::string& path, IncomingCase& incoming,
                Progress& progress) {
  convert::PictureOptions options;
  options.view = view;
  options.turn = turn.value_or(0);
  options.allTurns = turn.has_value();
  options.width = size[0];
  options.height = size[1];
  incoming.add(path, "picture",
               convert::encodePng(convert::drawCase(value, options, nullptr, progress)));
}

void addPictures(const formats::Case& value, const CaseWishes& wishes, IncomingCase& incoming,
                 Progress& progress) {
  if (!wishes.views.empty())
    addPicture(value, View::Best, {}, kThumbnail, "thumbnail.png", incoming, progress);
  for (const std::string& view : std::set(wishes.views.begin(), wishes.views.end()))
    addPicture(value, viewsByName().at(view), {}, kPicture, "picture-" + view + ".png", incoming,
               progress);
  for (int frame = 0; frame < wishes.turntable; ++frame) {
    std::string name = "turntable/";
    name.append(paddedNumber(static_cast<std::uint64_t>(frame), 3)).append(".png");
    addPicture(value, View::Anterior, 2 * std::numbers::pi * frame / wishes.turntable, kFrame, name,
               incoming, progress);
  }
}

void addSurface(const formats::Case& value, IncomingCase& incoming, Progress& progress) {
  const operations::Surface made =
      operations::surfaceOf(value, {}, "surface.glb", operationContext(progress));
  incoming.add("surface.glb", "surface", convert::encodeGltf(made.levels, true, {}));
}

void addExport(const std::string& name, const formats::Case& value, const std::string& file,
               IncomingCase& incoming, Progress& progress) {
  const convert::ExportTarget& target = exportTarget(name);
  convert::ExportOptions options;
  OptionTable defaults;
  addExportRows(defaults, options);
  operations::naming(printable(file) + ": --export " + name, [&] {
    const convert::ExportResult result =
        convert::exportCase(target, value, options, exportOptionTexts(defaults, target), progress);
    for (const std::string& loss : result.losses)
      warn(progress, about("exports/" + name, {WarningCode::ExportLoss, loss}));
    for (const Warning& warning : result.warnings)
      warn(progress, about("exports/" + name, warning));
    for (const convert::ExportFile& one : result.files) {
      const std::string path = "exports/" + name + "/" + one.name;
      incoming.add(path, "export", one.bytes, name);
      if (one.isProgram) allowRunning(incoming.folder() / path);
    }
  });
}

/// The page of the case under its id, without a word to the listener.
void addReport(const std::vector<std::byte>& bytes, formats::Case value, IncomingCase& incoming,
               const Progress& progress) {
  const convert::CaseRecord& record = incoming.record;
  QuietProgress quiet(progress);
  const operations::Page page =
      operations::reportOf({std::move(value), bytes, record.id + ".lumen", record.about.title}, {},
                           operationContext(quiet));
  incoming.add("report.html", "report", page.html);
}

/// The page of `lumen view`. The viewer is above the engine, so the caller hands it over.
void addViewer(std::string_view caseBytes, IncomingCase& incoming, const RunContext& context) {
  if (!context.viewerPage)
    throw unsupported("view.html: this program was built without the viewer");
  QuietProgress quiet(context.progress);
  incoming.add("view.html", "other",
               context.viewerPage(caseBytes, incoming.record.id + ".lumen", quiet));
}

}  // namespace

const std::vector<std::string>& pictureViews() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, view] : viewsByName()) all.push_back(name);
    return all;
  }();
  return names;
}

std::string idOfCase(const fs::path& caseFile) {
  return idOfDigest(sha256(binaryCase(caseFile).first));
}

std::string defaultTitle(const convert::CaseAbout& about, const std::string& id) {
  return about.anatomy.empty() ? "Case " + id : about.anatomy;
}

void warnOfPersonsIn(const convert::CaseAbout& about, Progress& progress) {
  for (const auto& [pointer, text] : convert::textsToLookAt(about))
    warnOfFindings("the description of the case", scanText(*text, pointer), progress);
}

void addReportPage(const fs::path& caseFile, IncomingCase& incoming, const RunContext& context) {
  auto [bytes, value] = readCaseAndBytes(caseFile);
  addReport(bytes, std::move(value), incoming, context.progress);
}

IncomingCase prepareCase(const fs::path& caseFile, convert::CaseAbout about,
                         const CaseWishes& wishes, const fs::path& library,
                         const RunContext& context) {
  Progress& progress = context.progress;
  const std::string file = caseFile.string();
  checkWishes(wishes);
  if (const std::string fault = convert::missingStatement(about); !fault.empty())
    throw invalidInput(printable(file) + ": " + fault);
  const auto [bytes, value] = binaryCase(caseFile);
  const std::string digest = sha256(bytes);
  const std::string id = wishes.id.empty() ? idOfDigest(digest) : wishes.id;
  if (!wishes.replace) convert::requireNewId(convert::openLibrary(library), id);
  if (!value.models) requireModels(wishes, file);
  if (about.title.empty()) about.title = defaultTitle(about, id);
  warnOfFindings(file, scanPrivacy(bytes), progress);
  warnOfPersonsIn(about, progress);

  IncomingCase incoming(library);
  incoming.record.id = id;
  incoming.record.about = std::move(about);
  incoming.add(convert::kCaseFile, "case", asText(bytes));
  operations::naming(printable(file), [&, &made = value] {
    convert::describe(made, digest, incoming.record, progress);
  });
  if (!wishes.recipe.empty()) incoming.record.provenance["recipe_sha256"] = wishes.recipe;
  for (const std::string& one : wishes.files) incoming.addFile(pathOfFile(one), "other", one);
  convert::warnOfClosed(convert::measureReach(value, progress), progress);
  if (value.models && wishes.surface) addSurface(value, incoming, progress);
  if (value.models) addPictures(value, wishes, incoming, progress);
  for (const std::string& target : wishes.targets)
    addExport(target, value, file, incoming, progress);
  if (wishes.report) addReport(bytes, value, incoming, progress);
  if (wishes.viewer) addViewer(asText(bytes), incoming, context);
  return incoming;
}

}  // namespace lumen::engine
