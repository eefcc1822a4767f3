// SPDX-License-Identifier: Apache-2.0
// For libraries without the room io: programs link, but their tests of files are not run.
#include "frontmost/files.h"

namespace frontmost {

Scene load(const std::string& path, const LoadOptions&, const Execution&) {
  throw Error(ErrorCode::unsupported, path + ": this library reads no files");
}

Scene load(std::span<const std::byte>, const std::string& name, const LoadOptions&, const Execution&) {
  throw Error(ErrorCode::unsupported, name + ": this library reads no files");
}

}  // namespace frontmost
