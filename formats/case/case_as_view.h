// SPDX-License-Identifier: Apache-2.0
// A case in memory as the rules and the binary encoding see it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/case/case.h"
#include "formats/view/case_view.h"

namespace lumen::formats {

/// A view of a case, with the branch records that the view points to. The case must outlive it. A
/// view cannot be copied or moved.
class CaseAsView {
public:
  explicit CaseAsView(const Case& value);
  CaseAsView(const CaseAsView&) = delete;
  CaseAsView& operator=(const CaseAsView&) = delete;
  [[nodiscard]] const CaseView& view() const { return m_view; }

private:
  std::vector<std::byte> m_records;
  std::string m_labels;
  CaseView m_view;
};

/// The content of the chunk BREC, and of BLAB.
std::vector<std::byte> branchRecords(const std::vector<Branch>& branches);
std::string joinedLabels(const std::vector<Branch>& branches);

}  // namespace lumen::formats
