// SPDX-License-Identifier: Apache-2.0
// Python's words for shading, and shading options as arguments that several calls share.
#pragma once

#include <frontmost/pictures.h>

#include <optional>
#include <string>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::Shading, "shading",
                {{frontmost::Shading::lit, "lit"},
                 {frontmost::Shading::flat, "flat"},
                 {frontmost::Shading::normals, "normals"},
                 {frontmost::Shading::depth, "depth"},
                 {frontmost::Shading::ids, "ids"},
                 {frontmost::Shading::uv, "uv"}});
FRONTMOST_WORDS(frontmost::Lights, "lights",
                {{frontmost::Lights::key, "key"},
                 {frontmost::Lights::file, "file"},
                 {frontmost::Lights::both, "both"},
                 {frontmost::Lights::none, "none"}});
FRONTMOST_WORDS(frontmost::Shadows, "shadows",
                {{frontmost::Shadows::off, "off"},
                 {frontmost::Shadows::map, "map"},
                 {frontmost::Shadows::rays, "rays"}});
FRONTMOST_WORDS(frontmost::SeeThrough, "see_through",
                {{frontmost::SeeThrough::where_needed, "where_needed"},
                 {frontmost::SeeThrough::always, "always"},
                 {frontmost::SeeThrough::never, "never"}});
FRONTMOST_WORDS(frontmost::Blend, "blend", {{frontmost::Blend::linear, "linear"}, {frontmost::Blend::srgb, "srgb"}});
FRONTMOST_WORDS(frontmost::ToneMapping, "tone_mapping",
                {{frontmost::ToneMapping::none, "none"},
                 {frontmost::ToneMapping::aces, "aces"},
                 {frontmost::ToneMapping::khronos, "khronos"}});

namespace frontmost::python {

/// An Environment from an Environment, "studio", "sky", "none", or the path of a picture.
[[nodiscard]] Environment environment_of(const py::object& given);

/// Binds `make(of, options, threads, progress)` as a method with the members of ShadeOptions as keyword arguments.
template <class Class, class Make>
void bind_shading(Class& bound, const char* name, const char* words, const Make& make) {
  using namespace py::literals;
  bound.def(
      name,
      [make](typename Class::type& of, Shading shading, const py::object& background, Shadows shadows, float opacity,
             SeeThrough see_through, int grid, Lights lights, std::optional<double> ambient_occlusion,
             std::optional<double> ambient_occlusion_radius, Blend blend, const py::object& environment,
             double environment_angle, bool shows_environment, double exposure, ToneMapping tone_mapping,
             const py::object& light_direction, std::optional<double> light_intensity, int threads,
             const py::object& progress) {
        ShadeOptions options{shading, std::nullopt, opacity, {shadows, lights}, {see_through, grid}};
        if (!background.is_none()) options.background = glm::vec3(point(background, "background"));
        if (ambient_occlusion)
          options.light.ambient_occlusion = AmbientOcclusion{*ambient_occlusion, ambient_occlusion_radius};
        options.pixels.blend = blend;
        if (!environment.is_none()) options.light.environment = environment_of(environment);
        options.light.environment_angle = glm::radians(environment_angle);
        options.light.shows_environment = shows_environment;
        options.light.exposure = exposure;
        options.light.tone_mapping = tone_mapping;
        if (!light_direction.is_none()) options.light.direction = point(light_direction, "light_direction");
        options.light.intensity = light_intensity;
        return make(of, options, threads, progress);
      },
      py::kw_only(), "shading"_a = Shading::lit, "background"_a = py::make_tuple(1.0, 1.0, 1.0),
      "shadows"_a = Shadows::map, "opacity"_a = 1.0f, "see_through"_a = SeeThrough::where_needed, "grid"_a = 0,
      "lights"_a = Lights::key, "ambient_occlusion"_a = py::none(), "ambient_occlusion_radius"_a = py::none(),
      "blend"_a = Blend::linear, "environment"_a = py::none(), "environment_angle"_a = 0.0,
      "shows_environment"_a = false, "exposure"_a = 0.0, "tone_mapping"_a = ToneMapping::none,
      "light_direction"_a = py::none(), "light_intensity"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(),
      words);
}

}  // namespace frontmost::python
