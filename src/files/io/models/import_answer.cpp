// SPDX-License-Identifier: Apache-2.0
// Sizes that are only claimed take no memory: a frame is taken when all of it is there.
#include "io/models/import_answer.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace frontmost {
namespace {

using import_frames::Kind;

constexpr std::size_t kMostWarnings = 64;
/// Share of all progress that the import takes; the rest is for reading the answer.
constexpr double kImportShare = 0.9;

std::optional<double> number_of(std::string_view text) {
  double number = 0;
  const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// Sets the unit and the upward axis, as far as the text names them.
void set_space(Scene& scene, std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return;
  const std::optional<double> metres = number_of(text.substr(0, blank));
  if (metres && *metres > 0) scene.source.metres_per_unit = metres;
  const std::string_view up = text.substr(blank + 1);
  constexpr std::string_view names[] = {"x", "y", "z", "-x", "-y", "-z"};
  constexpr Axis axes[] = {Axis::x, Axis::y, Axis::z, Axis::minus_x, Axis::minus_y, Axis::minus_z};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (up == names[i]) scene.up = axes[i];
}

}  // namespace

void ImportReceiver::take(std::vector<std::byte>& bytes) {
  std::size_t at = 0;
  while (!answer.has_ended && bytes.size() - at >= import_frames::header_bytes) {
    const std::uint64_t size = import_frames::payload_size(&bytes[at]);
    const auto kind = Kind(bytes[at]);
    if (size > (kind == Kind::model ? most_bytes_ : import_frames::longest_text))
      source_.fail("", "frontmost-import sends a frame of " + std::to_string(size) + " bytes");
    if (bytes.size() - at - import_frames::header_bytes < size) break;
    at += import_frames::header_bytes;
    if (kind == Kind::model) {  // the last frame, and the only large one: it is not copied
      bytes.resize(at + std::size_t(size));
      bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(at));
      answer.model = std::exchange(bytes, {});
      answer.has_ended = true;
      return;
    }
    take(kind, text_of({bytes.data() + at, std::size_t(size)}));
    at += std::size_t(size);
  }
  bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(at));
}

void ImportReceiver::take(Kind kind, std::string_view text) {
  switch (kind) {
    case Kind::progress:
      report_progress(source_.execution(), "load", kImportShare * std::clamp(number_of(text).value_or(0), 0.0, 1.0));
      return;
    case Kind::warning:
      if (answer.warnings.size() < kMostWarnings) answer.warnings.emplace_back(text);
      return;
    case Kind::file:
      if (answer.files.size() <= ImportAnswer::most_files) answer.files.emplace_back(text);
      return;
    case Kind::space: answer.space = text; return;
    case Kind::error: source_.fail("", "could not be read: " + printable(text));
    case Kind::model: break;
  }
  source_.fail("", "frontmost-import sends a frame of unknown kind " + in_quotes(std::string(1, char(kind))));
}

Scene scene_of(const ImportAnswer& answer, const ModelSource& source) {
  Scene scene = read_gltf(answer.model, source);
  scene.source.metres_per_unit = std::nullopt;
  scene.up = Axis::z;
  set_space(scene, answer.space);
  std::vector<std::string> warnings;
  for (const std::string& warning : answer.warnings) warnings.push_back(printable(warning));
  scene.warnings.insert(scene.warnings.begin(), warnings.begin(), warnings.end());
  return scene;
}

}  // namespace frontmost
