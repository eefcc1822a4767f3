// SPDX-License-Identifier: Apache-2.0
// frontmost render.
#include "command.h"

namespace frontmost::cli {

int run_render(const Settings&) { throw Error(ErrorCode::unsupported, "render: not in this build"); }

}  // namespace frontmost::cli
