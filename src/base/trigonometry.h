// Sine, cosine and arc tangent near 0.
#pragma once

namespace gaitpad {

inline constexpr double kTwoOverPi = 6.36619772367581382433e-01;
// Cody-Waite: pi/2 in three parts of 33 bits, so that n * part is exact for |n| < 2^20.
inline constexpr double kHalfPi1 = 1.57079632673412561417e+00,
                        kHalfPi2 = 6.07710050630396597660e-11,
                        kHalfPi3 = 2.02226624879595063154e-21;

// Polynomials on [-pi/4, pi/4], the classic minimax ones of Sun's fdlibm (k_sin.c, k_cos.c).
inline double sin_kernel(double x) noexcept {
  const double z = x * x;
  const double p = 8.33333333332248946124e-03 +
                   z * (-1.98412698298579493134e-04 +
                        z * (2.75573137070700676789e-06 +
                             z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return x + x * z * (-1.66666666666666324348e-01 + z * p);
}

inline double cos_kernel(double x) noexcept {
  const double z = x * x;
  const double p =
      4.16666666666666019037e-02 +
      z * (-1.38888888888741095749e-03 +
           z * (2.48015872894767294178e-05 +
                z * (-2.75573143513906633035e-07 +
                     z * (2.08757232129817482790e-09 - z * 1.13596475577881948265e-11))));
  return 1.0 - 0.5 * z + z * z * p;
}

// atan on [-7/16, 7/16] (fdlibm s_atan.c).
inline double atan_kernel(double x) noexcept {
  const double z = x * x, w = z * z;
  const double s1 =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double s2 =
      w * (-1.99999999998764832476e-01 +
           w * (-1.11111104054623557880e-01 +
                w * (-7.69187620504482999495e-02 +
                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  return x - x * (s1 + s2);
}

}  // namespace gaitpad
