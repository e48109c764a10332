// SPDX-License-Identifier: Apache-2.0
// The C boundary.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

#include "answer.h"
#include "boundary.h"
#include "build_model.h"
#include "columns.h"
#include "hessian.h"
#include "locate.h"
#include "nearest.h"
#include "open_case.h"
#include "segment.h"
#include "simd/backend.h"

namespace {

using namespace lumen::blob;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kModelCookie = 0x626c6f32U;

std::atomic<blob_misuse_handler> g_misuseHandler{nullptr};

// A batch whose points and cursors have been copied: answers may be written over points.
struct ExactBatch {
  static constexpr std::size_t kMostPoints = kMostRefined;
  double point[kMostPoints][3];
  std::uint32_t cursor[kMostPoints];
  blob_sample sample[kMostPoints];
  bool inRange[kMostPoints];

  void read(const blob_columns& c, std::size_t first, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k)
        std::memcpy(&point[i][k], column(c.point[k], first + i, c.point_stride), sizeof(double));
      cursor[i] = BLOB_NOWHERE;
      if (c.cursor != nullptr)
        std::memcpy(&cursor[i], column(c.cursor, first + i, c.cursor_stride), sizeof cursor[i]);
    }
  }

  void answer(const blob_model& model, std::uint32_t flags, std::size_t count) noexcept {
    Job job{packedColumns(count, point, cursor), sample, inRange};
    model.backend->query(model, flags, job);
    refineSamples(model, flags, count, point, inRange, sample);
  }

  void write(const Job& job, std::size_t first, std::size_t count) const noexcept {
    const blob_columns& c = job.columns;
    for (std::size_t i = 0; i < count; ++i) {
      if (c.cursor != nullptr) put(c.cursor, first + i, c.cursor_stride, cursor[i]);
      if (job.samples != nullptr)
        job.samples[first + i] = sample[i];
      else
        putSample(c, first + i, sample[i]);
    }
  }
};

void queryExact(const blob_model& model, std::uint32_t flags, const Job& job) noexcept {
  ExactBatch batch;
  for (std::size_t first = 0; first < job.columns.count; first += ExactBatch::kMostPoints) {
    const std::size_t count = std::min(job.columns.count - first, ExactBatch::kMostPoints);
    batch.read(job.columns, first, count);
    batch.answer(model, flags, count);
    batch.write(job, first, count);
  }
}

void queryJob(const blob_model& model, std::uint32_t flags, const Job& job) noexcept {
  if ((flags & BLOB_DISTANCE_EXACT) != 0)
    queryExact(model, flags, job);
  else
    model.backend->query(model, flags, job);
}

bool hasNan(const double* p) noexcept {
  return std::isnan(p[0]) || std::isnan(p[1]) || std::isnan(p[2]);
}

void fill(double* values, int count, double value) noexcept {
  for (int i = 0; i < count; ++i) values[i] = value;
}

}  // namespace

void lumen::blob::reportMisuse(const char* condition, const char* file, int line) noexcept {
  if (const blob_misuse_handler handler = g_misuseHandler.load())
    handler(condition, file, line);
  else
    std::abort();
}

extern "C" {

const char* blob_status_text(blob_status status) noexcept {
  switch (status) {
    case BLOB_OK:
      return "done";
    case BLOB_ERROR_MEMORY:
      return "the system has no more memory";
    case BLOB_ERROR_ARGUMENT:
      return "a pointer is null, or the definition was not made by its default function";
    case BLOB_ERROR_FILE:
      return "the file cannot be opened or read, or is empty";
    case BLOB_ERROR_FORMAT:
      return "the bytes are not a .lumen file, or break a rule of the format";
    case BLOB_ERROR_CHECKSUM:
      return "the bytes do not match their checksum";
    case BLOB_ERROR_ENCODING:
      return "a chunk that is needed is stored compressed";
    case BLOB_ERROR_NO_MODELS:
      return "the case has no models";
    case BLOB_ERROR_EMPTY:
      return "there is no node";
    case BLOB_ERROR_LIMIT:
      return "there are more nodes, blobs or links than the limits allow";
    case BLOB_ERROR_RANGE:
      return "a number is not finite or out of its range";
    case BLOB_ERROR_TOPOLOGY:
      return "a parent, link or offset names what does not exist";
    case BLOB_ERROR_KERNEL:
      return "there is no such kernel";
    case BLOB_ERROR_NO_MOTION:
      return "the case has no motion";
  }
  return "unknown status";
}

blob_open_def blob_open_def_default(void) noexcept {
  return {1, BLOB_SIMD_BEST, nullptr, 0, kOpenCookie};
}

blob_model_def blob_model_def_default(void) noexcept {
  blob_model_def def{};
  def.blobs.kernel = BLOB_CAUCHY;
  def.blobs.kernel_parameter = 0.2;
  def.blobs.iso_level = 0.1;
  def.simd = BLOB_SIMD_BEST;
  def.cookie = kModelCookie;
  return def;
}

blob_columns blob_columns_default(void) noexcept {
  blob_columns columns{};
  columns.point_stride = sizeof(double);
  columns.cursor_stride = sizeof(std::uint32_t);
  columns.answer_stride = sizeof(double);
  columns.state_stride = 1;
  return columns;
}

blob_status blob_model_open(const char* path, const blob_open_def* def,
                            blob_model** model) noexcept {
  const blob_open_def used = def != nullptr ? *def : blob_open_def_default();
  return construct(model, [&] {
    if (path == nullptr || used.cookie != kOpenCookie) return BLOB_ERROR_ARGUMENT;
    return openFile(path, used, model);
  });
}

blob_status blob_model_open_bytes(const void* bytes, size_t size, const blob_open_def* def,
                                  blob_model** model) noexcept {
  const blob_open_def used = def != nullptr ? *def : blob_open_def_default();
  return construct(model, [&] {
    if (bytes == nullptr || used.cookie != kOpenCookie) return BLOB_ERROR_ARGUMENT;
    return openBytes(bytes, size, used, model);
  });
}

blob_status blob_model_create(const blob_model_def* def, blob_model** model) noexcept {
  return construct(model, [&] {
    if (def == nullptr || def->cookie != kModelCookie) return BLOB_ERROR_ARGUMENT;
    const blob_status status = checkDefinition(*def);
    if (status == BLOB_OK) *model = buildModel(*def).release();
    return status;
  });
}

void blob_model_close(blob_model* model) noexcept {
  delete model;
}

blob_model_info blob_model_describe(const blob_model* model) noexcept {
  BLOB_REQUIRE(model != nullptr);
  blob_model_info info{};
  info.node_count = model->nodes.size();
  info.blob_count = model->blobCount;
  info.kernel = model->field.kernel;
  info.kernel_parameter = model->field.kernelParameter;
  info.iso_level = model->field.isoLevel;
  info.simd = model->simd;
  for (int i = 0; i < 3; ++i) {
    info.low[i] = model->low[i];
    info.high[i] = model->high[i];
  }
  info.bytes = countBytes(*model);
  return info;
}

blob_node blob_model_node(const blob_model* model, uint32_t node) noexcept {
  BLOB_REQUIRE(model != nullptr);
  blob_node result{{kNan, kNan, kNan}, kNan, -1};
  if (node >= model->nodes.size()) return result;
  for (int i = 0; i < 3; ++i) result.centre[i] = model->nodes[node].centre[i];
  result.radius = model->nodes[node].radius();
  result.parent = model->parent[node];
  return result;
}

size_t blob_model_neighbours(const blob_model* model, uint32_t node, uint32_t* neighbours,
                             size_t capacity) noexcept {
  BLOB_REQUIRE(model != nullptr && (neighbours != nullptr || capacity == 0));
  if (node >= model->nodes.size()) return 0;
  const NodeRecord& record = model->nodes[node];
  std::size_t count = 0;
  // the next greater index each time: blocks are in another order, and this needs no memory
  for (std::int64_t last = -1;; ++count) {
    std::int64_t next = std::numeric_limits<std::int64_t>::max();
    for (std::uint32_t b = 0; b < record.neighbourBlocks; ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        const NeighbourBlock& block = model->neighbours[record.firstNeighbours + b];
        const std::int64_t k = block.node[lane];
        if (!isPadding(block, lane) && k > last) next = std::min(next, k);
      }
    if (next == std::numeric_limits<std::int64_t>::max()) return count;
    if (count < capacity) neighbours[count] = static_cast<std::uint32_t>(next);
    last = next;
  }
}

uint32_t blob_cursor_locate(const blob_model* model, const double point[3]) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr);
  return isFinitePoint(point) ? locateNode(*model, point) : BLOB_NOWHERE;
}

uint32_t blob_cursor_follow(const blob_model* model, const double point[3],
                            uint32_t cursor) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr);
  return isFinitePoint(point) ? nodeFor(*model, 0, point, cursor) : cursor;
}

void blob_query(const blob_model* model, uint32_t flags, const double point[3], uint32_t* cursor,
                blob_sample* sample) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr && sample != nullptr);
  std::uint32_t unknown = BLOB_NOWHERE;
  sampleAt(*model, flags, point, cursor != nullptr ? *cursor : unknown, *sample);
}

void blob_query_many(const blob_model* model, uint32_t flags, size_t count,
                     const double (*points)[3], uint32_t* cursors, blob_sample* samples) noexcept {
  BLOB_REQUIRE(model != nullptr && ((points != nullptr && samples != nullptr) || count == 0));
  if (count == 0) return;
  queryJob(*model, flags, Job{packedColumns(count, points, cursors), samples, nullptr});
}

void blob_query_columns(const blob_model* model, uint32_t flags,
                        const blob_columns* columns) noexcept {
  BLOB_REQUIRE(model != nullptr && columns != nullptr);
  queryJob(*model, flags, Job{*columns, nullptr, nullptr});
}

int blob_inside(const blob_model* model, uint32_t flags, const double point[3],
                uint32_t* cursor) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr);
  std::uint32_t node;
  if (!findQueryNode(*model, flags, point, cursor, node)) return 0;
  return model->backend->inside(*model, flags, point, node) ? 1 : 0;
}

void blob_nearest(const blob_model* model, uint32_t flags, const double point[3], uint32_t* cursor,
                  double tolerance, uint32_t max_steps, blob_nearest_point* nearest) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr && nearest != nullptr);
  std::uint32_t node;
  if (findQueryNode(*model, flags, point, cursor, node)) {
    findNearest(*model, flags, point, node, tolerance, max_steps, *nearest);
    return;
  }
  blob_sample sample;
  answerOutOfRange(*model, point, node, sample);
  *nearest = {};
  for (int i = 0; i < 3; ++i) {
    nearest->normal[i] = sample.normal[i];
    nearest->point[i] = isFinitePoint(point) ? point[i] - sample.distance * sample.normal[i] : kNan;
  }
  nearest->distance = sample.distance;
  nearest->node = node;
}

void blob_query_hessian(const blob_model* model, uint32_t flags, const double point[3],
                        uint32_t* cursor, blob_hessian* hessian) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr && hessian != nullptr);
  std::uint32_t node;
  if (findQueryNode(*model, flags, point, cursor, node)) {
    evaluateHessian(*model, flags, point, node, *hessian);
    return;
  }
  *hessian = {};
  hessian->mean_curvature = hessian->gaussian_curvature = kNan;
  if (!hasNan(point)) return;
  hessian->value = kNan;
  fill(hessian->gradient, 3, kNan);
  fill(hessian->hessian, 6, kNan);
}

void blob_segment_hit(const blob_model* model, uint32_t flags, const double from[3],
                      const double to[3], uint32_t* cursor, double tolerance, uint32_t max_steps,
                      blob_hit* hit) noexcept {
  BLOB_REQUIRE(model != nullptr && from != nullptr && to != nullptr && hit != nullptr);
  *hit = {};
  std::uint32_t node;
  const bool inRange = findQueryNode(*model, flags, from, cursor, node);
  if (inRange && isFinitePoint(to)) {
    findHit(*model, flags, from, to, node, tolerance, max_steps, *hit);
    return;
  }
  fill(hit->point, 3, kNan);
  fill(hit->normal, 3, kNan);
  hit->t = kNan;
  hit->node = node;
}

void blob_capsule_approach(const blob_model* model, uint32_t flags, const double from[3],
                           const double to[3], double radius, uint32_t* cursor,
                           blob_approach* approach) noexcept {
  BLOB_REQUIRE(model != nullptr && from != nullptr && to != nullptr && approach != nullptr);
  std::uint32_t node;
  const bool inRange = findQueryNode(*model, flags, from, cursor, node);
  *approach = {};
  if (inRange && isFinitePoint(to)) {
    findDeepest(*model, flags, from, to, node, *approach);
  } else {
    fill(approach->point, 3, kNan);
    fill(approach->normal, 3, kNan);
    approach->t = approach->distance = kNan;
    approach->node = node;
  }
  approach->depth = approach->distance + radius;
}

void blob_set_misuse_handler(blob_misuse_handler handler) noexcept {
  g_misuseHandler.store(handler);
}

}  // extern "C"
