// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/encoded_document.h"

#include <algorithm>
#include <filesystem>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/mesh_options.h"
#include "converters/engine/scope.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/operations/case_of.h"
#include "viewer/session/document/arguments.h"
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
    if (row == nullptr) refuse("\"" + name + "\" is no option of a download");
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
  refuse("\"" + name + "\" is no format; lumen writes " + engine::formatNames(engine::canWrite));
}

std::string encodedSeeds(Seeds seeds) {
  convert::dropOtherParents(seeds);
  for (convert::SeedBranch& seed : seeds) seed.isTracked = false;  // counts in a case alone
  return convert::encodeSeeds(seeds, "seeds.json");
}

}  // namespace

std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    Progress& progress) {
  if (format == "seeds") return encodedSeeds(*document.seeds);
  const engine::FileFormat& writer = writableFormat(format);
  if (!document.value) refuse("there is no case to save");
  const engine::OutputOptions output = outputOptions(options, writer, progress);
  const std::string name = "case" + std::string(writer.endings.front());
  const auto value = caseWithSeeds(document);
  if (!engine::needsModels(writer) || value->models)
    return writer.encodeCase(*value, name, output, progress).bytes;
  const formats::Case fitted =
      operations::fitted(*value, {settings.fit}, engine::operationContext(progress));
  return writer.encodeCase(fitted, name, output, progress).bytes;
}

}  // namespace lumen::viewer
