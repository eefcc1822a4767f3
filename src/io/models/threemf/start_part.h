// SPDX-License-Identifier: Apache-2.0
// Which part of a package the model is.
#pragma once

#include "io/models/threemf/package.h"

namespace frontmost::threemf {

/// By the package's relationships or, where they name none, its content types.
/// \throws Error file_malformed where no part is a model.
[[nodiscard]] std::string find_start_part(Package& package, const ModelSource& source);

}  // namespace frontmost::threemf
