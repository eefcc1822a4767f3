// SPDX-License-Identifier: Apache-2.0
// Takes any bytes as the answer of frontmost-import, in pieces as they come through a pipe: the result is a valid scene
// or an Error. Its stated edges are drawn. The first byte is the size of the pieces.
#include "frontmost/drawings.h"
#include "io/models/import_answer.h"
#include "support/reader_fuzz.h"

namespace frontmost {
namespace {

void draw(const Scene& scene) {
  constexpr std::uint64_t most_triangles = 2000;
  if (triangle_count(scene) == 0 || triangle_count(scene) > most_triangles) return;
  const Surfaces surfaces(scene, {.threads = 1});
  if (surfaces.bounds().is_empty()) return;
  (void)find_rounds(surfaces, {.threads = 1});
  (void)draw_lines(surfaces, frame(surfaces, 64, 64), {}, {.threads = 1});
}

void take(std::span<const std::byte> input) {
  const ModelSource source("fuzz", {.threads = 1});
  ImportReceiver receiver(source, 1 << 24);
  const std::size_t piece = 1 + std::size_t(input[0]) * 16;
  std::vector<std::byte> bytes;
  try {
    for (std::size_t at = 1; at < input.size() && !receiver.answer.has_ended; at += piece) {
      const auto next = input.subspan(at, std::min(piece, input.size() - at));
      bytes.insert(bytes.end(), next.begin(), next.end());
      receiver.take(bytes);
    }
    if (!receiver.answer.has_ended) return;
    Scene scene = scene_of(receiver.answer, source);
    try {
      validate(scene);
    } catch (const Error&) {
      return;  // load() validates, too, and names the file
    }
    draw(scene);
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ") && error.code() != ErrorCode::singular_camera &&
        error.code() != ErrorCode::bad_argument && error.code() != ErrorCode::limit_exceeded)
      std::abort();
  }
}

}  // namespace
}  // namespace frontmost

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) frontmost::take({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
