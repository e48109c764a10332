// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/batch_inputs.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/engine/file_format.h"
#include "converters/engine/library_build.h"
#include "converters/io/content/file_content.h"
#include "converters/io/volume/dicom/dicom_series.h"
#include "converters/library/index/record.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

using convert::BatchInput;

constexpr std::size_t kLongestId = 64, kDigest = 8;  // characters

/// The letters and digits of a path without its ending, in lower case, with "-" between them.
std::string idOf(const std::string& name) {
  const std::size_t ending = longestEnding(name);
  std::string id;
  for (const char c : lowerCase(name.substr(0, name.size() - ending))) {
    const bool isKept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (isKept) id += c;
    if (!isKept && !id.empty() && id.back() != '-') id += '-';
  }
  while (!id.empty() && id.back() == '-') id.pop_back();
  return id;
}

/// An id that no input before has. It depends on the input's name alone where two names differ by
/// more than signs.
std::string uniqueId(const std::string& name, std::set<std::string>& taken) {
  std::string id = idOf(name);
  if (!convert::isCaseId(id) || taken.contains(id)) {
    const std::string digest = sha256(name).substr(0, kDigest);
    id = id.substr(0, kLongestId - kDigest - 1);
    id += (id.empty() ? "case-" : "-") + digest;
  }
  taken.insert(id);
  return id;
}

class FolderSearch {
public:
  FolderSearch(fs::path folder, const fs::path& out, Progress& progress)
      : m_folder(std::move(folder)), m_progress(progress) {
    std::error_code ignored;
    m_out = fs::weakly_canonical(out, ignored);
  }

  FoundInputs run() {
    search(m_folder);
    std::sort(m_found.inputs.begin(), m_found.inputs.end(),
              [](const BatchInput& a, const BatchInput& b) { return a.name < b.name; });
    std::set<std::string> taken;
    for (BatchInput& input : m_found.inputs) input.row.id = uniqueId(input.name, taken);
    return std::move(m_found);
  }

private:
  void search(const fs::path& folder) {
    m_progress.check();
    std::error_code error;
    std::vector<fs::path> files, folders;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().filename().string().starts_with('.')) continue;
      std::error_code ignored;
      (entry->is_directory(ignored) ? folders : files).push_back(entry->path());
    }
    if (error)
      throw invalidInput(formats::printable(folder.string()) +
                         ": this folder cannot be read: " + error.message());
    std::sort(files.begin(), files.end());
    bool hasDicom = false;
    for (const fs::path& file : files) hasDicom = look(file) || hasDicom;
    if (hasDicom) addSeries(folder);
    for (const fs::path& below : folders) {
      std::error_code ignored;
      if (fs::weakly_canonical(below, ignored) != m_out) search(below);
    }
  }

  /// Takes a file of a format of volumes; true for one of DICOM, which its folder stands for.
  bool look(const fs::path& file) {
    const std::string name = file.filename().string();
    const std::size_t ending = longestEnding(name);
    if (ending == 0) {
      if (convert::isDicom(convert::detectContent(InputFile(file.string())))) return true;
      m_found.passedOver.push_back(nameOf(file));
      return false;
    }
    const FileFormat& format = inputFormat(InputFile(file.string()), "");
    if (format.kind == FormatKind::Volume && !format.endings.empty())
      add(file, nameOf(file));
    else
      m_found.passedOver.push_back(nameOf(file));
    return false;
  }

  void addSeries(const fs::path& folder) {
    const convert::DicomListing listing =
        convert::listDicomSeries(InputFile(folder.string()), {}, m_progress);
    const std::string name = nameOf(folder);
    std::size_t number = 0;
    for (const convert::DicomSeries& series : listing.series) {
      ++number;
      const std::string of =
          listing.series.size() == 1 ? name : name + "/series-" + std::to_string(number);
      if (!series.fault.empty()) {
        m_found.passedOver.push_back(of + " (" + series.fault + ")");
        continue;
      }
      BatchInput& input = add(folder, of);
      if (listing.series.size() > 1) input.row.options["--series"] = series.uid;
    }
  }

  BatchInput& add(const fs::path& file, const std::string& name) {
    BatchInput& input = m_found.inputs.emplace_back();
    input.row.input = file;
    input.row.about = "{}\n";
    input.name = name;
    return input;
  }

  [[nodiscard]] std::string nameOf(const fs::path& file) const {
    const std::string name = file.lexically_relative(m_folder).generic_string();
    return name == "." ? file.filename().string() : name;
  }

  fs::path m_folder, m_out;
  Progress& m_progress;
  FoundInputs m_found;
};

/// Throws Error(Usage) unless lumen convert takes these options with these values.
void requireOptions(const std::map<std::string, std::string>& options, const Engine& engine) {
  Operation convert{"convert", {"input", "case.lumen"}, {}};
  for (const auto& [name, value] : options) convert.with(name.substr(2), value);
  setRows(*engine.find("convert").table, convert);
}

std::uint64_t voxelsOf(const BatchInput& input, const Progress& progress) {
  const InputFile file(input.row.input.string());
  const auto from = input.row.options.find("--from");
  const auto series = input.row.options.find("--series");
  try {
    const FileFormat& format =
        inputFormat(file, from == input.row.options.end() ? "" : from->second);
    if (format.readVolumeHeader == nullptr) return 0;
    convert::ReadVolumeOptions options;
    if (series != input.row.options.end()) options.series = series->second;
    const convert::VolumeHeader header = format.readVolumeHeader(file, options, progress);
    std::uint64_t voxels = 1;
    for (const auto n : header.geometry.size) voxels *= static_cast<std::uint64_t>(n);
    return voxels;
  } catch (const Error&) {
    progress.check();
    return 0;  // its case fails with the reason
  }
}

}  // namespace

FoundInputs volumesBelow(const fs::path& folder, const fs::path& out, Progress& progress) {
  FoundInputs found = FolderSearch(folder.lexically_normal() / "", out, progress).run();
  if (found.inputs.empty())
    throw invalidInput(formats::printable(folder.string()) + ": holds no volume; expected " +
                       formatTitles(canReadVolume));
  return found;
}

FoundInputs inputsOfList(const std::string& list, const std::set<std::size_t>& lines) {
  convert::BuildList rows = loadBuildList(list);
  const fs::path folder = fs::path(list).parent_path();
  FoundInputs found;
  std::set<std::string> taken;
  for (const convert::BuildRow& row : rows.rows)
    if (!row.id.empty()) taken.insert(row.id);
  for (convert::BuildRow& row : rows.rows) {
    BatchInput& input = found.inputs.emplace_back();
    input.name = row.input.lexically_relative(folder).generic_string();
    if (row.id.empty()) row.id = uniqueId(input.name, taken);
    input.row = std::move(row);
  }
  for (const convert::RowFault& fault : rows.faults) {
    BatchInput& input = found.inputs.emplace_back();
    input.name = "line " + std::to_string(fault.line);
    input.row.id = fault.id.empty() ? uniqueId(input.name, taken) : fault.id;
    input.row.line = fault.line;
    input.fault = fault.why;
  }
  for (const std::size_t line : lines)
    if (std::none_of(found.inputs.begin(), found.inputs.end(),
                     [line](const BatchInput& input) { return input.row.line == line; }))
      throw invalidInput(formats::printable(list) + ": no row begins on line " +
                         std::to_string(line));
  if (!lines.empty())
    std::erase_if(found.inputs,
                  [&](const BatchInput& input) { return !lines.contains(input.row.line); });
  return found;
}

void completeInputs(const BatchDefaults& defaults, const Engine& engine,
                    std::vector<BatchInput>& inputs, Progress& progress) {
  std::map<std::string, std::string> common;
  for (const auto& [name, value] : defaults) common["--" + name] = value;
  requireOptions(common, engine);
  for (BatchInput& input : inputs) {
    if (!input.fault.empty()) continue;
    input.row.options.insert(common.begin(), common.end());
    try {
      requireOptions(input.row.options, engine);
      input.voxels = voxelsOf(input, progress);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Usage) throw;
      input.fault = error.what();
    }
  }
}

}  // namespace lumen::engine
