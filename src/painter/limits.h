// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "frontmost/base.h"

namespace frontmost::painter_detail {

[[noreturn]] inline void refuse_more_polygons_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "painter: more than " + std::to_string(most) + " polygons and pieces");
}

}  // namespace frontmost::painter_detail
