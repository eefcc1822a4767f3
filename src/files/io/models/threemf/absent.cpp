// SPDX-License-Identifier: Apache-2.0
// Stands for threemf.cpp in builds without libzip and Expat.
#include "io/models/reader.h"

namespace frontmost {

Scene read_3mf(Bytes, const ModelSource& source) {
  throw Error(ErrorCode::unsupported, source.name(), "", "this Frontmost was built without 3MF (FRONTMOST_3MF)");
}

}  // namespace frontmost
