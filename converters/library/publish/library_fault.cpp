// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/library_fault.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

constexpr std::array<std::pair<FaultCode, const char*>, 24> kNames = {{
    {FaultCode::LibraryFile, "LIBRARY_FILE"},
    {FaultCode::LibraryIdTwice, "LIBRARY_ID_TWICE"},
    {FaultCode::LibraryOrder, "LIBRARY_ORDER"},
    {FaultCode::LibraryLicence, "LIBRARY_LICENCE"},
    {FaultCode::LibraryConsent, "LIBRARY_CONSENT"},
    {FaultCode::RecordFile, "RECORD_FILE"},
    {FaultCode::RecordDigest, "RECORD_DIGEST"},
    {FaultCode::RecordCase, "RECORD_CASE"},
    {FaultCode::FileMissing, "FILE_MISSING"},
    {FaultCode::FileAltered, "FILE_ALTERED"},
    {FaultCode::FileUnlisted, "FILE_UNLISTED"},
    {FaultCode::FilePath, "FILE_PATH"},
    {FaultCode::FileKind, "FILE_KIND"},
    {FaultCode::FileUnreadable, "FILE_UNREADABLE"},
    {FaultCode::CaseInvalid, "CASE_INVALID"},
    {FaultCode::CaseFigures, "CASE_FIGURES"},
    {FaultCode::Privacy, "PRIVACY"},
    {FaultCode::Bag, "BAG"},
    {FaultCode::Crate, "CRATE"},
    {FaultCode::SignatureMissing, "SIGNATURE_MISSING"},
    {FaultCode::SignatureKey, "SIGNATURE_KEY"},
    {FaultCode::SignatureBroken, "SIGNATURE_BROKEN"},
    {FaultCode::RevisionOlder, "REVISION_OLDER"},
    {FaultCode::RevisionOther, "REVISION_OTHER"},
}};

}  // namespace

const char* faultName(FaultCode code) {
  const auto* const found = std::find_if(kNames.begin(), kNames.end(),
                                         [code](const auto& name) { return name.first == code; });
  return found == kNames.end() ? "UNKNOWN" : found->second;
}

formats::Severity severityOf(FaultCode code) {
  return code == FaultCode::Privacy ? formats::Severity::Warning : formats::Severity::Error;
}

std::string LibraryFault::text() const {
  const std::string name =
      std::string(faultName(code)) + " (" + std::to_string(static_cast<int>(code)) + "): ";
  if (expected.empty()) return formats::printable(name + found);
  return formats::printable(name + "found " + found + ", expected " + expected);
}

}  // namespace lumen::convert
