// SPDX-License-Identifier: Apache-2.0
#include "vertex/raster_position.h"

#include <algorithm>

#include "base/parallel.h"
#include "vertex/batch.h"

namespace frontmost::gl_detail {

void set_raster_position(DrawInput& input, const glm::vec4& object, Isa isa) {
  const IeeeScope ieee;
  const auto draw = snapshot(input);
  Batch batch;
  batch.clear(draw, Batch::Kind::points);
  batch.vertex_count = 1;
  for (int k = 0; k < kAttributes; ++k) std::fill_n(batch.input(k), 16, input.state.current.values[std::size_t(k)]);
  for (int k = 0; k < 4; ++k) std::fill_n(batch.input(k), 16, object[k]);
  transform_vertices(batch, isa);

  RasterPosition& raster = input.state.current.raster;
  const glm::vec4 clip{batch.clip(0)[0], batch.clip(1)[0], batch.clip(2)[0], batch.clip(3)[0]};
  raster.is_valid = clip.w > 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w &&
                    std::abs(clip.z) <= clip.w && (batch.out_codes()[0] >> 6) == 0;
  if (!raster.is_valid) return;
  const auto window = [&](int axis) {
    return clip[axis] / clip.w * draw->window_scale[axis] + draw->window_offset[axis];
  };
  raster.window = {window(0) / 256, window(1) / 256, std::clamp(window(2), 0.0f, 1.0f), clip.w};
  for (int k = 0; k < 4; ++k) raster.color[k] = batch.output(kOutRed + k)[0];
  for (int k = 0; k < 3; ++k) raster.secondary[k] = draw->has_secondary ? batch.output(kOutRed2 + k)[0] : 0.0f;
  const bool has_coordinate = input.state.fog.coord_source == GL_FOG_COORDINATE;
  raster.distance =
      has_coordinate ? input.state.current.values[kFogCoord] : std::abs((draw->eye_from_object * object).z);
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit) {
    const float* const coord = &input.state.current.values[kTexCoord + 4 * unit];
    raster.texcoords[unit] =
        glm::mat4(input.matrices.texture[unit].back()) * glm::vec4(coord[0], coord[1], coord[2], coord[3]);
  }
  // Generated coordinates; r is of no use to textures of two dimensions.
  for (const BoundTexture& t : draw->textures) {
    const float* const coord = batch.output(kOutTexCoord + 3 * t.unit);
    const std::size_t stride = batch.output_stride();
    glm::vec4& to = raster.texcoords[std::size_t(t.unit)];
    to = {coord[0], coord[stride], to.z, coord[2 * stride]};
  }
}

void set_window_position(DrawInput& input, const glm::vec3& window) {
  RasterPosition& raster = input.state.current.raster;
  const auto& values = input.state.current.values;
  const ViewportState& v = input.state.viewport;
  const double z = std::clamp(double(window.z), 0.0, 1.0);
  raster.window = {window.x, window.y, float(v.near + z * (v.far - v.near)), 1};
  raster.distance = input.state.fog.coord_source == GL_FOG_COORDINATE ? values[kFogCoord] : 0.0f;
  for (int k = 0; k < 4; ++k) raster.color[k] = std::clamp(values[std::size_t(kRed + k)], 0.0f, 1.0f);
  for (int k = 0; k < 3; ++k) raster.secondary[k] = std::clamp(values[std::size_t(kRed2 + k)], 0.0f, 1.0f);
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit)
    for (int k = 0; k < 4; ++k) raster.texcoords[unit][k] = values[kTexCoord + 4 * unit + std::size_t(k)];
  raster.is_valid = true;
}

}  // namespace frontmost::gl_detail
