// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/detached_data.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/io/volume/text_header.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxWidth = 20;  // digits of a number in a name

bool isWithin(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

/// `path` with every link followed and no slash at its end; empty if it does not exist.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::canonical(path.empty() ? fs::path(".") : path, error);
  return error ? fs::path() : place;
}

/// A pattern in three parts: before the number, after it, and its width.
struct NamePattern {
  std::string before, after;
  std::size_t width = 0;
  bool zeros = false;

  [[nodiscard]] std::string name(std::int64_t number) const {
    std::string digits = std::to_string(number < 0 ? -number : number);
    const std::string sign = number < 0 ? "-" : "";
    const std::size_t length = digits.size() + sign.size();
    const std::size_t missing = width > length ? width - length : 0;
    if (zeros) return before + sign + std::string(missing, '0') + digits + after;
    return before + std::string(missing, ' ') + sign + digits + after;
  }
};

/// Reads the number's placeholder at `at`, after its %; false unless it is valid.
bool readPlace(const std::string& text, std::size_t& at, NamePattern& pattern) {
  if (at < text.size() && text[at] == '0') pattern.zeros = true;
  for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at) {
    pattern.width = 10 * pattern.width + static_cast<std::size_t>(text[at] - '0');
    if (pattern.width > kMaxWidth) return false;
  }
  if (at >= text.size() || (text[at] != 'd' && text[at] != 'i' && text[at] != 'u')) return false;
  ++at;
  return true;
}

NamePattern parsePattern(const fs::path& header, const std::string& text) {
  NamePattern pattern;
  int places = 0;
  bool sound = true;
  for (std::size_t at = 0; at < text.size() && sound;) {
    std::string& part = places == 0 ? pattern.before : pattern.after;
    if (text[at] != '%' || text.compare(at, 2, "%%") == 0) {
      part += text[at];
      at += text[at] == '%' ? 2 : 1;
    } else {
      ++at;
      sound = ++places == 1 && readPlace(text, at, pattern);
    }
  }
  if (sound && places == 1) return pattern;
  throw invalidInput(header.string() + ": its voxels are in files named " + quotedText(text) +
                     "; expected a pattern with one number in it, such as \"slice%03d.raw\"");
}

}  // namespace

std::vector<fs::path> detachedFiles(const InputFile& input, const DetachedNames& names,
                                    const std::vector<fs::path>& allowed, const FieldWord& word,
                                    const std::string& what) {
  const fs::path& header = input.path();
  std::vector<fs::path> places;
  if (!input.isInMemory()) places.push_back(resolved(header.parent_path()));
  for (const fs::path& path : allowed) places.push_back(resolved(path));
  std::erase_if(places, [](const fs::path& place) { return place.empty(); });
  std::vector<fs::path> files;
  for (std::uint64_t n = 0; n < names.count; ++n) {
    const std::string name = names.name(n);
    const fs::path stated = input.isInMemory() ? fs::path(name) : header.parent_path() / name;
    const auto refuse = [&](const std::string& why) {
      return invalidInput(header.string() + ": " + what + " in " +
                          formats::printable(stated.string()) + why);
    };
    if (input.isInMemory() && (allowed.empty() || !stated.is_absolute()))
      throw refuse("; expected them behind its header, as it is in memory");
    std::error_code error;
    fs::path file =
        name.find('\0') == std::string::npos ? fs::canonical(stated, error) : fs::path();
    if (error || file.empty())
      throw refuse(", which cannot be read (" +
                   (error ? error.message() : std::string("no name of a file")) + ")");
    const bool within = std::any_of(places.begin(), places.end(),
                                    [&](const fs::path& place) { return isWithin(file, place); });
    if (!within)
      throw refuse(", outside of the header's folder; if they are meant, " +
                   word("allow-detached") + " " + formats::printable(file.parent_path().string()) +
                   " allows it");
    if (!fs::is_regular_file(file, error)) throw refuse(", which is not a regular file");
    files.push_back(std::move(file));
  }
  return files;
}

std::uint64_t NumberRange::count() const {
  if (step == 0 || (step > 0) != (last >= first)) return first == last && step != 0 ? 1 : 0;
  const auto distance = static_cast<std::uint64_t>(step > 0 ? last - first : first - last);
  return 1 + distance / static_cast<std::uint64_t>(step > 0 ? step : -step);
}

DetachedNames namesOfPattern(const fs::path& header, const std::string& text,
                             const NumberRange& range) {
  const auto name = [pattern = parsePattern(header, text), range](std::uint64_t n) {
    return pattern.name(range.first + static_cast<std::int64_t>(n) * range.step);
  };
  return {range.count(), name};
}

DetachedNames namesOfList(std::vector<std::string> names) {
  const std::uint64_t count = names.size();
  return {count, [names = std::move(names)](std::uint64_t n) { return names[n]; }};
}

}  // namespace lumen::convert
