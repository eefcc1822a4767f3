// SPDX-License-Identifier: Apache-2.0
// The state of a context: initial values, capabilities, stacks of attributes, display lists, and strings.
#include <cstring>
#include <fstream>
#include <regex>
#include <sstream>
#include <thread>

#include "state_table.h"

namespace frontmost::test::state_test {
namespace {

double get(GLenum pname) { return state::get(pname, 1)[0]; }
std::vector<double> color() { return state::get(GL_CURRENT_COLOR, 4); }
const std::vector<double> kRed = {1, 0, 0, 1}, kGreen = {0, 1, 0, 1}, kBlue = {0, 0, 1, 1}, kWhite = {1, 1, 1, 1};
constexpr GLenum kNone = GL_NO_ERROR;

TEST(State, BeginsWithTheValuesOfTheSpecification) {
  OffScreen screen;
  for (const StateValue& v : state_table()) {
    EXPECT_EQ(v.now(), v.initial) << v.name;
    EXPECT_EQ(glGetError(), kNone) << v.name;
  }
}

// clang-format off
TEST(State, LimitsAreAtLeastThoseOfTheSpecification) {
  OffScreen screen;
  for (const auto& [pname, least] : std::initializer_list<std::pair<GLenum, double>>{
      {GL_MAX_LIGHTS, 8}, {GL_MAX_CLIP_PLANES, 6}, {GL_MAX_MODELVIEW_STACK_DEPTH, 32}, {GL_SUBPIXEL_BITS, 4},
      {GL_MAX_PROJECTION_STACK_DEPTH, 2}, {GL_MAX_TEXTURE_STACK_DEPTH, 2}, {GL_MAX_TEXTURE_SIZE, 64}, {GL_RED_BITS, 8},
      {GL_MAX_PIXEL_MAP_TABLE, 32}, {GL_MAX_LIST_NESTING, 64}, {GL_MAX_EVAL_ORDER, 8}, {GL_MAX_VIEWPORT_DIMS, 16},
      {GL_MAX_ATTRIB_STACK_DEPTH, 16}, {GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, 16}, {GL_MAX_TEXTURE_UNITS, 2},
      {GL_MAX_TEXTURE_LOD_BIAS, 2}, {GL_ALPHA_BITS, 8}, {GL_DEPTH_BITS, 24}, {GL_STENCIL_BITS, 8}})
    EXPECT_GE(state::get(pname, 2)[0], least) << std::hex << pname;
  EXPECT_EQ(glGetError(), kNone);
}

TEST(State, CapabilitiesAreEnabledOneByOne) {
  OffScreen screen;
  const std::vector<StateValue>& table = state_table();
  for (const StateValue& v : table) {
    if (!(v.groups & GL_ENABLE_BIT)) continue;
    const auto before = all_values();
    const bool was_on = v.initial[0] != 0;
    was_on ? glDisable(v.pname) : glEnable(v.pname);
    EXPECT_EQ(glIsEnabled(v.pname), !was_on) << v.name;
    EXPECT_EQ((asked<glGetBooleanv, GLboolean>(1, v.pname)[0]), !was_on) << v.name;
    const auto after = all_values();
    for (std::size_t k = 0; k < table.size() && v.pname != GL_COLOR_MATERIAL; ++k)
      EXPECT_EQ(after[k] == before[k], &table[k] != &v) << table[k].name << " after a change of " << v.name;
    was_on ? glEnable(v.pname) : glDisable(v.pname);
    EXPECT_EQ(glIsEnabled(v.pname), was_on) << v.name;
  }
  for (const GLenum array : {GL_VERTEX_ARRAY, GL_NORMAL_ARRAY, GL_COLOR_ARRAY, GL_INDEX_ARRAY, GL_TEXTURE_COORD_ARRAY,
                             GL_EDGE_FLAG_ARRAY, GL_SECONDARY_COLOR_ARRAY, GL_FOG_COORDINATE_ARRAY}) {
    glEnableClientState(array);
    EXPECT_TRUE(glIsEnabled(array) && get(array) == 1) << std::hex << array;
    glDisableClientState(array);
    EXPECT_FALSE(glIsEnabled(array)) << std::hex << array;
  }
  EXPECT_EQ(glGetError(), kNone);
}

/// Sets every value that glPushAttrib saves: kind 1 and kind 2 differ in each of them.
void set_everything(int kind) {
  const auto pick = [kind](auto one, auto two) { return kind == 1 ? one : two; };
  const float f = .25f * float(kind);
  const GLuint k = GLuint(kind);
  const GLfloat v[] = {f, f / 2, f / 4, f / 8};
  const GLdouble dv[] = {v[0], v[1], v[2], v[3]};
  for (const GLenum unit : {GL_TEXTURE3 - k, GL_TEXTURE0 + k}) {
    glActiveTexture(unit), glMultiTexCoord4fv(unit, v);
    for (const StateValue& s : state_table())
      if (s.groups & GL_ENABLE_BIT && s.pname != GL_COLOR_MATERIAL)
        (s.initial[0] == 0) == (kind == 1) ? glEnable(s.pname) : glDisable(s.pname);
    for (const bool is_bound : {false, true})
      for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D}) {
        if (is_bound) glBindTexture(target, 20 + k + 10 * (target == GL_TEXTURE_1D));
        glTexParameterfv(target, GL_TEXTURE_BORDER_COLOR, v), glTexParameterf(target, GL_TEXTURE_PRIORITY, f);
        for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
          glTexParameteri(target, name, pick(GL_NEAREST, GL_LINEAR));
        for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
          glTexParameteri(target, name, pick(GL_CLAMP, GL_MIRRORED_REPEAT));
        for (const GLenum name : {GL_TEXTURE_MIN_LOD, GL_TEXTURE_MAX_LOD, GL_TEXTURE_BASE_LEVEL, GL_TEXTURE_MAX_LEVEL,
                                  GL_TEXTURE_LOD_BIAS, GL_GENERATE_MIPMAP})
          glTexParameteri(target, name, name == GL_GENERATE_MIPMAP ? 2 - kind : kind);
      }
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, pick(GL_DECAL, GL_COMBINE));
    glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, v), glTexEnvf(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, f);
    for (GLenum i = 0; i < 3; ++i) {
      for (const GLenum name : {GL_SOURCE0_RGB, GL_SOURCE0_ALPHA})
        glTexEnvi(GL_TEXTURE_ENV, name + i, pick(GL_PRIMARY_COLOR, GL_CONSTANT));
      for (const GLenum name : {GL_OPERAND0_RGB, GL_OPERAND0_ALPHA})
        glTexEnvi(GL_TEXTURE_ENV, name + i, pick(GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA));
    }
    for (const GLenum name : {GL_COMBINE_RGB, GL_COMBINE_ALPHA})
      glTexEnvi(GL_TEXTURE_ENV, name, pick(GL_ADD, GL_REPLACE));
    for (const GLenum name : {GL_RGB_SCALE, GL_ALPHA_SCALE}) glTexEnvi(GL_TEXTURE_ENV, name, 2 * kind);
    for (const GLenum name : {GL_S, GL_T, GL_R, GL_Q})
      glTexGeni(name, GL_TEXTURE_GEN_MODE, pick(GL_OBJECT_LINEAR, GL_EYE_LINEAR)),
          glTexGenfv(name, GL_OBJECT_PLANE, v), glTexGenfv(name, GL_EYE_PLANE, v);
  }
  for (const GLenum name : {GL_FOG_DENSITY, GL_FOG_START, GL_FOG_END, GL_FOG_INDEX}) glFogf(name, f);
  glFogi(GL_FOG_MODE, pick(GL_LINEAR, GL_EXP2)), glFogfv(GL_FOG_COLOR, v), glFogCoordf(f);
  glFogi(GL_FOG_COORD_SRC, pick(GL_FOG_COORD, GL_FRAGMENT_DEPTH)), glColor4fv(v), glSecondaryColor3fv(v);
  glNormal3fv(v), glEdgeFlag(pick(0, 1)), glWindowPos3f(f, f, f), glMatrixMode(pick(GL_PROJECTION, GL_TEXTURE));
  glViewport(kind, kind, kind, kind), glDepthRange(f, 1 - f / 2), glScissor(kind, kind, kind, kind);
  for (GLenum i = 0; i < 6; ++i) glClipPlane(GL_CLIP_PLANE0 + i, dv);
  for (const GLenum name : {GL_LIGHT_MODEL_LOCAL_VIEWER, GL_LIGHT_MODEL_TWO_SIDE}) glLightModeli(name, 2 - kind);
  glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, pick(GL_SEPARATE_SPECULAR_COLOR, GL_SINGLE_COLOR));
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, v), glShadeModel(pick(GL_FLAT, GL_SMOOTH));
  glColorMaterial(pick(GL_FRONT, GL_BACK), pick(GL_AMBIENT, GL_DIFFUSE));
  for (const GLenum name : {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION, GL_SHININESS, GL_COLOR_INDEXES})
    glMaterialfv(GL_FRONT_AND_BACK, name, v);
  for (const GLenum light : {GL_LIGHT0, GL_LIGHT5})
    for (const GLenum name : {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_POSITION, GL_SPOT_DIRECTION, GL_SPOT_EXPONENT,
                              GL_SPOT_CUTOFF, GL_CONSTANT_ATTENUATION, GL_LINEAR_ATTENUATION, GL_QUADRATIC_ATTENUATION})
      glLightfv(light, name, v);
  for (const GLenum name : {GL_POINT_SIZE_MIN, GL_POINT_FADE_THRESHOLD_SIZE}) glPointParameterf(name, f);
  glPointSize(f), glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, v), glLineWidth(f), glLineStipple(kind + 1, 9 * k);
  glCullFace(pick(GL_FRONT, GL_BACK)), glPolygonMode(GL_FRONT_AND_BACK, pick(GL_LINE, GL_POINT));
  glFrontFace(pick(GL_CW, GL_CCW)), glPolygonOffset(f, f), glPolygonStipple(std::vector(128, GLubyte(k)).data());
  glAlphaFunc(pick(GL_LESS, GL_EQUAL), f), glStencilFunc(pick(GL_LESS, GL_EQUAL), kind, k), glStencilMask(k);
  glStencilOp(pick(GL_INCR, GL_DECR), pick(GL_INCR, GL_DECR), pick(GL_INCR, GL_DECR)), glClearStencil(kind);
  glDepthFunc(pick(GL_GREATER, GL_EQUAL)), glDepthMask(pick(0, 1)), glClearDepth(f);
  glBlendFuncSeparate(pick(0, 1), pick(1, 0), pick(0, 1), pick(1, 0)), glBlendEquation(pick(GL_MIN, GL_MAX));
  glBlendColor(f, f, f, f), glLogicOp(pick(GL_XOR, GL_AND)), glDrawBuffer(pick(GL_NONE, GL_FRONT)), glIndexMask(k);
  glColorMask(pick(0, 1), pick(0, 1), pick(0, 1), pick(0, 1)), glClearColor(f, f, f, f), glClearIndex(f);
  for (const GLenum name : {GL_MAP_COLOR, GL_MAP_STENCIL}) glPixelTransferi(name, 2 - kind);
  for (const GLenum name : {GL_INDEX_SHIFT, GL_INDEX_OFFSET, GL_DEPTH_SCALE, GL_DEPTH_BIAS, GL_RED_SCALE, GL_RED_BIAS,
                            GL_GREEN_SCALE, GL_GREEN_BIAS, GL_BLUE_SCALE, GL_BLUE_BIAS, GL_ALPHA_SCALE, GL_ALPHA_BIAS})
    glPixelTransferi(name, 1 + kind);
  glPixelZoom(f, f), glReadBuffer(pick(GL_FRONT_LEFT, GL_FRONT)), glListBase(k);
  glMapGrid1f(1 + kind, f, 2), glMapGrid2f(1 + kind, f, 2, kind, f, 3);
  for (const GLenum hint : {GL_PERSPECTIVE_CORRECTION_HINT, GL_POINT_SMOOTH_HINT, GL_LINE_SMOOTH_HINT, GL_FOG_HINT,
                            GL_POLYGON_SMOOTH_HINT, GL_GENERATE_MIPMAP_HINT, GL_TEXTURE_COMPRESSION_HINT})
    glHint(hint, pick(GL_FASTEST, GL_NICEST));
}
// clang-format on

TEST(Attributes, EachGroupIsSavedWholeAndAlone) {
  const std::vector<StateValue>& table = state_table();
  for (int bit = 0; bit <= 20; ++bit) {
    const GLbitfield group = bit < 20 ? 1u << bit : GLbitfield(GL_ALL_ATTRIB_BITS);
    OffScreen screen;
    set_everything(1);
    const auto first = all_values();
    glPushAttrib(group);
    set_everything(2);
    ASSERT_EQ(glGetError(), kNone);
    const auto second = all_values();
    glPopAttrib();
    const auto restored = all_values();
    for (std::size_t k = 0; k < table.size(); ++k) {
      if (table[k].groups == 0 || table[k].pname == GL_COLOR_MATERIAL) continue;
      EXPECT_TRUE(bit > 0 || first[k] != second[k]) << table[k].name << " is not changed by the calls for it";
      EXPECT_EQ(restored[k], table[k].groups & group ? first[k] : second[k])
          << table[k].name << " after group " << std::hex << group;
    }
  }
}

TEST(Attributes, OfClientsAreSavedByGroup) {
  const auto set = [](int kind) {
    for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT,
                              GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_ALIGNMENT})
      glPixelStorei(name, kind);
    glClientActiveTexture(GL_TEXTURE0 + GLenum(kind)), glBindBuffer(GL_ARRAY_BUFFER, GLuint(kind));
    kind == 1 ? glEnableClientState(GL_COLOR_ARRAY) : glDisableClientState(GL_COLOR_ARRAY);
    glVertexPointer(1 + kind, GL_SHORT, kind, nullptr), glColorPointer(2 + kind, GL_BYTE, 4 + kind, nullptr);
  };
  for (const GLbitfield group : {GL_CLIENT_PIXEL_STORE_BIT, GL_CLIENT_VERTEX_ARRAY_BIT}) {
    OffScreen screen;
    set(1);
    const auto first = all_values();
    glPushClientAttrib(group), set(2);
    const auto second = all_values();
    glPopClientAttrib();
    const auto restored = all_values();
    for (std::size_t k = 0; k < first.size(); ++k) {
      const StateValue& v = state_table()[k];
      if (v.pname == GL_POLYGON_STIPPLE || v.pname == GL_CLIENT_ATTRIB_STACK_DEPTH) continue;
      const bool is_saved = (std::strstr(v.name, "PACK_") != nullptr) == (group == GL_CLIENT_PIXEL_STORE_BIT);
      EXPECT_EQ(restored[k], is_saved ? first[k] : second[k]) << v.name << " after group " << group;
    }
  }
}

TEST(Values, AreClampedOrConvertedSilently) {
  OffScreen screen;
  glAlphaFunc(GL_LESS, 2), glClearDepth(-1), glDepthRange(2, -1), glClearColor(-1, 2, .5f, 1), glLineStipple(1000, 1);
  EXPECT_EQ(get(GL_ALPHA_TEST_REF), 1);
  EXPECT_EQ(get(GL_DEPTH_CLEAR_VALUE), 0);
  EXPECT_EQ(state::get(GL_DEPTH_RANGE, 2), (std::vector<double>{1, 0}));
  EXPECT_EQ(state::get(GL_COLOR_CLEAR_VALUE, 4), (std::vector<double>{0, 1, .5, 1}));
  EXPECT_EQ(get(GL_LINE_STIPPLE_REPEAT), 256);
  glViewport(0, 0, 1 << 30, 1 << 30), glColor4f(-1, 2, .5f, 1), glPointSize(2.6f);
  EXPECT_EQ(state::get(GL_VIEWPORT, 4)[2], get(GL_MAX_VIEWPORT_DIMS));
  EXPECT_EQ(color(), (std::vector<double>{-1, 2, .5, 1})) << "current colors are not clamped";
  EXPECT_EQ((asked<glGetIntegerv, GLint>(1, GLenum(GL_POINT_SIZE))), std::vector<double>{3}) << "nearest integer";
  EXPECT_EQ((asked<glGetIntegerv, GLint>(1, GLenum(GL_ALPHA_TEST_REF))), std::vector<double>{2147483647});
  const GLint ints[] = {2147483647, 0, -2147483647 - 1, 1073741823};
  glLightiv(GL_LIGHT0, GL_AMBIENT, ints);
  for (const auto& [i, value] : {std::pair(0, 1.0), {2, -1.0}, {3, .5}})
    EXPECT_NEAR(state::light0(GL_AMBIENT, 4)[std::size_t(i)], value, 1e-6);
  EXPECT_EQ(glGetError(), kNone);
}

TEST(RasterPosition, IsAVertexInWindowCoordinates) {
  OffScreen screen;
  glColor4f(2, .5f, -1, 1), glTexCoord2f(.5f, .25f), glMatrixMode(GL_TEXTURE), glScalef(2, 2, 2);
  glMatrixMode(GL_MODELVIEW), glTranslatef(0, 0, -.5f), glRasterPos3f(.5f, -.5f, 0);
  EXPECT_EQ(state::get(GL_CURRENT_RASTER_POSITION, 4), (std::vector<double>{12, 4, .25, 1}));
  EXPECT_EQ(state::get(GL_CURRENT_RASTER_COLOR, 4), (std::vector<double>{1, .5, 0, 1}));
  EXPECT_EQ(get(GL_CURRENT_RASTER_DISTANCE), .5) << "whether fog is enabled or not";
  EXPECT_EQ(state::get(GL_CURRENT_RASTER_TEXTURE_COORDS, 4), (std::vector<double>{1, .5, 0, 1}));
  glRasterPos3f(2, 0, 0);
  EXPECT_EQ(get(GL_CURRENT_RASTER_POSITION_VALID), 0);
  glWindowPos2i(-5, 900);
  EXPECT_EQ(state::get(GL_CURRENT_RASTER_POSITION, 4), (std::vector<double>{-5, 900, 0, 1}));
  EXPECT_EQ(get(GL_CURRENT_RASTER_POSITION_VALID), 1) << "always, by glWindowPos";
}

TEST(Lists, AreCompiledWithoutOrWithExecution) {
  OffScreen screen;
  glNewList(1, GL_COMPILE);
  EXPECT_TRUE(get(GL_LIST_INDEX) == 1 && get(GL_LIST_MODE) == GL_COMPILE);
  glColor3f(1, 0, 0), glEnable(GL_FOG), glTranslatef(1, 0, 0), glEndList();
  EXPECT_EQ(color(), kWhite) << "GL_COMPILE does not execute";
  EXPECT_TRUE(!glIsEnabled(GL_FOG) && state::get(GL_MODELVIEW_MATRIX, 16)[12] == 0) << "GL_COMPILE does not execute";
  glCallList(1), glCallList(1);
  EXPECT_EQ(color(), kRed);
  EXPECT_TRUE(glIsEnabled(GL_FOG) && state::get(GL_MODELVIEW_MATRIX, 16)[12] == 2) << "of two calls";
  glNewList(1, GL_COMPILE_AND_EXECUTE), glColor3f(0, 1, 0), glEndList();
  EXPECT_EQ(color(), kGreen) << "GL_COMPILE_AND_EXECUTE executes";
  glColor3f(0, 0, 1), glCallList(1);
  EXPECT_EQ(color(), kGreen);
}

TEST(Lists, CallsThatRunAtOnceAreNotCompiled) {
  OffScreen screen;
  GLuint texture = 0, buffer = 0;
  GLubyte pixel[4] = {9, 9, 9, 9};
  glNewList(7, GL_COMPILE);
  EXPECT_NE(glGenLists(2), 0u);
  glGenTextures(1, &texture), glGenBuffers(1, &buffer), glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 8), glEnableClientState(GL_COLOR_ARRAY), glVertexPointer(2, GL_SHORT, 6, nullptr);
  glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS), glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  glTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGB, 8, 8, 0, GL_RGB, GL_BYTE, nullptr);
  EXPECT_TRUE(texture != 0 && buffer != 0 && get(GL_ARRAY_BUFFER_BINDING) == buffer && pixel[0] == 0);
  EXPECT_TRUE(glIsEnabled(GL_COLOR_ARRAY) && get(GL_VERTEX_ARRAY_STRIDE) == 6 && get(GL_PACK_ALIGNMENT) == 8);
  EXPECT_EQ(get(GL_CLIENT_ATTRIB_STACK_DEPTH), 1);
  EXPECT_EQ((asked<glGetTexLevelParameteriv, GLint>(1, GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH)[0]), 8);
  glEndList();
  glPixelStorei(GL_PACK_ALIGNMENT, 4), glDisableClientState(GL_COLOR_ARRAY), glBindBuffer(GL_ARRAY_BUFFER, 0);
  glCallList(7);
  EXPECT_TRUE(get(GL_PACK_ALIGNMENT) == 4 && !glIsEnabled(GL_COLOR_ARRAY) && get(GL_ARRAY_BUFFER_BINDING) == 0);
  EXPECT_EQ(glGetError(), kNone);
}

TEST(Lists, KeepPixelsAndVerticesOfTheirTime) {
  OffScreen screen;
  GLubyte pixel[4] = {255, 0, 0, 255};
  GLfloat triangle[] = {-1, -1, 3, -1, -1, 3};
  glEnableClientState(GL_VERTEX_ARRAY), glVertexPointer(2, GL_FLOAT, 0, triangle);
  glNewList(1, GL_COMPILE), glDrawArrays(GL_TRIANGLES, 0, 3), glWindowPos2i(0, 0);
  glDrawPixels(1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel), glEndList();
  std::fill_n(pixel, 4, GLubyte(0)), std::fill_n(triangle, 6, 0.0f);
  glColor3f(0, 0, 1), glCallList(1);
  EXPECT_EQ(read_colors(0, 0, 2, 1), (std::vector<GLubyte>{255, 0, 0, 255, 0, 0, 255, 255})) << "a pixel, the triangle";
}

TEST(Lists, AreNestedAndCalledByOffsets) {
  OffScreen screen;
  const auto scale = [] { return state::get(GL_MODELVIEW_MATRIX, 16)[0]; };
  for (GLuint name = 1; name <= 100; ++name)  // each doubles, and calls the one before
    glNewList(name, GL_COMPILE), glScalef(2, 1, 1), glCallList(name - 1), glEndList();
  glCallList(64);
  EXPECT_EQ(scale(), 18446744073709551616.0) << "64 deep";
  const GLubyte bytes[] = {0, 0, 0, 1, 1, 0};
  const GLint back[] = {-1, 1000000};
  const GLfloat one[] = {1.9f};
  glLoadIdentity(), glListBase(2), glCallLists(3, GL_2_BYTES, bytes);
  EXPECT_EQ(scale(), 32) << "lists 2 and 3; 258 is not there";
  glLoadIdentity(), glCallLists(2, GL_INT, back), glCallLists(1, GL_FLOAT, one);
  EXPECT_EQ(scale(), 16) << "lists 1 and 3";
  EXPECT_EQ(glGetError(), kNone);
}

TEST(Lists, MayRedefineAndCallThemselves) {
  OffScreen screen;
  glNewList(1, GL_COMPILE), glColor3f(1, 0, 0), glEndList();
  glNewList(1, GL_COMPILE_AND_EXECUTE), glCallList(1);
  EXPECT_EQ(color(), kRed) << "the old list stays until glEndList";
  glColor3f(0, 1, 0), glEndList(), glColor3f(0, 0, 1), glCallList(1);
  EXPECT_EQ(color(), kGreen) << "calls itself as deeply as lists may be nested";
  glDeleteLists(1, 1), glColor3f(0, 0, 1), glCallList(1);
  EXPECT_TRUE(color() == kBlue && !glIsList(1)) << "a list that is gone does nothing";
  EXPECT_EQ(glGetError(), kNone);
}

TEST(Errors, AreKeptUntilAskedFor) {
  OffScreen screen;
  glPointSize(0), glEnable(0), glEnd(), glPointSize(4);
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_VALUE)) << "the first one";
  EXPECT_EQ(glGetError(), kNone);
  EXPECT_EQ(get(GL_POINT_SIZE), 4) << "calls after an error work";
}

TEST(Strings, SayWhatThereIs) {
  OffScreen screen;
  const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
  EXPECT_FALSE(text(GL_VENDOR).empty() || text(GL_RENDERER).empty());
  EXPECT_TRUE(std::regex_match(text(GL_VERSION), std::regex("1\\.[1-5]( .*)?"))) << text(GL_VERSION);
  std::istringstream extensions(text(GL_EXTENSIONS));
  for (std::string name; extensions >> name;) EXPECT_TRUE(std::regex_match(name, std::regex("GL_[A-Z]+_\\w+"))) << name;
}

TEST(Functions, AreFoundByName) {
  std::ifstream file("/usr/include/GL/gl.h");
  std::stringstream text;
  text << file.rdbuf();
  const std::string declared = text.str().substr(0, text.str().find("OpenGL 1.2"));
  const std::regex call("GLAPIENTRY (gl\\w+)");
  int count = 0;
  for (std::sregex_iterator found(declared.begin(), declared.end(), call), end; found != end; ++found, ++count)
    EXPECT_NE(OSMesaGetProcAddress((*found)[1].str().c_str()), nullptr) << (*found)[1];
  for (const char* name : {"glNoSuchCall", "gl", "", "glob", "printf", "OSMesaNoSuchCall", "glBegin "})
    EXPECT_EQ(OSMesaGetProcAddress(name), nullptr) << name;
  if (count == 0) GTEST_SKIP() << "no system header";
  EXPECT_EQ(count, 336) << "functions of OpenGL 1.1";
}

TEST(Functions, SayToGlewThatThereIsADisplay) {
  const auto display = reinterpret_cast<const void* (*)()>(OSMesaGetProcAddress("glXGetCurrentDisplay"));
  const auto version = reinterpret_cast<int (*)(const void*, int*, int*)>(OSMesaGetProcAddress("glXQueryVersion"));
  ASSERT_TRUE(display && version);
  int major = 0, minor = 0;
  EXPECT_TRUE(display() && version(display(), &major, &minor));
  EXPECT_TRUE(major == 1 && minor == 2) << major << '.' << minor << ": with GLX 1.1, glewInit() fails";
}

TEST(Contexts, OnTwoThreadsAreIndependent) {
  const auto draw = [](float red, std::vector<GLubyte>* picture) {
    OffScreen screen;
    for (int k = 0; k < 200; ++k) {
      glClearColor(red, 0, 0, 1), glClear(GL_COLOR_BUFFER_BIT), glPointSize(1 + red);
      if (red > 0) glEnable(0);
      glNewList(1, GL_COMPILE), glColor3f(red, 1, 0), glEndList(), glCallList(1), glRectf(-1, -1, 0, 0);
      EXPECT_EQ(glGetError(), GLenum(red > 0 ? GL_INVALID_ENUM : GL_NO_ERROR));
      EXPECT_EQ(get(GL_POINT_SIZE), 1 + red);
    }
    *picture = screen.picture();
  };
  std::vector<GLubyte> black, red;
  std::thread one(draw, 0.0f, &black), two(draw, 1.0f, &red);
  one.join(), two.join();
  for (std::size_t i = 0; i < 256; ++i) {
    const GLubyte inside = i / 16 < 8 && i % 16 < 8 ? 255 : 0;
    EXPECT_TRUE(black[4 * i] == 0 && black[4 * i + 1] == inside && red[4 * i] == 255 && red[4 * i + 1] == inside) << i;
  }
  EXPECT_EQ(OSMesaGetCurrentContext(), nullptr);
}

}  // namespace
}  // namespace frontmost::test::state_test
