// SPDX-License-Identifier: Apache-2.0
// Stands for draco.cpp in builds without Draco.
#include "io/models/gltf/compressed.h"

namespace frontmost::gltf {

bool has_draco() { return false; }
DracoMesh decode_draco(const JsonValue&, Bytes) { return {}; }

}  // namespace frontmost::gltf
