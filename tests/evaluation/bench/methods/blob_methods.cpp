// SPDX-License-Identifier: Apache-2.0
#include "method.h"

namespace lumen::bench {
namespace {

// Tool points as rows that a query reads.
const double (*rows(const double* points))[3] {
  return reinterpret_cast<const double(*)[3]>(points);
}

class BlobMethod : public Method {
public:
  BlobMethod(std::string name, std::uint32_t flags, BlobCall call)
      : m_name(std::move(name)), m_flags(flags), m_call(call) {}
  [[nodiscard]] std::string name() const override { return m_name; }
  void prepare(const Vessel& vessel) override { m_model = vessel.model; }

  void place(const Start& start) override {
    m_cursor.clear();
    for (std::size_t i = 0; i < start.count; ++i)
      m_cursor.push_back(start.nodes != nullptr
                             ? start.nodes[i]
                             : blob_cursor_locate(m_model, start.points + 3 * i));
    if (m_call != BlobCall::Columns) m_sample.resize(start.count);
  }

  void query(std::size_t first, const double* points, std::size_t count,
             const Answers& answers) override {
    if (m_call == BlobCall::Columns) return queryColumns(first, points, count, answers);
    blob_sample* samples = m_sample.data() + first;
    if (m_call == BlobCall::Single)
      for (std::size_t i = 0; i < count; ++i)
        blob_query(m_model, m_flags, points + 3 * i, &m_cursor[first + i], samples + i);
    else
      blob_query_many(m_model, m_flags, count, rows(points), m_cursor.data() + first, samples);
    for (std::size_t i = 0; i < count; ++i) answers.distance[i] = samples[i].distance;
    if (answers.normal[0] == nullptr) return;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) answers.normal[k][i] = samples[i].normal[k];
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(blob_model_describe(m_model).bytes) * 1e-6;
  }
  [[nodiscard]] int passes() const override {
    return (m_flags & BLOB_DISTANCE_EXACT) != 0 ? 20 : 200;
  }

private:
  // Distances and normals straight to where they are wanted.
  void queryColumns(std::size_t first, const double* points, std::size_t count,
                    const Answers& answers) {
    blob_columns columns = blob_columns_default();
    columns.count = count;
    for (std::size_t k = 0; k < 3; ++k) columns.point[k] = points + k;
    columns.point_stride = 3 * sizeof(double);
    columns.cursor = m_cursor.data() + first;
    columns.distance = answers.distance;
    for (std::size_t k = 0; k < 3; ++k) columns.normal[k] = answers.normal[k];
    blob_query_columns(m_model, m_flags, &columns);
  }

  std::string m_name;
  std::uint32_t m_flags;
  BlobCall m_call;
  const blob_model* m_model = nullptr;
  std::vector<std::uint32_t> m_cursor;
  std::vector<blob_sample> m_sample;
};

// The inside test: what it cannot give counts as distance -1 or 1.
class BlobInside : public Method {
public:
  [[nodiscard]] std::string name() const override { return "libblob inside"; }
  void prepare(const Vessel& vessel) override { m_model = vessel.model; }
  void place(const Start& start) override { m_cursor.assign(start.count, BLOB_NOWHERE); }
  void query(std::size_t first, const double* points, std::size_t count,
             const Answers& answers) override {
    for (std::size_t i = 0; i < count; ++i)
      answers.distance[i] =
          blob_inside(m_model, BLOB_LOCAL, points + 3 * i, &m_cursor[first + i]) != 0 ? -1.0 : 1.0;
  }

private:
  const blob_model* m_model = nullptr;
  std::vector<std::uint32_t> m_cursor;
};

// The global search, which gives a node and no distance.
class BlobLocate : public Method {
public:
  [[nodiscard]] std::string name() const override { return "libblob locate"; }
  void prepare(const Vessel& vessel) override { m_model = vessel.model; }
  void query(std::size_t, const double* points, std::size_t count,
             const Answers& answers) override {
    for (std::size_t i = 0; i < count; ++i)
      answers.distance[i] = blob_cursor_locate(m_model, points + 3 * i);
  }

private:
  const blob_model* m_model = nullptr;
};

}  // namespace

std::unique_ptr<Method> blobMethod(std::string name, std::uint32_t flags, BlobCall call) {
  return std::make_unique<BlobMethod>(std::move(name), flags, call);
}

void addBlobMethods(Methods& methods) {
  methods.push_back(blobMethod("libblob EXACT", BLOB_DISTANCE_EXACT, BlobCall::Samples));
  methods.push_back(blobMethod("libblob LOCAL", BLOB_LOCAL, BlobCall::Samples));
  methods.push_back(blobMethod("libblob LOCAL, single", BLOB_LOCAL, BlobCall::Single));
  methods.push_back(blobMethod("libblob BLENDED", BLOB_BLENDED, BlobCall::Samples));
  methods.push_back(blobMethod("libblob BLENDED, single", BLOB_BLENDED, BlobCall::Single));
  methods.push_back(std::make_unique<BlobInside>());
  methods.push_back(std::make_unique<BlobLocate>());
}

}  // namespace lumen::bench
