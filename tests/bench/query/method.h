// SPDX-License-Identifier: Apache-2.0
// One way to answer where the wall is, and what the benchmark asks of it.
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
  std::vector<std::array<float, 3>> vertex;  ///< mm
  std::vector<std::array<std::uint32_t, 3>> face;
};

/// A vessel, and the points of a tool that is pushed through it.
struct Surface {
  std::string name;
  const blob_model* model = nullptr;
  Triangles mesh;
  double voxel = 0.2;  ///< mm, of the volume that the vessel comes from
  std::size_t toolPoints = 0;
  std::vector<double> points;  ///< x, y, z, mm: frames of toolPoints points, one after another
  [[nodiscard]] std::size_t frames() const { return points.size() / 3 / toolPoints; }
};

class Method {
public:
  virtual ~Method() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// What the clock does not see.
  virtual void prepare(const Surface& surface) = 0;
  /// One frame: a distance for each point, mm; the sign is ignored. Adds to what it did before.
  virtual void query(const double* points, std::size_t count, double* distances) = 0;
  /// Of the structure that answers, 0 if unknown.
  [[nodiscard]] virtual double megabytes() const { return 0; }
  /// Passes over all frames that a measurement takes.
  [[nodiscard]] virtual int passes() const { return 200; }
};

using Methods = std::vector<std::unique_ptr<Method>>;

void addBlobMethods(Methods& methods);
void addFloor(Methods& methods);
void addGrid(Methods& methods);
void addEmbree(Methods& methods);
void addCgal(Methods& methods);
void addFcl(Methods& methods);
void addOpenVdb(Methods& methods);

/// "capsule" and "spiral" are made here, after Yureidini's thesis, 5.5.2; anything else is the path
/// of a case. The tool lies between axis and wall, or all of it near the wall. Throws
/// std::runtime_error.
struct OwnedSurface {
  Surface surface;
  std::shared_ptr<blob_model> model;
};
OwnedSurface makeSurface(const std::string& what, bool atWall);

struct Row {
  std::string surface, method;
  double nanoseconds = 0;                 ///< per query
  double medianError = 0, highError = 0;  ///< of the distance, against EXACT; 99th percentile, mm
  double megabytes = 0;
};
std::string markdown(const std::vector<Row>& rows);
std::string json(const std::vector<Row>& rows);
std::string svg(const std::vector<Row>& rows);

/// "0.25 mm".
std::string inMm(double length);

}  // namespace lumen::bench
