// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/read_dicom.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include <Eigen/Geometry>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

#include "converters/volume/dicom_file.h"
#include "converters/volume/itk_image.h"
#include "converters/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

// Slices lie on a regular grid if their distances agree within this share of their mean ...
constexpr double kGapTolerance = 0.02;
// ... and the stack leans by at most this share of a pixel from its first to its last slice.
constexpr double kShearTolerance = 0.5;

struct Slice {
  fs::path file;
  double position = 0;  ///< mm along the slices' normal
  VolumeGeometry geometry;
  Voxels voxels;
};

itk::GDCMImageIO::Pointer openImage(const fs::path& file) {
  auto io = itk::GDCMImageIO::New();
  io->SetFileName(file.string());
  try {
    io->ReadImageInformation();
  } catch (const itk::ExceptionObject& exception) {
    throw invalidInput(file.string() + ": its DICOM header cannot be read (" + oneLine(exception) +
                       ")");
  }
  return io;
}

std::string tagText(const itk::GDCMImageIO& io, const std::string& tag) {
  std::string value;
  if (!const_cast<itk::GDCMImageIO&>(io).GetValueFromTag(tag, value)) return {};
  while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
  return value;
}

/// One line per series: number, UID, files, description, size of an image.
std::string listing(itk::GDCMSeriesFileNames& names, const std::vector<std::string>& series) {
  std::ostringstream text;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const auto& files = names.GetFileNames(series[n]);
    text << "\n  " << n + 1 << ": " << series[n] << " (" << files.size()
         << (files.size() == 1 ? " file" : " files");
    if (!files.empty()) {
      const auto io = openImage(files[0]);
      const std::string description = tagText(*io, "0008|103e");
      if (!description.empty()) text << ", " << description;
      text << ", " << io->GetDimensions(0) << " x " << io->GetDimensions(1);
    }
    text << ")";
  }
  return text.str();
}

std::string chooseSeries(itk::GDCMSeriesFileNames& names, const std::string& wanted,
                         const fs::path& path) {
  const std::vector<std::string> series = names.GetSeriesUIDs();
  if (series.empty())
    throw invalidInput(path.string() +
                       ": holds no DICOM images (its subdirectories are not searched)");
  if (wanted.empty()) {
    if (series.size() == 1) return series[0];
    throw invalidInput(
        path.string() + ": holds " + std::to_string(series.size()) +
        " DICOM series; choose one with --series, by number or UID:" + listing(names, series));
  }
  if (std::find(series.begin(), series.end(), wanted) != series.end()) return wanted;
  std::size_t number = 0;
  const auto end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end && number >= 1 && number <= series.size())
    return series[number - 1];
  throw invalidInput(path.string() + ": has no series \"" + wanted +
                     "\"; it holds:" + listing(names, series));
}

/// The numbers of a tag such as "0.5\\0.25"; empty if it is absent.
std::vector<double> tagNumbers(const itk::GDCMImageIO& io, const std::string& tag) {
  std::string text = tagText(io, tag);
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::istringstream stream(text);
  std::vector<double> values;
  for (double value = 0; stream >> value;) values.push_back(value);
  return values;
}

/// Slices without a position in space cannot be stacked, whatever ITK assumes for them.
void checkTags(const itk::GDCMImageIO& io, const fs::path& file) {
  if (tagNumbers(io, "0020|0032").size() != 3 || tagNumbers(io, "0020|0037").size() != 6)
    throw invalidInput(file.string() +
                       ": has no image position and orientation; expected a slice of a volume");
  const auto spacing = tagNumbers(io, "0028|0030");
  if (spacing.size() != 2 || !(spacing[0] > 0) || !(spacing[1] > 0))
    throw invalidInput(file.string() + ": its pixel spacing is \"" + tagText(io, "0028|0030") +
                       "\"; expected two positive numbers of mm");
}

void checkWhole(const itk::GDCMImageIO& io, const fs::path& file) {
  const std::string bits = tagText(io, "0028|0100");
  std::size_t stored = 0;
  std::from_chars(bits.data(), bits.data() + bits.size(), stored);
  const std::size_t bytes =
      static_cast<std::size_t>(io.GetImageSizeInPixels()) * io.GetNumberOfComponents() * stored / 8;
  if (!hasWholePixelData(file, bytes))
    throw invalidInput(file.string() + ": truncated: it does not hold the " +
                       std::to_string(bytes) + " bytes of pixels that it announces");
}

Slice readSlice(const fs::path& file) {
  const auto io = openImage(file);
  checkTags(*io, file);
  if (io->GetNumberOfComponents() != 1)
    throw invalidInput(file.string() + ": each pixel has " +
                       std::to_string(io->GetNumberOfComponents()) +
                       " components; expected one number");
  if (io->GetNumberOfDimensions() > 2 && io->GetDimensions(2) != 1)
    throw invalidInput(
        file.string() + ": holds " + std::to_string(io->GetDimensions(2)) +
        " frames beside other files of its series; expected one frame for each file");
  Slice slice;
  slice.file = file;
  auto& g = slice.geometry;
  g.size = {static_cast<int>(io->GetDimensions(0)), static_cast<int>(io->GetDimensions(1)), 1};
  for (unsigned a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    g.spacing[e] = a < 2 ? io->GetSpacing(a) : 1;
    g.origin[e] = io->GetOrigin(a);
    const std::vector<double> column = io->GetDirection(a);
    for (unsigned r = 0; r < 3; ++r) g.direction(static_cast<Eigen::Index>(r), e) = column[r];
  }
  slice.position = g.direction.col(2).dot(g.origin);
  checkWhole(*io, file);
  slice.voxels = readVoxels(*io, file);
  return slice;
}

void checkSameGrid(const Slice& slice, const Slice& first, const fs::path& path) {
  const auto& a = slice.geometry;
  const auto& b = first.geometry;
  if (a.size == b.size && (a.spacing - b.spacing).cwiseAbs().maxCoeff() < 1e-4 &&
      (a.direction - b.direction).cwiseAbs().maxCoeff() < 1e-4)
    return;
  throw invalidInput(path.string() + ": " + slice.file.filename().string() + " and " +
                     first.file.filename().string() +
                     " belong to one series, but differ in size, pixel spacing or orientation; "
                     "expected parallel slices of one grid");
}

/// Distance between slices that are sorted by position, mm.
double sliceSpacing(const std::vector<Slice>& slices, const fs::path& path) {
  std::vector<double> gaps;
  for (std::size_t n = 1; n < slices.size(); ++n)
    gaps.push_back(slices[n].position - slices[n - 1].position);
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    if (gaps[n] > 0 && std::abs(gaps[n] - usual) <= kGapTolerance * usual) continue;
    std::ostringstream text;
    text << path.string() << ": slices " << slices[n].file.filename().string() << " and "
         << slices[n + 1].file.filename().string() << " are " << gaps[n]
         << " mm apart, where most are " << usual
         << " mm; expected a regular stack with one image for each position";
    throw invalidInput(text.str());
  }
  return (slices.back().position - slices.front().position) / static_cast<double>(gaps.size());
}

void checkUpright(const std::vector<Slice>& slices, const fs::path& path) {
  const auto& g = slices.front().geometry;
  const Eigen::Vector3d lean = slices.back().geometry.origin - g.origin;
  for (int a = 0; a < 2; ++a)
    if (std::abs(lean.dot(g.direction.col(a))) > kShearTolerance * g.spacing[a])
      throw invalidInput(path.string() +
                         ": its slices are shifted along themselves (a tilted gantry?); expected a "
                         "stack along the slices' normal");
}

template <class To>
std::vector<To> stacked(const std::vector<Slice>& slices) {
  std::vector<To> voxels;
  voxels.reserve(slices.size() * slices[0].geometry.voxelCount());
  for (const Slice& slice : slices)
    std::visit(
        [&](const auto& from) {
          for (const auto v : from) voxels.push_back(static_cast<To>(v));
        },
        slice.voxels);
  return voxels;
}

/// Slices may differ in type, where each has its own rescale slope; then all become float.
Voxels stack(const std::vector<Slice>& slices) {
  const std::size_t type = slices[0].voxels.index();
  const bool same = std::all_of(slices.begin(), slices.end(),
                                [&](const Slice& s) { return s.voxels.index() == type; });
  if (!same) return stacked<float>(slices);
  return std::visit(
      [&](const auto& first) -> Voxels {
        return stacked<typename std::decay_t<decltype(first)>::value_type>(slices);
      },
      slices[0].voxels);
}

Volume readSlices(const std::vector<std::string>& files, const fs::path& path,
                  const Progress& progress) {
  std::vector<Slice> slices;
  slices.reserve(files.size());
  for (const auto& file : files) {
    progress.check();
    slices.push_back(readSlice(file));
    checkSameGrid(slices.back(), slices.front(), path);
  }
  std::stable_sort(slices.begin(), slices.end(),
                   [](const Slice& a, const Slice& b) { return a.position < b.position; });
  Volume volume;
  volume.geometry = slices.front().geometry;
  volume.geometry.size[2] = static_cast<int>(slices.size());
  volume.geometry.spacing[2] = sliceSpacing(slices, path);
  checkUpright(slices, path);
  volume.voxels = stack(slices);
  checkGeometry(volume.geometry, path);
  return volume;
}

/// What a multi-frame file states outside of its functional groups. GDCM looks for it in some kinds
/// of objects only, and takes 1 mm and the origin in the others.
void useStatedGeometry(const itk::GDCMImageIO& io, VolumeGeometry& geometry) {
  if (const auto v = tagNumbers(io, "0028|0030"); v.size() == 2) {
    geometry.spacing[0] = v[1];
    geometry.spacing[1] = v[0];
  }
  if (const auto v = tagNumbers(io, "0018|0088"); v.size() == 1) geometry.spacing[2] = v[0];
  if (const auto v = tagNumbers(io, "0020|0032"); v.size() == 3)
    geometry.origin = {v[0], v[1], v[2]};
  if (const auto v = tagNumbers(io, "0020|0037"); v.size() == 6) {
    const Eigen::Vector3d row(v[0], v[1], v[2]), column(v[3], v[4], v[5]);
    geometry.direction.col(0) = row;
    geometry.direction.col(1) = column;
    geometry.direction.col(2) = row.cross(column);
  }
}

/// A multi-frame file is a volume by itself.
Volume readFrames(const fs::path& file) {
  const auto io = openImage(file);
  Volume volume;
  volume.geometry = checkedGeometry(*io, file);
  if (!hasFrameSpacing(file))
    throw invalidInput(file.string() +
                       ": does not say how far its frames are apart; expected a volume");
  useStatedGeometry(*io, volume.geometry);
  checkGeometry(volume.geometry, file);
  checkWhole(*io, file);
  volume.voxels = readVoxels(*io, file);
  return volume;
}

}  // namespace

Volume readDicom(const fs::path& path, const ReadVolumeOptions& options, const Progress& progress) {
  const QuietDicom quiet;
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(false);  // with details, the identifiers are not the series' UIDs
  names->SetDirectory(path.string());
  const std::string uid = chooseSeries(*names, options.series, path);
  const std::vector<std::string> files = names->GetFileNames(uid);
  return files.size() == 1 ? readFrames(files[0]) : readSlices(files, path, progress);
}

VolumeHeader readDicomHeader(const fs::path& path, const ReadVolumeOptions& options,
                             const Progress& progress) {
  Volume volume = readDicom(path, options, progress);
  return {.geometry = volume.geometry, .assumptions = std::move(volume.assumptions)};
}

}  // namespace lumen::convert
