// SPDX-License-Identifier: Apache-2.0
// Tables of neighbours at rest on a pose, beside tables that are made anew: pose_strain MODEL.lumen WAVE. The space is moved by waves of WAVE mm and growing height; points lie about the
// nodes, up to 0.2 radii outside of the wall.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "blob_pose.h"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Closer {
  void operator()(blob_model* model) const { blob_model_close(model); }
  void operator()(blob_pose* pose) const { blob_pose_close(pose); }
};
using Pose = std::unique_ptr<blob_pose, Closer>;

struct Waves {
  double height, number;  // mm, 1/mm
  [[nodiscard]] Vector3d place(const Vector3d& x) const {
    return x + height * Vector3d(std::sin(number * x.y()), std::sin(number * x.z() + 1),
                                 std::sin(number * x.x() + 2));
  }
  [[nodiscard]] blob_transform transform(const Vector3d& x) const {
    constexpr double kStep = 1e-3;
    Matrix3d deformation;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kStep * Vector3d::Unit(axis);
      deformation.col(axis) = (place(x + step) - place(x - step)) / (2 * kStep);
    }
    const Eigen::JacobiSVD<Matrix3d> parts(deformation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Quaterniond turn(Matrix3d(parts.matrixU() * parts.matrixV().transpose()));
    const Vector3d at = place(x);
    return {{at.x(), at.y(), at.z()}, {turn.x(), turn.y(), turn.z(), turn.w()}, 1};
  }
};

Pose poseOf(const blob_model* rest, const std::vector<blob_transform>& transforms, double& strain) {
  blob_pose_def def = blob_pose_def_default();
  def.renew = 0;
  blob_pose* pose = nullptr;
  blob_pose_change change{};
  if (blob_pose_create(rest, &def, &pose) != BLOB_OK ||
      blob_pose_set(pose, transforms.size(), nullptr, transforms.data(), &change) != BLOB_OK)
    std::exit(1);
  strain = change.strain;
  return Pose(pose);
}

void compare(const blob_model* rest, const Waves& waves) {
  constexpr int kPoints = 10;  // about each node
  std::vector<blob_transform> transforms;
  for (std::uint32_t i = 0; i < blob_model_describe(rest).node_count; ++i) {
    const blob_node node = blob_model_node(rest, i);
    transforms.push_back(waves.transform({node.centre[0], node.centre[1], node.centre[2]}));
  }
  double strain = 0;
  const Pose old = poseOf(rest, transforms, strain), anew = poseOf(rest, transforms, strain);
  blob_pose_renew(anew.get());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1.1, 1.1);
  std::size_t nodes = 0, far = 0;
  std::vector<double> errors;
  for (std::uint32_t i = 0; i < transforms.size(); ++i)
    for (int n = 0; n < kPoints; ++n) {
      const blob_node node = blob_model_node(blob_pose_model(old.get()), i);
      double point[3];
      for (int k = 0; k < 3; ++k) point[k] = node.centre[k] + node.radius * part(random);
      std::uint32_t a = i, b = i;
      blob_sample before, after;
      blob_query(blob_pose_model(old.get()), 0, point, &a, &before);
      blob_query(blob_pose_model(anew.get()), 0, point, &b, &after);
      if (before.distance > 0.2 * node.radius) continue;
      errors.push_back(std::abs(before.distance - after.distance) / node.radius);
      far += errors.back() > 1e-3 ? 1 : 0;
      nodes += a != b ? 1 : 0;
    }
  std::sort(errors.begin(), errors.end());
  const double share = 100.0 / static_cast<double>(errors.size());
  std::printf(
      "strain %.2f: %zu points, %.4f %% at another node, %.4f %% farther off than 0.001 radii, "
      "worst %.3f\n",
      strain, errors.size(), share * static_cast<double>(nodes), share * static_cast<double>(far),
      errors.back());
}

}  // namespace

int main(int argc, char** argv) {
  blob_model* model = nullptr;
  if (argc != 3 || blob_model_open(argv[1], nullptr, &model) != BLOB_OK) return 1;
  const std::unique_ptr<blob_model, Closer> rest(model);
  for (const double height : {0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0})
    compare(rest.get(), {height, 2 * 3.14159265358979 / std::strtod(argv[2], nullptr)});
}
