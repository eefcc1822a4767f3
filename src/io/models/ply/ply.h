// SPDX-License-Identifier: Apache-2.0
// What reading a PLY file whole and reading it as a stream share.
#pragma once

#include "io/models/ply/ply_header.h"

namespace frontmost {

/// Materials for the texture files that the header names, used by the scene's first mesh.
void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene);

/// For Scene::warnings.
[[nodiscard]] std::string skipped_faces_warning(std::uint64_t count);

}  // namespace frontmost
