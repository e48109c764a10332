// SPDX-License-Identifier: Apache-2.0
// The flow through an artery over a cycle of the heart.
#pragma once

namespace lumen::convert {

/// s: the period of the waveform.
inline constexpr double kCycle = 1.1;

/// Flow of the common carotid artery at a time, in s, over its mean: 1 in the mean. Boileau et al., A
/// benchmark study of numerical schemes for one-dimensional arterial blood flow modelling, Int J
/// Numer Meth Biomed Eng 31, 2015: a Fourier series with a mean of 6.5 ml/s, of which harmonics above
/// the eleventh, below 0.3 % of it, are left out.
double carotidFlow(double time);

}  // namespace lumen::convert
