// SPDX-License-Identifier: Apache-2.0
// Several files as one stream, and the loop over their pieces.
//
// Errors must not depend on which thread was first. A worker that fails notes the number of its piece, and no later
// piece is begun. When all workers have ended, the error of the earliest piece is thrown: reading from front to back
// would have met that one.
#include "stream/piece_loop.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/parallel.h"
#include "io/models/reader.h"

namespace frontmost::streaming {
namespace {

constexpr std::uint64_t most_triangles = no_primitive - 1;  // as in a scene that is read as a whole

[[noreturn]] void fail_too_many() {
  throw Error(ErrorCode::limit_exceeded, "stream", "more than 4294967294 triangles over all files");
}

/// Refuses pipes: every rank would get other bytes, and some ranks would wait for ever.
void refuse_pipe(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && (!std::filesystem::exists(path, ignored) || std::filesystem::is_regular_file(path, ignored)))
    return;
  throw Error(ErrorCode::unsupported, path == "-" ? "standard input" : path, "",
              "several ranks can read only ordinary files");
}

}  // namespace

Models::Models(const std::vector<std::string>& paths, const LoadOptions& options, const Turns& turns,
               const Execution& execution)
    : turns_(turns) {
  if (paths.empty()) throw Error(ErrorCode::bad_argument, "stream", "no files");
  std::uint64_t known = 0;
  for (const std::string& path : paths) {
    if (turns.count > 1) refuse_pipe(path);
    Model model;
    model.stream = open_model_stream(path, options, execution);
    add(std::move(model));
    // Counts in headers suffice to refuse files before they are read; files without counts are refused while they are
    // read.
    known += models_.back().stream->known_count().value_or(0);
    if (known > most_triangles) fail_too_many();
  }
  has_opened_ = true;
}

void Models::add(Model model) {
  const Scene& part = model.stream->scene();
  if (models_.empty()) {
    scene_.name = part.name;
    scene_.up = part.up;
  }
  model.object = std::uint32_t(scene_.instances.size());
  model.first_material = std::uint32_t(scene_.materials.size());
  Scene without_warnings = part;
  // Warnings may come with every piece, and are taken over one by one.
  without_warnings.warnings.clear();
  frontmost::add(scene_, std::move(without_warnings));
  if (!part.instances.empty()) {
    // Pieces are moved into place when they are parsed, so that surfaces made of them need no transforms.
    glm::dmat4& place = scene_.instances.back().world_from_mesh;
    model.moved = glm::dvec3(place[3]);
    place = glm::dmat4(1.0);
  }
  models_.push_back(std::move(model));
  take_warnings(models_.back());
}

/// Adds a warning. All ranks know the warnings of opening. Warnings of a pass are reported by one of the ranks that
/// read the file.
void Models::warn(const Model& model, const std::string& text) {
  const std::string words = model.stream->source().with_name(text);
  if (turns_.count == 1 || !has_opened_) return scene_.warnings.push_back(words);
  const auto file = std::uint32_t(&model - models_.data());
  if (!is_shared(file) || turns_.number == 0) warnings_.push_back({file, words});
}

void Models::take_warnings(Model& model) {
  const std::vector<std::string>& all = model.stream->scene().warnings;
  for (; model.warnings < all.size(); ++model.warnings) warn(model, all[model.warnings]);
}

std::uint64_t Models::triangle_count() const {
  std::uint64_t sum = 0;
  for (const Model& model : models_) sum += model.triangle_count;
  return sum;
}

std::vector<PrimitiveId> Models::first_ids() const {
  std::vector<PrimitiveId> ids;
  for (const Model& model : models_) ids.push_back(model.first);
  return ids;
}

std::vector<std::uint64_t> Models::triangle_counts() const {
  std::vector<std::uint64_t> counts;
  for (const Model& model : models_) counts.push_back(model.triangle_count);
  return counts;
}

void Models::set_triangle_counts(const std::vector<std::uint64_t>& counts) {
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    models_[i].first = PrimitiveId(first);
    first += counts[i];
    if (first > most_triangles) fail_too_many();
  }
  knows_firsts_ = true;
}

std::vector<FileWarning> Models::take_warnings() { return std::exchange(warnings_, {}); }

void Models::add_warnings(const std::vector<FileWarning>& warnings) {
  for (const FileWarning& warning : warnings) scene_.warnings.push_back(warning.text);
}

bool Models::can_rewind() const {
  return std::all_of(models_.begin(), models_.end(), [](const Model& m) { return m.stream->can_rewind(); });
}

double Models::fraction() const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (!is_read_here(i)) continue;
    sum += models_[i].stream->fraction();
    ++count;
  }
  return count == 0 ? 1 : sum / double(count);
}

void Models::rewind() {
  for (Model& model : models_) {
    model.stream->rewind();
    model.triangle_count = 0;
  }
  current_ = begun_ = next_number_ = 0;
  next_ = shared_pieces_ = 0;
}

bool Models::fetch(StreamPiece& piece, PiecePlace& place, std::uint32_t triangles) {
  for (; current_ < models_.size(); ++current_) {
    if (!is_read_here(current_)) continue;
    Model& model = models_[current_];
    if (begun_ <= current_) {
      if (knows_firsts_) next_ = model.first;
      model.first = PrimitiveId(next_);
      begun_ = current_ + 1;
    }
    while (true) {
      const bool is_wanted =
          !is_shared(current_) || shared_pieces_++ % std::uint64_t(turns_.count) == std::uint64_t(turns_.number);
      const bool got = is_wanted ? model.stream->fetch(piece, triangles) : model.stream->pass_over(piece, triangles);
      take_warnings(model);
      if (!got) break;
      model.triangle_count += piece.triangle_count;
      place = {next_number_++, PrimitiveId(next_), model.object};
      next_ += piece.triangle_count;
      if (next_ > most_triangles) fail_too_many();
      if (is_wanted) return true;
    }
    // A file without triangles gets a warning, as from load().
    if (!model.has_ended && model.triangle_count == 0) warn(model, no_triangles_warning);
    model.has_ended = true;
  }
  return false;
}

void Models::parse(StreamPiece& piece, const PiecePlace& place) const {
  const Model& model =
      *std::find_if(models_.rbegin(), models_.rend(), [&](const Model& m) { return m.object <= place.object; });
  model.stream->parse(piece);
  // The model is found by object, not by current_: another thread may meanwhile have fetched from the next file.
  for (std::uint32_t& material : piece.mesh.material_ids)
    if (material != no_index) material += model.first_material;
  if (model.moved != glm::dvec3(0))
    for (glm::vec3& position : piece.mesh.positions) position = glm::vec3(glm::dvec3(position) + model.moved);
}

namespace {

/// Hands out pieces, and remembers the error of the earliest piece that failed.
class Queue {
 public:
  Queue(Models& models, std::uint32_t triangles) : models_(models), triangles_(triangles) {}

  bool fetch(StreamPiece& piece, PiecePlace& place, const Execution& execution) {
    const std::lock_guard lock(mutex_);
    if (error_) return false;
    place.number = fetched_;  // for an error of this fetch
    const bool got = models_.fetch(piece, place, triangles_);
    if (got) fetched_ = place.number + 1;
    report_progress(execution, "stream", models_.fraction());
    return got;
  }
  void fail(std::size_t number) {
    const std::lock_guard lock(mutex_);
    // The error of the earliest piece is kept, as with a single thread, so messages do not depend on threads.
    if (error_ && number_ <= number) return;
    error_ = std::current_exception();
    number_ = number;
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  Models& models_;
  std::uint32_t triangles_;
  std::mutex mutex_;
  std::size_t fetched_ = 0, number_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void for_each_piece(Models& models, const LoopOptions& options, const Execution& execution,
                    const std::function<void(int, StreamPiece&, const PiecePlace&)>& work) {
  Queue queue(models, options.triangles_at_once);
  // One index per worker and not per piece, because the number of pieces is known only at the end.
  parallel_for(execution, std::size_t(options.workers), 1, [&](std::size_t worker, std::size_t) {
    StreamPiece piece;
    PiecePlace place;
    try {
      while (queue.fetch(piece, place, execution)) {
        models.parse(piece, place);
        work(int(worker), piece, place);
        check_cancelled(execution);
      }
    } catch (...) {
      queue.fail(place.number);
    }
  });
  queue.rethrow();
}

}  // namespace frontmost::streaming
