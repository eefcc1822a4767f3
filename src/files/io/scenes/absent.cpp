// SPDX-License-Identifier: Apache-2.0
// Stands for the rest of this folder in builds without scene files.
#include "io/models/reader.h"

namespace frontmost {

Scene read_scene_file(Bytes, const ModelSource& source) {
  throw Error(ErrorCode::unsupported, source.name(), "",
              "this Frontmost was built without scene files (FRONTMOST_SCENE_FILES)");
}

}  // namespace frontmost
