// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/encoded_document.h"

#include <algorithm>
#include <filesystem>

#include "converters/base/error.h"
#include "converters/cli/mesh_options.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/fitting/fit.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  auto bytes = formats::readFileBytes(file);
  if (!bytes) throw failed(bytes.error().message);
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

/// The options of `lumen convert` that concern a mesh or an encoding.
app::OutputOptions outputOptions(const SavingOptions& options) {
  app::OutputOptions output;
  CLI::App parser;
  parser.set_help_flag("");
  app::addMeshOptions(parser, output);
  app::addEncodingOptions(parser, output.encoding);
  std::vector<std::string> words;
  for (const auto& [name, value] : options) {
    if (parser.get_option_no_throw("--" + name) == nullptr)
      throw Error(ErrorKind::Usage, "\"" + name + "\" is no option of a download");
    words.push_back("--" + name + (value.empty() ? "" : "=" + value));
  }
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

std::string encodedSeeds(const Seeds& seeds, DroppedFiles& places) {
  const auto file = places.placeFor("seeds.json");
  convert::writeSeeds(seeds, file->path());
  return textOf(file->path());
}

}  // namespace

std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    DroppedFiles& places, Progress& progress) {
  if (format == "seeds") return encodedSeeds(*document.seeds, places);
  const app::FileFormat& writer = writableFormat(format);
  if (!document.value) throw Error(ErrorKind::Usage, "there is no case to save");
  const app::OutputOptions output = outputOptions(options);
  const auto file = places.placeFor("case" + std::string(writer.endings.front()));
  if (app::canWriteMesh(writer) && !document.value->models) {
    formats::Case fitted = *document.value;
    convert::fit(fitted, settings.fit.options(), progress);
    writer.writeCase(fitted, file->path(), output, progress);
  } else {
    writer.writeCase(*document.value, file->path(), output, progress);
  }
  return textOf(file->path());
}

}  // namespace lumen::viewer
