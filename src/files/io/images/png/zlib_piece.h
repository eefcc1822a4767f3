// SPDX-License-Identifier: Apache-2.0
// Compression of a piece of a deflate stream by zlib, for both kinds of StripDeflater.
#pragma once

#include <zlib.h>

#include <span>

#include "frontmost/base.h"

namespace frontmost::detail {

/// Compresses a piece by itself into `out`, which has room for the worst case. \returns the part of `out` that was
/// filled.
inline std::span<const std::uint8_t> deflate_piece(z_stream& stream, std::span<const std::uint8_t> raw, bool last,
                                                   Buffer<std::uint8_t>& out) {
  ::deflateReset(&stream);
  stream.next_in = const_cast<Bytef*>(raw.data());  // zlib does not write to it
  stream.avail_in = uInt(raw.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  ::deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
  return {out.data(), stream.total_out};
}

}  // namespace frontmost::detail
