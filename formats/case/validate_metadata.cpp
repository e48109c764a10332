// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "formats/case/error_text.h"
#include "formats/case/limits.h"
#include "formats/case/text_rules.h"
#include "formats/case/validate_parts.h"

namespace lumen::formats {
namespace {

constexpr double kOrthonormalTolerance = 1e-4;

Problem checkName(const std::string& name, const std::string& place) {
  if (name.empty()) return makeError(ErrorCode::TextLength, place, "the text is empty");
  return checkText(name, kMaxNameBytes, place);
}

Problem checkFinite(std::span<const double> values, const std::string& place) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      return makeError(ErrorCode::NotFinite, place + "/" + std::to_string(i),
                       "found " + shortText(values[i]) + ", expected a finite number");
  return std::nullopt;
}

// Columns a and b of the row-major 3x3 matrix.
double dotColumns(const std::array<double, 9>& m, std::size_t a, std::size_t b) {
  return m[a] * m[b] + m[3 + a] * m[3 + b] + m[6 + a] * m[6 + b];
}

Problem checkDirection(const std::array<double, 9>& direction) {
  const std::string place = "/metadata/source/direction";
  if (auto problem = checkFinite(direction, place)) return problem;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) {
      const double expected = a == b ? 1.0 : 0.0;
      const double found = dotColumns(direction, a, b);
      if (!(std::abs(found - expected) <= kOrthonormalTolerance))
        return makeError(ErrorCode::SourceDirection, place,
                         "the product of columns " + std::to_string(a) + " and " +
                             std::to_string(b) + " is " + shortText(found) + ", expected " +
                             shortText(expected) + " within 0.0001");
    }
  return std::nullopt;
}

bool isSha256(const std::string& text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

Problem checkSource(const SourceVolume& source) {
  for (std::size_t a = 0; a < 3; ++a)
    if (source.size[a] == 0)
      return makeError(ErrorCode::SourceSize, "/metadata/source/size/" + std::to_string(a),
                       "found 0, expected at least 1 voxel");
  if (auto problem = checkFinite(source.spacing, "/metadata/source/spacing")) return problem;
  for (std::size_t a = 0; a < 3; ++a)
    if (!(source.spacing[a] > 0))
      return makeError(ErrorCode::SourceSpacing, "/metadata/source/spacing/" + std::to_string(a),
                       "found " + shortText(source.spacing[a]) + ", expected more than 0 mm");
  if (auto problem = checkFinite(source.origin, "/metadata/source/origin")) return problem;
  if (auto problem = checkDirection(source.direction)) return problem;
  if (!isSha256(source.sha256))
    return makeError(ErrorCode::SourceSha256, "/metadata/source/sha256",
                     "expected 64 lower-case hexadecimal digits");
  return std::nullopt;
}

Problem checkParameter(const std::string& name, const ParameterValue& value,
                       const std::string& place) {
  if (auto problem = checkName(name, place)) return problem;
  const std::string at = place + "/" + jsonPointerToken(name);
  if (const auto* number = std::get_if<double>(&value); number && !std::isfinite(*number))
    return makeError(ErrorCode::NotFinite, at,
                     "found " + shortText(*number) + ", expected a finite number");
  if (const auto* text = std::get_if<std::string>(&value))
    return checkText(*text, kMaxTextBytes, at);
  return std::nullopt;
}

Problem checkStep(const Step& step, const std::string& place) {
  if (auto problem = checkName(step.name, place + "/name")) return problem;
  if (auto problem = checkName(step.tool, place + "/tool")) return problem;
  if (step.parameters.size() > kMaxParameters)
    return makeError(ErrorCode::Limit, place + "/parameters",
                     std::to_string(step.parameters.size()) + " parameters, the limit is " +
                         std::to_string(kMaxParameters));
  for (const auto& [name, value] : step.parameters)
    if (auto problem = checkParameter(name, value, place + "/parameters")) return problem;
  return std::nullopt;
}

}  // namespace

Problem checkMetadata(const Metadata& metadata) {
  if (metadata.voxelSize && !(std::isfinite(*metadata.voxelSize) && *metadata.voxelSize > 0))
    return makeError(
        std::isfinite(*metadata.voxelSize) ? ErrorCode::VoxelSize : ErrorCode::NotFinite,
        "/metadata/voxelSize",
        "found " + shortText(*metadata.voxelSize) + ", expected a finite number above 0 mm");
  if (metadata.source)
    if (auto problem = checkSource(*metadata.source)) return problem;
  if (metadata.steps.size() > kMaxSteps)
    return makeError(ErrorCode::Limit, "/metadata/steps",
                     std::to_string(metadata.steps.size()) + " steps, the limit is " +
                         std::to_string(kMaxSteps));
  for (std::size_t i = 0; i < metadata.steps.size(); ++i)
    if (auto problem = checkStep(metadata.steps[i], "/metadata/steps/" + std::to_string(i)))
      return problem;
  return std::nullopt;
}

}  // namespace lumen::formats
