// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/xray/attenuation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lumen::convert {

namespace {

/// keV, and cm^2/g.
struct Coefficient {
  double energy, mass;
};

constexpr Coefficient kWater[] = {{10, 5.329},   {15, 1.673},  {20, 0.8096}, {30, 0.3756},
                                  {40, 0.2683},  {50, 0.2269}, {60, 0.2059}, {80, 0.1837},
                                  {100, 0.1707}, {150, 0.1505}};
constexpr Coefficient kBone[] = {{10, 28.51},   {15, 9.032},  {20, 4.001},  {30, 1.331},
                                 {40, 0.6655},  {50, 0.4242}, {60, 0.3148}, {80, 0.2229},
                                 {100, 0.1855}, {150, 0.1480}};
// the K edge is between two entries of one energy
constexpr Coefficient kIodine[] = {{10, 162.6},      {15, 55.12},      {20, 25.43},  {30, 8.561},
                                   {33.1694, 6.553}, {33.1694, 35.82}, {40, 22.10},  {50, 12.32},
                                   {60, 7.579},      {80, 3.510},      {100, 1.942}, {150, 0.6978}};
constexpr Coefficient kAluminium[] = {{10, 26.23},   {15, 7.955},  {20, 3.441},  {30, 1.128},
                                      {40, 0.5685},  {50, 0.3681}, {60, 0.2778}, {80, 0.2018},
                                      {100, 0.1704}, {150, 0.1378}};
constexpr double kAluminiumDensity = 2.699;         // g/cm^3
constexpr double kLeastEnergy = 10, kBinWidth = 2;  // keV

std::span<const Coefficient> tableOf(Material material) {
  switch (material) {
    case Material::Bone:
      return kBone;
    case Material::Iodine:
      return kIodine;
    case Material::Aluminium:
      return kAluminium;
    case Material::Water:
      break;
  }
  return kWater;
}

}  // namespace

double massAttenuation(Material material, double keV) {
  const std::span<const Coefficient> table = tableOf(material);
  const auto after = std::upper_bound(table.begin() + 1, table.end() - 1, keV,
                                      [](double e, const Coefficient& c) { return e < c.energy; });
  const Coefficient &a = *(after - 1), &b = *after;
  const double share = std::log(keV / a.energy) / std::log(b.energy / a.energy);
  return a.mass * std::pow(b.mass / a.mass, share);
}

Spectrum::Spectrum(double peak, double filter) {
  const auto count = static_cast<int>(std::ceil((peak - kLeastEnergy) / kBinWidth));
  const double width = (peak - kLeastEnergy) / count;
  double photons = 0, energy = 0;
  for (int i = 0; i < count; ++i) {
    const double e = kLeastEnergy + (i + 0.5) * width;
    const double kept =
        std::exp(-massAttenuation(Material::Aluminium, e) * kAluminiumDensity * filter / 10);
    const double n = (peak / e - 1) * kept;
    photons += n;
    energy += n * e;
    m_bins.push_back({n * e, n * e * e, massAttenuation(Material::Water, e),
                      massAttenuation(Material::Bone, e), massAttenuation(Material::Iodine, e)});
  }
  m_meanEnergy = energy / photons;
  for (Bin& bin : m_bins) {
    bin.share /= energy;
    bin.square *= photons / (energy * energy);
  }
}

double Spectrum::sum(double Bin::*weight, const Matter& matter) const {
  double sum = 0;
  for (const Bin& bin : m_bins)
    sum +=
        bin.*weight *
        std::exp(-(bin.water * matter.water + bin.bone * matter.bone + bin.iodine * matter.iodine));
  return sum;
}

double Spectrum::transmitted(const Matter& matter) const {
  return sum(&Bin::share, matter);
}

double Spectrum::variance(const Matter& matter) const {
  return sum(&Bin::square, matter);
}

}  // namespace lumen::convert
