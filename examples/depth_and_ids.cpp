// SPDX-License-Identifier: Apache-2.0
// Depth and object ids through a calibrated camera, as arrays for numpy.load.
//
//   depth_and_ids object.ply depth.npy objects.npy
#include <frontmost/frontmost.h>

#include <cstdio>

namespace {

// A camera of 640 x 480 pixels, as OpenCV's calibration gives it, placed before the model and looking at its middle.
frontmost::View calibrated_view(const frontmost::Surfaces& surfaces) {
  using namespace frontmost;
  const Intrinsics intrinsics{.fx = 615, .fy = 615, .cx = 319.5, .cy = 239.5, .rule = PixelRule::centre_at_integer};
  const glm::dvec3 middle = surfaces.bounds().centre();
  const glm::dvec3 up = direction(surfaces.scene().up);
  View view;
  view.width = 640;
  view.height = 480;
  view.world_from_eye = look_at(middle + 1.5 * surfaces.bounds().diagonal() * glm::dvec3(0.6, 0.6, 0.6), middle, up);
  view.projection =
      make_projection(intrinsics, view.width, view.height, fit_clip(surfaces.bounds(), view.world_from_eye, false));
  return view;
}

}  // namespace

int main(int argument_count, char** arguments) {
  using namespace frontmost;
  if (argument_count != 4) {
    std::fprintf(stderr, "usage: depth_and_ids MODEL DEPTH IDS\n");
    return 2;
  }
  try {
    const Scene scene = load(arguments[1]);
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, calibrated_view(surfaces));
    save(depth_image(visible), arguments[2]);
    save(id_image(surfaces, visible, IdKind::object), arguments[3]);
    const float depth = depths(visible)[visible.index(320, 240)];
    std::printf("the middle of the picture is %g units away\n", double(depth));
  } catch (const Error& error) {
    std::fprintf(stderr, "depth_and_ids: %s\n", error.what());
    return 1;
  }
}
