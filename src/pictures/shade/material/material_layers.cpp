// SPDX-License-Identifier: Apache-2.0
#include "shade/material/material_layers.h"

#include <algorithm>
#include <cmath>

#include "shade/powers.h"

namespace frontmost::shading {
namespace {

void fill(Lane& lane, int count, float value) { std::fill_n(lane.values, count, value); }
void fill(Lane3& lanes, int count, float value) {
  for (Lane* lane : {&lanes.x, &lanes.y, &lanes.z}) fill(*lane, count, value);
}

/// The reflectance at normal incidence between air and this index of refraction; an index of 0 means a mirror.
float straight_reflectance(float ior) {
  const float ratio = (ior - 1) / (ior + 1);
  return ratio * ratio;
}

glm::vec3 absorption_of(const Material::Volume& volume) {
  glm::vec3 absorption;
  // Black absorbs everything at once, with a finite coefficient.
  constexpr float least = 1e-30f;
  for (int c = 0; c < 3; ++c)
    absorption[c] = log2_of(std::max(volume.attenuation_color[c], least)) / volume.attenuation_distance;
  return absorption;
}

}  // namespace

std::unique_ptr<LayerRow> layers_of(const Material& m) {
  if (m.unlit) return nullptr;
  LayerRow row;
  row.has_transmission = m.transmission.factor > 0;
  const Material::Specular& s = m.specular;
  row.has_dielectric = row.has_transmission || m.ior != 1.5f || s.factor != 1 || s.color != glm::vec3(1) ||
                       s.factor_texture.is_set() || s.color_texture.is_set();
  row.has_coat = m.clearcoat.factor > 0;
  row.has_sheen = m.sheen.color != glm::vec3(0);
  if (!row.has_dielectric && !row.has_coat && !row.has_sheen) return nullptr;
  if (m.ior != 1.5f) row.straight = straight_reflectance(m.ior);
  row.absorption = absorption_of(m.volume);
  return std::make_unique<LayerRow>(row);
}

float length_scale_of(const Instance& instance) {
  return float(std::cbrt(std::abs(glm::determinant(glm::dmat3(instance.world_from_mesh)))));
}

std::vector<float> length_scales_of(const Scene& scene) {
  std::vector<float> scales;
  for (const Instance& instance : scene.instances) scales.push_back(length_scale_of(instance));
  return scales;
}

void LayerRun::begin_layers() {
  LayerLanes& out = batch_.layers;
  const int count = batch_.coverage.count;
  if (row_.has_dielectric && !out.has_dielectric) {
    fill(out.is_dielectric, count, 0);
    fill(out.f0, count, 0.04f);
    fill(out.f90, count, 1);
    fill(out.transmission, count, 0);
    out.has_dielectric = true;
  }
  if (row_.has_transmission && !out.has_transmission) {
    fill(out.filter, count, 0);
    fill(out.is_shown, count, 1);
    out.has_transmission = true;
  }
  if (row_.has_sheen && !out.has_sheen) {
    fill(out.sheen, count, 0);
    fill(out.sheen_roughness, count, 1);
    out.has_sheen = true;
  }
  if (row_.has_coat && !out.has_coat) {
    if (!batch_.coat) batch_.coat = std::make_unique<FragmentBatch>();
    fill(out.coat, count, 0);
    FragmentBatch& coat = *batch_.coat;
    coat.geometry.normal = batch_.geometry.normal;
    coat.geometry.to_viewer = batch_.geometry.to_viewer;
    fill(coat.material.base, count, 0);
    fill(coat.material.emissive, count, 0);
    fill(coat.material.metallic, count, 0);
    fill(coat.material.roughness, count, 1);
    coat.coverage.count = count;
    out.has_coat = true;
  }
}

void LayerRun::fill_factors(int begin, int end) {
  begin_layers();
  LayerLanes& out = batch_.layers;
  const auto for_each = [&](bool is_there, const auto& set) {
    for (int i = begin; is_there && i < end; ++i) set(i);
  };
  for_each(row_.has_dielectric, [&](int i) {
    out.is_dielectric[i] = 1;
    out.f0.set(i, m_.specular.color);
    out.f90[i] = m_.specular.factor;
    out.transmission[i] = m_.transmission.factor;
  });
  for_each(row_.has_transmission, [&](int i) { thickness_[i] = m_.volume.thickness; });
  for_each(row_.has_sheen, [&](int i) {
    out.sheen.set(i, m_.sheen.color);
    out.sheen_roughness[i] = m_.sheen.roughness;
  });
  for_each(row_.has_coat, [&](int i) {
    out.coat[i] = m_.clearcoat.factor;
    batch_.coat->material.roughness[i] = m_.clearcoat.roughness;
    batch_.coat->geometry.normal.set(i, batch_.geometry.normal.at(i));
  });
}

/// Light leaves a closed volume through back sides; the absorption was already applied at the front.
bool LayerRun::is_way_out(int i) const {
  return m_.volume.thickness > 0 && !m_.double_sided && input_.setups[batch_.coverage.triangle[i]].is_backside;
}

glm::vec3 LayerRun::filter_at(int i) const {
  if (is_way_out(i)) return glm::vec3(1);
  const float metal = batch_.material.metallic[i], metallic = metal > 0 ? std::min(metal, 1.0f) : 0.0f;
  const glm::vec3 tint = glm::min(glm::max(glm::vec3(0), batch_.material.base.at(i)), glm::vec3(1));  // 0 for NaN
  glm::vec3 filter = tint * (1 - metallic);
  if (m_.volume.thickness > 0) {
    const float scale = input_.length_scales[input_.setups[batch_.coverage.triangle[i]].instance];
    const float way = std::min(thickness_[i] * scale, 1e30f);
    for (int c = 0; c < 3; ++c) filter[c] *= exp2_of(std::max(row_.absorption[c] * way, -126.0f));
  }
  return filter;
}

void LayerRun::settle(int begin, int end) {
  LayerLanes& out = batch_.layers;
  for (int i = begin; i < end && row_.has_dielectric; ++i)
    out.f0.set(i, glm::min(out.f0.at(i) * row_.straight, glm::vec3(1)) * out.f90[i]);
  for (int i = begin; i < end && row_.has_transmission; ++i) {
    out.filter.set(i, filter_at(i));
    out.is_shown[i] = is_way_out(i) ? 0.0f : 1.0f;
  }
}

}  // namespace frontmost::shading
