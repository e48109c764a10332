// SPDX-License-Identifier: Apache-2.0
#include "formats/view/case_view.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "formats/container/bytes.h"
#include "unit/formats/allocation_meter.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;
using test::dataOf;
using test::entryOf;
using test::tamperedFull;

std::string codeOf(const Bytes& file, Verify verify) {
  const auto view = viewCase(file, verify);
  return view ? "OK" : errorName(view.error().code);
}

TEST(CaseView, LeadsToTheBytesOfTheFile) {
  const Bytes file = encodeBinary(test::fullCase());
  const auto view = viewCase(file, Verify::All);
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ(static_cast<const void*>(view->nodeCentre.data()), &file[dataOf(file, "NCEN")]);
  EXPECT_EQ(static_cast<const void*>(view->models->width.data()), &file[dataOf(file, "MWID")]);
}

TEST(CaseView, HasWhatTheCaseHas) {
  const Case value = test::fullCase();
  const Bytes file = encodeBinary(value);
  const auto view = viewCase(file, Verify::Structure);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->nodeCount(), 6u);
  EXPECT_EQ(view->nodeCentre[5][2], value.tree.centre[5].z);
  EXPECT_TRUE(std::ranges::equal(view->nodeRadius, value.tree.radius));
  EXPECT_TRUE(std::ranges::equal(view->nodeParent, value.tree.parent));
  EXPECT_TRUE(std::ranges::equal(view->nodeInlierRate, value.tree.inlierRate));
  EXPECT_TRUE(std::ranges::equal(view->links, value.tree.links));
  EXPECT_TRUE(std::ranges::equal(view->pointOffset, value.points->offset));
  EXPECT_EQ(view->models->kernel, 0);
  EXPECT_EQ(view->models->kernelParameter, 0.2);
  EXPECT_EQ(view->models->isoLevel, 0.1);
  EXPECT_TRUE(std::ranges::equal(view->models->width, value.models->width));
  EXPECT_EQ(view->nodeArrays.size(), 2u);
  EXPECT_TRUE(view->metadata.starts_with("{\"coordinateSystem\""));
}

TEST(CaseView, GivesBranchesAndLabels) {
  const Bytes file = encodeBinary(test::fullCase());
  const auto view = viewCase(file, Verify::Structure);
  ASSERT_TRUE(view);
  ASSERT_EQ(view->branchCount(), 3u);
  const BranchView dome = view->branch(2);
  EXPECT_EQ(view->label(dome), "dome");
  EXPECT_EQ(dome.firstNode, 5u);
  EXPECT_EQ(dome.parentNode, 2);
  EXPECT_EQ(dome.kind, 1);
  EXPECT_EQ(view->branch(1).meanInlierRate, kNoRate);
}

TEST(CaseView, OfATreeAloneHasNoPointsAndModels) {
  const Bytes file = encodeBinary(test::smallestCase());
  const auto view = viewCase(file, Verify::All);
  ASSERT_TRUE(view);
  EXPECT_FALSE(view->hasPoints);
  EXPECT_TRUE(view->pointOffset.empty());
  EXPECT_FALSE(view->models.has_value());
}

TEST(CaseView, OfTheStructureDoesNotLookAtValues) {
  const Bytes file = tamperedFull([](Bytes& f) { storeLittle(&f[dataOf(f, "NRAD")], -1.0f); });
  EXPECT_EQ(codeOf(file, Verify::Structure), "OK");
  const auto all = viewCase(file, Verify::All);
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().code, ErrorCode::RadiusRange);
  EXPECT_EQ(all.error().offset, dataOf(file, "NRAD"));
  EXPECT_EQ(all.error().pointer, "/tree/radius/0");
}

TEST(CaseView, OfTheStructureDoesNotVerifyChecksums) {
  Bytes file = encodeBinary(test::fullCase());
  file[dataOf(file, "PPOS")] ^= std::byte{1};
  EXPECT_EQ(codeOf(file, Verify::Structure), "OK");
  EXPECT_EQ(codeOf(file, Verify::All), "CHUNK_CHECKSUM");
}

TEST(CaseView, IsRefusedIfAnArrayHasNotOneEntryPerNode) {
  const Bytes file = tamperedFull([](Bytes& f) {
    const std::size_t entry = entryOf(f, "NRAD");
    std::fill_n(f.begin() + static_cast<std::ptrdiff_t>(dataOf(f, "NRAD") + 20), 4, std::byte{0});
    storeLittle(&f[entry + 16], std::uint64_t{20});
    storeLittle(&f[entry + 24], std::uint64_t{20});
  });
  EXPECT_EQ(codeOf(file, Verify::Structure), "CHUNK_LENGTH");
}

TEST(CaseView, ChecksTheKernelEvenOfTheStructure) {
  const auto withKernel = [](std::uint8_t kernel) {
    return tamperedFull([kernel](Bytes& f) { storeLittle(&f[dataOf(f, "MKER")], kernel); });
  };
  const Bytes noParameter =
      tamperedFull([](Bytes& f) { storeLittle(&f[dataOf(f, "MKER") + 8], 0.0); });
  EXPECT_EQ(codeOf(withKernel(9), Verify::Structure), "ENUM_VALUE");
  EXPECT_EQ(codeOf(noParameter, Verify::Structure), "KERNEL_PARAMETER");
  EXPECT_EQ(codeOf(withKernel(3), Verify::Structure), "OK");
}

TEST(CaseView, IsRefusedForBytesThatAreNotAligned) {
  const Bytes file = encodeBinary(test::smallestCase());
  Bytes moved(1);
  moved.insert(moved.end(), file.begin(), file.end());
  const auto view = viewCase(std::span(moved).subspan(1), Verify::Structure);
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().code, ErrorCode::ViewMemory);
}

TEST(CaseView, IsRefusedWhereverTheDecoderRefusesTheModel) {
  for (std::size_t at = 64; at < encodeBinary(test::fullCase()).size(); ++at) {
    const Bytes file = tamperedFull([at](Bytes& f) { f[at] ^= std::byte{0xff}; });
    const bool seen = static_cast<bool>(viewCase(file, Verify::All));
    const auto decoded = decodeBinary(file);
    if (decoded) {
      EXPECT_TRUE(seen) << at;
    } else if (seen) {
      // the decoder alone looks into the metadata, node arrays and other chunks
      const std::string code = test::codeOf(decoded);
      const std::string place = decoded.error().pointer.value_or("");
      EXPECT_TRUE(code.starts_with("JSON") || place.starts_with("/metadata") ||
                  place.starts_with("/nodeArrays") || code == "CHUNK_LENGTH" ||
                  code == "CHUNK_MISSING")
          << at << " " << decoded.error().text();
    }
  }
}

// A file in memory whose pages can be made unreadable.
class Pages {
public:
  explicit Pages(const Bytes& file) : m_size(file.size()) {
    m_data = static_cast<std::byte*>(
        ::mmap(nullptr, m_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    std::copy(file.begin(), file.end(), m_data);
  }
  ~Pages() { ::munmap(m_data, m_size); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  [[nodiscard]] std::span<const std::byte> bytes() const { return {m_data, m_size}; }
  void protect(std::size_t page, int protection) const {
    ASSERT_EQ(::mprotect(m_data + page * size(), 1, protection), 0);
  }
  static std::size_t size() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

private:
  std::size_t m_size;
  std::byte* m_data;
};

TEST(CaseView, TouchesTheTableAndTheKernelRecordsOfALargeCaseAndNoOtherPage) {
  const Bytes file = encodeBinary(test::longCase(10000, 20, 6));
  const Pages pages(file);
  for (std::size_t page = 1; page < file.size() / Pages::size(); ++page)
    if (page != dataOf(file, "MKER") / Pages::size()) pages.protect(page, PROT_NONE);
  const auto view = viewCase(pages.bytes(), Verify::Structure);  // ends the test program if it does
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ(view->nodeCount(), 10000u);
}

TEST(CaseView, AsksForNoMemoryThatGrowsWithTheCase) {
  const auto allocated = [](std::size_t nodes) {
    const Bytes file = encodeBinary(test::longCase(nodes, 4, 3));
    test::startMeter();
    EXPECT_TRUE(viewCase(file, Verify::Structure));
    return test::peakBytes();
  };
  EXPECT_EQ(allocated(10), allocated(10000));
}

}  // namespace
}  // namespace lumen::formats
