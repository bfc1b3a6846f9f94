// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/exercise/smoothness.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostPoints = std::size_t{1} << 20U;  ///< of a speed: nearly 3 h at 100 Hz
constexpr int kMostPadding = 8;

/// Transforms in place by the iterative algorithm of Cooley and Tukey (1965).
/// @pre the size is a power of two
void fourier_transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, reversed = 0; i < n; ++i) {
    std::size_t bit = n >> 1U;
    for (; (reversed & bit) != 0; bit >>= 1U) reversed ^= bit;
    reversed ^= bit;
    if (i < reversed) std::swap(x[i], x[reversed]);
  }
  std::vector<std::complex<double>> root(n / 2);
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = std::polar(1.0, -2.0 * kPi * static_cast<double>(k) / static_cast<double>(n));
  for (std::size_t length = 2; length <= n; length *= 2)
    for (std::size_t begin = 0; begin < n; begin += length)
      for (std::size_t k = 0; k < length / 2; ++k) {
        const std::complex<double> odd = x[begin + k + length / 2] * root[k * (n / length)];
        const std::complex<double> even = x[begin + k];
        x[begin + k] = even + odd;
        x[begin + k + length / 2] = even - odd;
      }
}

void check(std::span<const double> speed, double rate, const SparcParameters& parameters) {
  if (speed.size() < 2 || speed.size() > kMostPoints)
    throw std::invalid_argument(
        fmt::format("the speed has {} values; 2 to {} are needed", speed.size(), kMostPoints));
  const auto unusable = [](double v) { return !std::isfinite(v); };
  if (std::any_of(speed.begin(), speed.end(), unusable))
    throw std::invalid_argument("the speed has a value that is not finite");
  if (!(rate > 0.0 && std::isfinite(rate)))
    throw std::invalid_argument(fmt::format("the rate is {} Hz; write a number above 0", rate));
  if (parameters.padding < 0 || parameters.padding > kMostPadding)
    throw std::invalid_argument(
        fmt::format("the padding is {}; write 0 to {}", parameters.padding, kMostPadding));
  if (!(parameters.cut_off > 0.0 && parameters.threshold >= 0.0 && parameters.threshold <= 1.0))
    throw std::invalid_argument(
        fmt::format("cut-off {} Hz and threshold {}: the cut-off is above 0, the threshold from 0 to 1",
                    parameters.cut_off, parameters.threshold));
}

}  // namespace

double spectral_arc_length(std::span<const double> speed, double rate, const SparcParameters& parameters) {
  check(speed, rate, parameters);
  const std::size_t points = std::bit_ceil(speed.size()) << static_cast<unsigned>(parameters.padding);
  std::vector<std::complex<double>> spectrum(points);
  std::copy(speed.begin(), speed.end(), spectrum.begin());
  fourier_transform(spectrum);
  std::vector<double> magnitude(points);
  std::transform(spectrum.begin(), spectrum.end(), magnitude.begin(), [](auto c) { return std::abs(c); });
  const double largest = *std::max_element(magnitude.begin(), magnitude.end());
  if (!(largest > 0.0)) throw std::invalid_argument("the speed is 0 all the time; its spectrum has no shape");

  // Points up to the cut-off, from the first to the last one that reaches the threshold.
  const double step = rate / static_cast<double>(points);
  std::size_t first = points;
  std::size_t last = 0;
  for (std::size_t k = 0; k < points && static_cast<double>(k) * step <= parameters.cut_off; ++k) {
    if (magnitude[k] / largest < parameters.threshold) continue;
    first = std::min(first, k);
    last = k;
  }
  if (first >= last)
    throw std::invalid_argument(fmt::format(
        "the spectrum has fewer than two points above the threshold below {} Hz", parameters.cut_off));
  double length = 0.0;
  for (std::size_t k = first; k < last; ++k)
    length +=
        std::hypot(1.0 / static_cast<double>(last - first), (magnitude[k + 1] - magnitude[k]) / largest);
  return -length;
}

}  // namespace phalanx
