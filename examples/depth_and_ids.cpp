// SPDX-License-Identifier: Apache-2.0
// Depths and object ids for a calibrated camera, as files for numpy.load: depth_and_ids object.ply depth.npy
// objects.npy
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 4) throw Error(ErrorCode::bad_argument, "give MODEL DEPTH IDS");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  // OpenCV's conventions: the first pixel's centre is (0, 0); x points right, y down, z ahead. Matrices are by columns.
  const Intrinsics intrinsics{.fx = 615, .fy = 615, .cx = 319.5, .cy = 239.5};
  const glm::dmat4 pose(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 1, 12, 1);
  const View view = make_view(intrinsics, 640, 480).placed(pose, PoseConvention::opencv_world_to_camera).between(1, 50);
  const Visible visible = zbuffer(surfaces, view);
  save(depth_image(visible), arguments[2]);
  save(id_image(surfaces, visible, IdKind::object), arguments[3]);
  std::printf("the middle of the picture is %g units away\n", double(depths_of(visible)[visible.index(320, 240)]));
} catch (const Error& error) {
  std::fprintf(stderr, "depth_and_ids: %s\n", error.what());
  return 1;
}
