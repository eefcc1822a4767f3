// SPDX-License-Identifier: Apache-2.0
// Stands for exr.cpp in builds without OpenEXR.
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw Error(ErrorCode::unsupported, name, "", "this Frontmost was built without OpenEXR (FRONTMOST_OPENEXR)");
}

}  // namespace

void save_exr(const Image&, OutputFile& file, const Execution&) { refuse(file.name()); }
void save_deep_exr(const DeepImage&, OutputFile& file, const Execution&) { refuse(file.name()); }
Image load_exr(std::span<const std::byte>, const std::string& name) { refuse(name); }

}  // namespace frontmost::detail
