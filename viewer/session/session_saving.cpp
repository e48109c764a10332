// SPDX-License-Identifier: Apache-2.0
// Session: what leaves it as files.
#include <algorithm>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/cli/mesh_options.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/stages/fitting/fit.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  auto bytes = formats::readFileBytes(file);
  if (!bytes) throw failed(bytes.error().message);
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

/// The options of `lumen convert` that concern a mesh or an encoding.
app::OutputOptions outputOptions(const std::vector<std::pair<std::string, std::string>>& options) {
  app::OutputOptions output;
  CLI::App parser;
  app::addMeshOptions(parser, output);
  app::addEncodingOptions(parser, output.encoding);
  std::vector<std::string> words;
  for (const auto& [name, value] : options)
    words.push_back("--" + name + (value.empty() ? "" : "=" + value));
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    parser.parse(words);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::Usage, error.what());
  }
  return output;
}

const app::FileFormat& writableFormat(const std::string& name) {
  for (const app::FileFormat& format : app::fileFormats())
    if (format.name == name && app::canWrite(format)) return format;
  throw Error(ErrorKind::Usage,
              "\"" + name + "\" is no format; lumen writes " + app::formatNames(app::canWrite));
}

}  // namespace

std::pair<bool, bool> Session::unsavedParts() const {
  const Document document = m_history.now().document;
  const std::lock_guard lock(m_mutex);
  // seeds that a case was tracked from are in it
  const bool areKept = document.fileOf(FileRole::Seeds) == nullptr && document.value != nullptr;
  const bool otherSeeds = m_savedSeeds ? document.seeds != m_savedSeeds : !document.seeds->empty();
  return {document.value && document.value != m_savedCase, otherSeeds && !areKept};
}

bool Session::unsaved() const {
  const auto [hasCase, hasSeeds] = unsavedParts();
  return hasCase || hasSeeds;
}

std::string Session::encoded(const std::string& format,
                             const std::vector<std::pair<std::string, std::string>>& options,
                             Progress& progress) {
  const Document document = m_history.now().document;
  if (format == "seeds") {
    const fs::path file = placeFor("seeds.json");
    convert::writeSeeds(*document.seeds, file);
    return textOf(file);
  }
  const app::FileFormat& writer = writableFormat(format);
  if (!document.value) throw Error(ErrorKind::Usage, "there is no case to save");
  const app::OutputOptions output = outputOptions(options);
  const fs::path file = placeFor("case" + std::string(writer.endings.front()));
  struct Remove {
    const fs::path folder;
    ~Remove() {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
  };
  const Remove remove{file.parent_path()};
  if (app::canWriteMesh(writer) && !document.value->models) {
    formats::Case fitted = *document.value;
    convert::fit(fitted, m_options.fit.options(), progress);
    writer.writeCase(fitted, file, output, progress);
  } else {
    writer.writeCase(*document.value, file, output, progress);
  }
  return textOf(file);
}

fs::path Session::saveTarget(const Document& document) const {
  const OpenFile* open = document.fileOf(FileRole::Case);
  const bool wasDropped = open != nullptr && open->path.empty();
  return wasDropped && m_saveStamp != FileStamp{} ? fs::path() : m_saveTo;
}

Json Session::save(const Arguments& request) {
  const Moment now = momentFor(request);
  fs::path file;
  {
    const std::lock_guard lock(m_mutex);
    file = saveTarget(now.document);
    if (!file.empty() && stampOf(file) != m_saveStamp && !request.flag("force"))
      throw Conflict(file.filename().string() +
                     " was changed by another program since it was read; saving would undo that");
  }
  if (file.empty() || !now.document.value)
    throw Error(ErrorKind::Usage, "there is no case, or no file that it came from; download it");
  const app::FileFormat& format = app::caseOutputFormat(file, "", "what is saved");
  Progress silent;
  format.writeCase(*now.document.value, file, {}, silent);
  const OpenFile* seeds = now.document.fileOf(FileRole::Seeds);
  if (seeds != nullptr && !seeds->path.empty() && unsavedParts().second)
    convert::writeSeeds(*now.document.seeds, seeds->path);
  Document document = now.document;
  for (OpenFile& open : document.files)
    if (open.role == FileRole::Case || open.role == FileRole::Seeds)
      if (!open.path.empty()) open.stamp = stampOf(open.path);
  {
    const std::lock_guard lock(m_mutex);
    m_savedCase = now.document.value;
    m_savedSeeds = now.document.seeds;
    m_saveStamp = stampOf(file);
  }
  m_history.restamp(document.files);
  keepUnsaved();
  m_events.tell("message",
                {{"severity", "note"}, {"text", file.filename().string() + " is saved"}});
  changed();
  return {{"revision", m_history.now().revision}};
}

}  // namespace lumen::viewer
