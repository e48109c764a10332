// SPDX-License-Identifier: Apache-2.0
// blob_query_columns() as kernels of CUDA. They include nothing of an SDK, so that clang alone
// compiles them to PTX, as for blob_cuda.h:
//
//     clang -x cuda --cuda-gpu-arch=sm_70 -nocudainc -nocudalib --cuda-device-only -S -O3
//           -ffp-contract=off -I INCLUDE query.cu
//
// A query is blob_query_points(), a thread for each point, then blob_blend_pairs() and
// blob_blend_crowds(). Threads of a warp wait for the slowest, and points differ: most have one
// model or blend two, few blend many. So the first kernel answers the points with one model and
// marks the others in their cursors; each of the next ones gathers its points, and leaves cursors
// without marks. For BLOB_LOCAL the first is enough, and for BLOB_DISTANCE_EXACT there is
// blob_query_exact_points(). Kernels whose names end in _cauchy are for buffers whose vessels all
// have that kernel.
//
// A block has kBlock threads; one that gathers has a span of points, at most kMostGathered. Whoever
// compiles this for a processor without warps defines BLOB_DEVICE_THREAD and what follows it
// below.
#include "blob_device_exact.h"

#if defined(BLOB_DEVICE_THREAD)
#elif defined(__clang__)
#define BLOB_DEVICE_KERNEL(blocks) \
  extern "C" __attribute__((global, launch_bounds(kBlock, blocks))) void
#define BLOB_DEVICE_SHARED __attribute__((shared))
#define BLOB_DEVICE_THREAD                                                    \
  ((uint64_t)__nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() + \
   __nvvm_read_ptx_sreg_tid_x())
#define BLOB_DEVICE_NEXT(counter) __nvvm_atom_add_gen_i((int*)(counter), 1)
#define BLOB_DEVICE_OF_FIRST(x) __nvvm_shfl_sync_idx_i32(~0u, x, 0, 31)
#define BLOB_DEVICE_SYNC() __syncthreads()
#else
#define BLOB_DEVICE_KERNEL(blocks) extern "C" __global__ void __launch_bounds__(kBlock, blocks)
#define BLOB_DEVICE_SHARED __shared__
#define BLOB_DEVICE_THREAD ((uint64_t)blockIdx.x * blockDim.x + threadIdx.x)
#define BLOB_DEVICE_NEXT(counter) atomicAdd(counter, 1)
#define BLOB_DEVICE_OF_FIRST(x) __shfl_sync(~0u, x, 0)
#define BLOB_DEVICE_SYNC() __syncthreads()
#endif

namespace {

// Columns of points and answers. Arguments are those of the kernel in query.cl, and the vessel of
// each point, or null where all are of `vessel`. A vessel that the buffer has not gives NaN,
// outside, and leaves the cursor.
struct Columns {
  const uint32_t* words;
  uint32_t vessel, flags, count;
  const float* point;
  uint32_t* cursor;
  float *answer, *value;
  uint32_t* state;
  const uint32_t* vesselOfPoint;
};

// Marks of cursors: a pair, whose rival is neighbour 0 to 7 of the first block, in bits 28 to 30;
// or a crowd of 2 rivals, or more. A buffer has less than 2^28 nodes, as each has 16 of 2^32 words.
constexpr uint32_t kPair = 0x80000000u, kSmallCrowd = 0x10000000u, kLargeCrowd = 0x20000000u;
constexpr uint32_t kCrowds = kSmallCrowd | kLargeCrowd, kRivalShift = 28, kNode = 0x0fffffffu;
constexpr int kAnyKernel = -1, kCauchy = 0;

constexpr uint32_t kBlock = 64;  // threads
// blocks of a multiprocessor at once, which bound the registers of a thread
constexpr uint32_t kBlocks = 12, kExactBlocks = 16;
constexpr uint32_t kMostGathered = 2048;  // points of a span

// Four floats of a row, moved at once where rows are aligned to them.
struct Row {
  float f[4];
};

#if defined(__CUDA_ARCH__)
#if defined(__clang__)
typedef float WholeRow __attribute__((vector_size(16)));
#else
typedef float4 WholeRow;
#endif
BLOB_DEVICE_FN bool isAligned(const float* rows) {
  return reinterpret_cast<uintptr_t>(rows) % sizeof(WholeRow) == 0;
}
#endif

BLOB_DEVICE_FN void writeRow(float* rows, uint64_t i, const Row& row) {
#if defined(__CUDA_ARCH__)
  if (isAligned(rows)) {
    reinterpret_cast<WholeRow*>(rows)[i] = WholeRow{row.f[0], row.f[1], row.f[2], row.f[3]};
    return;
  }
#endif
  for (uint32_t k = 0; k < 4; ++k) rows[4 * i + k] = row.f[k];
}

BLOB_DEVICE_FN Row readRow(const float* rows, uint64_t i) {
#if defined(__CUDA_ARCH__)
  if (isAligned(rows)) {
    const WholeRow whole = reinterpret_cast<const WholeRow*>(rows)[i];
    Row row;
    __builtin_memcpy(&row, &whole, sizeof row);  // by elements, it is read by elements
    return row;
  }
#endif
  return Row{{rows[4 * i], rows[4 * i + 1], rows[4 * i + 2], rows[4 * i + 3]}};
}

BLOB_DEVICE_FN void writeAnswer(const Columns& to, uint64_t i, const blob_device_sample& s) {
  writeRow(to.answer, i, Row{{s.distance, s.normal[0], s.normal[1], s.normal[2]}});
  if (to.state != nullptr) to.state[i] = s.state;
  if (to.value != nullptr)
    writeRow(to.value, i, Row{{s.value, s.gradient[0], s.gradient[1], s.gradient[2]}});
}

BLOB_DEVICE_FN void answerNoVessel(const Columns& to, uint64_t i) {
  const float nan = blob_device_float(0x7fc00000u);
  writeAnswer(to, i, blob_device_sample{nan, {nan, nan, nan}, nan, {nan, nan, nan}, 0, 0});
}

BLOB_DEVICE_FN uint32_t vesselOf(const Columns& c, uint64_t i) {
  return c.vesselOfPoint != nullptr ? c.vesselOfPoint[i] : c.vessel;
}

// The vessel of a point; its blobs' kernel is a constant where Phi is one.
template <int Phi>
BLOB_DEVICE_FN blob_device_vessel openVessel(const Columns& c, uint64_t i) {
  blob_device_vessel v = blob_device_open(c.words, vesselOf(c, i));
  if (Phi != kAnyKernel) v.phi = static_cast<blob_device_word>(Phi);
  return v;
}

BLOB_DEVICE_FN void finishPoint(const Columns& c, uint64_t i, const blob_device_vessel& v,
                                const blob_device_node& node, const blob_device_lane& lane) {
  blob_device_sample sample;
  blob_device_finish(&v, &lane, node.x, &sample);
  writeAnswer(c, i, sample);
}

// Answers a point by its own node's model, or marks that it blends, and leaves f and grad f of that
// model in the place of the answer.
template <int Phi>
BLOB_DEVICE_FN void answerPoint(const Columns& c, uint64_t i) {
  if (vesselOf(c, i) >= c.words[3]) {
    answerNoVessel(c, i);
    return;
  }
  const blob_device_vessel v = openVessel<Phi>(c, i);
  const blob_device_place place = blob_device_place_at(c.point + 3 * i);
  uint32_t cursor = c.cursor[i];
  if (cursor >= v.node_count) cursor = blob_device_locate(&v, &place);
  blob_device_node node;
  blob_device_sample sample;
  if (!blob_device_enter(&v, c.flags, &place, &cursor, &node, &sample)) {
    c.cursor[i] = cursor;
    writeAnswer(c, i, sample);
    return;
  }
  const blob_device_lane lane = blob_device_evaluate(&v, &node);
  const uint32_t rivals = (c.flags & BLOB_DEVICE_LOCAL) == 0 ? node.rivals : 0;
  if (rivals == 0) {
    c.cursor[i] = cursor;
    finishPoint(c, i, v, node, lane);
    return;
  }
  const uint32_t number = blob_device_count(rivals);
  c.cursor[i] = cursor | (number == 1   ? kPair | blob_device_first(rivals) << kRivalShift
                          : number == 2 ? kSmallCrowd
                                        : kLargeCrowd);
  writeRow(c.answer, i, Row{{lane.field[0], lane.field[1], lane.field[2], lane.field[3]}});
}

// What the first kernel has found at a marked point.
struct Marked {
  blob_device_vessel vessel;
  blob_device_place place;
  uint32_t index;
  blob_device_node node;
};

template <int Phi>
BLOB_DEVICE_FN Marked markedPoint(const Columns& c, uint64_t i) {
  Marked m;
  m.vessel = openVessel<Phi>(c, i);
  m.place = blob_device_place_at(c.point + 3 * i);
  m.index = c.cursor[i] & kNode;
  m.node = blob_device_at(&m.vessel, m.index, &m.place);
  return m;
}

BLOB_DEVICE_FN blob_device_lane laneOf(const Columns& c, uint64_t i, const Marked& m) {
  if (m.vessel.phi == 1) return blob_device_evaluate(&m.vessel, &m.node);  // has a shift, too
  blob_device_lane lane;
  const Row row = readRow(c.answer, i);
  for (uint32_t k = 0; k < 4; ++k) lane.field[k] = row.f[k];
  lane.shift = 0;
  lane.radius = blob_device_float(m.node.record[3]);
  return lane;
}

// Answers a pair, or marks one that is none as a crowd.
template <int Phi>
BLOB_DEVICE_FN void blendPair(const Columns& c, uint64_t i) {
  const Marked m = markedPoint<Phi>(c, i);
  blob_device_lane lane = laneOf(c, i, m);
  const bool isPair = blob_device_blend_one(&m.vessel, &m.place, m.index, &m.node,
                                            c.cursor[i] >> kRivalShift & 7u, &lane) != 0;
  c.cursor[i] = isPair ? m.index : m.index | kLargeCrowd;
  if (isPair) finishPoint(c, i, m.vessel, m.node, lane);
}

template <int Phi>
BLOB_DEVICE_FN void blendCrowd(const Columns& c, uint64_t i) {
  const Marked m = markedPoint<Phi>(c, i);
  blob_device_lane lane = laneOf(c, i, m);
  blob_device_blend_all(&m.vessel, &m.place, m.index, &lane);
  c.cursor[i] = m.index;
  finishPoint(c, i, m.vessel, m.node, lane);
}

BLOB_DEVICE_FN bool isMarked(const Columns& c, uint64_t i, uint32_t marks) {
  if (i >= c.count || vesselOf(c, i) >= c.words[3]) return false;
  const uint32_t cursor = c.cursor[i];
  return marks == kPair ? (cursor & kPair) != 0 : (cursor & kPair) == 0 && (cursor & kCrowds) != 0;
}

// --------------------------------------------------------- what the threads of a block share

// Points of a block's span in two sorts: the first from the front, the second from the back.
struct Gathered {
  uint16_t points[kMostGathered];
  uint32_t counts[2], batches;  // of each sort; that warps have taken
};

BLOB_DEVICE_FN uint32_t threadOf(uint32_t size) {
  return static_cast<uint32_t>(BLOB_DEVICE_THREAD % size);
}

// Gathers the points of a span that have one of these marks.
template <uint32_t Marks>
BLOB_DEVICE_FN void gather(const Columns& c, uint64_t first, uint32_t span, Gathered* g) {
  if (threadOf(kBlock) == 0) g->counts[0] = g->counts[1] = g->batches = 0;
  BLOB_DEVICE_SYNC();
  for (uint32_t k = threadOf(kBlock); k < span; k += kBlock) {
    if (!isMarked(c, first + k, Marks)) continue;
    const uint32_t sort = Marks == kCrowds && (c.cursor[first + k] & kLargeCrowd) != 0 ? 1 : 0;
    const uint32_t at = static_cast<uint32_t>(BLOB_DEVICE_NEXT(&g->counts[sort]));
    g->points[sort == 0 ? at : kMostGathered - 1 - at] = static_cast<uint16_t>(k);
  }
  BLOB_DEVICE_SYNC();
}

// The first of the next 32 gathered points for the warp of this thread.
BLOB_DEVICE_FN uint32_t nextBatch(Gathered* g) {
  const int batch = threadOf(32) == 0 ? static_cast<int>(BLOB_DEVICE_NEXT(&g->batches)) : 0;
  return 32 * static_cast<uint32_t>(BLOB_DEVICE_OF_FIRST(batch));
}

// Blends the points with a mark, each block those of its span. A batch is of one sort.
template <int Phi, uint32_t Marks>
BLOB_DEVICE_FN void blendMarked(const Columns& c, uint32_t span) {
  BLOB_DEVICE_SHARED Gathered g;
  const uint64_t first = BLOB_DEVICE_THREAD / kBlock * span;
  gather<Marks>(c, first, span, &g);
  const uint32_t second = (g.counts[0] + 31) / 32 * 32, end = second + g.counts[1];
  for (uint32_t batch = nextBatch(&g); batch < end; batch = nextBatch(&g)) {
    const uint32_t sort = batch < second ? 0 : 1;
    const uint32_t at = batch + threadOf(32) - (sort == 0 ? 0 : second);
    if (at >= g.counts[sort]) continue;
    const uint64_t i = first + g.points[sort == 0 ? at : kMostGathered - 1 - at];
    if (Marks == kPair)
      blendPair<Phi>(c, i);
    else
      blendCrowd<Phi>(c, i);
  }
}

BLOB_DEVICE_FN void answerExactly(const Columns& c, uint64_t i) {
  if (vesselOf(c, i) >= c.words[3]) {
    answerNoVessel(c, i);
    return;
  }
  const float at[3] = {c.point[3 * i], c.point[3 * i + 1], c.point[3 * i + 2]};
  uint32_t node = c.cursor[i];
  blob_device_sample sample;
  blob_device_query_exact(c.words, vesselOf(c, i), c.flags, at, &node, &sample);
  c.cursor[i] = node;
  writeAnswer(c, i, sample);
}

}  // namespace

#define BLOB_DEVICE_COLUMNS                                                                   \
  const uint32_t *words, uint32_t vessel, uint32_t flags, uint32_t count, const float *point, \
      uint32_t *cursor, float *answer, float *value, uint32_t *state,                         \
      const uint32_t *vessel_of_point
#define BLOB_DEVICE_GIVEN                                                             \
  Columns {                                                                           \
    words, vessel, flags, count, point, cursor, answer, value, state, vessel_of_point \
  }

#define BLOB_DEVICE_KERNELS(Phi, suffix)                                                      \
  BLOB_DEVICE_KERNEL(kBlocks) blob_query_points##suffix(BLOB_DEVICE_COLUMNS) {                \
    const uint64_t i = BLOB_DEVICE_THREAD;                                                    \
    if (i < count) answerPoint<Phi>(BLOB_DEVICE_GIVEN, i);                                    \
  }                                                                                           \
  BLOB_DEVICE_KERNEL(kBlocks) blob_blend_pairs##suffix(BLOB_DEVICE_COLUMNS, uint32_t span) {  \
    blendMarked<Phi, kPair>(BLOB_DEVICE_GIVEN, span);                                         \
  }                                                                                           \
  BLOB_DEVICE_KERNEL(kBlocks) blob_blend_crowds##suffix(BLOB_DEVICE_COLUMNS, uint32_t span) { \
    blendMarked<Phi, kCrowds>(BLOB_DEVICE_GIVEN, span);                                       \
  }

BLOB_DEVICE_KERNELS(kAnyKernel, )
BLOB_DEVICE_KERNELS(kCauchy, _cauchy)

// The distance to the nearest point of the wall and the normal there; `state` may have
// BLOB_DEVICE_NOT_CONVERGED.
BLOB_DEVICE_KERNEL(kExactBlocks) blob_query_exact_points(BLOB_DEVICE_COLUMNS) {
  const uint64_t i = BLOB_DEVICE_THREAD;
  if (i < count) answerExactly(BLOB_DEVICE_GIVEN, i);
}
