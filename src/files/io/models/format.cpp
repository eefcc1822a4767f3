// SPDX-License-Identifier: Apache-2.0
// Recognizes a file's format by its name and its contents. The suffix decides if there is one. Standard input and
// memory have no name, so their first bytes decide: first by magic words, then by typical contents.
#include <algorithm>
#include <array>
#include <cstring>

#include "io/models/reader.h"
#include "io/models/stl/stl.h"

namespace frontmost {
namespace {

/// The first bytes as text, without leading white space and comment lines.
std::string_view first_statement(Bytes bytes) {
  constexpr std::size_t window = 1 << 16;
  std::string_view text = text_of(bytes.first(std::min(bytes.size(), window)));
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (!text.starts_with('#')) return text;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || std::strchr(" \t\r\n", text[word.size()]) != nullptr);
}

bool looks_like_off(std::string_view text) {
  // [ST][C][N][4][n]OFF, the prefixes in any order and the first count perhaps without a blank before it.
  text.remove_prefix(std::min(text.find_first_not_of("STCN4n"), text.size()));
  constexpr std::string_view followers = " \t\r\n#0123456789";
  return text.starts_with("OFF") && (text.size() == 3 || followers.find(text[3]) != std::string_view::npos);
}

bool looks_like_obj(std::string_view text) {
  constexpr std::array statements{"v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "p", "usemtl", "mtllib"};
  return std::any_of(statements.begin(), statements.end(),
                     [&](std::string_view word) { return starts_with_word(text, word); });
}

/// Whether the text of JSON has the member "asset". Writers that sort keys put it behind the accessors, so all text is
/// searched.
bool has_asset(Bytes bytes) { return text_of(bytes).find("\"asset\"") != std::string_view::npos; }

}  // namespace

std::optional<ModelFormat> format_of_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  if (suffix == ".stl") return ModelFormat::stl;
  if (suffix == ".ply") return ModelFormat::ply;
  if (suffix == ".obj") return ModelFormat::obj;
  if (suffix == ".off") return ModelFormat::off;
  if (suffix == ".gltf" || suffix == ".glb") return ModelFormat::gltf;
  if (suffix == ".3mf") return ModelFormat::threemf;
  return std::nullopt;
}

Axis default_up(ModelFormat format) {
  return format == ModelFormat::stl || format == ModelFormat::threemf ? Axis::z : Axis::y;
}

std::optional<ModelFormat> format_of_content(Bytes bytes) {
  const std::string_view text = first_statement(bytes);
  if (text.starts_with("glTF")) return ModelFormat::gltf;
  if (text.starts_with('{')) return has_asset(bytes) ? ModelFormat::gltf : ModelFormat::scene;
  if (text.starts_with("PK\x03\x04")) return ModelFormat::threemf;
  if (starts_with_word(text, "ply")) return ModelFormat::ply;
  if (looks_like_off(text)) return ModelFormat::off;
  if (stl_encoding(bytes) != StlEncoding::neither) return ModelFormat::stl;
  if (looks_like_obj(text)) return ModelFormat::obj;
  return std::nullopt;
}

}  // namespace frontmost
