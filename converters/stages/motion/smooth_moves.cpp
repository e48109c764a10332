// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/smooth_moves.h"

#include <algorithm>

#include <Eigen/SparseCholesky>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kRounds = 4;           // of Cauchy's weights
constexpr double kLeastEdge = 1e-3;  // mm

Eigen::VectorXd solve(int size, const Triplets& entries, const Eigen::VectorXd& right) {
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  return factors.solve(right);
}

// Adds weight |x_i - x_k|^2 for numbers i and k.
void tie(int i, int k, double weight, Triplets& entries) {
  entries.emplace_back(i, i, weight);
  entries.emplace_back(k, k, weight);
  entries.emplace_back(i, k, -weight);
  entries.emplace_back(k, i, -weight);
}

template <class Visit>
void eachEdge(const formats::CenterlineTree& tree, Visit visit) {
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] < 0) continue;
    const auto parent = static_cast<std::uint32_t>(tree.parent[i]);
    const double length = (toEigen(tree.centre[i]) - toEigen(tree.centre[parent])).norm();
    visit(i, parent, std::max(length, kLeastEdge));
  }
}

double cauchy(double residual, double deviation) {
  const double share = residual / (2 * deviation);
  return 1 / (1 + share * share);
}

}  // namespace

std::vector<Vector3d> smoothMoves(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredMove>& measured, double walk) {
  const int size = 3 * static_cast<int>(measured.size());
  Triplets ties;
  eachEdge(tree, [&](std::uint32_t i, std::uint32_t k, double length) {
    for (int axis = 0; axis < 3; ++axis)
      tie(3 * static_cast<int>(i) + axis, 3 * static_cast<int>(k) + axis, 1 / (walk * length),
          ties);
  });
  // a move along the vessel is held by its neighbours alone; this keeps the sum positive definite
  for (int i = 0; i < size; ++i) ties.emplace_back(i, i, 1e-6 / walk);
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(size);
  for (int round = 0; round < kRounds; ++round) {
    Triplets entries = ties;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const MeasuredMove& m = measured[i];
      if (!(m.deviation > 0)) continue;
      const int row = 3 * static_cast<int>(i);
      const Matrix3d across = Matrix3d::Identity() - m.direction * m.direction.transpose();
      const double off = round == 0 ? 0.0 : (across * (moves.segment<3>(row) - m.move)).norm();
      const double weight = cauchy(off, m.deviation) / (m.deviation * m.deviation);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) entries.emplace_back(row + a, row + b, weight * across(a, b));
      right.segment<3>(row) += weight * (across * m.move);
    }
    moves = solve(size, entries, right);
  }
  std::vector<Vector3d> result;
  for (std::size_t i = 0; i < measured.size(); ++i)
    result.emplace_back(moves.segment<3>(3 * static_cast<int>(i)));
  return result;
}

std::vector<double> smoothNumbers(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredNumber>& measured,
                                  const std::vector<double>& walk, double spread) {
  const int size = static_cast<int>(measured.size());
  Triplets ties;
  eachEdge(tree, [&](std::uint32_t i, std::uint32_t k, double length) {
    tie(static_cast<int>(i), static_cast<int>(k), 1 / (walk[i] * length), ties);
  });
  const double share = 1 / (spread * spread * std::max(1, size));
  for (int i = 0; i < size; ++i) ties.emplace_back(i, i, share);
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(size);
  for (int round = 0; round < kRounds; ++round) {
    Triplets entries = ties;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (int i = 0; i < size; ++i) {
      const MeasuredNumber& m = measured[static_cast<std::size_t>(i)];
      if (!(m.deviation > 0)) continue;
      const double off = round == 0 ? 0.0 : numbers[i] - m.value;
      const double weight = cauchy(off, m.deviation) / (m.deviation * m.deviation);
      entries.emplace_back(i, i, weight);
      right[i] += weight * m.value;
    }
    numbers = solve(size, entries, right);
  }
  return {numbers.data(), numbers.data() + size};
}

}  // namespace lumen::convert
