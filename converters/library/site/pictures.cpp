// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/pictures.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace lumen::convert {

namespace {

constexpr std::size_t kFewestFrames = 3;  // fewer are no turn
constexpr const char* kThumbnail = "thumbnail.png";

/// Rest of "turn-007.png" or "turn/007.png" without its number: "turn-.png", "turn/.png"; empty for
/// others.
std::string turnName(const std::string& path) {
  constexpr std::size_t kDigits = 3;
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || dot < kDigits + 1) return {};
  if (const char before = path[dot - kDigits - 1]; before != '-' && before != '/') return {};
  for (std::size_t i = dot - kDigits; i < dot; ++i)
    if (path[i] < '0' || path[i] > '9') return {};
  return path.substr(0, dot - kDigits) + path.substr(dot);
}

bool isShown(const RecordedFile& file) {
  return file.role == "picture" &&
         (file.media == "image/png" || file.media == "image/jpeg" || file.media == "image/webp");
}

}  // namespace

CasePictures casePictures(const CaseRecord& record) {
  CasePictures pictures;
  std::vector<std::string> paths;
  std::map<std::string, std::vector<std::string>> turns;
  for (const RecordedFile& file : record.files) {
    if (!isShown(file)) continue;
    if (file.path == kThumbnail) {
      pictures.thumbnail = file.path;
      continue;
    }
    paths.push_back(file.path);
    if (const std::string turn = turnName(file.path); !turn.empty())
      turns[turn].push_back(file.path);
  }
  std::sort(paths.begin(), paths.end());
  for (auto& [name, frames] : turns)
    if (frames.size() >= kFewestFrames && frames.size() > pictures.frames.size())
      pictures.frames = std::move(frames);
  std::sort(pictures.frames.begin(), pictures.frames.end());
  for (const std::string& path : paths)
    if (!std::binary_search(pictures.frames.begin(), pictures.frames.end(), path))
      pictures.others.push_back(path);
  auto first = std::find(pictures.others.begin(), pictures.others.end(), "picture.png");
  if (first == pictures.others.end()) first = pictures.others.begin();
  if (first != pictures.others.end()) {
    pictures.first = *first;
    pictures.others.erase(first);
  } else if (!pictures.frames.empty()) {
    pictures.first = pictures.frames.front();
  }
  if (pictures.first.empty()) pictures.first = pictures.thumbnail;
  if (pictures.thumbnail.empty()) pictures.thumbnail = pictures.first;
  return pictures;
}

}  // namespace lumen::convert
