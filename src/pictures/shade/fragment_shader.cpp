// SPDX-License-Identifier: Apache-2.0
#include "shade/fragment_shader.h"

namespace frontmost::shading {

TriangleCache::Found TriangleCache::find_or_add(PrimitiveId id) {
  std::uint32_t slot = id * 0x9E3779B1u >> 21;  // 11 bits: slot_count
  while (slots_[slot].generation == generation_) {
    if (slots_[slot].id == id) return {slots_[slot].number, false};
    slot = (slot + 1) % slot_count;
  }
  slots_[slot] = {generation_, id, std::uint16_t(count_++)};
  return {slots_[slot].number, true};
}

void FragmentShader::add_row(PrimitiveId id, int count, const RowStart& start) {
  const TriangleCache::Found found = cache_.find_or_add(id);
  if (found.is_new) new_triangles_.push_back({id, found.number, start.screen});
  Coverage& out = batch_.coverage;
  // Writes four at a time: most rows are that short, and the next row overwrites any excess.
  constexpr int at_once = 4;
  for (int k = 0; k < count; k += at_once)
    for (int lane = 0; lane < at_once; ++lane) {
      const int i = out.count + k + lane;
      out.pixel[i] = start.number + std::uint32_t(start.step * (k + lane));
      out.triangle[i] = found.number;
      out.samples[i] = start.samples;
      out.weight[i] = start.weight;
      out.screen.x[i] = start.screen.x + float(start.step * (k + lane));
      out.screen.y[i] = start.screen.y;
    }
  out.count += count;
}

void FragmentShader::shade_arrived() {
  source_->set_up(new_triangles_, cache_.setups());
  new_triangles_.clear();
  interpolate_geometry(source_->rays(), cache_.setups(), batch_, isa_);
  (*colorist_)(cache_.setups(), batch_);
}

}  // namespace frontmost::shading
