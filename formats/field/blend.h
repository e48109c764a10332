// SPDX-License-Identifier: Apache-2.0
// The blended field in doubles, with its derivatives: f = sum u_k f_k / sum u_k over the nodes that
// blend. Templates for any container of nodes.
#pragma once

#include <cstdint>

#include "formats/field/kernel.h"

namespace lumen::field {

#include "formats/field/blend_formulas.h"

/// A value, its gradient and, of the second order, its Hessian as xx, yy, zz, xy, xz, yz.
template <int order>
struct Jet {
  static_assert(order == 1 || order == 2);
  double value = 0, gradient[3]{};
};
template <>
struct Jet<2> {
  double value = 0, gradient[3]{}, hessian[6]{};
};

/// Rows and columns of the six entries of a Hessian in the matrix.
inline constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kColumn[6] = {0, 1, 2, 1, 2, 2};

/// A neighbour k of a node i: p_k - p_i = n . (X - O_i) + c, mm^2.
struct Rival {
  double n[3], c;     ///< mm and mm^2
  double inverseTau;  ///< 1 / tau_ik, 1/mm^2
  std::uint32_t node;
};

inline double powerDifference(const Rival& rival, const double* x) {
  return rival.n[0] * x[0] + rival.n[1] * x[1] + rival.n[2] * x[2] + rival.c;
}

/// Adds a blob of width w to f, at `d` from its centre, mm; u = a |d|^2.
template <class K, int order>
inline void addBlob(const double* d, double a, double w, Jet<order>& f) {
  const double u = a * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  const double first = K::first(u);
  f.value += w * K::phi(u);
  for (int i = 0; i < 3; ++i) f.gradient[i] += 2.0 * w * a * first * d[i];
  if constexpr (order > 1) {
    const double second = K::second(u);
    for (int i = 0; i < 6; ++i)
      f.hessian[i] += 4.0 * w * a * a * second * d[kRow[i]] * d[kColumn[i]] +
                      (i < 3 ? 2.0 * w * a * first : 0.0);
  }
}

/// Multiplies a weight u by psi against one neighbour at s < 1, and adds to the derivatives of
/// its logarithm.
template <int order>
inline void multiplyByStep(const Rival& rival, double s, double& u, Jet<order>& logarithm) {
  const double half = 0.5 * rival.inverseTau, psi = smoothStep(s);
  const double first = 30.0 * s * s * (1.0 - s) * (1.0 - s) / psi * half;
  u *= psi;
  for (int i = 0; i < 3; ++i) logarithm.gradient[i] += first * rival.n[i];
  if constexpr (order > 1) {
    const double second = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / psi * half * half;
    for (int i = 0; i < 6; ++i)
      logarithm.hessian[i] += (second - first * first) * rival.n[kRow[i]] * rival.n[kColumn[i]];
  }
}

/// The weight u_k of a node, the product of psi over its neighbours. Those that the node does not
/// beat by tau are added to the nodes that blend. `Nodes` is described at blend().
template <int order, class Nodes>
Jet<order> blendWeight(const Nodes& nodes, std::uint32_t node, const double* point,
                       ActiveNodes& active) {
  constexpr double kLeastStep = 1e-7;  // least s: u, u' and u'' fall like s^3, s^2 and s
  double x[3];
  for (int i = 0; i < 3; ++i) x[i] = point[i] - nodes.centre(node)[i];
  Jet<order> logarithm, weight;
  double u = 1;
  const bool isBeaten = !nodes.eachRival(node, [&](const Rival& rival) {
    const double s = 0.5 + 0.5 * rival.inverseTau * powerDifference(rival, x);
    if (s >= 1.0) return true;
    active.add(rival.node);
    if (s <= kLeastStep) return false;
    multiplyByStep<order>(rival, s, u, logarithm);
    return true;
  });
  if (isBeaten) return weight;
  weight.value = u;
  for (int i = 0; i < 3; ++i) weight.gradient[i] = u * logarithm.gradient[i];
  if constexpr (order > 1)
    for (int i = 0; i < 6; ++i)
      weight.hessian[i] =
          u * (logarithm.hessian[i] + logarithm.gradient[kRow[i]] * logarithm.gradient[kColumn[i]]);
  return weight;
}

/// Sums over the nodes that blend: of u, and of u (f - f0), where f0 is the first node's value, so
/// that models that agree leave only the rounding of their difference.
template <int order>
struct Mixture {
  Jet<order> excess, weight;
  double f0 = 0;
  bool isEmpty = true;

  void add(const Jet<order>& u, const Jet<order>& f) {
    if (isEmpty) f0 = f.value;
    isEmpty = false;
    const double above = f.value - f0;
    weight.value += u.value;
    excess.value += u.value * above;
    for (int i = 0; i < 3; ++i) {
      weight.gradient[i] += u.gradient[i];
      excess.gradient[i] += u.gradient[i] * above + u.value * f.gradient[i];
    }
    if constexpr (order > 1)
      for (int i = 0; i < 6; ++i) {
        const int r = kRow[i], c = kColumn[i];
        weight.hessian[i] += u.hessian[i];
        excess.hessian[i] += u.hessian[i] * above + u.gradient[r] * f.gradient[c] +
                             u.gradient[c] * f.gradient[r] + u.value * f.hessian[i];
      }
  }

  /// sum u f / sum u, by the rule for quotients.
  [[nodiscard]] Jet<order> quotient() const {
    const double u = weight.value, above = excess.value / u;
    Jet<order> f;
    f.value = f0 + above;
    for (int i = 0; i < 3; ++i)
      f.gradient[i] = (excess.gradient[i] - above * weight.gradient[i]) / u;
    if constexpr (order > 1)
      for (int i = 0; i < 6; ++i) {
        const int r = kRow[i], c = kColumn[i];
        f.hessian[i] = (excess.hessian[i] - f.gradient[r] * weight.gradient[c] -
                        f.gradient[c] * weight.gradient[r] - above * weight.hessian[i]) /
                       u;
      }
    return f;
  }
};

/// The node where following a point from `node` ends. The walk never steps straight back: by rounding, two
/// nodes could each see less power in the other. `Nodes` is described at blend().
template <class Nodes>
std::uint32_t followNodes(const Nodes& nodes, const double* point, std::uint32_t node) {
  constexpr int kMaxSteps = 256;
  std::uint32_t before = node;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double* c = nodes.centre(node);
    const double x[3] = {point[0] - c[0], point[1] - c[1], point[2] - c[2]};
    std::uint32_t next = node;
    double least = 0;
    nodes.eachRival(node, [&](const Rival& rival) {
      const double difference = powerDifference(rival, x);
      if (difference < least) {
        least = difference;
        next = rival.node;
      }
      return true;
    });
    if (next == node || next == before) break;
    before = node;
    node = next;
  }
  return node;
}

/// The blended field at a point, for the cursor at `node`; the node's own model where no weight is
/// left. `Nodes` has centre(k), which points to three numbers; eachRival(k, visit), which visits
/// the neighbours until visit(rival) is false and returns whether it never was; and model<order>(k,
/// point), the jet of f_k.
template <int order, class Nodes>
Jet<order> blend(const Nodes& nodes, std::uint32_t node, const double* point) {
  Mixture<order> sum;
  visitActiveNodes(node, [&](std::uint32_t k, ActiveNodes& active) {
    const Jet<order> weight = blendWeight<order>(nodes, k, point, active);
    if (!(weight.value > 0)) return false;
    sum.add(weight, nodes.template model<order>(k, point));
    return true;
  });
  return sum.isEmpty ? nodes.template model<order>(node, point) : sum.quotient();
}

}  // namespace lumen::field
