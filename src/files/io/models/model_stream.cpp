// SPDX-License-Identifier: Apache-2.0
// Recognizes files that can be read piece by piece by their first bytes. A pipe cannot be read again, so these bytes
// are passed on to the reader.

#include "io/models/model_stream.h"

#include "base/parallel.h"
#include "io/models/reader.h"
#include "io/models/stl/stl.h"

namespace frontmost {
namespace {

[[noreturn]] void refuse_stream(const ModelSource& source, const std::string& what) {
  throw Error(ErrorCode::unsupported, source.name(), "", what + " cannot be streamed; binary STL and PLY can");
}

std::unique_ptr<ModelStream> open(ModelFormat format, StreamStart start, const ModelSource& source) {
  switch (format) {
    case ModelFormat::stl:
      if (known_stl_encoding(start.start, start.greatest_size(), source) == StlEncoding::ascii)
        refuse_stream(source, "text STL");
      return open_stl_stream(std::move(start), source);
    case ModelFormat::ply: return open_ply_stream(std::move(start), source);
    case ModelFormat::obj: refuse_stream(source, "OBJ");
    case ModelFormat::off: refuse_stream(source, "OFF");
    case ModelFormat::gltf: refuse_stream(source, "glTF");
    case ModelFormat::threemf: refuse_stream(source, "3MF");
    case ModelFormat::scene: refuse_stream(source, "a scene file");
  }
  throw Error(ErrorCode::bad_argument, source.name(), "", "not a model format");
}

}  // namespace

/// Clears the values but keeps the memory, because the same few pieces are filled repeatedly.
void StreamPiece::clear() {
  const auto clear = [](auto& attribute) {
    attribute.values.clear();
    attribute.triangles.clear();
  };
  mesh.positions.clear();
  mesh.triangles.clear();
  mesh.material_ids.clear();
  mesh.face_ids.clear();
  clear(mesh.normals);
  clear(mesh.texcoords);
  clear(mesh.colors);
  used = 0;
  row_count = 0;
  triangle_count = 0;
}

std::optional<std::uint64_t> StreamStart::size() const {
  return has_ended ? std::uint64_t(start.size()) : bytes->size();
}

void StreamStart::extend(std::size_t size) {
  if (size <= start.size()) return;
  const std::size_t before = start.size();
  start.resize(size);
  start.resize(before + bytes->read(start.data() + before, size - before));
  has_ended = start.size() < size;
}

std::unique_ptr<ModelStream> open_model_stream(const std::string& path, const LoadOptions& options,
                                               const Execution& execution) {
  const std::string name = path == "-" ? "standard input" : path;
  if (path.starts_with("builtin:")) refuse_stream(ModelSource(name, execution), "a built-in scene");
  const auto opened = std::make_shared<OpenedFiles>(path);
  StreamStart start{std::make_unique<ByteStream>(path, name), {}, path, opened};
  constexpr std::size_t enough_to_know = 1024;
  start.extend(enough_to_know);
  const ModelSource source(name, execution);
  if (start.start.empty()) throw Error(ErrorCode::file_malformed, name, "", "the file is empty");
  if (const auto conversion = options.format ? std::nullopt : conversion_by_suffix(path))
    throw Error(ErrorCode::unsupported, name, "", *conversion);
  auto format = options.format ? options.format : path == "-" ? std::nullopt : format_of_suffix(path);
  if (!format) format = format_of_content(start.start);
  // A prefix of a binary STL file holds no whole number of triangles, so format_of_content() does not recognize it.
  if (!format && stl_encoding(start.start, start.greatest_size()) == StlEncoding::binary) format = ModelFormat::stl;
  if (!format)
    throw Error(ErrorCode::unsupported, name, "",
                conversion_by_content(start.start).value_or("not a model that can be streamed (binary STL or PLY)"));
  std::unique_ptr<ModelStream> stream = open(*format, std::move(start), source);
  stream->introduce(path == "-" ? "stdin" : source.stem(), options.up.value_or(default_up(*format)),
                    {format, std::nullopt, opened->paths(), {}});
  return stream;
}

}  // namespace frontmost
