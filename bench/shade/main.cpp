// SPDX-License-Identifier: Apache-2.0
// shade_table [--size W,H] [--frames N] [--samples N] [--picture FILE.png] MODEL... : draws models one after another on
// one thread while the camera turns about them, beside llvmpipe with base colours alone, alternating frame by frame.
// builtin:NAME is a scene of the library, scene:NAME one of harness/scenes.h. The camera flies through scenes that have
// a camera inside.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>

#include "harness/scenes.h"
#include "harness/table.h"
#include "shade/textured_gl.h"

namespace frontmost::bench {
namespace {

struct Request {
  int width = 640, height = 480, frames = 15, samples = 1;
  std::string picture;  ///< file for the peer's last frame
  std::vector<std::string> models;
};

/// Processor milliseconds of this thread.
double milliseconds(const std::function<void()>& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
  };
  const double start = now();
  work();
  return now() - start;
}

/// Times of the first frame and of later ones.
struct Times {
  std::vector<double> all;

  [[nodiscard]] double first() const { return all.front(); }
  [[nodiscard]] double median() const {
    std::vector<double> later(all.begin() + 1, all.end());
    std::nth_element(later.begin(), later.begin() + std::ptrdiff_t(later.size() / 2), later.end());
    return later[later.size() / 2];
  }
};

/// Draws our frames: visibility, then colours.
class Pictures {
 public:
  Pictures(const Surfaces& surfaces, Shadows shadows, ShadingRate rate = ShadingRate::each_pixel)
      : surfaces_(surfaces), shader_(surfaces) {
    options_.light.shadows = shadows;
    options_.pixels.rate = rate;
  }
  void draw(const View& view, Times& visibility, Times& colors) {
    const Execution execution{.threads = 1};
    const Visible* visible = nullptr;
    visibility.all.push_back(milliseconds([&] { visible = &buffer_.draw(surfaces_, view, execution); }));
    colors.all.push_back(milliseconds([&] { shader_.shade_bitmap({.visible = visible}, options_, execution); }));
  }

 private:
  const Surfaces& surfaces_;
  ZBuffer buffer_;
  Shader shader_;
  ShadeOptions options_;
};

/// The scene to draw, and how the camera moves.
struct Subject {
  std::string name;
  Scene scene;
  Camera camera = Camera::fit;
};

Subject subject_of(const std::string& model) {
  constexpr std::string_view own = "scene:", built_in = "builtin:";
  if (model.rfind(built_in, 0) == 0) {
    const std::string name = model.substr(built_in.size());
    return {name, builtin(name)};
  }
  if (model.rfind(own, 0) != 0) return {std::filesystem::path(model).stem().string(), load(model)};
  const SceneEntry& entry = find_scene(model.substr(own.size()));
  return {std::string(entry.name), make_scene(entry.name, FRONTMOST_MODELS), entry.camera};
}

View first_view(const Subject& subject, const Surfaces& surfaces, const Request& request) {
  if (subject.camera != Camera::fit) return make_view(surfaces.bounds(), subject.camera, request.width, request.height);
  return frame(surfaces, request.width, request.height);
}

/// Moves the camera one step, about the middle or ahead.
View next_view(const View& view, const Subject& subject, const Box& bounds) {
  const glm::dvec3 middle = bounds.centre(), up = direction(subject.scene.up);
  if (subject.camera == Camera::fit) {
    const glm::dvec3 eye = view.eye() + 0.03 * glm::distance(view.eye(), middle) * view.right();
    return view.looking(eye, middle, up).enclosing(bounds);
  }
  const glm::dvec3 eye =
      view.eye() + 0.002 * glm::distance(glm::dvec3(bounds.low), glm::dvec3(bounds.high)) * view.forward();
  return view.looking(eye, eye + view.forward(), view.up()).enclosing(bounds);
}

void measure(const std::string& model, const Request& request, Table& table) {
  const Subject subject = subject_of(model);
  const Surfaces surfaces(subject.scene);
  Pictures plain(surfaces, Shadows::off), shadowed(surfaces, Shadows::map),
      coarse(surfaces, Shadows::map, ShadingRate::each_2x2);
  TexturedGl peer(subject.scene, request.width, request.height, 1);
  View view = first_view(subject, surfaces, request);
  view.samples = request.samples;
  Times visible, again, colors, with_shadows, by_blocks, theirs;
  for (int i = 0; i < request.frames; ++i) {
    theirs.all.push_back(milliseconds([&] { peer.draw(view); }));
    plain.draw(view, visible, colors);
    shadowed.draw(view, again, with_shadows);
    coarse.draw(view, again, by_blocks);
    view = next_view(view, subject, surfaces.bounds());
  }
  if (!request.picture.empty()) save(peer.read(), request.picture);
  const double ours = visible.median() + colors.median(), all = visible.median() + with_shadows.median();
  table.add({subject.name,
             Cell::whole(surfaces.primitive_count()),
             {visible.median()},
             {colors.median(), 1},
             {with_shadows.median(), 1},
             {by_blocks.median(), 1},
             {with_shadows.first(), 1},
             {1000 / all, 0},
             {theirs.median(), 1},
             {theirs.median() / ours, 2}});
}

Request request_of(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string option = arguments[i];
    const char* const value = i + 1 < count ? arguments[i + 1] : "";
    if (option.rfind("--", 0) != 0) {
      request.models.push_back(option);
      continue;
    }
    ++i;
    if (option == "--size" && std::sscanf(value, "%d,%d", &request.width, &request.height) == 2) continue;
    if (option == "--frames" && std::sscanf(value, "%d", &request.frames) == 1 && request.frames > 1) continue;
    if (option == "--samples" && std::sscanf(value, "%d", &request.samples) == 1) continue;
    if (option == "--picture" && *value) {
      request.picture = value;
      continue;
    }
    throw Error(ErrorCode::bad_argument, option + ": not an option with a value");
  }
  if (request.models.empty()) throw Error(ErrorCode::bad_argument, "give models");
  return request;
}

}  // namespace
}  // namespace frontmost::bench

int main(int count, char** arguments) try {
  using namespace frontmost::bench;
  const Request request = request_of(count, arguments);
  Table table("pictures one after another, one thread, ms", {"model", "triangles", "visible", "colours", "with shadows",
                                                             "by 2x2", "first", "a second", "llvmpipe", "times"});
  for (const std::string& model : request.models) measure(model, request, table);
} catch (const frontmost::Error& error) {
  std::fprintf(stderr, "shade_table: %s\n", error.what());
  return 1;
}
