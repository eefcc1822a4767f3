// SPDX-License-Identifier: Apache-2.0
// OpenGL's types and constants, as the system's <GL/gl.h> declares them, without its functions' import attributes.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
