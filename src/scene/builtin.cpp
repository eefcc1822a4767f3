// SPDX-License-Identifier: Apache-2.0
// The built-in scenes by name.
#include <array>

#include "base/float_environment.h"
#include "scene/builtin_scenes.h"

namespace frontmost {
namespace {

constexpr std::array<std::string_view, 6> kNames{"teapot", "cubes", "cycle", "city", "spheres", "gallery"};
constexpr std::array<Scene (*)(), kNames.size()> kMakers{make_teapot, make_cubes,   make_cycle,
                                                         make_city,   make_spheres, make_gallery};

}  // namespace

std::span<const std::string_view> builtin_names() { return kNames; }

Scene builtin(std::string_view name) {
  // Scenes are the same to the bit on every machine, so the caller's rounding mode must not matter either.
  const IeeeScope ieee;
  std::string known;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) {
      Scene scene = kMakers[i]();
      scene.name = name;
      return scene;
    }
    known += (i == 0 ? "" : ", ") + std::string(kNames[i]);
  }
  throw Error(ErrorCode::bad_argument, "builtin:" + std::string(name) + ": no such scene; there are " + known);
}

}  // namespace frontmost
