// SPDX-License-Identifier: Apache-2.0
// Several files as one stream, and the loop over their pieces.
//
// Errors must not depend on which thread was first. So a worker that fails notes the number of its piece, no later
// piece is begun, and when all have ended the error of the earliest piece is thrown: the one that reading from front to
// back would have met.
#include "stream/piece_loop.h"

#include <algorithm>

#include "base/parallel.h"
#include "io/models/reader.h"

namespace frontmost::streaming {
namespace {

constexpr std::uint64_t most_triangles = no_primitive - 1;  // as of a scene that is read as a whole

[[noreturn]] void fail_too_many() {
  throw Error(ErrorCode::limit_exceeded, "stream: more than 4294967294 triangles over all files");
}

}  // namespace

Models::Models(const std::vector<std::string>& paths, const LoadOptions& options, const Execution& execution) {
  if (paths.empty()) throw Error(ErrorCode::bad_argument, "stream: no files");
  std::uint64_t known = 0;
  for (const std::string& path : paths) {
    Model model;
    model.stream = open_model_stream(path, options, execution);
    add(std::move(model));
    // What headers promise is enough to refuse; a file that does not tell is caught while it is read.
    known += models_.back().stream->known_count().value_or(0);
    if (known > most_triangles) fail_too_many();
  }
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
  // Warnings may come with every piece, and are taken over one by one as they do.
  without_warnings.warnings.clear();
  frontmost::add(scene_, std::move(without_warnings));
  if (!part.instances.empty()) {
    // Pieces are put in place when they are parsed, so that what is made of them has no transforms.
    glm::dmat4& place = scene_.instances.back().world_from_mesh;
    model.moved = glm::dvec3(place[3]);
    place = glm::dmat4(1.0);
  }
  models_.push_back(std::move(model));
  take_warnings(models_.back());
}

void Models::take_warnings(Model& model) {
  const std::vector<std::string>& all = model.stream->scene().warnings;
  for (; model.warnings < all.size(); ++model.warnings)
    scene_.warnings.push_back(model.stream->source().with_name(all[model.warnings]));
}

/// As load() warns.
void Models::end(Model& model) {
  if (!model.has_ended && model.triangle_count == 0)
    scene_.warnings.push_back(model.stream->source().with_name(no_triangles_warning));
  model.has_ended = true;
}

bool Models::can_rewind() const {
  return std::all_of(models_.begin(), models_.end(), [](const Model& m) { return m.stream->can_rewind(); });
}

double Models::fraction() const {
  double sum = 0;
  for (const Model& model : models_) sum += model.stream->fraction();
  return sum / double(models_.size());
}

void Models::rewind() {
  for (Model& model : models_) {
    model.stream->rewind();
    model.triangle_count = 0;
  }
  current_ = next_number_ = 0;
  next_ = 0;
}

bool Models::fetch(StreamPiece& piece, PiecePlace& place, std::uint32_t triangles) {
  for (; current_ < models_.size(); ++current_) {
    Model& model = models_[current_];
    const bool got = model.stream->fetch(piece, triangles);
    take_warnings(model);
    if (!got) {
      end(model);
      continue;
    }
    model.triangle_count += piece.triangle_count;
    place = {next_number_++, PrimitiveId(next_), model.object};
    next_ += piece.triangle_count;
    if (next_ > most_triangles) fail_too_many();
    return true;
  }
  return false;
}

void Models::parse(StreamPiece& piece, const PiecePlace& place) const {
  const Model& model =
      *std::find_if(models_.rbegin(), models_.rend(), [&](const Model& m) { return m.object <= place.object; });
  model.stream->parse(piece);
  // By its object, not by current_: another thread may have fetched from the next file meanwhile.
  for (std::uint32_t& material : piece.mesh.material_ids)
    if (material != no_index) material += model.first_material;
  if (model.moved != glm::dvec3(0))
    for (glm::vec3& position : piece.mesh.positions) position = glm::vec3(glm::dvec3(position) + model.moved);
}

namespace {

/// Hands out pieces, and remembers the error of the first piece that had one.
class Queue {
 public:
  Queue(Models& models, std::uint32_t triangles) : models_(models), triangles_(triangles) {}

  bool fetch(StreamPiece& piece, PiecePlace& place, const Execution& execution) {
    const std::lock_guard lock(mutex_);
    if (error_) return false;
    place.number = fetched_;  // should this fetch fail
    const bool got = models_.fetch(piece, place, triangles_);
    if (got) fetched_ = place.number + 1;
    report_progress(execution, "stream", models_.fraction());
    return got;
  }
  void fail(std::size_t number) {
    const std::lock_guard lock(mutex_);
    // The earliest piece's, as one thread alone would have met it: messages do not depend on threads.
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
  // An index for each worker rather than for each piece: how many pieces there are is known only at the end.
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
