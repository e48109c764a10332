// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_phases.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/dicom/dicom_pixels.h"

namespace lumen::convert {
namespace {

using Images = std::vector<DicomImage>;
using Groups = std::vector<std::vector<std::size_t>>;  // indices of images at each position

constexpr double kSamePlace = 1e-4;  // mm, and of directions

bool isAtOnePlace(const DicomImage& a, const DicomImage& b) {
  if (a.columns != b.columns || a.rows != b.rows || a.series != b.series) return false;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs((*a.plane.position)[i] - (*b.plane.position)[i]) < kSamePlace)) return false;
  for (std::size_t i = 0; i < 6; ++i)
    if (!(std::abs((*a.plane.orientation)[i] - (*b.plane.orientation)[i]) < kSamePlace))
      return false;
  return true;
}

// The images by their positions; empty unless all are single placed frames, and some share one.
Groups groupsOf(const Images& images) {
  for (const DicomImage& image : images)
    if (image.frames > 1 || !image.plane.position || !image.plane.orientation) return {};
  std::vector<std::size_t> order(images.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  // along a direction that is no axis of a scan, so that few positions are equal in it
  const Eigen::Vector3d along(0.3141, 0.5926, 0.7413);
  const auto place = [&](std::size_t i) { return along.dot(*images[i].plane.position); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  Groups groups;
  for (const std::size_t i : order)
    if (!groups.empty() && isAtOnePlace(images[groups.back().front()], images[i]))
      groups.back().push_back(i);
    else
      groups.push_back({i});
  if (groups.size() == images.size()) return {};
  for (auto& group : groups) std::sort(group.begin(), group.end());
  return groups;
}

bool areCopies(const Images& images, const Groups& groups, const Progress& progress) {
  for (const auto& group : groups) {
    if (group.size() < 2) continue;
    const Voxels first = readDicomFrame(images[group.front()], 0, progress);
    for (std::size_t k = 1; k < group.size(); ++k)
      if (readDicomFrame(images[group[k]], 0, progress) != first) return false;
  }
  return true;
}

// The values of an element, if each has one image at every position.
std::vector<std::string> valuesOf(const Images& images, const Groups& groups, std::size_t element) {
  std::vector<std::string> values;
  for (const std::size_t i : groups.front()) values.push_back(images[i].phases[element]);
  std::sort(values.begin(), values.end());
  if (values.size() < 2 || values.front().empty()) return {};
  if (std::adjacent_find(values.begin(), values.end()) != values.end()) return {};
  for (const auto& group : groups) {
    std::vector<std::string> here;
    for (const std::size_t i : group) here.push_back(images[i].phases[element]);
    std::sort(here.begin(), here.end());
    if (here != values) return {};
  }
  // numbers in their order
  std::stable_sort(values.begin(), values.end(),
                   [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
  return values;
}

// The series of each value of an element, under a name of its own.
void divide(Images images, const std::vector<std::string>& values, std::size_t element,
            DicomFolder& folder) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    const DicomPhaseElement& known = kPhaseElements[element];
    std::string name = images.front().series + ", volume " +
                       paddedNumber(v + 1, std::to_string(values.size()).size()) + " of " +
                       std::to_string(values.size()) + " by the " + known.name;
    if (!known.isTime) name += ", " + values[v];
    for (const DicomImage& image : images)
      if (image.phases[element] == values[v]) folder.series[name].push_back(image);
    for (DicomImage& image : folder.series[name]) image.series = name;
  }
}

}  // namespace

void dividePhases(DicomFolder& folder, const Progress& progress) {
  std::map<std::string, Images> found = std::move(folder.series);
  folder.series.clear();
  for (auto& [uid, images] : found) {
    const Groups groups = groupsOf(images);
    bool isDivided = false;
    for (std::size_t e = 0; !groups.empty() && e < kPhaseElements.size() && !isDivided; ++e) {
      const std::vector<std::string> values = valuesOf(images, groups, e);
      if (values.empty()) continue;
      if (areCopies(images, groups, progress)) break;
      divide(images, values, e, folder);
      isDivided = true;
    }
    if (isDivided) continue;
    if (!groups.empty() && areCopies(images, groups, progress)) {
      Images kept;
      for (const auto& group : groups) kept.push_back(images[group.front()]);
      folder.remarks[uid].push_back(counted(images.size() - kept.size(), "file", "files") +
                                    " with the position and the voxels of another one " +
                                    (images.size() - kept.size() == 1 ? "is" : "are") +
                                    " left out");
      images = std::move(kept);
    }
    folder.series[uid] = std::move(images);
  }
}

}  // namespace lumen::convert
