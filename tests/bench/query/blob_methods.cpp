// SPDX-License-Identifier: Apache-2.0
#include "method.h"

namespace lumen::bench {
namespace {

class BlobMethod : public Method {
public:
  BlobMethod(std::string name, std::uint32_t flags, bool single)
      : m_name(std::move(name)), m_flags(flags), m_single(single) {}
  [[nodiscard]] std::string name() const override { return m_name; }

  void prepare(const Surface& surface) override {
    m_model = surface.model;
    m_cursor.clear();
    for (std::size_t i = 0; i < surface.toolPoints; ++i)
      m_cursor.push_back(blob_cursor_locate(m_model, &surface.points[3 * i]));
    m_sample.resize(surface.toolPoints);
  }

  void query(const double* points, std::size_t count, double* distances) override {
    if (m_single)
      for (std::size_t i = 0; i < count; ++i)
        blob_query(m_model, m_flags, points + 3 * i, &m_cursor[i], &m_sample[i]);
    else
      blob_query_many(m_model, m_flags, count, reinterpret_cast<const double(*)[3]>(points),
                      m_cursor.data(), m_sample.data());
    for (std::size_t i = 0; i < count; ++i) distances[i] = m_sample[i].distance;
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(blob_model_describe(m_model).bytes) * 1e-6;
  }
  [[nodiscard]] int passes() const override {
    return (m_flags & BLOB_DISTANCE_EXACT) != 0 ? 20 : 200;
  }

private:
  std::string m_name;
  std::uint32_t m_flags;
  bool m_single;
  const blob_model* m_model = nullptr;
  std::vector<std::uint32_t> m_cursor;
  std::vector<blob_sample> m_sample;
};

// The inside test: what it cannot give counts as distance -1 or 1.
class BlobInside : public Method {
public:
  [[nodiscard]] std::string name() const override { return "libblob inside"; }
  void prepare(const Surface& surface) override {
    m_model = surface.model;
    m_cursor.assign(surface.toolPoints, BLOB_NOWHERE);
  }
  void query(const double* points, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i)
      distances[i] =
          blob_inside(m_model, BLOB_LOCAL, points + 3 * i, &m_cursor[i]) != 0 ? -1.0 : 1.0;
  }

private:
  const blob_model* m_model = nullptr;
  std::vector<std::uint32_t> m_cursor;
};

// The global search, which gives a node and no distance.
class BlobLocate : public Method {
public:
  [[nodiscard]] std::string name() const override { return "libblob locate"; }
  void prepare(const Surface& surface) override { m_model = surface.model; }
  void query(const double* points, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i)
      distances[i] = blob_cursor_locate(m_model, points + 3 * i);
  }

private:
  const blob_model* m_model = nullptr;
};

}  // namespace

void addBlobMethods(Methods& methods) {
  const auto add = [&](const char* name, std::uint32_t flags, bool single) {
    methods.push_back(std::make_unique<BlobMethod>(name, flags, single));
  };
  add("libblob EXACT", BLOB_DISTANCE_EXACT, false);
  add("libblob LOCAL", BLOB_LOCAL, false);
  add("libblob LOCAL, single", BLOB_LOCAL, true);
  add("libblob BLENDED", BLOB_BLENDED, false);
  add("libblob BLENDED, single", BLOB_BLENDED, true);
  methods.push_back(std::make_unique<BlobInside>());
  methods.push_back(std::make_unique<BlobLocate>());
}

}  // namespace lumen::bench
