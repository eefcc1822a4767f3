// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB.
#include "io/models/reader.h"

namespace frontmost {

Scene read_gltf(Bytes, const ModelSource& source) {
  throw Error(ErrorCode::unsupported, source.name() + ": glTF is not supported by this build");
}

}  // namespace frontmost
