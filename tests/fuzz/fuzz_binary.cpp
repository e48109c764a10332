// SPDX-License-Identifier: Apache-2.0
// The binary encoding, as it came and with its checksums made right: all readers of it agree.
#include "formats/case/case_file.h"
#include "formats/view/case_view.h"
#include "fuzz/fuzz_support.h"

namespace {

using namespace lumen::formats;
using lumen::fuzz::expect;

void readEveryWay(std::span<const std::byte> bytes) {
  const auto decoded = decodeBinary(bytes);
  constexpr std::size_t kMaxIssues = 5;
  const ValidationReport report = validateBytes(bytes, kMaxIssues);
  expect(report.valid() == static_cast<bool>(decoded) || !hasContainerMagic(bytes),
         "the validator and the reader accept the same files");
  expect(report.issues.size() <= kMaxIssues, "no more issues than were asked for");
  const auto whole = viewCase(bytes, Verify::All);
  const auto structure = viewCase(bytes, Verify::Structure);
  expect(static_cast<bool>(structure) || !whole, "what is all right has a right structure");
  if (structure)
    for (std::size_t i = 0; i < structure->branchCount(); ++i)
      (void)structure->label(structure->branch(i));
  if (!decoded) return;
  expect(static_cast<bool>(validate(*decoded)), "what was read obeys the rules");
  if (whole) expect(whole->nodeCount() == decoded->tree.nodeCount(), "the view has all nodes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = lumen::fuzz::bytesOf(data, size);
  std::vector<std::byte> file(bytes.begin(), bytes.end());  // aligned, which a view needs
  readEveryWay(file);
  lumen::fuzz::resign(file);
  readEveryWay(file);
  return 0;
}
