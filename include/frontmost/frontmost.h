// SPDX-License-Identifier: Apache-2.0
// All of Frontmost. Each header can be included by itself as well. The shortest way from a file to a picture:
//
//   const Scene scene = load("engine.glb");          // io.h: or builtin("teapot"), or meshes of your own
//   const Surfaces surfaces(scene);                  // surfaces.h: its triangles, each with a number
//   const View view = frame(surfaces, 1920, 1080);   // view.h: a camera and a grid of pixels
//   const Visible visible = zbuffer(surfaces, view); // zbuffer.h; raycast() and others answer in the same type
//   save(shade(surfaces, visible), "engine.png");    // shade.h, io.h: colour is decided last
#pragma once

#include "frontmost/abuffer.h"         // IWYU pragma: export
#include "frontmost/accounting.h"      // IWYU pragma: export
#include "frontmost/agreement.h"       // IWYU pragma: export
#include "frontmost/base.h"            // IWYU pragma: export
#include "frontmost/datasets.h"        // IWYU pragma: export
#include "frontmost/depth_buffer.h"    // IWYU pragma: export
#include "frontmost/environment.h"     // IWYU pragma: export
#include "frontmost/explain.h"         // IWYU pragma: export
#include "frontmost/fighting_faces.h"  // IWYU pragma: export
#include "frontmost/figure.h"          // IWYU pragma: export
#include "frontmost/hatching.h"        // IWYU pragma: export
#include "frontmost/image.h"           // IWYU pragma: export
#include "frontmost/io.h"              // IWYU pragma: export
#include "frontmost/lettering.h"       // IWYU pragma: export
#include "frontmost/lines.h"           // IWYU pragma: export
#include "frontmost/model_file.h"      // IWYU pragma: export
#include "frontmost/occlusion.h"       // IWYU pragma: export
#include "frontmost/output_folder.h"   // IWYU pragma: export
#include "frontmost/page.h"            // IWYU pragma: export
#include "frontmost/painter.h"         // IWYU pragma: export
#include "frontmost/precision.h"       // IWYU pragma: export
#include "frontmost/ray_camera.h"      // IWYU pragma: export
#include "frontmost/raycast.h"         // IWYU pragma: export
#include "frontmost/report.h"          // IWYU pragma: export
#include "frontmost/rounds.h"          // IWYU pragma: export
#include "frontmost/scene.h"           // IWYU pragma: export
#include "frontmost/section.h"         // IWYU pragma: export
#include "frontmost/shade.h"           // IWYU pragma: export
#include "frontmost/sheet.h"           // IWYU pragma: export
#include "frontmost/sheet_view.h"      // IWYU pragma: export
#include "frontmost/stream.h"          // IWYU pragma: export
#include "frontmost/strokes.h"         // IWYU pragma: export
#include "frontmost/surfaces.h"        // IWYU pragma: export
#include "frontmost/table.h"           // IWYU pragma: export
#include "frontmost/tessellate.h"      // IWYU pragma: export
#include "frontmost/version.h"         // IWYU pragma: export
#include "frontmost/view.h"            // IWYU pragma: export
#include "frontmost/visible.h"         // IWYU pragma: export
#include "frontmost/visible_faces.h"   // IWYU pragma: export
#include "frontmost/visible_pixels.h"  // IWYU pragma: export
#include "frontmost/zbuffer.h"         // IWYU pragma: export
