// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/seeds.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/seeds/seeds_parse.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using formats::printable;

/// The name of `file` without ".mrk.json" or its extension.
std::string stemOf(const fs::path& file) {
  const fs::path stem = file.stem();
  return (stem.extension() == ".mrk" ? stem.stem() : stem).string();
}

/// The first character that is no white space; 0 if there is none.
char firstCharacter(std::string_view text) {
  const auto at = text.find_first_not_of(" \t\r\n");
  return at == text.npos ? '\0' : text[at];
}

/// The first line, for a message.
std::string firstLine(const std::string& text) {
  return quotedText(trimmed(text.substr(0, std::min(text.find('\n'), text.size()))));
}

std::vector<SeedBranch> parseText(const std::string& text, const fs::path& file,
                                  const SeedReading& reading) {
  const std::string_view marked = withoutByteOrderMark(text);
  const char first = firstCharacter(marked);
  const bool named = lowerCase(file.extension().string()) == ".fcsv";
  if (first == '#' || (named && first != '{'))
    return parseFcsv(marked, file, stemOf(file), reading);
  if (first != '{' && first != '[')
    throw invalidInput(
        printable(file.string()) + ": is not JSON: found " +
        (first == '\0' ? std::string("nothing") : firstLine(text)) +
        "; expected lumen's seeds (spec/seeds.md), or points that 3D Slicer saved as "
        ".mrk.json or .fcsv");
  JsonFile json(text, file);
  const JsonPlace root(json);
  return root.has("markups") ? parseMarkups(root, stemOf(file), reading)
                             : parseSeeds(root, reading);
}

}  // namespace

std::vector<SeedBranch> readSeeds(const InputFile& file, const SeedReading& reading) {
  const fs::path& path = file.path();
  return checkedSeeds(parseText(file.read("seeds file", kMostText), path, reading), path);
}

std::string encodeSeeds(const std::vector<SeedBranch>& seeds, const fs::path& name) {
  const bool isMarkups = lowerCase(name.filename().string()).ends_with(".mrk.json");
  return isMarkups ? markupsText(seeds) : seedsText(seeds);
}

void writeSeeds(const std::vector<SeedBranch>& seeds, const fs::path& file) {
  const std::string text = encodeSeeds(seeds, file);
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
  if (!written) throw failed(printable(file.string()) + ": " + written.error().text());
}

}  // namespace lumen::convert
