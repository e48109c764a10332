// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/dropped_files.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace lumen::viewer {

namespace {

constexpr std::size_t kLongestName = 100;  // bytes

/// The end of `name` in harmless letters, with its ending, which names the format.
std::string harmlessName(const std::string& name) {
  std::string text;
  for (const char c : name.substr(name.size() - std::min(name.size(), kLongestName)))
    text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ? c : '_';
  if (text.empty() || text.front() == '.') text.insert(0, "file");
  return text;
}

}  // namespace

void DroppedFiles::add(const std::string& name, std::string bytes) {
  m_bytes.push_back(std::move(bytes));
  m_files.emplace_back(harmlessName(name), m_bytes.back());
}

}  // namespace lumen::viewer
