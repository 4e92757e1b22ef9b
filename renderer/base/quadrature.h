#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace translucube {

struct Quadrature {
  std::vector<double> x, weight;
};

/// Gauss and Legendre's rule on [0, 1], x rising, by Newton's method from Chebyshev's points
/// (Abramowitz and Stegun 1964, 25.4.30).
inline Quadrature gauss_legendre(int points) {
  Quadrature rule;
  for (int i = points - 1; i >= 0; --i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= points; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = points * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    rule.x.push_back(0.5 * (1 + x));
    rule.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace translucube
