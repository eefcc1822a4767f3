// SPDX-License-Identifier: Apache-2.0
// Binary PLY, piece by piece. Faces name vertices anywhere in the file, so the rows of vertices must stay accessible.
// A file is mapped, and a piece parses only the blocks that its faces name. The vertices of a pipe stay in memory.
//
//   | header | vertices: rows of one length              | faces: rows of any length |
//              [block 0][block 1] ...                      | piece 0 | piece 1 | ...
//                  ^ 512 rows, parsed when a face of the piece names one of them
//
// If faces jump about so much that the blocks would make up most of the file, single vertices are parsed instead.
#include <algorithm>

#include "base/parallel.h"
#include "io/models/model_stream.h"
#include "io/models/ply/ply_mesh.h"

namespace frontmost {
namespace {

using namespace ply;

/// Limits in bytes for a header, for a row, and for the vertices of a pipe.
constexpr std::size_t max_header = std::size_t(1) << 24;
constexpr std::size_t max_row = std::size_t(1) << 28;
constexpr std::uint64_t max_kept_vertices = std::uint64_t(1) << 29;

/// Finds the length of a row of faces and its number of triangles, without parsing the rest.
class RowScanner {
 public:
  RowScanner(const PlyElement& element, Endian endian, const ModelSource& source) : endian_(endian), source_(source) {
    for (const Column& column : Columns(element).list) {
      const PlyProperty& p = column.property;
      steps_.push_back({size_of(p.is_list ? p.count_type : p.type), size_of(p.type), p.is_list, p.count_type,
                        column.role == Role::corners});
    }
  }

  struct Row {
    std::uint64_t size = 0, triangles = 0;
    bool is_whole = false;
  };
  /// Returns the row at the start of `bytes`. An incomplete row is returned as far as it is known; the parser reports
  /// it.
  [[nodiscard]] Row scan(Bytes bytes) const {
    Row row;
    for (const Step& step : steps_) {
      if (bytes.size() < row.size + step.size) return row;
      const std::byte* value = bytes.data() + row.size;
      row.size += step.size;
      if (!step.is_list) continue;
      const std::int64_t count = PlyBinaryRows({value, step.size}, endian_, source_).integer(step.count_type);
      if (count < 0) break;
      if (step.is_corners) row.triangles = count < 3 ? 0 : std::uint64_t(count) - 2;
      row.size += std::uint64_t(count) * step.value_size;
      if (bytes.size() < row.size) return row;
    }
    row.is_whole = true;
    return row;
  }

 private:
  struct Step {
    std::size_t size, value_size;
    bool is_list;
    PlyType count_type;
    bool is_corners;
  };
  Endian endian_;
  const ModelSource& source_;
  std::vector<Step> steps_;
};

/// The rows of all vertices and their parser.
struct VertexRows {
  Bytes rows;
  const PlyElement* element = nullptr;
  const VertexReader* reader = nullptr;
  const ModelSource* source = nullptr;
  Endian endian = Endian::little;

  void parse(std::uint64_t begin, std::uint64_t end, Coordinates& coordinates, Mesh& mesh) const {
    const std::size_t row = element->least_row_size();
    PlyBinaryRows part(rows.subspan(std::size_t(begin) * row, std::size_t(end - begin) * row), endian, *source);
    reader->read(part, begin, end, coordinates, mesh);
  }

  /// Returns the best origin of the vertices. The first block suffices if the model lies near zero.
  [[nodiscard]] glm::dvec3 fitting_origin() const {
    constexpr std::uint64_t block = 4096;
    Coordinates coordinates;
    Mesh scrap;
    for (std::uint64_t begin = 0; begin < element->count && !coordinates.is_settled(); begin += block) {
      parse(begin, std::min(begin + block, element->count), coordinates, scrap);
      scrap = Mesh();
      check_cancelled(source->execution());
    }
    return coordinates.found();
  }
};

/// The vertices that the faces of a piece name.
class NamedVertices {
 public:
  NamedVertices(const VertexRows& rows, const glm::dvec3& origin, std::size_t most_in_blocks)
      : rows_(rows),
        coordinates_(origin),
        most_in_blocks_(most_in_blocks),
        places_(std::size_t(count_of(rows) / block + 1), no_index) {}

  [[nodiscard]] std::uint64_t count(const Mesh&) const { return count_of(rows_); }
  std::uint32_t operator()(std::uint64_t index, Mesh& mesh) {
    std::uint32_t& place = places_[std::size_t(index / block)];
    if (place != no_index) return place + std::uint32_t(index % block);
    const auto next = std::uint32_t(mesh.positions.size());
    if (next >= most_in_blocks_) {
      rows_.parse(index, index + 1, coordinates_, mesh);
      return next;
    }
    const std::uint64_t begin = index - index % block;
    rows_.parse(begin, std::min(begin + block, count_of(rows_)), coordinates_, mesh);
    place = next;
    return next + std::uint32_t(index % block);
  }

 private:
  static constexpr std::uint64_t block = 512;
  static std::uint64_t count_of(const VertexRows& rows) { return rows.element->count; }

  const VertexRows& rows_;
  Coordinates coordinates_;
  std::size_t most_in_blocks_;
  std::vector<std::uint32_t> places_;  ///< first vertex of each block in the mesh; no_index: not parsed
};

class PlyStream final : public ModelStream {
 public:
  PlyStream(StreamStart start, PlyHeader header, std::unique_ptr<const InputFile> file, const ModelSource& source)
      : ModelStream(std::move(start.bytes), source), header_(std::move(header)), file_(std::move(file)) {
    scene_.warnings = header_.warnings;
    add_object(scene_, "", source_, "header");
    add_texture_materials(header_, source_, scene_);
    choose_elements();
    start_ = std::move(start.start);
    if (file_) {
      vertices_.rows = file_->bytes().subspan(vertex_offset_, std::size_t(vertex_bytes()));
    } else {
      keep_vertices();
    }
    scene_.origin = vertices_.fitting_origin();
    scanner_.emplace(*faces_, endian(), source_);
    if (can_rewind()) rewind();
  }

  void rewind() override {
    bytes_->seek(face_offset_);
    left_.clear();
    next_row_ = next_triangle_ = skipped_ = 0;
  }

  [[nodiscard]] double fraction() const override {
    return double(next_row_) / double(std::max<std::uint64_t>(faces_->count, 1));
  }

  bool fetch(StreamPiece& piece, std::uint64_t triangles) override {
    piece.clear();
    piece.first_triangle = next_triangle_;
    piece.first_row = next_row_;
    for (bool again = false; piece.row_count == 0 && next_row_ < faces_->count; again = true)
      fetch_rows(piece, triangles, again);
    next_triangle_ += piece.triangle_count;
    if (next_row_ == faces_->count && skipped_ > 0 && !has_warned_) {
      scene_.warnings.push_back(skipped_faces_warning(skipped_));
      has_warned_ = true;
    }
    return piece.row_count > 0;
  }

  void parse(StreamPiece& piece) const override {
    PlyBinaryRows rows(Bytes(piece.bytes).first(piece.used), endian(), source_);
    FaceReader<PlyBinaryRows, NamedVertices> faces(
        rows, {vertices_, scene_.origin, 2 * std::size_t(piece.row_count) + 4096}, header_, source_, piece.mesh);
    faces.read_faces(*faces_, Columns(*faces_), piece.first_row, piece.first_row + piece.row_count);
    faces.finish();
    if (piece.mesh.material_ids.empty()) piece.mesh.material_ids = scene_.meshes[0].material_ids;
    if (file_) file_->release(vertices_.rows);
  }

 private:
  [[nodiscard]] Endian endian() const { return endian_of(header_); }
  [[nodiscard]] std::uint64_t vertex_bytes() const {
    return vertices_.element->count * vertices_.element->least_row_size();
  }
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(ErrorCode::unsupported, source_.name(), "header", reason);
  }

  /// Finds one element of vertices and one of faces behind it. Other elements are skipped, if their length is known.
  void choose_elements() {
    // Each element fits into the file, but the sum of all is not checked yet.
    constexpr std::uint64_t farthest = std::uint64_t(1) << 62;
    const std::uint64_t size = file_ ? file_->bytes().size() : farthest;
    std::uint64_t offset = header_.size;
    for (const PlyElement& element : header_.elements) {
      const bool is_face = element.name == "face" || element.name == "tristrips";
      if (element.name == "vertex") {
        if (vertices_.element || faces_) refuse("a stream needs one element of vertices, before the faces");
        reader_.emplace(element, source_);
        vertices_ = {{}, &element, &*reader_, &source_, endian()};
        vertex_offset_ = std::size_t(offset);
      } else if (is_face && Columns(element).has(Role::corners)) {
        if (element.name == "tristrips") refuse("triangle strips cannot be streamed");
        if (!vertices_.element || faces_) refuse("a stream needs one element of faces, after the vertices");
        faces_ = &element;
        face_offset_ = offset;
      }
      if (faces_) continue;  // elements behind the faces are ignored
      if (element.has_lists()) refuse("element " + in_quotes(element.name) + " has lists, and comes before the faces");
      const std::uint64_t row = element.least_row_size();
      if (row > 0 && element.count > (size - std::min(size, offset)) / row)
        fail_within(element, (size - std::min(size, offset)) / row);
      offset += element.count * row;
    }
    if (!faces_) refuse("there are no faces to stream");
    check_index_type(*faces_, Columns(*faces_), source_);
  }

  /// Keeps the vertices of a pipe. The bytes read so far are in `start_` already.
  void keep_vertices() {
    if (face_offset_ - header_.size > max_kept_vertices)
      source_.fail_limit("header", "the vertices of a pipe are kept in memory, and these take more than " +
                                       std::to_string(max_kept_vertices) + " bytes; give a file in place of the pipe");
    const std::size_t before = start_.size();
    if (face_offset_ > before) {
      start_.resize(std::size_t(face_offset_));
      const std::size_t got = bytes_->read(start_.data() + before, start_.size() - before);
      if (before + got < start_.size()) fail_at(before + got);
    } else {
      left_.assign(start_.begin() + std::ptrdiff_t(face_offset_), start_.end());
      start_.resize(std::size_t(face_offset_));
    }
    vertices_.rows = Bytes(start_).subspan(vertex_offset_);
  }

  [[noreturn]] void fail_within(const PlyElement& element, std::uint64_t row) const {
    source_.fail(element.name + " " + std::to_string(row), "the file ends within the row");
  }

  /// Reports a pipe that ended before the faces.
  [[noreturn]] void fail_at(std::uint64_t size) const {
    std::uint64_t offset = header_.size;
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t row = element.least_row_size();
      if (row > 0 && size < offset + element.count * row) fail_within(element, (size - std::min(size, offset)) / row);
      offset += element.count * row;
    }
    source_.fail("header", "the file ends before its rows");
  }

  /// Fills the piece with whole rows. Remaining bytes are kept for the next piece and count for it, because polygons
  /// make more triangles per byte than triangles do. `again` means that a row was longer than all bytes, so twice as
  /// many are read.
  void fetch_rows(StreamPiece& piece, std::uint64_t triangles, bool again) {
    const std::size_t row = faces_->least_row_size() + 3 * corner_size();
    const std::size_t enough = std::max<std::size_t>(std::size_t(triangles) * row, 4096);
    const std::size_t wanted = again ? std::max(enough, left_.size()) : enough - std::min(enough, left_.size());
    piece.bytes.resize(std::max(piece.bytes.size(), left_.size() + wanted));
    std::copy(left_.begin(), left_.end(), piece.bytes.begin());
    const std::size_t got = bytes_->read(piece.bytes.data() + left_.size(), wanted);
    const std::size_t end = left_.size() + got;
    std::size_t at = 0;
    std::uint64_t& count = piece.triangle_count;
    while (next_row_ < faces_->count && count < triangles) {
      RowScanner::Row next = scanner_->scan(Bytes(piece.bytes).subspan(at, end - at));
      if (!next.is_whole && got == wanted && next.size <= max_row) break;
      if (!next.is_whole && got == wanted)
        source_.fail_limit("face " + std::to_string(next_row_), "too long to be streamed");
      // An incomplete row at the end of the file goes to the parser, which reports it.
      at = next.is_whole ? at + std::size_t(next.size) : end;
      count += next.is_whole ? next.triangles : 1;
      if (next.triangles == 0) ++skipped_;
      ++next_row_;
      ++piece.row_count;
      if (!next.is_whole) break;
    }
    left_.assign(piece.bytes.begin() + std::ptrdiff_t(at), piece.bytes.begin() + std::ptrdiff_t(end));
    piece.used = at;
  }

  [[nodiscard]] std::size_t corner_size() const {
    for (const Column& column : Columns(*faces_).list)
      if (column.role == Role::corners) return size_of(column.property.type);
    return 0;
  }

  PlyHeader header_;
  std::unique_ptr<const InputFile> file_;
  std::vector<std::byte> start_;  ///< bytes of a pipe up to the last vertex
  std::optional<VertexReader> reader_;
  VertexRows vertices_;
  const PlyElement* faces_ = nullptr;
  std::optional<RowScanner> scanner_;
  std::size_t vertex_offset_ = 0;
  std::uint64_t face_offset_ = 0;
  std::vector<std::byte> left_;  ///< bytes of an incomplete row
  std::uint64_t next_row_ = 0, next_triangle_ = 0, skipped_ = 0;
  bool has_warned_ = false;
};

/// Reads on until the header is complete. Only the header's parser finds its end: comments and longer words may contain
/// "end_header", too, and lines may be joined.
PlyHeader read_header(StreamStart& start, const ModelSource& source) {
  while (true) {
    const bool is_all = start.has_ended || start.start.size() >= max_header;
    try {
      PlyHeader header = read_ply_header(start.start, start.greatest_size(), source);
      // The header needs the byte behind it, because a line may end with two characters.
      if (is_all || header.size < start.start.size()) return header;
    } catch (const Error&) {
      if (is_all) throw;
    }
    start.extend(2 * start.start.size());
  }
}

}  // namespace

std::unique_ptr<ModelStream> open_ply_stream(StreamStart start, const ModelSource& source) {
  PlyHeader header = read_header(start, source);
  if (header.encoding == PlyEncoding::ascii)
    throw Error(ErrorCode::unsupported, source.name(), "", "text PLY cannot be streamed; binary STL and PLY can");
  if (!start.bytes->can_rewind())
    return std::make_unique<PlyStream>(std::move(start), std::move(header), nullptr, source);
  auto file = std::make_unique<const InputFile>(InputFile::open(start.path, source.name()));
  const ModelSource with_folder(source.name(), source.execution(), *file, start.path, start.opened);
  return std::make_unique<PlyStream>(std::move(start), std::move(header), std::move(file), with_folder);
}

}  // namespace frontmost
