// SPDX-License-Identifier: Apache-2.0
// The floor: f and grad f of eight Cauchy blobs at a point, and nothing else, in a loop. Which
// blobs is known beforehand; points are floats; no cursor, no distance, no normal.
#include "method.h"

#if defined(__x86_64__)
#include <immintrin.h>
#define LUMEN_FLOOR_TARGET __attribute__((target("avx2")))
#endif

namespace lumen::bench {
namespace {

#if defined(__x86_64__)
struct alignas(32) Block {
  float x[8], y[8], z[8], a[8], w[8];
};

LUMEN_FLOOR_TARGET inline void kernel(const Block& b, const float* p, float* out) {
  const __m256 x = _mm256_sub_ps(_mm256_set1_ps(p[0]), _mm256_load_ps(b.x));
  const __m256 y = _mm256_sub_ps(_mm256_set1_ps(p[1]), _mm256_load_ps(b.y));
  const __m256 z = _mm256_sub_ps(_mm256_set1_ps(p[2]), _mm256_load_ps(b.z));
  const __m256 a = _mm256_load_ps(b.a);
  const __m256 square =
      _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
  const __m256 one = _mm256_set1_ps(1);
  const __m256 q = _mm256_div_ps(one, _mm256_add_ps(one, _mm256_mul_ps(a, square)));
  const __m256 f = _mm256_mul_ps(_mm256_load_ps(b.w), _mm256_mul_ps(q, q));
  const __m256 s = _mm256_mul_ps(_mm256_mul_ps(a, _mm256_set1_ps(-4)), _mm256_mul_ps(f, q));
  const __m256 gx = _mm256_mul_ps(s, x), gy = _mm256_mul_ps(s, y), gz = _mm256_mul_ps(s, z);
  const __m256 fx = _mm256_add_ps(_mm256_unpacklo_ps(f, gx), _mm256_unpackhi_ps(f, gx));
  const __m256 yz = _mm256_add_ps(_mm256_unpacklo_ps(gy, gz), _mm256_unpackhi_ps(gy, gz));
  const __m256 r = _mm256_add_ps(_mm256_shuffle_ps(fx, yz, 0x44), _mm256_shuffle_ps(fx, yz, 0xEE));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(r), _mm256_extractf128_ps(r, 1)));
}

class Floor : public Method {
public:
  [[nodiscard]] std::string name() const override { return "floor: bare kernel"; }

  void prepare(const Vessel& vessel) override {
    m_model = vessel.model;
    m_block.resize(blob_model_describe(m_model).node_count);
    for (Block& block : m_block)
      for (int i = 0; i < 8; ++i) {
        block.x[i] = 0.1f * static_cast<float>(i);
        block.y[i] = block.z[i] = 0;
        block.a[i] = 0.5f;
        block.w[i] = 0.3f;
      }
  }

  void place(const Start& start) override {
    m_node.clear();
    m_points.clear();
    for (std::size_t i = 0; i < start.count; ++i) {
      m_node.push_back(blob_cursor_locate(m_model, start.points + 3 * i));
      for (std::size_t k = 0; k < 3; ++k)
        m_points.push_back(0.01f * static_cast<float>(i) * static_cast<float>(k + 1));
    }
    m_out.resize(4 * start.count);
  }

  void query(std::size_t, const double*, std::size_t count, const Answers& answers) override {
    run(count);
    answers.distance[0] = static_cast<double>(m_out[0]);
  }

private:
  LUMEN_FLOOR_TARGET void run(std::size_t count) {
    const Block* blocks = m_block.data();
    const std::uint32_t* node = m_node.data();
    const float* points = m_points.data();
    float* out = m_out.data();
    for (std::size_t i = 0; i < count; ++i) kernel(blocks[node[i]], points + 3 * i, out + 4 * i);
  }

  const blob_model* m_model = nullptr;
  std::vector<Block> m_block;
  std::vector<std::uint32_t> m_node;
  std::vector<float> m_points, m_out;
};
#endif

}  // namespace

void addFloor(Methods& methods) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) methods.push_back(std::make_unique<Floor>());
#else
  static_cast<void>(methods);
#endif
}

}  // namespace lumen::bench
