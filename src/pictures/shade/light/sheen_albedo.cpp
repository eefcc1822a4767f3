// SPDX-License-Identifier: Apache-2.0
// The table is computed when the first cloth is shaded, in a few milliseconds, over light directions in equal steps of
// N.L and of the angle around the normal. Sines and cosines of that angle come from rotating a vector by a constant
// step, so every machine has the same table.
#include <algorithm>
#include <cmath>

#include "shade/light/sheen.h"

namespace frontmost::shading {
namespace {

/// Steps over half a turn, and steps of N.L.
constexpr int kSteps = 24;
constexpr double kCosine = 0.99144486137381038, kSine = 0.13052619222005157;             // of pi / 24
constexpr double kFirstCosine = 0.99785892323860348, kFirstSine = 0.065403129230143062;  // of pi / 48

/// The light of one ring of directions, one for each step around the normal.
double ring_sum(float n_l, float n_v, float roughness) {
  const double in_plane_l = std::sqrt(1 - double(n_l) * double(n_l)),
               in_plane_v = std::sqrt(1 - double(n_v) * double(n_v));
  double sum = 0, cosine = kFirstCosine, sine = kFirstSine;
  for (int step = 0; step < kSteps; ++step) {
    const double x = in_plane_v + in_plane_l * cosine, y = in_plane_l * sine, z = double(n_v) + double(n_l);
    const double n_h = z / std::sqrt(x * x + y * y + z * z);
    sum += double(sheen_of({n_l, n_v, float(n_h)}, roughness));
    const double turned = cosine * kCosine - sine * kSine;
    sine = sine * kCosine + cosine * kSine;
    cosine = turned;
  }
  return sum;
}

float albedo_of(float n_v, float roughness) {
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float n_l = (float(i) + 0.5f) / kSteps;
    sum += ring_sum(n_l, n_v, roughness) * double(n_l);
  }
  return float(2 * sum / (kSteps * kSteps));
}

SheenAlbedo make_table() {
  SheenAlbedo table;
  constexpr float last = SheenAlbedo::size - 1;
  for (int row = 0; row < SheenAlbedo::size; ++row)
    for (int column = 0; column < SheenAlbedo::size; ++column) {
      const float root = std::max(float(column) / last, 0.03f);
      const float roughness = least_sheen_roughness + (1 - least_sheen_roughness) * (float(row) / last);
      table.values[std::size_t(row * SheenAlbedo::size + column)] = albedo_of(root * root, roughness);
    }
  return table;
}

}  // namespace

float SheenAlbedo::at(float n_v, float shown_roughness) const {
  constexpr float last = size - 1;
  const float x = std::sqrt(std::clamp(n_v, 0.0f, 1.0f)) * last;
  const float y = (shown_roughness - least_sheen_roughness) * (last / (1 - least_sheen_roughness));
  const int column = std::min(int(x), size - 2), row = std::min(int(y), size - 2);
  const float right = x - float(column), below = y - float(row);
  const float* const upper = values.data() + row * size + column;
  const float* const lower = upper + size;
  const float above_value = upper[0] + (upper[1] - upper[0]) * right;
  const float below_value = lower[0] + (lower[1] - lower[0]) * right;
  return std::clamp(above_value + (below_value - above_value) * below, 0.0f, 1.0f);
}

const SheenAlbedo& sheen_albedo() {
  static const SheenAlbedo table = make_table();
  return table;
}

}  // namespace frontmost::shading
