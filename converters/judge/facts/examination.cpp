// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/facts/examination.h"

#include <optional>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/privacy.h"
#include "converters/base/text.h"
#include "converters/io/content/file_content.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/judge/facts/reachable.h"

namespace lumen::convert {

namespace {

using formats::ErrorCode;
using formats::Issue;
using formats::ValidationReport;

// not rules of the format: see spec/errors.md
constexpr int kClosedEdge = 651, kSeedsUnreadable = 653;

Remark remarkOf(const Issue& issue) {
  return {formats::errorName(issue.code),
          static_cast<int>(issue.code),
          formats::severityName(formats::severityOf(issue.code)),
          issue.offset,
          issue.pointer,
          issue.arguments,
          issue.message,
          issue.text()};
}

Remark remarkOf(const PrivacyFinding& finding) {
  const std::string code(finding.code);
  return {code,
          finding.number,
          formats::severityName(formats::Severity::Warning),
          std::nullopt,
          finding.pointer,
          {{"found", finding.found}},
          finding.message,
          code + " at " + finding.pointer + ": " + finding.message};
}

Remark remarkOf(const ClosedPath& path) {
  const std::string code = "CLOSED_EDGE", pointer = "/tree/parent/" + std::to_string(path.node);
  const std::string message = closedText(path) + "; lumen fit may open it";
  return {code,
          kClosedEdge,
          formats::severityName(formats::Severity::Warning),
          std::nullopt,
          pointer,
          {{"found", fixedText(path.beyond, 1)}},
          message,
          code + " at " + pointer + ": " + message};
}

/// The remark on seeds that cannot be read, if there are any.
std::optional<Remark> seedsRemark(const formats::Case& value) {
  try {
    (void)seedsOf(value, "the case");
    return std::nullopt;
  } catch (const Error& error) {
    Remark remark;
    remark.code = "SEEDS";
    remark.number = kSeedsUnreadable;
    remark.severity = formats::severityName(formats::Severity::Warning);
    remark.message = error.what();
    remark.text = remark.code + " at file: " + remark.message;
    return remark;
  }
}

/// The issue; its message names the file's kind if that is another than a case.
Issue named(Issue issue, const std::string& file) {
  const std::string other = notA(ContentKind::Case, file);
  if (!other.empty()) issue.message = other;
  return issue;
}

}  // namespace

FileReport examine(const InputFile& file, std::size_t maxIssues, bool privacy,
                   const Progress& progress) {
  if (file.isInMemory()) {
    const std::string text = file.read("case file", kAnySize);
    return examineBytes(std::as_bytes(std::span(text)), file.name(), maxIssues, privacy, progress);
  }
  const auto bytes = formats::readFileBytes(file.path());
  if (!bytes) {
    FileReport unread{false, false, false, {1, 0, 0}, {}};
    if (maxIssues > 0) unread.remarks.push_back(remarkOf(bytes.error()));
    return unread;
  }
  return examineBytes(*bytes, file.name(), maxIssues, privacy, progress);
}

FileReport examineBytes(std::span<const std::byte> bytes, const std::string& file,
                        std::size_t maxIssues, bool privacy, const Progress& progress) {
  const ValidationReport report = formats::validateBytes(bytes, maxIssues);
  FileReport result{report.valid(), false, false, report.counts, {}};
  for (const Issue& issue : report.issues)
    result.remarks.push_back(
        remarkOf(issue.code == ErrorCode::NotLumen ? named(issue, file) : issue));
  const auto addWarning = [&](Remark remark) {
    ++result.counts.warnings;
    if (result.remarks.size() < maxIssues) result.remarks.push_back(std::move(remark));
  };
  const auto warn = [&](const auto& finding) { addWarning(remarkOf(finding)); };
  if (result.valid) {
    if (const auto value = formats::decodeCase(bytes)) {
      if (auto remark = seedsRemark(*value)) addWarning(*std::move(remark));
      if (const auto reach = measureReach(*value, progress))
        for (const ClosedPath& path : reach->closed) warn(path);
    }
  }
  if (!privacy) return result;
  for (const PrivacyFinding& finding : scanPrivacy(bytes)) {
    result.personal = true;
    warn(finding);
  }
  return result;
}

}  // namespace lumen::convert
