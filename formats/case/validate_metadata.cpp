// SPDX-License-Identifier: Apache-2.0
// The rules of metadata and node arrays; declared in metadata_json.h.
#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "formats/case/metadata_json.h"
#include "formats/case/node_origin.h"
#include "formats/case/node_words.h"
#include "formats/case/vessel_system.h"
#include "formats/view/limits.h"
#include "formats/view/model_rules.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

constexpr double kOrthonormalTolerance = 1e-4;
constexpr std::int32_t kMaxPointBits = 30;

void checkName(const std::string& name, const std::string& place, IssueList& issues) {
  if (name.empty()) return issues.add(limitIssue(ErrorCode::TextLength, place, 0, kMaxNameBytes));
  checkText(name, kMaxNameBytes, place, issues);
}

// Columns a and b of the row-major 3x3 matrix.
double dotColumns(const std::array<double, 9>& m, std::size_t a, std::size_t b) {
  return m[a] * m[b] + m[3 + a] * m[3 + b] + m[6 + a] * m[6 + b];
}

void checkDirection(const std::array<double, 9>& direction, IssueList& issues) {
  const std::string place = "/metadata/source/direction";
  for (std::size_t i = 0; i < direction.size(); ++i)
    if (!std::isfinite(direction[i])) return checkFinite(direction[i], at(place, i), issues);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) {
      const double expected = a == b ? 1.0 : 0.0;
      const double found = dotColumns(direction, a, b);
      if (!(std::abs(found - expected) <= kOrthonormalTolerance))
        return issues.add(foundIssue(ErrorCode::SourceDirection, place,
                                     "a product of columns " + std::to_string(a) + " and " +
                                         std::to_string(b) + " of " + shortText(found),
                                     shortText(expected) + " within 0.0001"));
    }
}

void checkSha256(const std::string& text, const std::string& place, ErrorCode code,
                 IssueList& issues) {
  const bool legal = text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
                     });
  if (!legal) issues.add(pointerIssue(code, place, "expected 64 lower-case hexadecimal digits"));
}

void checkSource(const SourceVolume& source, IssueList& issues) {
  const std::string place = "/metadata/source";
  for (std::size_t a = 0; a < 3; ++a)
    if (source.size[a] == 0)
      issues.add(pointerIssue(ErrorCode::SourceSize, at(place + "/size", a),
                              "found 0, expected at least 1 voxel"));
  for (std::size_t a = 0; a < 3; ++a)
    checkPositive(source.spacing[a], at(place + "/spacing", a), ErrorCode::SourceSpacing, issues);
  for (std::size_t a = 0; a < 3; ++a)
    checkFinite(source.origin[a], at(place + "/origin", a), issues);
  checkDirection(source.direction, issues);
  checkSha256(source.sha256, place + "/sha256", ErrorCode::SourceSha256, issues);
}

void checkParameter(const std::string& name, const ParameterValue& value, const std::string& place,
                    IssueList& issues) {
  checkName(name, place, issues);
  const std::string at = place + "/" + jsonPointerToken(name);
  if (const auto* number = std::get_if<double>(&value)) checkFinite(*number, at, issues);
  if (const auto* text = std::get_if<std::string>(&value))
    checkText(*text, kMaxTextBytes, at, issues);
  if (name != "random-seed") return;
  const auto* seed = std::get_if<std::int64_t>(&value);
  if (seed == nullptr || *seed < 0)
    issues.add(foundIssue(ErrorCode::RandomSeed, at,
                          seed == nullptr ? "another type" : std::to_string(*seed),
                          "an integer from 0"));
}

void checkStep(const Step& step, const std::string& place, IssueList& issues) {
  checkName(step.name, place + "/name", issues);
  checkName(step.tool, place + "/tool", issues);
  checkLimit(step.parameters.size(), kMaxParameters, place + "/parameters", issues);
  for (const auto& [name, value] : step.parameters) {
    if (issues.done()) return;
    checkParameter(name, value, place + "/parameters", issues);
  }
}

bool isUpperOrDigit(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}
bool isWord(char c) {
  return isUpperOrDigit(c) || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
}

// VENDOR_name: upper-case letters and digits, a letter first; an underscore; letters, digits, - and
// _.
bool isExtensionName(std::string_view name) {
  const std::size_t underscore = name.find('_');
  if (underscore == std::string_view::npos || underscore == 0 || underscore + 1 == name.size() ||
      name.size() > kMaxNameBytes || name[0] < 'A' || name[0] > 'Z')
    return false;
  const std::string_view vendor = name.substr(0, underscore);
  return std::all_of(vendor.begin(), vendor.end(), isUpperOrDigit) &&
         std::all_of(name.begin(), name.end(), isWord);
}

bool checkExtensionList(const std::vector<std::string>& names, const std::string& place,
                        IssueList& issues) {
  if (!checkLimit(names.size(), kMaxExtensions, place, issues)) return false;
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size() && !issues.done(); ++i) {
    const std::vector<Argument> found = {{"found", names[i].substr(0, 80)}};
    if (!isExtensionName(names[i]))
      issues.add(pointerIssue(ErrorCode::ExtensionName, at(place, i),
                              "the name is not of the form VENDOR_name", found));
    else if (!seen.insert(names[i]).second)
      issues.add(pointerIssue(ErrorCode::ExtensionDuplicate, at(place, i),
                              "the extension is listed a second time", found));
  }
  return true;
}

bool isListed(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void checkExtensions(const Metadata& metadata, IssueList& issues) {
  const std::string required = "/metadata/extensionsRequired";
  const bool used = checkExtensionList(metadata.extensionsUsed, "/metadata/extensionsUsed", issues);
  if (!checkExtensionList(metadata.extensionsRequired, required, issues) || !used) return;
  for (std::size_t i = 0; i < metadata.extensionsRequired.size() && !issues.done(); ++i) {
    const std::string name = metadata.extensionsRequired[i].substr(0, 80);
    if (!isListed(metadata.extensionsUsed, metadata.extensionsRequired[i]))
      issues.add(pointerIssue(ErrorCode::ExtensionUnlisted, at(required, i),
                              "the extension " + name + " is not in extensionsUsed",
                              {{"found", name}}));
    else if (name != kOriginExtension && name != kSystemExtension &&
             isExtensionName(metadata.extensionsRequired[i]))
      // this reader has no other extension
      issues.add(pointerIssue(ErrorCode::ExtensionRequired, at(required, i),
                              "the extension " + name +
                                  " is needed to understand the file, and "
                                  "this reader does not have it",
                              {{"found", name}}));
  }
}

// EXTENSION.name, the extension being one that is used.
void checkArrayName(const NodeArray& array, const Metadata& metadata, const std::string& place,
                    IssueList& issues) {
  const std::size_t dot = array.name.find('.');
  const std::string_view name = array.name;
  const std::vector<Argument> found = {{"found", array.name.substr(0, 80)}};
  const std::string_view own = dot == std::string::npos ? "" : name.substr(dot + 1);
  if (own.empty() || array.name.size() > kMaxNameBytes ||
      !std::all_of(own.begin(), own.end(), isWord) || !isExtensionName(name.substr(0, dot)))
    issues.add(pointerIssue(ErrorCode::NodeArrayName, place + "/name",
                            "the name is not of the form EXTENSION.name", found));
  else if (!isListed(metadata.extensionsUsed, name.substr(0, dot)))
    issues.add(pointerIssue(ErrorCode::ExtensionUnlisted, place + "/name",
                            "its extension is not in extensionsUsed", found));
}

void checkArrayValues(const NodeArray& array, std::size_t nodeCount, IssueList& issues) {
  const std::string place = "/nodeArrays/" + jsonPointerToken(array.name);
  const std::size_t count =
      std::visit([](const auto& values) { return values.size(); }, array.values);
  checkLength(count, nodeCount * array.components, place, issues);
  if (const auto* values = std::get_if<std::vector<float>>(&array.values))
    checkValues(*values, place, {[](float) { return true; }, ErrorCode::NotFinite, ""}, issues);
}

}  // namespace

void checkNodeArrays(const Case& value, IssueList& issues) {
  const std::string list = "/metadata/nodeArrays";
  if (!checkLimit(value.nodeArrays.size(), kMaxNodeArrays, list, issues)) return;
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < value.nodeArrays.size() && !issues.done(); ++i) {
    const NodeArray& array = value.nodeArrays[i];
    const std::string place = at(list, i);
    checkArrayName(array, value.metadata, place, issues);
    if (!names.insert(array.name).second)
      issues.add(pointerIssue(ErrorCode::NodeArrayName, place + "/name",
                              "the name is that of an earlier array",
                              {{"found", array.name.substr(0, 80)}}));
    checkText(array.unit, kMaxNameBytes, place + "/unit", issues);
    if (array.components < 1 || array.components > kMaxComponents)
      issues.add(limitIssue(ErrorCode::NodeArrayComponents, place + "/components", array.components,
                            kMaxComponents));
    else
      checkArrayValues(array, value.tree.nodeCount(), issues);
    if (std::optional<Issue> fault = nodeWordFault(array, place)) issues.add(std::move(*fault));
  }
}

void checkMetadata(const Metadata& metadata, IssueList& issues) {
  if (metadata.voxelSize)
    checkPositive(*metadata.voxelSize, "/metadata/voxelSize", ErrorCode::VoxelSize, issues);
  if (metadata.source) checkSource(*metadata.source, issues);
  if (!metadata.parentSha256.empty())
    checkSha256(metadata.parentSha256, "/metadata/parentSha256", ErrorCode::ParentSha256, issues);
  if (const auto& q = metadata.pointQuantisation) {
    const std::string place = "/metadata/pointQuantisation";
    if (q->bits < 1 || q->bits > kMaxPointBits)
      issues.add(foundIssue(ErrorCode::PointQuantisation, place + "/bits", std::to_string(q->bits),
                            "1 to 30"));
    checkPositive(q->step, place + "/step", ErrorCode::PointQuantisation, issues);
  }
  checkText(metadata.note, kMaxTextBytes, "/metadata/note", issues);
  checkExtensions(metadata, issues);
  checkLimit(metadata.steps.size(), kMaxSteps, "/metadata/steps", issues);
  for (std::size_t i = 0; i < metadata.steps.size() && !issues.done(); ++i)
    checkStep(metadata.steps[i], at("/metadata/steps", i), issues);
}

}  // namespace lumen::formats
