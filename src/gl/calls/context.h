// SPDX-License-Identifier: Apache-2.0
// A context: the state that calls change, the objects that it names, and the stream that draws.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "calls/call_list.h"
#include "state/frame.h"
#include "state/state.h"
#include "submit/stream.h"

namespace frontmost::gl_detail {

/// Objects with names. Contexts that were made with one another's share lists have these in common. A name that
/// glGen... gave out and that is not used yet has a null pointer.
struct SharedObjects {
  std::map<GLuint, std::shared_ptr<TextureObject>> textures;
  std::map<GLuint, std::shared_ptr<const CallList>> lists;
  std::map<GLuint, std::shared_ptr<BufferObject>> buffers;
};

/// What glPushAttrib saved.
struct SavedState {
  GLbitfield mask;
  State state;
  /// Parameters of the textures that were bound to each unit, for GL_TEXTURE_BIT.
  std::vector<TextureObject> textures;
};

struct SavedClientState {
  GLbitfield mask;
  ClientState state;
};

struct OcclusionQuery {
  std::uint64_t samples = 0;
  bool is_made = false;  ///< glBeginQuery was called for the name
};

class Context : public DrawInput {
 public:
  ClientState client;
  std::vector<SavedState> saved;
  std::vector<SavedClientState> saved_client;
  std::array<PixelMap, 10> pixel_maps;  ///< from GL_PIXEL_MAP_I_TO_I on
  std::shared_ptr<SharedObjects> shared = std::make_shared<SharedObjects>();
  std::shared_ptr<TextureObject> default_textures[2];   ///< name 0 of GL_TEXTURE_1D and GL_TEXTURE_2D
  TextureObject proxies[2];                             ///< GL_PROXY_TEXTURE_1D and GL_PROXY_TEXTURE_2D, without texels
  std::array<std::array<EvaluatorMap, kMaps>, 2> maps;  ///< of glMap1 and glMap2
  std::map<GLuint, OcclusionQuery> queries;
  GLuint current_query = 0;
  GLenum current_query_target = GL_SAMPLES_PASSED;
  GLenum render_mode = GL_RENDER;

  PrimitiveStream stream;

  // The display list that is compiled now.
  GLuint list_name = 0;  ///< 0 if none
  GLenum list_mode = GL_COMPILE;
  std::shared_ptr<CallList> list;
  int list_depth = 0;  ///< of nested glCallList

  explicit Context(Context* shares_with);

  /// Records an error, unless one waits for glGetError already.
  void fail(GLenum error) {
    if (error_ == GL_NO_ERROR) error_ = error;
  }
  [[nodiscard]] GLenum take_error() { return std::exchange(error_, GLenum(GL_NO_ERROR)); }
  /// Says once for each name, if FRONTMOST_GL_VERBOSE is set, that a call does nothing here; GL_INVALID_OPERATION.
  void refuse(const char* call);
  [[nodiscard]] bool is_inside_begin() const { return stream.is_open(); }
  /// Draws everything that was submitted.
  void finish() { stream.finish(*this); }

 private:
  GLenum error_ = GL_NO_ERROR;
};

/// The calling thread's context, or null.
[[nodiscard]] Context* current_context();

}  // namespace frontmost::gl_detail
