// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_phases.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
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

/// A frame of one of the images of a series.
struct Place {
  std::size_t image = 0, frame = 0;
};
using Places = std::vector<Place>;
using Groups = std::vector<Places>;  // the frames at each position, in the order of files

constexpr double kSamePlace = 1e-4;  // mm, and of directions

bool isAtOnePlace(const DicomImage& a, const DicomPlane& one, const DicomImage& b,
                  const DicomPlane& other) {
  if (a.columns != b.columns || a.rows != b.rows) return false;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs((*one.position)[i] - (*other.position)[i]) < kSamePlace)) return false;
  for (std::size_t i = 0; i < 6; ++i)
    if (!(std::abs((*one.orientation)[i] - (*other.orientation)[i]) < kSamePlace)) return false;
  return true;
}

/// The frames of a series; empty unless each is placed.
Places framesOf(const Images& images) {
  Places places;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].labels != DicomLabels::None) return {};
    for (const std::size_t frame : images[i].usedFrames()) {
      const DicomPlane& plane = images[i].planeOf(frame);
      if (!plane.position || !plane.orientation) return {};
      places.push_back({i, frame});
    }
  }
  return places;
}

Groups groupsOf(const Images& images, const Places& places) {
  const auto planeOf = [&](const Place& p) -> const DicomPlane& {
    return images[p.image].planeOf(p.frame);
  };
  // along a direction that is no axis of a scan, so that few positions are equal in it
  const Eigen::Vector3d along(0.3141, 0.5926, 0.7413);
  Places order = places;
  std::stable_sort(order.begin(), order.end(), [&](const Place& a, const Place& b) {
    return along.dot(*planeOf(a).position) < along.dot(*planeOf(b).position);
  });
  Groups groups;
  for (const Place& p : order) {
    const Place* const last = groups.empty() ? nullptr : &groups.back().front();
    if (last != nullptr &&
        isAtOnePlace(images[last->image], planeOf(*last), images[p.image], planeOf(p)))
      groups.back().push_back(p);
    else
      groups.push_back({p});
  }
  const auto inOrder = [](const Place& a, const Place& b) {
    return std::pair(a.image, a.frame) < std::pair(b.image, b.frame);
  };
  for (Places& group : groups) std::sort(group.begin(), group.end(), inOrder);
  return groups;
}

bool areCopies(const Images& images, const Groups& groups, const Progress& progress) {
  const auto read = [&](const Place& p) {
    return readDicomFrame(images[p.image], p.frame, progress);
  };
  for (const Places& group : groups) {
    if (group.size() < 2) continue;
    const Voxels first = read(group.front());
    for (std::size_t k = 1; k < group.size(); ++k)
      if (read(group[k]) != first) return false;
  }
  return true;
}

/// The values of an element, if it takes a series apart into volumes: each has no position twice, and
/// `isWhole` each position, else at least two.
std::vector<std::string> valuesOf(const Images& images, const Groups& groups, std::size_t element,
                                  bool isWhole) {
  std::map<std::string, std::size_t> counts;
  for (const Places& group : groups) {
    std::set<std::string> here;
    for (const Place& p : group) {
      const std::string& value = images[p.image].phasesOf(p.frame)[element];
      if (value.empty() || !here.insert(value).second) return {};
      ++counts[value];
    }
  }
  if (counts.size() < 2) return {};
  std::vector<std::string> values;
  for (const auto& [value, count] : counts) {
    if (count < (isWhole ? groups.size() : 2)) return {};
    values.push_back(value);
  }
  // numbers in their order
  std::stable_sort(values.begin(), values.end(),
                   [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
  return values;
}

/// The images with these frames alone.
Images withFrames(const Images& images, const Places& places) {
  Images out;
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::vector<std::size_t> frames;
    for (const Place& p : places)
      if (p.image == i) frames.push_back(p.frame);
    if (frames.empty()) continue;
    std::sort(frames.begin(), frames.end());
    out.push_back(images[i]);
    if (frames.size() < images[i].frames) out.back().chosen = std::move(frames);
  }
  return out;
}

/// The series of each value of an element, under a name of its own.
std::map<std::string, Images> divided(const Images& images, const Places& places,
                                      const std::vector<std::string>& values, std::size_t element) {
  std::map<std::string, Images> series;
  for (std::size_t v = 0; v < values.size(); ++v) {
    const DicomPhaseElement& known = kPhaseElements[element];
    std::string name = images.front().series + ", volume " +
                       paddedNumber(v + 1, std::to_string(values.size()).size()) + " of " +
                       std::to_string(values.size()) + " by the " + known.name;
    if (!known.isTime) name += ", " + values[v];
    Places own;
    for (const Place& p : places)
      if (images[p.image].phasesOf(p.frame)[element] == values[v]) own.push_back(p);
    series[name] = withFrames(images, own);
    for (DicomImage& image : series[name]) image.series = name;
  }
  return series;
}

/// The element that takes the series apart into volumes, and its values; none without one.
std::pair<std::size_t, std::vector<std::string>> dividerOf(const Images& images,
                                                           const Groups& groups) {
  const auto isStack = [](std::size_t e) { return e == 0; };
  const bool isRepeated = std::any_of(groups.begin(), groups.end(),
                                      [](const Places& group) { return group.size() > 1; });
  for (const bool isWhole : {true, false})
    for (std::size_t e = 0; e < kPhaseElements.size(); ++e) {
      if (isWhole ? !isRepeated : kPhaseElements[e].isTime || !(isRepeated || isStack(e))) continue;
      if (auto values = valuesOf(images, groups, e, isWhole); !values.empty())
        return {e, std::move(values)};
    }
  return {};
}

}  // namespace

void dividePhases(DicomFolder& folder, const Progress& progress) {
  std::vector<Images> open;
  for (auto& [uid, images] : folder.series) open.push_back(std::move(images));
  folder.series.clear();
  while (!open.empty()) {
    Images images = std::move(open.back());
    open.pop_back();
    const std::string name = images.front().series;
    const Places places = framesOf(images);
    const Groups groups = groupsOf(images, places);
    const auto [element, values] = dividerOf(images, groups);
    const bool isRepeated = groups.size() < places.size();
    const bool isCopied = isRepeated && areCopies(images, groups, progress);
    if (!values.empty() && !isCopied) {
      for (auto& [part, own] : divided(images, places, values, element))
        open.push_back(std::move(own));
      continue;
    }
    if (isCopied) {
      Places kept;
      for (const Places& group : groups) kept.push_back(group.front());
      const std::size_t left = places.size() - kept.size();
      const bool isOfFiles = places.size() == images.size();
      folder.remarks[name].push_back(
          counted(left, isOfFiles ? "file" : "frame", isOfFiles ? "files" : "frames") +
          " with the position and the voxels of another one " + (left == 1 ? "is" : "are") +
          " left out");
      images = withFrames(images, kept);
    }
    folder.series[name] = std::move(images);
  }
}

}  // namespace lumen::convert
