// SPDX-License-Identifier: Apache-2.0
// Binary STL, piece by piece: records of 50 bytes.
//
// A record holds its whole triangle, so a piece is a number of records and depends on no earlier ones. The header or
// the size tells their number; for a pipe with an open header, only its end does. The first piece must know whether
// triangles have colours, so the first thousand records decide.
#include <algorithm>

#include "base/parallel.h"
#include "io/models/model_stream.h"
#include "io/models/stl/stl.h"
#include "scene/origin.h"

namespace frontmost {
namespace {

constexpr std::uint64_t color_window = 1000;  // stated in a warning

class StlStream final : public ModelStream {
 public:
  StlStream(StreamStart start, std::optional<std::uint64_t> size, const ModelSource& source)
      : ModelStream(std::move(start.bytes), source), size_(size), start_(std::move(start.start)) {
    promised_ = stl_promised_count(start_);
    if (size_) {
      known_count_ = stl_checked_count(start_, *size_, source_, scene_.warnings);
      count_ = *known_count_;
    } else {
      is_open_ = promised_ == 0 || promised_ == 0xFFFFFFFFu;
      count_ = is_open_ ? std::numeric_limits<std::uint64_t>::max() : promised_;
    }
    if (count_ == 0) return;
    const std::uint64_t window = std::min({count_, color_window, std::uint64_t(left_.size() / stl_record_size)});
    has_colors_ = colors_.are_in(left_.first(std::size_t(window) * stl_record_size));
    Mesh& mesh = scene_.meshes.emplace_back();
    mesh.name = stl_header_name(start_);
    scene_.instances.push_back({.name = mesh.name, .mesh = 0});
    // A stream that can be read only once keeps its origin at zero. Its coordinates are floats, so no precision is
    // lost.
    if (can_rewind()) set_origin(scene_, fitting_origin());
  }

  void rewind() override {
    bytes_->seek(start_.size());
    left_ = Bytes(start_).subspan(stl_prelude_size);
    next_ = 0;
  }

  [[nodiscard]] double fraction() const override { return double(next_) / double(std::max<std::uint64_t>(count_, 1)); }

  bool fetch(StreamPiece& piece, std::uint64_t triangles) override {
    piece.clear();
    piece.first_triangle = next_;
    const std::size_t wanted = std::size_t(std::min(triangles, count_ - next_)) * stl_record_size;
    piece.bytes.resize(std::max(piece.bytes.size(), wanted));
    const std::size_t again = std::min(left_.size(), wanted);
    std::copy_n(left_.begin(), again, piece.bytes.begin());
    left_ = left_.subspan(again);
    piece.used = again + bytes_->read(piece.bytes.data() + again, wanted - again);
    const std::uint64_t got = piece.used / stl_record_size;
    next_ += got;
    if (piece.used < wanted) end_early(piece.used % stl_record_size);
    piece.used = std::size_t(got) * stl_record_size;
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
    const std::uint64_t bytes = piece.triangle_count * stl_record_size;
    const bool is_beyond = bytes > left_.size();
    left_ = left_.subspan(std::min(std::size_t(bytes), left_.size()));
    next_ += piece.triangle_count;
    if (is_beyond) bytes_->seek(stl_prelude_size + next_ * stl_record_size);
    return piece.triangle_count > 0;
  }

  void parse(StreamPiece& piece) const override {
    append_stl_records(Bytes(piece.bytes).first(piece.used), has_colors_ ? &colors_ : nullptr, piece.mesh);
  }

 private:
  /// The best origin. The first piece suffices if the model lies near zero.
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

  /// Reports a pipe that ends early; the size of a file would have told this before.
  void end_early(std::size_t rest) {
    if (is_open_ && rest != 0)
      source_.fail("triangle " + std::to_string(next_),
                   "the file ends within the triangle; its header does not say how many there are");
    if (!is_open_)
      source_.fail("triangle " + std::to_string(next_),
                   "the file ends here, but its header promises " + std::to_string(promised_) + " triangles");
    if (next_ > 0 && count_ != next_)
      scene_.warnings.push_back("byte 80: the triangle count was left open, the size of the file gives " +
                                std::to_string(next_));
    count_ = next_;
  }

  void warn_of_the_rest() {
    if (size_ || is_open_) return;
    // A file's size tells whether bytes follow; a pipe has to be read to its end.
    std::vector<std::byte> scrap(1 << 16);
    std::uint64_t rest = left_.size();
    for (std::size_t got = 1; got > 0; rest += got) got = bytes_->read(scrap.data(), scrap.size());
    left_ = {};
    if (rest > 0)
      scene_.warnings.push_back("byte " + std::to_string(stl_prelude_size + next_ * stl_record_size) + ": " +
                                std::to_string(rest) + " bytes after the last triangle were passed over");
  }

  std::optional<std::uint64_t> size_;
  std::vector<std::byte> start_;
  Bytes left_ = Bytes(start_).subspan(stl_prelude_size);  ///< rest of the start that is not in a piece yet
  std::uint64_t promised_ = 0, count_ = 0, next_ = 0;
  bool is_open_ = false;  ///< whether this is a pipe whose header does not tell the number of triangles
  StlColors colors_{start_};
  bool has_colors_ = false, has_warned_of_colors_ = false;
};

}  // namespace

std::unique_ptr<ModelStream> open_stl_stream(StreamStart start, const ModelSource& source) {
  const std::optional<std::uint64_t> size = start.size();
  start.extend(stl_prelude_size + color_window * stl_record_size);
  return std::make_unique<StlStream>(std::move(start), size, source);
}

}  // namespace frontmost
