// SPDX-License-Identifier: Apache-2.0
// Models out: what a scene holds as a file that other programs read.
//
//   .ply   all objects as one mesh; numbers and colours of its faces
//   .stl   nothing but triangles
//   .glb   objects with their names and places, materials, textures
#pragma once

#include <string>

#include "frontmost/scene.h"
#include "frontmost/table.h"

namespace frontmost {

/// Writes the objects of a scene, whole or not at all, in the format that the suffix names. Triangles have the order of
/// primitive ids. Coordinates are those of the file that the scene came from (about its origin again); PLY is of
/// floats, and of doubles where the scene has an origin; STL of floats. PLY and STL wind the triangles of mirrored
/// objects the other way, so that what is outside stays outside. Curved primitives, cameras, lights and categories are
/// left out.
///
/// `of_triangles` are further properties of the faces in a PLY file, a row for every triangle: uchar, uint or double.
/// Columns of bytes that are named red, green and blue are the colours that viewers show.
///
/// GLB (glTF 2.0) has a node for each object, a mesh for each that is used, materials with the layers of glTF's
/// extensions, and textures as PNG. Its y is up: where another axis is, or the scene has an origin, a node above all
/// others turns and moves them. Vertices are those that corners need: one for each position, normal, colour and texture
/// coordinates that belong together. Triangles with corners that are not finite are left out, and so are normals of a
/// mesh of which one has no direction.
/// O(triangles log triangles) for GLB, O(triangles) for others. \throws Error file_unwritable; unsupported for another
/// suffix, or a table where the format is not PLY; bad_argument for a table that is not of the scene's triangles;
/// limit_exceeded for more than 2^32 - 2 vertices in PLY or 4 GiB in GLB; as validate(scene) does.
void save(const Scene& scene, const std::string& path, const Table& of_triangles = {});

}  // namespace frontmost
