// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>

#include <LumenSofa/vessel_case.h>

#include "formats/container/printable.h"
#include "formats/view/case_view.h"

namespace lumensofa {
namespace {

using lumen::formats::printable;

constexpr std::size_t kListedLabels = 20;

std::string inQuotes(std::string_view text) {
  std::string sentence("'");
  return sentence.append(printable(text)).append("'");
}

bool readBytes(const std::string& path, std::vector<std::byte>& bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return false;
  bytes.resize(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  return static_cast<std::size_t>(file.gcount()) == bytes.size();
}

std::string labelsOf(const lumen::formats::CaseView& view) {
  std::string list;
  for (std::size_t i = 0; i < view.branchCount() && i < kListedLabels; ++i) {
    if (i > 0) list += ", ";
    list += printable(view.label(view.branch(i)));
  }
  if (view.branchCount() > kListedLabels)
    list += " and " + std::to_string(view.branchCount() - kListedLabels) + " more";
  return list;
}

// Looks up a branch in bytes that libblob has verified.
std::string findBranch(std::span<const std::byte> bytes, const std::string& path,
                       const std::string& label, NodeRange& range) {
  const auto view = lumen::formats::viewCase(bytes, lumen::formats::Verify::Structure);
  if (!view) return inQuotes(path) + ": " + printable(view.error().message);
  for (std::size_t i = 0; i < view->branchCount(); ++i) {
    const lumen::formats::BranchView branch = view->branch(i);
    if (view->label(branch) != label || branch.nodeCount == 0) continue;
    range = {branch.firstNode, branch.nodeCount};
    return {};
  }
  return inQuotes(path) + " has no branch " + inQuotes(label) + "; it has " + labelsOf(*view);
}

std::string sentenceFor(blob_status status, const std::string& path, const char* message) {
  const std::string name = inQuotes(path);
  if (status == BLOB_ERROR_NO_MODELS)
    return name + " has no models: 'lumen fit' makes them from the case's wall points";
  return name + " is not a case that can be used: " + printable(message);
}

double power(const blob_node& node, const double point[3]) {
  double sum = -node.radius * node.radius;
  for (int i = 0; i < 3; ++i) sum += (point[i] - node.centre[i]) * (point[i] - node.centre[i]);
  return sum;
}

}  // namespace

VesselCase openVesselCase(const std::string& path, const std::string& branch) {
  VesselCase vessel;
  std::vector<std::byte> bytes;
  if (!readBytes(path, bytes) || bytes.empty()) {
    vessel.problem.append("cannot read ").append(inQuotes(path));
    vessel.problem += ": there is no such file, or it is empty or may not be read";
    return vessel;
  }
  char message[512] = "";
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = sizeof message;
  blob_model* model = nullptr;
  const blob_status status = blob_model_open_bytes(bytes.data(), bytes.size(), &def, &model);
  vessel.model.reset(model);
  if (status != BLOB_OK) {
    vessel.problem = sentenceFor(status, path, message);
    return vessel;
  }
  const blob_model_info info = blob_model_describe(model);
  vessel.isoLevel = info.iso_level;
  vessel.nodeCount = info.node_count;
  vessel.branch = {0, static_cast<std::uint32_t>(info.node_count)};
  if (!branch.empty()) vessel.problem = findBranch(bytes, path, branch, vessel.branch);
  if (!vessel.problem.empty()) vessel.model.reset();
  return vessel;
}

std::uint32_t locate(const VesselCase& vessel, const blob_model* model, const double point[3]) {
  if (vessel.branch.count == vessel.nodeCount) return blob_cursor_locate(model, point);
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t found = BLOB_NOWHERE;
  for (std::uint32_t i = 0; i < vessel.branch.count; ++i) {
    const double here = power(blob_model_node(model, vessel.branch.first + i), point);
    if (!(here < least)) continue;
    least = here;
    found = vessel.branch.first + i;
  }
  return found;
}

}  // namespace lumensofa
