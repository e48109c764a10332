// SPDX-License-Identifier: Apache-2.0
// Attenuation of a spectrum of X-rays by water, bone, iodine and aluminium.
#pragma once

#include <cstddef>
#include <vector>

namespace lumen::convert {

enum class Material { Water, Bone, Iodine, Aluminium };

/// Mass attenuation coefficient, cm^2/g, of photons of 10 to 150 keV: between the energies of J. H.
/// Hubbell and S. M. Seltzer, Tables of X-ray mass attenuation coefficients, NISTIR 5632, by
/// logarithms. Bone is ICRU's cortical bone.
double massAttenuation(Material material, double keV);

/// Matter on a ray, g/cm^2.
struct Matter {
  double water = 0, bone = 0, iodine = 0;
};

/// The energy of an X-ray tube's spectrum that matter lets through: Kramers' law, filtered by
/// aluminium, seen by a detector that absorbs every photon and adds up their energy.
class Spectrum {
public:
  /// `peak`: of the tube, kV, 30 to 150; `filter`: aluminium, mm.
  Spectrum(double peak, double filter);

  /// The share of the energy, 0 to 1.
  [[nodiscard]] double transmitted(const Matter& matter) const;
  /// The variance of the detector's sum over the square of its mean without matter, for one photon
  /// of the bare beam.
  [[nodiscard]] double variance(const Matter& matter) const;
  [[nodiscard]] double meanEnergy() const { return m_meanEnergy; }  ///< keV, of the bare beam

private:
  struct Bin {
    double share = 0;   ///< of the energy
    double square = 0;  ///< of a photon's energy over the mean, squared, times the bin's photons
    double water = 0, bone = 0, iodine = 0;  ///< cm^2/g
  };
  /// Over the bins, what matter lets through of each.
  [[nodiscard]] double sum(double Bin::*weight, const Matter& matter) const;

  std::vector<Bin> m_bins;
  double m_meanEnergy = 0;
};

}  // namespace lumen::convert
