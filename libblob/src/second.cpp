// SPDX-License-Identifier: Apache-2.0
// f, its gradient and its Hessian in doubles: what the float paths compute, once more.
#include <cmath>
#include <limits>

#include "path.h"
#include "support.h"

namespace lumen::blob {
namespace {

// A value, its gradient, and its Hessian as xx, yy, zz, xy, xz, yz.
struct Jet {
  double value = 0, gradient[3]{}, hessian[6]{};
};

constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kColumn[6] = {0, 1, 2, 1, 2, 2};

// phi and its derivatives by u, which is x, or the kernel's parameter times x.
struct Phi {
  double value, first, second;
};

Phi phiOf(blob_kernel kernel, double u) noexcept {
  switch (kernel) {
    case BLOB_CAUCHY: {
      const double q = 1.0 / (1.0 + u), q2 = q * q;
      return {q2, -2.0 * q2 * q, 6.0 * q2 * q2};
    }
    case BLOB_GAUSSIAN: {
      const double e = std::exp(-u);
      return {e, -e, e};
    }
    case BLOB_QUARTIC:
      if (u >= 1.0) return {0, 0, 0};
      return {(1.0 - u) * (1.0 - u), -2.0 * (1.0 - u), 2.0};
    case BLOB_SOFT_OBJECT:
      break;
  }
  if (u >= 1.0) return {0, 0, 0};
  const double v = 1.0 - u;
  return {v * v * (5.0 + 4.0 * v) / 9.0, -v * (10.0 + 12.0 * v) / 9.0, (10.0 + 24.0 * v) / 9.0};
}

void addBlob(blob_kernel kernel, const BlobBlock& block, int lane, const double* at, Jet& f) {
  const double a = block.a[lane], w = block.w[lane];
  const double d[3] = {at[0] - double{block.x[lane]}, at[1] - double{block.y[lane]},
                       at[2] - double{block.z[lane]}};
  const Phi phi = phiOf(kernel, a * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
  f.value += w * phi.value;
  for (int i = 0; i < 3; ++i) f.gradient[i] += 2.0 * w * a * phi.first * d[i];
  for (int i = 0; i < 6; ++i)
    f.hessian[i] += 4.0 * w * a * a * phi.second * d[kRow[i]] * d[kColumn[i]] +
                    (i < 3 ? 2.0 * w * a * phi.first : 0.0);
}

Jet jetOfNode(const blob_model& model, std::uint32_t flags, std::uint32_t node,
              const double* point) {
  const Field& field = model.field(flags);
  const FieldNode& where = model.fieldNode(flags, node);
  double at[3];
  for (int i = 0; i < 3; ++i)
    at[i] = (point[i] - model.nodes[node].centre[i]) + double{where.place[i]};
  Jet f;
  for (std::uint32_t b = where.block; b < where.block + where.blockCount; ++b)
    for (int lane = 0; lane < kLanes; ++lane)
      if (field.blocks[b].w[lane] > 0) addBlob(field.kernel, field.blocks[b], lane, at, f);
  return f;
}

double powerDifference(const FanBlock& fan, int lane, const double* x) {
  return double{fan.nx[lane]} * x[0] + double{fan.ny[lane]} * x[1] + double{fan.nz[lane]} * x[2] +
         double{fan.c[lane]};
}

// As in path_body.h.
struct ActiveNodes {
  static constexpr unsigned kMost = 24;
  std::uint32_t node[kMost];
  unsigned count = 0;

  void add(std::uint32_t k) {
    for (unsigned i = 0; i < count; ++i)
      if (node[i] == k) return;
    if (count < kMost) node[count++] = k;
  }
};

// The blending weight of a node, see weigh() in path_body.h: a product, by way of the derivatives
// of its logarithm.
Jet weightOf(const blob_model& model, std::uint32_t node, const double* point,
             ActiveNodes& active) {
  const NodeRecord& record = model.nodes[node];
  double x[3];
  for (int i = 0; i < 3; ++i) x[i] = point[i] - record.centre[i];
  Jet log;
  double u = 1;
  for (std::uint32_t b = record.fan; b < record.fan + record.fanCount; ++b)
    for (int lane = 0; lane < kLanes; ++lane) {
      const FanBlock& fan = model.fans[b];
      const double half = 0.5 * double{fan.inverseTau[lane]};
      const double s = 0.5 + half * powerDifference(fan, lane, x);
      if (s >= 1.0) continue;
      active.add(fan.node[lane]);
      if (s <= 1e-7) return {};  // u, u' and u'' are s^3, s^2 and s
      const double psi = s * s * s * ((6.0 * s - 15.0) * s + 10.0);
      const double first = 30.0 * s * s * (1.0 - s) * (1.0 - s) / psi * half;
      const double second = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / psi * half * half;
      const double n[3] = {fan.nx[lane], fan.ny[lane], fan.nz[lane]};
      u *= psi;
      for (int i = 0; i < 3; ++i) log.gradient[i] += first * n[i];
      for (int i = 0; i < 6; ++i)
        log.hessian[i] += (second - first * first) * n[kRow[i]] * n[kColumn[i]];
    }
  Jet weight;
  weight.value = u;
  for (int i = 0; i < 3; ++i) weight.gradient[i] = u * log.gradient[i];
  for (int i = 0; i < 6; ++i)
    weight.hessian[i] = u * (log.hessian[i] + log.gradient[kRow[i]] * log.gradient[kColumn[i]]);
  return weight;
}

// Sum of u (f - f0), and of u.
struct Mixture {
  Jet excess, weight;
  double f0 = 0;
  bool empty = true;
};

void addNode(const blob_model& model, std::uint32_t flags, std::uint32_t node, const double* point,
             ActiveNodes& active, Mixture& sum) {
  const unsigned before = active.count;
  const Jet u = weightOf(model, node, point, active);
  if (!(u.value > 0)) {
    active.count = before;
    return;
  }
  const Jet f = jetOfNode(model, flags, node, point);
  if (sum.empty) sum.f0 = f.value;
  sum.empty = false;
  const double excess = f.value - sum.f0;
  sum.weight.value += u.value;
  sum.excess.value += u.value * excess;
  for (int i = 0; i < 3; ++i) {
    sum.weight.gradient[i] += u.gradient[i];
    sum.excess.gradient[i] += u.gradient[i] * excess + u.value * f.gradient[i];
  }
  for (int i = 0; i < 6; ++i) {
    const int r = kRow[i], c = kColumn[i];
    sum.weight.hessian[i] += u.hessian[i];
    sum.excess.hessian[i] += u.hessian[i] * excess + u.gradient[r] * f.gradient[c] +
                             u.gradient[c] * f.gradient[r] + u.value * f.hessian[i];
  }
}

Jet quotient(const Mixture& sum) {
  const double u = sum.weight.value, excess = sum.excess.value / u;
  Jet f;
  f.value = sum.f0 + excess;
  for (int i = 0; i < 3; ++i)
    f.gradient[i] = (sum.excess.gradient[i] - excess * sum.weight.gradient[i]) / u;
  for (int i = 0; i < 6; ++i) {
    const int r = kRow[i], c = kColumn[i];
    f.hessian[i] = (sum.excess.hessian[i] - f.gradient[r] * sum.weight.gradient[c] -
                    f.gradient[c] * sum.weight.gradient[r] - excess * sum.weight.hessian[i]) /
                   u;
  }
  return f;
}

Jet jetAt(const blob_model& model, std::uint32_t flags, const double* point, std::uint32_t node) {
  Mixture sum;
  if ((flags & BLOB_LOCAL) == 0) {
    ActiveNodes active;
    active.add(node);
    for (unsigned i = 0; i < active.count; ++i)
      addNode(model, flags, active.node[i], point, active, sum);
  }
  return sum.empty ? jetOfNode(model, flags, node, point) : quotient(sum);
}

}  // namespace

void evaluateSecond(const blob_model& model, std::uint32_t flags, const double* point,
                    std::uint32_t node, blob_second& second) noexcept {
  const Jet f = jetAt(model, flags, point, node);
  const double* g = f.gradient;
  const double* h = f.hessian;
  second.value = f.value;
  for (int i = 0; i < 3; ++i) second.gradient[i] = g[i];
  for (int i = 0; i < 6; ++i) second.hessian[i] = h[i];

  // g^T H g, and g^T adj(H) g; R. Goldman, Curvature formulas for implicit curves and surfaces,
  // 2005
  const double hg[3] = {h[0] * g[0] + h[3] * g[1] + h[4] * g[2],
                        h[3] * g[0] + h[1] * g[1] + h[5] * g[2],
                        h[4] * g[0] + h[5] * g[1] + h[2] * g[2]};
  const double bent = g[0] * hg[0] + g[1] * hg[1] + g[2] * hg[2];
  const double adjoint =
      g[0] * g[0] * (h[1] * h[2] - h[5] * h[5]) + g[1] * g[1] * (h[0] * h[2] - h[4] * h[4]) +
      g[2] * g[2] * (h[0] * h[1] - h[3] * h[3]) + 2.0 * g[0] * g[1] * (h[4] * h[5] - h[3] * h[2]) +
      2.0 * g[0] * g[2] * (h[3] * h[5] - h[4] * h[1]) +
      2.0 * g[1] * g[2] * (h[3] * h[4] - h[5] * h[0]);
  const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  second.mean_curvature =
      square > 0 ? (bent - square * (h[0] + h[1] + h[2])) / (2.0 * square * std::sqrt(square))
                 : nan;
  second.gaussian_curvature = square > 0 ? adjoint / (square * square) : nan;
}

}  // namespace lumen::blob
