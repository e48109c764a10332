// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/encoded_document.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/engine/export_options.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/mesh_options.h"
#include "converters/engine/scope.h"
#include "converters/export/shared/zip_archive.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/operations/case_of.h"
#include "converters/operations/exported.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document_seeds.h"

namespace lumen::viewer {

namespace {

constexpr std::string_view kZipEnding = ".zip";

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

/// The case with models.
formats::Case fittedCase(const formats::Case& value, const SessionOptions& settings,
                         Progress& progress) {
  if (value.models) return value;
  return operations::fitted(value, {settings.fit}, engine::operationContext(progress));
}

std::string zippedFolder(const Document& document, const std::string& name,
                         const SessionOptions& settings, Progress& progress) {
  if (!document.value) refuse("there is no case to export");
  OptionTable table;
  operations::ExportPlan plan{engine::exportTarget(name)};
  engine::addExportRows(table, plan.options);
  plan.texts = engine::exportOptionTexts(table, plan.target);
  const formats::Case fitted = fittedCase(*caseWithSeeds(document), settings, progress);
  convert::ZipArchive zip;
  for (const convert::ExportFile& file : operations::exported(fitted, "case.lumen", std::move(plan),
                                                              engine::operationContext(progress))
                                             .files)
    zip.add(name + "/" + file.name, file.bytes, file.isProgram);
  return zip.bytes();
}

}  // namespace

std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    Progress& progress) {
  if (format == "seeds") return encodedSeeds(*document.seeds);
  if (format.ends_with(kZipEnding))
    return zippedFolder(document, format.substr(0, format.size() - kZipEnding.size()), settings,
                        progress);
  const engine::FileFormat& writer = writableFormat(format);
  if (!document.value) refuse("there is no case to save");
  const engine::OutputOptions output = outputOptions(options, writer, progress);
  const std::string name = "case" + std::string(writer.endings.front());
  const auto value = caseWithSeeds(document);
  if (!engine::needsModels(writer) || value->models)
    return writer.encodeCase(*value, name, output, progress).bytes;
  return writer.encodeCase(fittedCase(*value, settings, progress), name, output, progress).bytes;
}

}  // namespace lumen::viewer
