// SPDX-License-Identifier: Apache-2.0
// The values that attributes of a model part hold. Blanks around them are passed over, anything else is no value.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>

namespace frontmost::threemf {

/// Also infinite ones and NaN: such vertices are kept, as of every format.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// Below no_index.
[[nodiscard]] std::optional<std::uint32_t> parse_index(std::string_view text);
/// #RRGGBB or #RRGGBBAA in sRGB, as linear light.
[[nodiscard]] std::optional<glm::vec4> parse_color(std::string_view text);
/// Twelve finite numbers: the rows of a matrix that row vectors are multiplied by, without its last column.
[[nodiscard]] std::optional<glm::dmat4> parse_transform(std::string_view text);

}  // namespace frontmost::threemf
