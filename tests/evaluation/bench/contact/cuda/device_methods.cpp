// SPDX-License-Identifier: Apache-2.0
#include "device_methods.h"

#include <stdexcept>
#include <string>

#include "blob_cuda.h"
#include "distance_grid.h"
#include "mesh_tree.h"
#include "signed_mesh.h"

namespace lumen::bench {

extern const char kKernels[];  // PTX of rivals.cu

namespace {

using cuda_device::Column;
using cuda_device::Device;
using cuda_device::Kernels;
using cuda_device::Texture;

constexpr unsigned kThreadsOfBlock = 128;

const Kernels& rivals() {
  static const Kernels kernels(kKernels);
  return kernels;
}

class CudaBlob : public DeviceMethod {
public:
  CudaBlob(std::string name, std::uint32_t flags) : m_name(std::move(name)), m_flags(flags) {}
  [[nodiscard]] std::string name() const override { return m_name; }

  void prepare(const Vessel& vessel) override {
    m_model = vessel.model;
    std::vector<std::uint32_t> words(blob_device_pack(&m_model, 1, nullptr, 0) / 4);
    m_bytes = 4 * words.size();
    blob_device_pack(&m_model, 1, words.data(), m_bytes);
    Device::get();
    char reason[512] = "";
    blob_cuda_def def = blob_cuda_def_default();
    def.message = reason;
    def.message_size = sizeof reason;
    blob_cuda* vessels = nullptr;
    if (blob_cuda_create(words.data(), m_bytes, &def, &vessels) != BLOB_CUDA_OK)
      throw std::runtime_error(reason);
    m_vessels.reset(vessels);
  }
  void place(const Start& start) override {
    DeviceMethod::place(start);
    std::vector<std::uint32_t> cursor(start.count);
    for (std::size_t i = 0; i < start.count; ++i)
      cursor[i] = start.nodes != nullptr ? start.nodes[i]
                                         : blob_cursor_locate(m_model, start.points + 3 * i);
    m_cursor = Column<std::uint32_t>(cursor);
  }
  void step(const float* points, std::size_t count) override {
    blob_cuda_columns columns = blob_cuda_columns_default();
    columns.count = static_cast<std::uint32_t>(count);
    columns.point = points;
    columns.cursor = m_cursor.data();
    columns.answer = answer();
    if (blob_cuda_query(m_vessels.get(), Device::get().stream(), m_flags, &columns) != BLOB_CUDA_OK)
      throw std::runtime_error("blob_cuda_query() fails");
  }
  [[nodiscard]] double megabytes() const override { return static_cast<double>(m_bytes) * 1e-6; }

private:
  struct Close {
    void operator()(blob_cuda* vessels) const { blob_cuda_close(vessels); }
  };
  std::string m_name;
  std::uint32_t m_flags;
  const blob_model* m_model = nullptr;
  std::size_t m_bytes = 0;
  std::unique_ptr<blob_cuda, Close> m_vessels;
  Column<std::uint32_t> m_cursor;
};

class CudaMesh : public DeviceMethod {
public:
  explicit CudaMesh(bool coherent) : m_coherent(coherent) {}
  [[nodiscard]] std::string name() const override {
    return m_coherent ? "tree of boxes, coherent" : "tree of boxes";
  }
  void prepare(const Vessel& vessel) override {
    SignedMesh normals;
    normals.prepare(vessel.mesh);
    const MeshTree tree(vessel.mesh, normals);
    m_megabytes = tree.megabytes();
    m_node = Column<Float4>(tree.node);
    m_corner = Column<Float4>(tree.corner);
    m_normal = Column<Float4>(tree.normal);
  }
  void place(const Start& start) override {
    DeviceMethod::place(start);
    constexpr float kFar = 1e15f;
    if (m_coherent) m_last = Column<Float4>(std::vector<Float4>(start.count, {0, 0, 0, kFar}));
  }
  void step(const float* points, std::size_t count) override {
    rivals().launch("nearest_in_mesh", count, kThreadsOfBlock, m_node.data(), m_corner.data(),
                    m_normal.data(), static_cast<std::uint32_t>(count), points, m_last.data(),
                    answer());
  }
  [[nodiscard]] double megabytes() const override { return m_megabytes; }

private:
  bool m_coherent;
  double m_megabytes = 0;
  Column<Float4> m_node, m_corner, m_normal, m_last;
};

class CudaGrid : public DeviceMethod {
public:
  [[nodiscard]] std::string name() const override { return "texture, " + inMm(m_grid.cell); }
  void prepare(const Vessel& vessel) override {
    m_grid = DistanceGrid(vessel);
    m_megabytes = static_cast<double>(m_grid.value.size() * sizeof(float)) * 1e-6;
    m_texture = std::make_unique<Texture>(m_grid.size, m_grid.value.data());
    m_grid.value = {};
  }
  void step(const float* points, std::size_t count) override {
    rivals().launch("sample_grid", count, kThreadsOfBlock, m_texture->handle(),
                    static_cast<float>(m_grid.low[0]), static_cast<float>(m_grid.low[1]),
                    static_cast<float>(m_grid.low[2]), static_cast<float>(1 / m_grid.cell),
                    static_cast<std::uint32_t>(count), points, answer());
  }
  [[nodiscard]] double megabytes() const override { return m_megabytes; }

private:
  DistanceGrid m_grid;  // without values
  double m_megabytes = 0;
  std::unique_ptr<Texture> m_texture;
};

}  // namespace

void DeviceMethod::place(const Start& start) {
  m_point = Column<float>(3 * start.count);
  m_answer = Column<float>(4 * start.count);
}

void DeviceMethod::query(std::size_t first, const double* points, std::size_t count,
                         const Answers& answers) {
  if (first != 0) throw std::runtime_error("a device answers points from the first on");
  std::vector<float> xyz(m_point.count());
  for (std::size_t i = 0; i < 3 * count; ++i) xyz[i] = static_cast<float>(points[i]);
  m_point.set(xyz.data());
  step(m_point.data(), count);
  const std::vector<float> rows = m_answer.values();
  for (std::size_t i = 0; i < count; ++i) {
    answers.distance[i] = static_cast<double>(rows[4 * i]);
    if (answers.normal[0] == nullptr) continue;
    for (std::size_t k = 0; k < 3; ++k)
      answers.normal[k][i] = static_cast<double>(rows[4 * i + 1 + k]);
  }
}

std::unique_ptr<DeviceMethod> cudaBlob(std::string name, std::uint32_t flags) {
  return std::make_unique<CudaBlob>(std::move(name), flags);
}

std::unique_ptr<DeviceMethod> cudaMesh(bool coherent) {
  return std::make_unique<CudaMesh>(coherent);
}

std::unique_ptr<DeviceMethod> cudaGrid() {
  return std::make_unique<CudaGrid>();
}

}  // namespace lumen::bench
