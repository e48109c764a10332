// SPDX-License-Identifier: Apache-2.0
// lumen_energy_terms FOLDER: what the cohesion and the curvature are good for (Yureidini's
// thesis, 4.3.4, tables 4.2 and 4.3, in three dimensions): fits of an aneurysm without and with
// noise, and of a noisy open vessel with six outliers outside or inside, with and without each
// term. Writes energy_terms.md and energy_terms.json.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "particles.h"
#include "report.h"
#include "seams.h"
#include "shape_fit.h"

namespace {

using namespace lumen;
using namespace lumen::reproduce;

constexpr double kVoxel = 0.2;  // mm
constexpr double kNoise = 0.1;  // mm
constexpr std::size_t kRuns = 20;
constexpr std::size_t kSamples = 600;
constexpr double kLongestStep = 0.3;  // mm
constexpr int kOutliers = 6;

struct Weights {
  const char* name;
  double cohesion, curvature;
};
constexpr std::array<Weights, 4> kWeights = {{{"E_d", 0, 0},
                                              {"E_d + alpha E_LJ", 1e-5, 0},
                                              {"E_d + beta E_kappa", 0, 1e-3},
                                              {"all terms", 1e-5, 1e-3}}};

struct Scenario {
  const char* name;
  std::size_t shape;  ///< of shapes()
  double noise;       ///< mm
  double outliers;    ///< distance of six outliers from the axis, mm; 0: none
};
constexpr std::array<Scenario, 4> kScenarios = {{{"aneurysm", 0, 0, 0},
                                                 {"aneurysm, noise", 0, kNoise, 0},
                                                 {"open vessel, outliers outside", 1, kNoise, 1.5},
                                                 {"open vessel, outliers inside", 1, kNoise, 0.5}}};

/// A sac of about 2 mm of radius on a vessel of 1 mm, and the open capsule.
std::vector<ConvolutionShape> shapes() {
  ConvolutionShape aneurysm = convolutionShapes()[2];
  aneurysm.name = "aneurysm";
  aneurysm.startBlobs = 4;
  for (const auto& [y, width] : {std::pair{1.6, 0.35}, {2.4, 0.55}}) {
    aneurysm.skeleton.emplace_back(-2, y, 0);
    aneurysm.model.centre.push_back({-2, static_cast<float>(y), 0});
    aneurysm.model.width.push_back(static_cast<float>(width));
  }
  aneurysm.model.offset[1] = static_cast<std::uint32_t>(aneurysm.model.width.size());
  return {aneurysm, convolutionShapes()[3]};
}

struct Outcome {
  double hausdorff = 0, mean = 0, blobs = 0;
  double followed = 0;  ///< outliers within a voxel of the fitted surface, of all, %
};

/// Distances of even samples of one surface from another.
std::vector<double> distances(const ConvolutionShape& shape, const formats::BlobbyModels& from,
                              const formats::BlobbyModels& to, Random& random) {
  ParticleOptions options;
  options.count = kSamples;
  const auto beside = [&](Random& r) { return besideSkeleton(shape.skeleton, r); };
  std::vector<double> out;
  for (const Vector3d& p : sampleSurface({from, 0}, beside, options, random)) {
    if (!shape.contains(p)) continue;
    const auto q = ImplicitSurface(to, 0).nearest(p, kLongestStep);
    out.push_back(q ? (p - *q).norm() : std::numeric_limits<double>::infinity());
  }
  return out;
}

double followedBy(const formats::BlobbyModels& model, const std::vector<Vector3d>& outliers) {
  double count = 0;
  for (const Vector3d& p : outliers) {
    const auto q = ImplicitSurface(model, 0).nearest(p, kLongestStep);
    if (q && (p - *q).norm() < kVoxel) count += 1;
  }
  return outliers.empty() ? std::nan("") : 100 * count / static_cast<double>(outliers.size());
}

/// Tables 4.2 and 4.3.
Table publishedTable() {
  return {
      "The thesis, in the plane, in pixels (tables 4.2 and 4.3): E_n for normals, E_c cohesion, "
      "E_a axis-wise curvature",
      {"points", "energy", "Hausdorff", "average", "blobs"},
      {{"aneurysm", "E_d", 2.00, 0.91, 30.0},
       {"aneurysm", "E_d + E_n", 2.08, 0.94, 20.0},
       {"aneurysm, noise", "E_d + E_n", 224.32, 2.07, 14.0},
       {"aneurysm, noise", "E_d + E_n + E_a", 8.89, 1.76, 14.0},
       {"open vessel, outliers outside", "E_d + E_n + E_c", 23.93, 5.15, 7.0},
       {"open vessel, outliers outside", "E_d + E_n + E_c + E_a", 23.93, 5.13, 20.0},
       {"open vessel, outliers inside", "E_d + E_n + E_c", 1004.0, 6.18, 8.0},
       {"open vessel, outliers inside", "E_d + E_n + E_c + E_a", 22.05, 4.69, 9.0}}};
}

Outcome runOnce(const ConvolutionShape& shape, const Scenario& scenario, const Weights& weights,
                const std::vector<Vector3d>& clean, std::uint64_t stream) {
  std::vector<Vector3d> points = withNoise(shape, clean, scenario.noise, Random(5, stream));
  Random random(6, stream);
  std::vector<Vector3d> outliers;
  for (int i = 0; scenario.outliers > 0 && i < kOutliers; ++i) {
    const Vector3d side = Vector3d(0, random.normal(), random.normal()).normalized();
    outliers.push_back(Vector3d(random.uniform(-3.5, -0.5), 0, 0) + scenario.outliers * side);
  }
  points.insert(points.end(), outliers.begin(), outliers.end());
  convert::fitting::LocalModelOptions options;
  options.energy.cohesionWeight = weights.cohesion;
  options.energy.curvatureWeight = weights.curvature;
  options.accuracy = std::max(0.01, 3 * scenario.noise);
  const formats::BlobbyModels model = fitShape(shape, points, options);
  std::vector<double> all = distances(shape, model, shape.model, random);
  const std::vector<double> back = distances(shape, shape.model, model, random);
  all.insert(all.end(), back.begin(), back.end());
  Outcome out{0, 0, static_cast<double>(model.width.size()), followedBy(model, outliers)};
  for (const double d : all) {
    out.hausdorff = std::max(out.hausdorff, d);
    out.mean += d / static_cast<double>(all.size());
  }
  return out;
}

double medianOf(const std::vector<Outcome>& runs, double Outcome::*value) {
  std::vector<double> values;
  for (const Outcome& run : runs) values.push_back(run.*value);
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

double meanOf(const std::vector<Outcome>& runs, double Outcome::*value) {
  double sum = 0;
  for (const Outcome& run : runs) sum += run.*value;
  return sum / static_cast<double>(runs.size());
}

void run(const std::filesystem::path& folder, Progress& progress) {
  Table table{
      "Distances between the fitted and the true surface, in voxels of 0.2 mm: Hausdorff and "
      "average symmetric, medians of 20 runs; outliers within a voxel of the fitted surface, mean",
      {"points", "energy", "Hausdorff", "average", "blobs", "outliers followed, %"},
      {}};
  const std::vector<ConvolutionShape> all = shapes();
  progress.begin("energy terms", kScenarios.size() * kWeights.size() * kRuns);
  for (const Scenario& scenario : kScenarios) {
    const ConvolutionShape& shape = all[scenario.shape];
    Random random(7, scenario.shape);
    const std::vector<Vector3d> clean = shape.samples(random);
    for (const Weights& weights : kWeights) {
      std::vector<Outcome> runs(kRuns);
      tbb::parallel_for(std::size_t{0}, kRuns, [&](std::size_t i) {
        progress.check();
        runs[i] = runOnce(shape, scenario, weights, clean, i);
        progress.advance();
      });
      table.rows.push_back({scenario.name, weights.name,
                            medianOf(runs, &Outcome::hausdorff) / kVoxel,
                            medianOf(runs, &Outcome::mean) / kVoxel,
                            medianOf(runs, &Outcome::blobs), meanOf(runs, &Outcome::followed)});
    }
  }
  progress.end();
  Report report("Energy terms");
  report.paragraph(
      "Here the energy is the present one, in three dimensions: E_d always, with and without the "
      "Lennard-Jones cohesion and the mean curvature. The thesis' pixels are those of other "
      "pictures, so only the order within a table compares. Its extra surfaces around outliers "
      "would "
      "show as outliers followed.");
  report.table(publishedTable());
  report.table(table);
  std::filesystem::create_directories(folder);
  report.write(folder, "energy_terms");
  std::fputs(report.markdown().c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  return runReport(argc, argv, "lumen_energy_terms", run);
}
