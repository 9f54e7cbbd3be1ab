// Sine and cosine near 0, for a double and for lanes of doubles.
#pragma once

namespace gaitpad {

inline constexpr double kTwoOverPi = 6.36619772367581382433e-01;
// Cody-Waite: pi/2 in three parts of 33 bits, so that n * part is exact for |n| < 2^20.
inline constexpr double kHalfPi1 = 1.57079632673412561417e+00,
                        kHalfPi2 = 6.07710050630396597660e-11,
                        kHalfPi3 = 2.02226624879595063154e-21;

// Polynomials on [-pi/4, pi/4], the classic minimax ones of Sun's fdlibm (k_sin.c, k_cos.c).
template <class X>
inline X sin_kernel(const X& x) noexcept {
  const X z = x * x;
  const X p = 8.33333333332248946124e-03 +
              z * (-1.98412698298579493134e-04 +
                   z * (2.75573137070700676789e-06 +
                        z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return x + x * z * (-1.66666666666666324348e-01 + z * p);
}

template <class X>
inline X cos_kernel(const X& x) noexcept {
  const X z = x * x;
  const X p = 4.16666666666666019037e-02 +
              z * (-1.38888888888741095749e-03 +
                   z * (2.48015872894767294178e-05 +
                        z * (-2.75573143513906633035e-07 +
                             z * (2.08757232129817482790e-09 - z * 1.13596475577881948265e-11))));
  return 1.0 - 0.5 * z + z * z * p;
}

}  // namespace gaitpad
