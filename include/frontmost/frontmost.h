// SPDX-License-Identifier: Apache-2.0
// Includes all of Frontmost; each header can also be included by itself. The shortest way from a file to a picture:
//
//   const Scene scene = load("engine.glb");          // files.h; or builtin("teapot"), or meshes of your own
//   const Surfaces surfaces(scene);                  // scene.h: the scene's triangles, each with an id
//   const View view = frame(surfaces, 1920, 1080);   // view.h: a camera and a grid of pixels
//   const Visible visible = zbuffer(surfaces, view); // zbuffer.h; raycast() and others return the same type
//   save(shade(surfaces, visible), "engine.png");    // pictures.h, files.h: colours are decided last
#pragma once

#include "frontmost/answers.h"   // IWYU pragma: export
#include "frontmost/core.h"      // IWYU pragma: export
#include "frontmost/drawings.h"  // IWYU pragma: export
#include "frontmost/files.h"     // IWYU pragma: export
#include "frontmost/methods.h"   // IWYU pragma: export
#include "frontmost/pictures.h"  // IWYU pragma: export
#include "frontmost/streams.h"   // IWYU pragma: export
