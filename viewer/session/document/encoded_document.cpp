// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/encoded_document.h"

#include <algorithm>
#include <filesystem>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/engine/command.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/mesh_options.h"
#include "converters/engine/scope.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/stages/fitting/fit.h"
#include "viewer/session/document/document_seeds.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

/// The options of `lumen convert` that concern a mesh or an encoding, in the scope of `writer`.
engine::OutputOptions outputOptions(const SavingOptions& options, const engine::FileFormat& writer,
                                    Progress& progress) {
  engine::OutputOptions output;
  OptionTable table;
  engine::addMeshFileRows(table, output);
  engine::addEncodingRows(table, output.encoding);
  for (const auto& [name, value] : options) {
    const OptionRow* const row = table.find(name);
    if (row == nullptr)
      throw Error(ErrorKind::Usage, "\"" + name + "\" is no option of a download");
    table.set(name, {value.empty() && row->isFlag() ? "true" : value});
  }
  engine::requireCompatible(table);
  engine::requireInScope(
      table,
      {kAnyContent, engine::outputContent(writer), "", "the format " + std::string(writer.name)},
      progress);
  return output;
}

const engine::FileFormat& writableFormat(const std::string& name) {
  for (const engine::FileFormat& format : engine::fileFormats())
    if (format.name == name && engine::canWrite(format)) return format;
  throw Error(ErrorKind::Usage, "\"" + name + "\" is no format; lumen writes " +
                                    engine::formatNames(engine::canWrite));
}

std::string encodedSeeds(Seeds seeds, DroppedFiles& places) {
  convert::dropOtherParents(seeds);
  for (convert::SeedBranch& seed : seeds) seed.isTracked = false;  // counts in a case alone
  const auto file = places.placeFor("seeds.json");
  convert::writeSeeds(seeds, file->path());
  return readWholeFile(file->path(), "document");
}

}  // namespace

std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    DroppedFiles& places, Progress& progress) {
  if (format == "seeds") return encodedSeeds(*document.seeds, places);
  const engine::FileFormat& writer = writableFormat(format);
  if (!document.value) throw Error(ErrorKind::Usage, "there is no case to save");
  const engine::OutputOptions output = outputOptions(options, writer, progress);
  const auto file = places.placeFor("case" + std::string(writer.endings.front()));
  const auto value = caseWithSeeds(document);
  if (engine::canWriteMesh(writer) && !value->models) {
    formats::Case fitted = *value;
    convert::fit(fitted, settings.fit, progress);
    writer.writeCase(fitted, file->path(), output, progress);
  } else {
    writer.writeCase(*value, file->path(), output, progress);
  }
  return readWholeFile(file->path(), "document");
}

}  // namespace lumen::viewer
