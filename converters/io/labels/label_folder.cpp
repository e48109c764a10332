// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/label_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/content/file_content.h"
#include "converters/io/labels/known_tables.h"
#include "converters/io/labels/label_lines.h"
#include "converters/io/volume/read_volume.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 255;  // labels of a mask are bytes
constexpr double kSameGrid = 1e-3;  // voxels: corners of equal grids are at most this far apart

const VolumeFormat* formatByEnding(const std::string& name, std::string& stem) {
  static const std::array<std::pair<std::string_view, const VolumeFormat*>, 6> endings = {
      {{".nii.gz", &VolumeFormat::Nifti},
       {".nii", &VolumeFormat::Nifti},
       {".seg.nrrd", &VolumeFormat::Nrrd},
       {".nrrd", &VolumeFormat::Nrrd},
       {".mha", &VolumeFormat::MetaImage},
       {".mhd", &VolumeFormat::MetaImage}}};
  const std::string lower = lowerCase(name);
  for (const auto& [ending, format] : endings)
    if (lower.size() > ending.size() && lower.ends_with(ending)) {
      stem = name.substr(0, name.size() - ending.size());
      return format;
    }
  return nullptr;
}

/// A file of the folder.
struct Structure {
  fs::path file;
  std::string name;
  const VolumeFormat* format = nullptr;
  VolumeHeader header{};
  int rank = 0;       // the lowest has a voxel that several have
  double volume = 0;  // mm3
};

int rankOf(const std::string& name) {
  const KnownName* known = findKnownName(name);
  const LabelRole role = known != nullptr ? known->role : roleOfName(name);
  if (isVessel(role) || isOtherLumen(role)) return 0;
  if (role == LabelRole::Unknown) return 1;
  return isNotVessel(role) ? 2 : 3;
}

/// The files with the ending of a volume, in the order of their names.
std::vector<Structure> structuresIn(const fs::path& folder) {
  std::vector<Structure> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    Structure one;
    one.file = entry.path();
    const std::string name = one.file.filename().string();
    one.format = formatByEnding(name, one.name);
    if (one.format != nullptr && !name.starts_with('.') && entry.is_regular_file(error))
      found.push_back(std::move(one));
  }
  std::sort(found.begin(), found.end(),
            [](const Structure& a, const Structure& b) { return a.file < b.file; });
  return found;
}

bool isSameGrid(const VolumeGeometry& a, const VolumeGeometry& b) {
  if (a.size != b.size) return false;
  const CellBox cells = a.cells();
  for (const Cell& corner : {Cell(0, 0, 0), Cell(cells.size - Cell::Ones()),
                             Cell(cells.size[0] - 1, 0, 0), Cell(0, cells.size[1] - 1, 0)})
    if ((b.indexFromWorld(a.position(corner)) - corner.cast<double>()).norm() > kSameGrid)
      return false;
  return true;
}

/// 1 where a structure is. Throws Error(InvalidInput) for more than one value beside 0.
std::vector<std::uint8_t> maskOf(const Volume& volume, const fs::path& file) {
  return std::visit(
      [&](const auto& voxels) {
        std::vector<std::uint8_t> mask(voxels.size(), 0);
        auto value = voxels.front();
        value = 0;
        for (std::size_t i = 0; i < voxels.size(); ++i) {
          const auto voxel = voxels[i];
          if (!(voxel < 0) && !(voxel > 0)) continue;
          if (!(value < 0) && !(value > 0)) value = voxel;
          if (voxel < value || voxel > value)
            throw invalidInput(formats::printable(file.string()) +
                               ": has several values; expected 0 and one other, as a folder is one "
                               "label map only if each of its volumes is one structure");
          mask[i] = 1;
        }
        return mask;
      },
      volume.voxels);
}

/// Labels of one grid, into which structures are put one after another.
class LabelCanvas {
public:
  LabelCanvas(const VolumeGeometry& geometry, std::vector<Structure>& structures)
      : m_geometry(geometry), m_structures(structures), m_labels(geometry.voxelCount(), 0) {}

  void put(std::size_t structure, const Volume& volume, const Progress& progress) {
    const std::vector<std::uint8_t> mask = maskOf(volume, m_structures[structure].file);
    const auto count = std::count(mask.begin(), mask.end(), 1);
    m_structures[structure].volume = static_cast<double>(count) * volume.geometry.spacing.prod();
    if (isSameGrid(m_geometry, volume.geometry)) {
      for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i] != 0) take(i, structure);
      return;
    }
    m_outside.emplace_back(structure, countOutside(mask, volume.geometry));
    for (std::size_t i = 0; i < m_labels.size(); ++i) {
      if (i % (1U << 20U) == 0) progress.check();
      const Eigen::Vector3d index =
          volume.geometry.indexFromWorld(m_geometry.position(m_geometry.cell(i)));
      const Cell nearest = index.array().round().matrix().cast<int>();
      if (volume.geometry.contains(nearest) && mask[volume.geometry.index(nearest)] != 0)
        take(i, structure);
    }
  }

  [[nodiscard]] std::vector<std::string> remarks(const std::string& folder) const {
    std::vector<std::string> all;
    if (!m_overlaps.empty()) all.push_back(folder + ": " + overlapSentence());
    for (const auto& [structure, count] : m_outside)
      if (count > 0)
        all.push_back(formats::printable(m_structures[structure].file.string()) + ": " +
                      counted(count, "voxel lies", "voxels lie") +
                      " outside of the grid of the map, which is the finest of the folder");
    return all;
  }
  std::vector<std::uint8_t> labels() && { return std::move(m_labels); }

private:
  void take(std::size_t voxel, std::size_t structure) {
    std::uint8_t& label = m_labels[voxel];
    const auto own = static_cast<std::uint8_t>(structure + 1);
    if (label == 0) {
      label = own;
      return;
    }
    ++m_overlaps[{label - 1U, structure}];
    const auto order = [&](std::size_t s) {
      return std::tuple(m_structures[s].rank, m_structures[s].volume, s);
    };
    if (order(structure) < order(label - 1U)) label = own;
  }

  [[nodiscard]] std::size_t countOutside(const std::vector<std::uint8_t>& mask,
                                         const VolumeGeometry& geometry) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (mask[i] == 0) continue;
      const Eigen::Vector3d index = m_geometry.indexFromWorld(geometry.position(geometry.cell(i)));
      count += m_geometry.contains(index.array().round().matrix().cast<int>()) ? 0 : 1;
    }
    return count;
  }

  [[nodiscard]] std::string overlapSentence() const {
    std::size_t all = 0;
    auto most = m_overlaps.begin();
    for (auto it = m_overlaps.begin(); it != m_overlaps.end(); ++it) {
      all += it->second;
      if (it->second > most->second) most = it;
    }
    const auto name = [&](std::size_t s) { return formats::printable(m_structures[s].name); };
    return "structures overlap in " + counted(all, "voxel", "voxels") + ", " +
           name(most->first.first) + " and " + name(most->first.second) + " in " +
           std::to_string(most->second) +
           "; a voxel is of the one that is a vessel, or else of the smaller one";
  }

  VolumeGeometry m_geometry;
  std::vector<Structure>& m_structures;
  std::vector<std::uint8_t> m_labels;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> m_overlaps;
  std::vector<std::pair<std::size_t, std::size_t>> m_outside;
};

/// Reads the headers, and returns the place of the first of the finest grids.
std::size_t readHeaders(std::vector<Structure>& structures, const ReadVolumeOptions& options,
                        const Progress& progress) {
  std::size_t finest = 0;
  const auto size = [&](std::size_t s) { return structures[s].header.geometry.voxelSize(); };
  for (std::size_t s = 0; s < structures.size(); ++s) {
    Structure& one = structures[s];
    one.header = readVolumeHeader(one.file, *one.format, options, progress);
    one.rank = rankOf(one.name);
    if (size(s) < size(finest) * (1 - kSameGrid)) finest = s;
  }
  return finest;
}

}  // namespace

bool isLabelFolder(const InputFile& folder) {
  if (folder.isInMemory() || !folder.isFolder() || structuresIn(folder.path()).empty())
    return false;
  std::error_code error;
  const fs::recursive_directory_iterator files(folder.path(), error);
  return std::none_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    std::string stem;
    const fs::path& file = entry.path();
    if (formatByEnding(file.filename().string(), stem) != nullptr) return false;
    const std::string ending = lowerCase(file.extension().string());
    return ending == ".dcm" || ending == ".ima" || detectContent(file).kind == ContentKind::Volume;
  });
}

FolderMap readLabelFolder(const InputFile& folder, const ReadVolumeOptions& options,
                          const Progress& progress) {
  const std::string name = formats::printable(folder.name());
  std::vector<Structure> structures = structuresIn(folder.path());
  if (structures.empty() || structures.size() > kMostFiles)
    throw invalidInput(name + ": has " + std::to_string(structures.size()) +
                       " volumes; expected 1 to " + std::to_string(kMostFiles));
  FolderMap map;
  map.header = structures[readHeaders(structures, options, progress)].header;
  map.header.storedType = "uint8";
  map.header.encoding = counted(structures.size(), "file", "files");
  map.header.voxelBytes = map.header.storedBytes = 0;
  LabelCanvas canvas(map.header.geometry, structures);
  ReadVolumeOptions reading = options;
  reading.allowsConstant = true;  // structures outside of the scan are empty
  for (std::size_t s = 0; s < structures.size(); ++s) {
    progress.check();
    canvas.put(s, readVolume(structures[s].file, *structures[s].format, reading, progress),
               progress);
    map.header.voxelBytes += structures[s].header.voxelBytes;
    map.header.storedBytes += structures[s].header.storedBytes;
    addLabelName(name + ": ", std::to_string(s + 1), structures[s].name, map.table.names);
  }
  map.remarks = canvas.remarks(name);
  for (const std::string& assumption : map.header.assumptions)
    map.remarks.push_back(name + ": " + assumption);
  map.table.from = "its file";
  std::vector<std::uint8_t> labels = std::move(canvas).labels();
  if (std::all_of(labels.begin(), labels.end(), [](std::uint8_t label) { return label == 0; }))
    throw invalidInput(name + ": none of its structures has a voxel");
  map.voxels = {map.header.geometry, std::move(labels), map.header.assumptions};
  return map;
}

}  // namespace lumen::convert
