// SPDX-License-Identifier: Apache-2.0
#include "shade/light/layers.h"

#include <algorithm>
#include <cmath>

#include "shade/light/sheen.h"

namespace frontmost::shading {
namespace {

void clear(Lane3& lanes, int count) {
  for (Lane* lane : {&lanes.x, &lanes.y, &lanes.z}) std::fill_n(lane->values, count, 0.0f);
}

/// Schlick's approximation.
float mirrored(float f0, float f90, float cosine) {
  const float x = std::clamp(1 - cosine, 0.0f, 1.0f), x2 = x * x;
  return f0 + (f90 - f0) * (x2 * x2 * x);
}

float cosine_of_view(const Geometry& g, int i) { return std::max(glm::dot(g.normal.at(i), g.to_viewer.at(i)), 1e-3f); }

float greatest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

/// The share of light that fibres leave for the surface below.
float below_sheen(const FragmentBatch& batch, int i) {
  const float roughness = shown_sheen_roughness(batch.layers.sheen_roughness[i]);
  return 1 - greatest(batch.layers.sheen.at(i)) * sheen_albedo().at(cosine_of_view(batch.geometry, i), roughness);
}

/// The share of light that a varnish leaves for the surface below.
float below_coat(const FragmentBatch& batch, int i) {
  return 1 - batch.layers.coat[i] * mirrored(0.04f, 1, cosine_of_view(batch.coat->geometry, i));
}

/// The share of light that neither the surface nor a layer over it mirrors.
float passes_surface(const FragmentBatch& batch, int i) {
  const LayerLanes& layers = batch.layers;
  const float cosine = cosine_of_view(batch.geometry, i);
  glm::vec3 taken;
  for (int c = 0; c < 3; ++c) taken[c] = mirrored(layers.f0.at(i)[c], layers.f90[i], cosine);
  float passes = 1 - std::min(greatest(taken), 1.0f);
  if (layers.has_sheen) passes *= below_sheen(batch, i);
  if (layers.has_coat) passes *= below_coat(batch, i);
  return passes;
}

}  // namespace

void begin_layers(FragmentBatch& batch) {
  const int count = batch.coverage.count;
  if (batch.layers.has_sheen) clear(batch.layers.sheen_light, count);
  if (batch.layers.has_coat) clear(batch.coat->light, count);
}

void lay_layers_over(FragmentBatch& batch) {
  const LayerLanes& layers = batch.layers;
  const int count = batch.coverage.count;
  for (int i = 0; i < count && layers.has_sheen; ++i)
    batch.light.set(i, batch.light.at(i) * below_sheen(batch, i) + layers.sheen_light.at(i));
  for (int i = 0; i < count && layers.has_coat; ++i)
    batch.light.set(i, batch.light.at(i) * below_coat(batch, i) + batch.coat->light.at(i) * layers.coat[i]);
}

void let_through(FragmentBatch& batch, Mirroring mirroring) {
  // Least opacity where light is mirrored: dividing by it stays finite, and it is invisible.
  constexpr float least = 0x1p-20f;
  const LayerLanes& layers = batch.layers;
  for (int i = 0; i < batch.coverage.count; ++i) {
    float& alpha = batch.material.alpha[i];
    batch.alphas.set(i, glm::vec3(alpha));
    const bool is_shown = layers.is_shown[i] > 0;
    if (is_shown && !(layers.transmission[i] > 0)) continue;
    const float passes = is_shown && mirroring == Mirroring::by_view ? passes_surface(batch, i) : 1.0f;
    const glm::vec3 through = layers.filter.at(i) * (layers.transmission[i] * passes);
    const glm::vec3 sent = is_shown ? batch.light.at(i) * alpha : glm::vec3(0);
    glm::vec3 hidden = glm::clamp((1.0f - through) * alpha, 0.0f, 1.0f);
    if (sent != glm::vec3(0)) hidden = glm::max(hidden, glm::vec3(least));
    alpha = (hidden.x + hidden.y + hidden.z) * (1.0f / 3);
    batch.alphas.set(i, hidden);
    batch.light.set(i, alpha > 0 ? sent / alpha : glm::vec3(0));
  }
}

void hide_by_highlights(FragmentBatch& batch) {
  for (int i = 0; i < batch.coverage.count; ++i) {
    const float brightest = greatest(batch.light.at(i));
    if (!(brightest > 1)) continue;
    batch.light.set(i, batch.light.at(i) / brightest);
    batch.alphas.set(i, glm::min(batch.alphas.at(i) * brightest, glm::vec3(1)));
    batch.material.alpha[i] = std::min(batch.material.alpha[i] * brightest, 1.0f);
  }
}

}  // namespace frontmost::shading
