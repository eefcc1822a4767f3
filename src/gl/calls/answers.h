// SPDX-License-Identifier: Apache-2.0
// The explanation that FRONTMOST_GL_EXPLAIN=x,y asks for, of programs that do not ask themselves.
#pragma once

#include "calls/context.h"

namespace frontmost::gl_detail {

/// Keeps the context's draws if an explanation is asked for. Explains at the program's end, too.
void keep_if_asked(Context& c);
/// Prints every fragment that came to the asked pixel of the context's frame.
void explain_if_asked(Context& c);

}  // namespace frontmost::gl_detail
