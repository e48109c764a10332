// SPDX-License-Identifier: Apache-2.0
// blob_cuda on an NVIDIA device, against blob_query_columns().
//
//   device_cuda [--points N] [--exact] [CASE...]
//
// Without a CASE: synthetic trees of each kernel, one of two vessels that touch. Prints what it
// compared, and both times. --exact: of a CASE, distances to the nearest point of the wall. Exit
// code 1: answers differ by more than blob_device.h allows; 77: there is no device.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "blob.h"
#include "blob_cuda.h"
#include "device.h"
#include "device_agreement.h"

namespace lumen::blob::test {
namespace {

using cuda_device::Column;
using cuda_device::Device;

constexpr int kSkipped = 77;

class OnDevice : public OtherProcessor {
public:
  [[nodiscard]] std::string name() const override { return "CUDA device: " + Device::get().name(); }
  void begin(const std::vector<std::uint32_t>& words, std::uint32_t flags,
             const Points& points) override {
    char reason[256] = "";
    blob_cuda_def def = blob_cuda_def_default();
    def.message = reason;
    def.message_size = sizeof reason;
    blob_cuda* vessels = nullptr;
    if (blob_cuda_create(words.data(), 4 * words.size(), &def, &vessels) != BLOB_CUDA_OK)
      throw std::runtime_error(reason);
    m_vessels.reset(vessels);
    m_flags = flags;
    m_point = Column<float>(points.xyz);
    m_cursor = Column<std::uint32_t>(points.cursor);
    // values that no answer has show what a kernel does not write
    m_answer = Column<float>(std::vector<float>(4 * points.count(), 12345.0f));
    m_value = Column<float>(std::vector<float>(4 * points.count(), 12345.0f));
    m_state = Column<std::uint32_t>(std::vector<std::uint32_t>(points.count(), 12345));
    m_columns = blob_cuda_columns_default();
    m_columns.count = static_cast<std::uint32_t>(points.count());
    m_columns.point = m_point.data();
    m_columns.cursor = m_cursor.data();
    m_columns.answer = m_answer.data();
    run();
  }
  double run() override {
    return Device::get().seconds([&] { query(); });
  }
  Answers answers() override {
    m_columns.value = m_value.data();
    m_columns.state = m_state.data();
    query();
    Answers found{m_cursor.values(), m_state.values(), {}};
    found.setNumbers(m_answer.values(), m_value.values());
    return found;
  }

private:
  struct Close {
    void operator()(blob_cuda* vessels) const { blob_cuda_close(vessels); }
  };
  void query() {
    const blob_cuda_status status =
        blob_cuda_query(m_vessels.get(), Device::get().stream(), m_flags, &m_columns);
    if (status != BLOB_CUDA_OK) throw std::runtime_error(blob_cuda_status_text(status));
  }

  std::unique_ptr<blob_cuda, Close> m_vessels;
  std::uint32_t m_flags = 0;
  Column<float> m_point, m_answer, m_value;
  Column<std::uint32_t> m_cursor, m_state;
  blob_cuda_columns m_columns{};
};

int run(int argc, char** argv) {
  Comparison wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--points") == 0 && i + 1 < argc)
      wanted.points = std::strtoull(argv[++i], nullptr, 10);
    else if (std::strcmp(argv[i], "--exact") == 0)
      wanted.exact = true;
    else
      wanted.cases.emplace_back(argv[i]);
  }
  OnDevice device;
  return compareWithLibrary(wanted, device);
}

}  // namespace
}  // namespace lumen::blob::test

int main(int argc, char** argv) {
  try {
    return lumen::blob::test::run(argc, argv);
  } catch (const lumen::cuda_device::NoDevice& none) {
    std::printf("skipped: %s\n", none.what());
    return lumen::blob::test::kSkipped;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_cuda: %s\n", error.what());
    return 1;
  }
}
