// SPDX-License-Identifier: Apache-2.0
// One way to answer where the wall is, and what the benchmarks ask of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blob.h"

namespace lumen::bench {

struct Triangles {
  std::vector<std::array<float, 3>> vertex;        ///< mm
  std::vector<std::array<std::uint32_t, 3>> face;  ///< counter-clockwise seen from outside
  bool closed = false;                             ///< it has an inside
};

/// A vessel as each method may want it.
struct Vessel {
  std::string name;
  const blob_model* model = nullptr;
  Triangles mesh;
  double voxel = 0.2;     ///< mm, of the volume that the vessel comes from
  double gridCell = 0.2;  ///< mm, of a dense grid
};

/// The points of tools before their first step, x, y, z after another, and the nodes that they are at,
/// or null: to be found.
struct Start {
  std::size_t count = 0;
  const double* points = nullptr;
  const std::uint32_t* nodes = nullptr;
};

/// Where answers go, as columns.
struct Answers {
  double* distance = nullptr;  ///< mm, negative in the lumen; of a mesh that is not closed unsigned
  double* normal[3] = {};      ///< unit, outward; null: not wanted
};

class Method {
public:
  virtual ~Method() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Work outside of the time that is measured.
  virtual void prepare(const Vessel& vessel) = 0;
  /// Forgets what was kept of points, and makes room for those of `start`.
  virtual void place(const Start& start) { static_cast<void>(start); }
  /// A step of `count` points, the first of which is point `first` of all that were placed. Threads may
  /// ask at the same time for points that differ.
  virtual void query(std::size_t first, const double* points, std::size_t count,
                     const Answers& answers) = 0;
  /// Size of the structure that answers, 0 if unknown.
  [[nodiscard]] virtual double megabytes() const { return 0; }
  /// Passes over all frames that query_bench takes.
  [[nodiscard]] virtual int passes() const { return 200; }
};

using Methods = std::vector<std::unique_ptr<Method>>;

/// How libblob is asked.
enum class BlobCall : std::uint8_t { Single, Samples, Columns };
std::unique_ptr<Method> blobMethod(std::string name, std::uint32_t flags, BlobCall call);

void addBlobMethods(Methods& methods);
void addFloor(Methods& methods);
void addGrid(Methods& methods);
/// Searches from infinity; or, if `coherent`, no farther than the last step's distance and the way since.
void addEmbree(Methods& methods, bool coherent);
void addCgal(Methods& methods);
void addFcl(Methods& methods, bool coherent);
void addOpenVdb(Methods& methods);

/// "0.25 mm".
std::string inMm(double length);

}  // namespace lumen::bench
