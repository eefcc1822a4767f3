// SPDX-License-Identifier: Apache-2.0
// Reads STL: binary files, whole or piece by piece, and text files. Stored normals are dropped, because they follow
// from the corners.
//
//   byte   0                    80        84                134               184
//          | anything, 80 bytes | count   | triangle 0      | triangle 1      | ...
//                                         normal, three corners (12 floats), 2 bytes: perhaps a colour
//
// Neither the header nor the count can be trusted: the header may hold any text, and writers that cannot seek back
// leave the count open. The file's size decides.
#include <algorithm>
#include <atomic>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "io/binary.h"
#include "io/models/coordinates.h"
#include "io/models/mesh_building.h"
#include "io/models/model_stream.h"
#include "io/models/reader.h"
#include "io/models/text.h"
#include "scene/origin.h"

namespace frontmost {
namespace {

constexpr std::size_t header_size = 80, prelude_size = 84, record_size = 50;
constexpr std::size_t normal_size = 12, corners_size = 36, attribute_offset = normal_size + corners_size;
// Each triangle has three vertices of its own, and 32-bit indices must reach all of them.
constexpr std::uint64_t max_triangles = no_index / 3;

/// Whether a word, in any case, is `lower`.
bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] | 0x20) != lower[i]) return false;
  return true;
}

bool is_text(Bytes bytes) {
  const Bytes start = bytes.first(std::min<std::size_t>(bytes.size(), 1024));
  return std::none_of(start.begin(), start.end(), [](std::byte b) {
    const auto c = std::to_integer<unsigned char>(b);
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

bool starts_like_ascii(Bytes bytes) {
  const std::string_view text = text_of(bytes);
  const std::size_t i = std::min(text.find_first_not_of(" \t\n\r"), text.size());
  return same_word(text.substr(i, 5), "solid") || same_word(text.substr(i, 5), "facet");
}

std::uint16_t attribute_of(Bytes record) {
  return read_value<std::uint16_t>(record.data() + attribute_offset, Endian::little);
}

/// The colours of triangles. Two groups of programs store them in the two bytes behind each triangle, 5 bits a channel:
/// - VisCAM and SolidView: if bit 15 is set, the triangle has a colour, with blue in the lowest bits;
/// - Magics: the header has "COLOR=" and the colour of the whole part. If bit 15 is clear, a triangle has its own
///   colour, with red in the lowest bits. MeshLab writes such files with bit 15 set.
class StlColors {
 public:
  explicit StlColors(Bytes prelude) {
    constexpr std::string_view key = "COLOR=";
    const std::string_view header(reinterpret_cast<const char*>(prelude.data()), header_size);
    const std::size_t at = header.find(key), end = at + key.size() + 3;
    if (at == std::string_view::npos || end > header_size) return;
    for (int k = 0; k < 3; ++k) part_[k] = float(static_cast<unsigned char>(header[end - 3 + std::size_t(k)])) / 255;
    part_ = linear_color(part_);
    is_red_lowest_ = true;
    is_own_by_bit_ = header.substr(end).starts_with(" MATERIAL=");  // MeshLab
  }
  /// Whether any of these records has a colour. Otherwise the bytes are all 0 or mean something else.
  [[nodiscard]] bool are_in(Bytes records) const {
    std::uint32_t bits = 0;
    for (; records.size() >= record_size; records = records.subspan(record_size)) bits |= attribute_of(records);
    return (bits & (is_own_by_bit_ ? 0x8000 : 0xFFFF)) != 0;
  }
  /// Returns the colour of a triangle, linear and opaque, because some writers leave alpha open. A triangle without a
  /// colour has that of the part, or white.
  [[nodiscard]] glm::vec4 of(Bytes record) const {
    const std::uint16_t bits = attribute_of(record);
    if (((bits & 0x8000) != 0) != is_own_by_bit_) return part_;
    const auto channel = [&](int lowest) { return float((bits >> lowest) & 31) / 31; };
    const int red = is_red_lowest_ ? 0 : 10;
    return linear_color({channel(red), channel(5), channel(10 - red), 1});
  }

 private:
  glm::vec4 part_{1};
  bool is_red_lowest_ = false, is_own_by_bit_ = true;
};

/// Copies records to existing triangles of the mesh, from number `first` on.
void copy_records(Bytes records, std::size_t first, Mesh& mesh) {
  const std::byte* record = records.data();
  const std::size_t end = first + records.size() / record_size;
  for (std::size_t t = first; t < end; ++t, record += record_size) {
    std::memcpy(&mesh.positions[3 * t], record + normal_size, corners_size);
    mesh.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  }
  if constexpr (native_endian == Endian::big)
    for (std::size_t i = 3 * first; i < 3 * end; ++i)
      for (int k = 0; k < 3; ++k) {
        float& value = mesh.positions[i][k];
        value = read_value<float>(reinterpret_cast<const std::byte*>(&value), Endian::little);
      }
}

/// Fills the colours of triangles from number `first` on. The mesh has room for them.
void color_records(Bytes records, const StlColors& colors, std::size_t first, Mesh& mesh) {
  for (std::size_t t = first; !records.empty(); ++t, records = records.subspan(record_size)) {
    mesh.colors.values[t] = colors.of(records);
    mesh.colors.triangles[t] = glm::uvec3(std::uint32_t(t));
  }
}

/// Returns the count in the header, which cannot be trusted.
std::uint64_t promised_count(Bytes prelude) {
  return read_value<std::uint32_t>(prelude.data() + header_size, Endian::little);
}

std::string open_count_warning(std::uint64_t count) {
  return "byte 80: the triangle count was left open, the size of the file gives " + std::to_string(count);
}

std::string rest_warning(std::uint64_t count, std::uint64_t rest) {
  return "byte " + std::to_string(prelude_size + count * record_size) + ": " + std::to_string(rest) +
         " bytes after the last triangle were passed over";
}

[[noreturn]] void fail_early(std::uint64_t triangle, std::uint64_t promised, const ModelSource& source) {
  source.fail("triangle " + std::to_string(triangle),
              "the file ends here, but its header promises " + std::to_string(promised) + " triangles");
}

/// Returns the number of triangles to read, after comparing the header with the size. Writers that cannot seek back
/// leave 0 or 0xFFFFFFFF as the count; then the size decides, if it fits whole records. Oddities cause warnings.
std::uint64_t checked_count(Bytes prelude, std::uint64_t file_size, const ModelSource& source,
                            std::vector<std::string>& warnings) {
  const std::uint64_t promised = promised_count(prelude);
  const std::uint64_t room = file_size - prelude_size, whole = room / record_size;
  if ((promised == 0 || promised == 0xFFFFFFFFu) && room > 0 && room % record_size == 0) {
    warnings.push_back(open_count_warning(whole));
    return whole;
  }
  if (promised > whole) fail_early(whole, promised, source);
  if (room > promised * record_size) warnings.push_back(rest_warning(promised, room - promised * record_size));
  return promised;
}

/// Returns the solid's name, if the header is text. Exporters often put "solid NAME" there.
std::string header_name(Bytes prelude) {
  std::string name(reinterpret_cast<const char*>(prelude.data()), header_size);
  name.resize(std::min(name.find('\0'), name.size()));
  // Programs leave dates, colours and rubbish in the header; unprintable text is no name.
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) return {};
  if (name.starts_with("solid ")) name.erase(0, 6);
  name.erase(name.find_last_not_of(' ') + 1);
  return name;
}

/// Appends the triangles of whole records, with colours unless `colors` is null.
void append_records(Bytes records, const StlColors* colors, Mesh& mesh) {
  const std::size_t first = mesh.triangles.size(), count = records.size() / record_size;
  // A block is so small that the zeros written by resize() are still in the cache when they are overwritten.
  constexpr std::size_t block = 8192;
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t end = std::min(count, begin + block);
    mesh.positions.resize(3 * (first + end));
    mesh.triangles.resize(first + end);
    const Bytes part = records.subspan(begin * record_size, (end - begin) * record_size);
    copy_records(part, first + begin, mesh);
    if (colors == nullptr) continue;
    mesh.colors.values.resize(first + end);
    mesh.colors.triangles.resize(first + end);
    color_records(part, *colors, first + begin, mesh);
  }
}

Scene read_binary_stl(Bytes bytes, const ModelSource& source) {
  Scene scene;
  const std::uint64_t checked = checked_count(bytes, bytes.size(), source, scene.warnings);
  if (checked > max_triangles)
    source.fail_limit("byte " + std::to_string(header_size),
                      std::to_string(checked) + " triangles are more than " + std::to_string(max_triangles));
  const auto count = std::size_t(checked);
  if (count == 0) return scene;
  Mesh mesh;
  mesh.name = header_name(bytes);
  reserve_large(mesh.positions, 3 * count, source.execution());
  reserve_large(mesh.triangles, count, source.execution());
  mesh.positions.resize(3 * count);
  mesh.triangles.resize(count);
  constexpr std::size_t block = 1u << 14;
  const StlColors colors(bytes);
  std::atomic<bool> has_colors = false;
  const auto records_of = [&](std::size_t begin, std::size_t end) {
    return bytes.subspan(prelude_size + begin * record_size, (end - begin) * record_size);
  };
  parallel_for(source.execution(), count, block, [&](std::size_t begin, std::size_t end) {
    const Bytes records = records_of(begin, end);
    copy_records(records, begin, mesh);
    if (colors.are_in(records)) has_colors = true;
    source.release(records);
  });
  if (has_colors) {
    mesh.colors.values.resize(count);
    mesh.colors.triangles.resize(count);
    parallel_for(source.execution(), count, block, [&](std::size_t begin, std::size_t end) {
      color_records(records_of(begin, end), colors, begin, mesh);
      source.release(records_of(begin, end));
    });
  }
  scene.instances.push_back({.name = mesh.name, .mesh = 0});
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

/// Reads text, in which each solid becomes a mesh. Words may be in any case and anywhere on a line, as in files from
/// the wild.
///
///   solid NAME
///     facet normal nx ny nz
///       outer loop
///         vertex x y z                three of them
///       endloop
///     endfacet
///   endsolid NAME
class AsciiStl {
 public:
  AsciiStl(Bytes bytes, const ModelSource& source, Coordinates& coordinates)
      : text_(bytes, source), coordinates_(coordinates) {}

  Scene read() {
    while (text_.to_word()) statement(text_.word());
    if (in_solid_) text_.fail("the file ends within a solid, before \"endsolid\"");
    return std::move(scene_);
  }

 private:
  void statement(std::string_view word) {
    if (same_word(word, "facet")) {
      facet();
    } else if (same_word(word, "solid")) {
      if (in_solid_) text_.fail("\"solid\" within a solid");
      begin_solid();
    } else if (same_word(word, "endsolid")) {
      text_.rest();
      in_solid_ = false;
    } else if (same_word(word, "color")) {
      text_.rest();
    } else {
      text_.fail(in_quotes(word) + " where \"facet\" or \"endsolid\" was expected");
    }
  }

  void begin_solid() {
    in_solid_ = true;
    const std::string name = name_of(text_.rest());
    add_object(scene_, name, text_.source(), text_.place());
  }

  void expect(std::string_view lower) {
    if (!text_.to_word()) text_.fail("the file ends within a triangle, before " + in_quotes(lower));
    const std::string_view word = text_.word();
    if (!same_word(word, lower)) text_.fail(in_quotes(word) + " where " + in_quotes(lower) + " was expected");
  }

  /// Reads facet normal X Y Z outer loop (vertex X Y Z) x 3 endloop endfacet.
  void facet() {
    if (!in_solid_) begin_solid_without_name();
    Mesh& mesh = scene_.meshes.back();
    expect("normal");
    // The normal follows from the corners; any three words in its place are skipped.
    for (int k = 0; k < 3 && text_.to_word(); ++k) text_.word();
    expect("outer");
    expect("loop");
    const auto first = std::uint32_t(mesh.positions.size());
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      mesh.positions.push_back(vertex());
    }
    expect("endloop");
    expect("endfacet");
    if (first > no_index - 6) text_.source().fail_limit(text_.place(), "too many triangles");
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }

  void begin_solid_without_name() {
    in_solid_ = true;
    if (!scene_.meshes.empty()) text_.fail("\"facet\" outside a solid");
    add_object(scene_, "", text_.source(), text_.place());
  }

  glm::vec3 vertex() {
    glm::vec3 rounded{0};
    glm::dvec3 exact{0};
    for (int k = 0; k < 3; ++k)
      if (!text_.to_word() || !text_.number(rounded[k], exact[k]) || !text_.at_blank())
        text_.fail("a vertex needs three numbers");
    return coordinates_(rounded, exact);
  }

  TextScanner text_;
  Coordinates& coordinates_;
  Scene scene_;
  bool in_solid_ = false;
};

constexpr std::uint64_t color_window = 1000;  // stated in a warning

/// A stream of records. A record holds its whole triangle, so a piece is some records and depends on no earlier piece.
/// The header or the size tells the number of records; if the header of a pipe leaves it open, only the end of the pipe
/// does. Whether triangles have colours must be known at the first piece, so the first thousand records decide.
class StlStream final : public ModelStream {
 public:
  StlStream(StreamStart start, std::optional<std::uint64_t> size, const ModelSource& source)
      : ModelStream(std::move(start.bytes), source), size_(size), start_(std::move(start.start)) {
    promised_ = promised_count(start_);
    if (size_) {
      known_count_ = checked_count(start_, *size_, source_, scene_.warnings);
      count_ = *known_count_;
    } else {
      is_open_ = promised_ == 0 || promised_ == 0xFFFFFFFFu;
      count_ = is_open_ ? std::numeric_limits<std::uint64_t>::max() : promised_;
    }
    if (count_ == 0) return;
    const std::uint64_t window = std::min({count_, color_window, std::uint64_t(left_.size() / record_size)});
    has_colors_ = colors_.are_in(left_.first(std::size_t(window) * record_size));
    Mesh& mesh = scene_.meshes.emplace_back();
    mesh.name = header_name(start_);
    scene_.instances.push_back({.name = mesh.name, .mesh = 0});
    // A stream that can be read only once keeps its origin at zero. Its coordinates are floats, so no precision is
    // lost.
    if (can_rewind()) set_origin(scene_, fitting_origin());
  }

  void rewind() override {
    bytes_->seek(start_.size());
    left_ = Bytes(start_).subspan(prelude_size);
    next_ = 0;
  }

  [[nodiscard]] double fraction() const override { return double(next_) / double(std::max<std::uint64_t>(count_, 1)); }

  bool fetch(StreamPiece& piece, std::uint64_t triangles) override {
    piece.clear();
    piece.first_triangle = next_;
    const std::size_t wanted = std::size_t(std::min(triangles, count_ - next_)) * record_size;
    piece.bytes.resize(std::max(piece.bytes.size(), wanted));
    const std::size_t again = std::min(left_.size(), wanted);
    std::copy_n(left_.begin(), again, piece.bytes.begin());
    left_ = left_.subspan(again);
    piece.used = again + bytes_->read(piece.bytes.data() + again, wanted - again);
    const std::uint64_t got = piece.used / record_size;
    next_ += got;
    if (piece.used < wanted) end_early(piece.used % record_size);
    piece.used = std::size_t(got) * record_size;
    piece.triangle_count = got;
    if (got == 0) warn_of_the_rest();
    if (!has_colors_ && !has_warned_of_colors_ && colors_.are_in(Bytes(piece.bytes).first(piece.used))) {
      has_warned_of_colors_ = true;
      scene_.warnings.emplace_back("colours: not read in a stream, because none of the first 1000 triangles has one");
    }
    return got > 0;
  }

  bool pass_over(StreamPiece& piece, std::uint64_t triangles) override {
    if (!size_) return fetch(piece, triangles);
    piece.clear();
    piece.triangle_count = std::min(triangles, count_ - next_);
    const std::uint64_t bytes = piece.triangle_count * record_size;
    const bool is_beyond = bytes > left_.size();
    left_ = left_.subspan(std::min(std::size_t(bytes), left_.size()));
    next_ += piece.triangle_count;
    if (is_beyond) bytes_->seek(prelude_size + next_ * record_size);
    return piece.triangle_count > 0;
  }

  void parse(StreamPiece& piece) const override {
    append_records(Bytes(piece.bytes).first(piece.used), has_colors_ ? &colors_ : nullptr, piece.mesh);
  }

 private:
  /// Returns the best origin. The first piece suffices if the model lies near zero.
  glm::dvec3 fitting_origin() {
    constexpr std::uint64_t triangles_at_once = 4096;
    OriginSearch search;
    StreamPiece piece;
    while (!search.is_home() && fetch(piece, triangles_at_once)) {
      parse(piece);
      for (const glm::vec3& position : piece.mesh.positions) search.include(glm::dvec3(position));
      check_cancelled(source_.execution());
    }
    rewind();
    return search.origin();
  }

  /// Reports a pipe that ends early. The size of a file would have told this before.
  void end_early(std::size_t rest) {
    if (is_open_ && rest != 0)
      source_.fail("triangle " + std::to_string(next_),
                   "the file ends within the triangle; its header does not say how many there are");
    if (!is_open_) fail_early(next_, promised_, source_);
    if (next_ > 0 && count_ != next_) scene_.warnings.push_back(open_count_warning(next_));
    count_ = next_;
  }

  void warn_of_the_rest() {
    if (size_ || is_open_) return;
    // A file's size tells whether bytes follow; a pipe has to be read to its end.
    std::vector<std::byte> scrap(1 << 16);
    std::uint64_t rest = left_.size();
    for (std::size_t got = 1; got > 0; rest += got) got = bytes_->read(scrap.data(), scrap.size());
    left_ = {};
    if (rest > 0) scene_.warnings.push_back(rest_warning(next_, rest));
  }

  std::optional<std::uint64_t> size_;
  std::vector<std::byte> start_;
  Bytes left_ = Bytes(start_).subspan(prelude_size);  ///< rest of the start that is not in a piece yet
  std::uint64_t promised_ = 0, count_ = 0, next_ = 0;
  bool is_open_ = false;  ///< whether this is a pipe whose header does not tell the number of triangles
  StlColors colors_{start_};
  bool has_colors_ = false, has_warned_of_colors_ = false;
};

}  // namespace

StlEncoding stl_encoding(Bytes start, std::uint64_t file_size) {
  if (file_size >= prelude_size) {
    const std::uint64_t room = file_size - prelude_size, needed = promised_count(start) * record_size;
    // Size decides before words: many binary files begin with "solid", and a text hardly has exactly the length that
    // its bytes 80 to 83 would demand.
    if (room == needed) return StlEncoding::binary;
    if (!is_text(start)) return room > needed && needed > 0 ? StlEncoding::binary : StlEncoding::neither;
  }
  return starts_like_ascii(start) && is_text(start) ? StlEncoding::ascii : StlEncoding::neither;
}

StlEncoding known_stl_encoding(Bytes start, std::uint64_t file_size, const ModelSource& source) {
  const StlEncoding encoding = stl_encoding(start, file_size);
  if (encoding != StlEncoding::neither) return encoding;
  if (is_text(start)) source.fail("line 1", "the file looks like a text STL, but does not start with \"solid\"");
  if (file_size < prelude_size)
    source.fail("byte " + std::to_string(file_size), "the file ends within the 84 bytes of a binary STL header");
  return StlEncoding::binary;  // broken; its reader reports the fault
}

Scene read_stl(Bytes bytes, const ModelSource& source) {
  if (known_stl_encoding(bytes, bytes.size(), source) == StlEncoding::binary) return read_binary_stl(bytes, source);
  return read_about_origin([&](Coordinates& coordinates) { return AsciiStl(bytes, source, coordinates).read(); });
}

std::unique_ptr<ModelStream> open_stl_stream(StreamStart start, const ModelSource& source) {
  const std::optional<std::uint64_t> size = start.size();
  start.extend(prelude_size + color_window * record_size);
  return std::make_unique<StlStream>(std::move(start), size, source);
}

}  // namespace frontmost
