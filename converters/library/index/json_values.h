// SPDX-License-Identifier: Apache-2.0
// Values that library.json and record.json have in common, read strictly.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "converters/base/json_place.h"

namespace lumen::convert {

/// `formatVersion` of library.json and record.json, spec/library.md.
inline constexpr int kLibraryFormat = 1;

/// The greatest whole number that every reader of JSON holds exactly.
inline constexpr std::uint64_t kMostWhole = std::uint64_t{1} << 53;

/// UTF-8 without control characters, of `least` to `most` bytes.
std::string plainText(const JsonPlace& place, std::size_t most, std::size_t least = 0);
std::uint64_t wholeNumber(const JsonPlace& place, std::uint64_t least = 0,
                          std::uint64_t most = kMostWhole);
double notNegative(const JsonPlace& place);
double positive(const JsonPlace& place);
/// One of these words.
std::string readWord(const JsonPlace& place, std::initializer_list<const char*> words);
/// SHA-256: 64 lower-case hexadecimal digits.
std::string digest(const JsonPlace& place);
/// A day that there is, YYYY-MM-DD.
std::string day(const JsonPlace& place);
std::string caseId(const JsonPlace& place);

bool isDay(std::string_view text);
bool isUuid(std::string_view text);

/// Refuses another format than `name`, and another version than kLibraryFormat.
void requireFormat(const JsonPlace& root, const char* name);

}  // namespace lumen::convert
