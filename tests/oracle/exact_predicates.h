// The predicates as determinants of arbitrary-precision integers, by plain cofactor expansion. Slow and obvious.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "base/vec.h"

namespace curvetet::oracle {

using Integer = boost::multiprecision::cpp_int;
using Matrix = std::vector<std::vector<Integer>>;

inline Integer determinant(const Matrix& m) {
  if (m.size() == 1) return m[0][0];
  Integer sum = 0;
  for (std::size_t column = 0; column < m.size(); ++column) {
    Matrix minor;
    for (std::size_t row = 1; row < m.size(); ++row) {
      std::vector<Integer> entries;
      for (std::size_t k = 0; k < m.size(); ++k) {
        if (k != column) entries.push_back(m[row][k]);
      }
      minor.push_back(entries);
    }
    const Integer term = m[0][column] * determinant(minor);
    sum += column % 2 == 0 ? term : Integer(-term);
  }
  return sum;
}

inline Integer on_grid(double x) { return Integer(static_cast<long long>(x * 0x1p42)); }
inline std::vector<Integer> row(Vec3 a) { return {on_grid(a.x), on_grid(a.y), on_grid(a.z)}; }
inline std::vector<Integer> row(Vec2 a) { return {on_grid(a.x), on_grid(a.y)}; }

inline std::vector<Integer> lifted(std::vector<Integer> r) {
  Integer sum = 0;
  for (const Integer& x : r) sum += x * x;
  r.push_back(sum);
  return r;
}
inline std::vector<Integer> with_one(std::vector<Integer> r) {
  r.push_back(1);
  return r;
}

/// det of rows (point, 1): a rigid reading of the definition, not the one the product uses.
inline int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return -determinant({with_one(row(a)), with_one(row(b)), with_one(row(c)), with_one(row(d))}).sign();
}
inline int orient2d(Vec2 a, Vec2 b, Vec2 c) {
  return determinant({with_one(row(a)), with_one(row(b)), with_one(row(c))}).sign();
}
inline int insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  return -determinant({with_one(lifted(row(a))), with_one(lifted(row(b))), with_one(lifted(row(c))),
                       with_one(lifted(row(d))), with_one(lifted(row(e)))})
              .sign();
}
inline int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return determinant(
             {with_one(lifted(row(a))), with_one(lifted(row(b))), with_one(lifted(row(c))), with_one(lifted(row(d)))})
      .sign();
}

}  // namespace curvetet::oracle
