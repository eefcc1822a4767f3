// SPDX-License-Identifier: Apache-2.0
// The vertices of a batch, a vector at a time: clip coordinates, light, texture coordinates, fog, out codes and places
// in the window.
//
// Clip coordinates come from one product of matrices, whatever else is on, so that the same vertices have the same
// depths in every pass.

#include "scene/turn.h"
#include "vertex/batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vertex/transform_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"
#include "vertex/powers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A vector of points or directions in each of three coordinates; of colors without alpha.
struct Vec3 {
  VF x, y, z;
};
HWY_INLINE Vec3 AllOf(const glm::vec3& v) { return {All(v.x), All(v.y), All(v.z)}; }
HWY_INLINE Vec3 Plus(const Vec3& a, const Vec3& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE Vec3 Minus(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 Times(const Vec3& a, VF f) { return {hn::Mul(a.x, f), hn::Mul(a.y, f), hn::Mul(a.z, f)}; }
HWY_INLINE Vec3 Times(const Vec3& a, const Vec3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE VF Dot(const Vec3& a, const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
/// Vectors of length 1; zero vectors stay zero.
HWY_INLINE Vec3 Unit(const Vec3& v) {
  const VF length = hn::Sqrt(Dot(v, v));
  return Times(v, hn::Div(All(1), hn::Max(length, All(1e-30f))));
}
HWY_INLINE VF Clamped(VF v) { return hn::Min(hn::Max(v, hn::Zero(DF())), All(1)); }

/// Four coordinates.
struct Vec4 {
  VF c[4];
};
HWY_INLINE VF Dot(const glm::vec4& p, const Vec4& v) {
  VF sum = hn::Add(hn::Mul(All(p.x), v.c[0]), hn::Mul(All(p.y), v.c[1]));
  sum = hn::Add(sum, hn::Mul(All(p.z), v.c[2]));
  return hn::Add(sum, hn::Mul(All(p.w), v.c[3]));
}
HWY_INLINE Vec4 Transformed(const glm::mat4& m, const Vec4& v) {
  Vec4 to;
  for (int r = 0; r < 4; ++r) to.c[r] = Dot(glm::vec4(m[0][r], m[1][r], m[2][r], m[3][r]), v);
  return to;
}

/// One enabled light, as far as it does not depend on the vertex.
struct EyeLight {
  glm::vec3 ambient, diffuse, specular;
  bool is_near;        ///< at a place, not in a direction
  glm::vec3 place;     ///< or the direction to the light, of length 1
  glm::vec3 half_way;  ///< between that direction and the viewer's, if neither depends on the vertex
  glm::vec3 attenuation;
  bool is_spot;
  glm::vec3 spot;
  float spot_cosine, spot_exponent;
};

[[nodiscard]] inline glm::vec3 UnitOf(const glm::vec3& v) {
  const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return length > 0 ? v / length : v;
}

class VertexLighting {
 public:
  explicit VertexLighting(const DrawState& d) : d_(d) {
    const State& s = d.state;
    for (int i = 0; i < kLights; ++i) {
      if (!s.capabilities.has(Capability::light0, i)) continue;
      const LightState& l = s.lighting.lights[std::size_t(i)];
      EyeLight to{glm::vec3(l.ambient),
                  glm::vec3(l.diffuse),
                  glm::vec3(l.specular),
                  l.position.w != 0,
                  glm::vec3(l.position),
                  glm::vec3(0),
                  l.attenuation,
                  l.spot_cutoff != 180,
                  UnitOf(l.spot_direction),
                  0,
                  l.spot_exponent};
      to.place = to.is_near ? to.place / l.position.w : UnitOf(to.place);
      to.half_way = UnitOf(to.place + glm::vec3(0, 0, 1));
      if (to.is_spot) to.spot_cosine = float(turn_of_degrees(double(l.spot_cutoff)).x);
      lights_.push_back(to);
    }
  }

  /// Lights vertices i and those after it: writes the colors of the front, or of the back.
  HWY_INLINE void LightVertices(Batch& batch, std::size_t i, const Vec3& eye, const Vec3& normal, int face,
                                const MaterialState& material) const {
    const DF df;
    const LightingState& s = d_.state.lighting;
    Vec3 ambient = AllOf(glm::vec3(s.model_ambient)), diffuse = AllOf(glm::vec3(0)), specular = diffuse;
    for (const auto& l : lights_) {
      Vec3 to_light = AllOf(l.place);
      VF strength = All(1);
      if (l.is_near) {
        to_light = Minus(to_light, eye);
        const VF distance = hn::Sqrt(Dot(to_light, to_light));
        to_light = Times(to_light, hn::Div(All(1), hn::Max(distance, All(1e-30f))));
        if (l.attenuation != glm::vec3(1, 0, 0)) {
          VF sum = hn::Add(All(l.attenuation.y), hn::Mul(All(l.attenuation.z), distance));
          sum = hn::Add(All(l.attenuation.x), hn::Mul(sum, distance));
          strength = hn::Div(All(1), hn::Max(sum, All(1e-30f)));
        }
      }
      if (l.is_spot) {
        const VF cosine = hn::Neg(Dot(to_light, AllOf(l.spot)));
        const VF beam = Power(hn::Max(cosine, hn::Zero(df)), All(l.spot_exponent));
        strength = hn::IfThenElseZero(hn::Ge(cosine, All(l.spot_cosine)), hn::Mul(strength, beam));
      }
      ambient = Plus(ambient, Times(AllOf(l.ambient), strength));
      const VF facing = hn::Max(Dot(normal, to_light), hn::Zero(df));
      diffuse = Plus(diffuse, Times(AllOf(l.diffuse), hn::Mul(strength, facing)));
      if (material.specular.r == 0 && material.specular.g == 0 && material.specular.b == 0 &&
          !Tracks(face, GL_SPECULAR))
        continue;
      Vec3 half = AllOf(l.half_way);
      if (l.is_near || s.local_viewer) {
        const Vec3 to_viewer =
            s.local_viewer ? Unit({hn::Neg(eye.x), hn::Neg(eye.y), hn::Neg(eye.z)}) : AllOf({0, 0, 1});
        half = Unit(Plus(to_light, to_viewer));
      }
      const VF shine = Power(hn::Max(Dot(normal, half), hn::Zero(df)), All(material.shininess));
      const auto lit = hn::Gt(facing, hn::Zero(df));
      specular = Plus(specular, Times(AllOf(l.specular), hn::IfThenElseZero(lit, hn::Mul(strength, shine))));
    }
    const Vec4 color{{hn::LoadU(df, batch.input(kRed) + i), hn::LoadU(df, batch.input(kGreen) + i),
                      hn::LoadU(df, batch.input(kBlue) + i), hn::LoadU(df, batch.input(kAlpha) + i)}};
    const Vec3 vertex{color.c[0], color.c[1], color.c[2]};
    const auto of_material = [&](GLenum what, const glm::vec4& constant)
                                 HWY_ATTR { return Tracks(face, what) ? vertex : AllOf(glm::vec3(constant)); };
    Vec3 sum =
        Plus(of_material(GL_EMISSION, material.emission), Times(ambient, of_material(GL_AMBIENT, material.ambient)));
    sum = Plus(sum, Times(diffuse, of_material(GL_DIFFUSE, material.diffuse)));
    specular = Times(specular, of_material(GL_SPECULAR, material.specular));
    if (!d_.has_secondary) sum = Plus(sum, specular);
    const VF alpha = Tracks(face, GL_DIFFUSE) ? color.c[3] : All(material.diffuse.a);
    const int at = face == 0 ? kOutRed : kOutBack;
    Store(batch, at, i, sum);
    hn::StoreU(Clamped(alpha), df, batch.output(at + 3) + i);
    if (d_.has_secondary) Store(batch, at + 4, i, specular);
  }

 private:
  /// Whether glColorMaterial makes this color of the material follow the vertex's color.
  [[nodiscard]] bool Tracks(int face, GLenum what) const {
    const LightingState& s = d_.state.lighting;
    if (!d_.state.capabilities.has(Capability::color_material)) return false;
    if (s.color_material_face != GL_FRONT_AND_BACK && s.color_material_face != GLenum(face == 0 ? GL_FRONT : GL_BACK))
      return false;
    if (s.color_material_mode == GL_AMBIENT_AND_DIFFUSE) return what == GL_AMBIENT || what == GL_DIFFUSE;
    return s.color_material_mode == what;
  }
  static HWY_INLINE void Store(Batch& batch, int varying, std::size_t i, const Vec3& color) {
    hn::StoreU(Clamped(color.x), DF(), batch.output(varying) + i);
    hn::StoreU(Clamped(color.y), DF(), batch.output(varying + 1) + i);
    hn::StoreU(Clamped(color.z), DF(), batch.output(varying + 2) + i);
  }

  const DrawState& d_;
  std::vector<HWY_NAMESPACE::EyeLight> lights_;
};

class VertexStage {
 public:
  explicit VertexStage(Batch& batch) : b_(batch), d_(*batch.state), lighting_(*batch.state) {}

  void Run() {
    std::size_t first = 0;
    const std::array<MaterialState, 2>* materials = &d_.state.lighting.materials;
    for (std::size_t run = 0; run <= b_.material_runs.size(); ++run) {
      const auto end = std::size_t(run < b_.material_runs.size() ? b_.material_runs[run].first : b_.vertex_count);
      for (std::size_t i = first; i < end; i += hn::Lanes(DF())) Vertices(i, *materials);
      if (run < b_.material_runs.size()) materials = &b_.material_runs[run].materials;
      first = end;
    }
  }

 private:
  [[nodiscard]] HWY_INLINE VF Input(int attribute, std::size_t i) const {
    return hn::LoadU(DF(), b_.input(attribute) + i);
  }
  HWY_INLINE void Output(VF v, int varying, std::size_t i) { hn::StoreU(v, DF(), b_.output(varying) + i); }

  HWY_INLINE void Vertices(std::size_t i, const std::array<MaterialState, 2>& materials) {
    const Vec4 object{{Input(kX, i), Input(kY, i), Input(kZ, i), Input(kW, i)}};
    Place(Transformed(d_.clip_from_object, object), i);
    Vec4 eye{};
    if (d_.needs_eye) eye = Transformed(d_.eye_from_object, object);
    Vec3 normal{};
    if (d_.needs_normal) {
      const Vec3 n{Input(kNormalX, i), Input(kNormalY, i), Input(kNormalZ, i)};
      const glm::mat3& m = d_.normal_matrix;
      normal = {Dot(AllOf({m[0][0], m[1][0], m[2][0]}), n), Dot(AllOf({m[0][1], m[1][1], m[2][1]}), n),
                Dot(AllOf({m[0][2], m[1][2], m[2][2]}), n)};
      if (d_.state.capabilities.has(Capability::normalize)) normal = Unit(normal);
    }
    // Light is computed at the place in space, not at homogeneous coordinates.
    Vec3 place{eye.c[0], eye.c[1], eye.c[2]};
    if (d_.is_lit) {
      if (!hn::AllTrue(DF(), hn::Eq(eye.c[3], All(1)))) {
        const auto finite = hn::Ne(eye.c[3], hn::Zero(DF()));
        place = Times(place, hn::IfThenElse(finite, hn::Div(All(1), eye.c[3]), All(1)));
      }
      lighting_.LightVertices(b_, i, place, normal, 0, materials[0]);
      const Vec3 away{hn::Neg(normal.x), hn::Neg(normal.y), hn::Neg(normal.z)};
      if (d_.is_two_sided) lighting_.LightVertices(b_, i, place, away, 1, materials[1]);
    } else {
      for (int k = 0; k < 4; ++k) Output(Clamped(Input(kRed + k, i)), kOutRed + k, i);
      for (int k = 0; d_.has_secondary && k < 3; ++k) Output(Clamped(Input(kRed2 + k, i)), kOutRed2 + k, i);
    }
    if (d_.has_fog)
      Output(d_.state.fog.coord_source == GL_FOG_COORDINATE ? Input(kFogCoord, i) : hn::Abs(eye.c[2]), kOutFog, i);
    for (const BoundTexture& t : d_.textures) TexCoords(t.unit, i, object, eye, normal);
    for (int k = 0; k < kClipPlanes; ++k)
      if (d_.clip_planes >> k & 1)
        Output(Dot(glm::vec4(d_.state.transform.clip_planes[std::size_t(k)]), eye), kOutClip + k, i);
    AddUserCodes(i);
  }

  HWY_INLINE void Place(const Vec4& clip, std::size_t i) {
    const DI di;
    const DF df;
    for (int k = 0; k < 4; ++k) hn::StoreU(clip.c[k], df, b_.clip(k) + i);
    const VF zero = hn::Zero(df), w = clip.c[3];
    // A coordinate that is not a number is outside of every plane.
    VI code = hn::Zero(di);
    const auto outside = [&](hn::Mask<DF> inside, int bit) HWY_ATTR {
      code = hn::Or(code, hn::IfThenZeroElse(hn::RebindMask(di, inside), hn::Set(di, bit)));
    };
    const VF from_near = hn::Add(clip.c[2], w);
    outside(hn::Or(hn::Gt(from_near, zero), hn::And(hn::Ge(from_near, zero), hn::Gt(w, zero))), 1);
    outside(hn::Le(clip.c[2], w), 2);
    for (int k = 0; k < 4; ++k) {
      const int axis = k / 2;
      const VF from_plane = hn::Add(hn::Mul(All(d_.guard[std::size_t(k)][axis]), clip.c[axis]),
                                    hn::Mul(All(d_.guard[std::size_t(k)].w), w));
      outside(hn::Ge(from_plane, zero), 4 << k);
    }
    hn::StoreU(code, di, b_.out_codes() + i);
    const auto any = hn::RebindMask(df, hn::Eq(code, hn::Zero(di)));
    const VF inverse = hn::Div(All(1), hn::IfThenElse(any, w, All(1)));
    hn::StoreU(inverse, df, b_.inverse_w() + i);
    const auto window = [&](int axis) HWY_ATTR {
      const VF ndc = hn::Mul(hn::IfThenElseZero(any, clip.c[axis]), inverse);
      return hn::Add(hn::Mul(ndc, All(d_.window_scale[axis])), All(d_.window_offset[axis]));
    };
    hn::StoreU(hn::NearestInt(window(0)), di, b_.place(0) + i);
    hn::StoreU(hn::NearestInt(window(1)), di, b_.place(1) + i);
    hn::StoreU(Clamped(window(2)), df, b_.window_z() + i);
  }

  HWY_INLINE void AddUserCodes(std::size_t i) {
    if (d_.clip_planes == 0) return;
    const DI di;
    VI code = hn::LoadU(di, b_.out_codes() + i);
    for (int k = 0; k < kClipPlanes; ++k)
      if (d_.clip_planes >> k & 1) {
        const auto inside = hn::Ge(hn::LoadU(DF(), b_.output(kOutClip + k) + i), hn::Zero(DF()));
        code = hn::Or(code, hn::IfThenZeroElse(hn::RebindMask(di, inside), hn::Set(di, 64 << k)));
      }
    hn::StoreU(code, di, b_.out_codes() + i);
  }

  HWY_INLINE void TexCoords(int unit, std::size_t i, const Vec4& object, const Vec4& eye, const Vec3& normal) {
    const TextureUnitState& u = d_.state.texture.units[std::size_t(unit)];
    Vec4 coord{{Input(kTexCoord + 4 * unit, i), Input(kTexCoord + 4 * unit + 1, i), Input(kTexCoord + 4 * unit + 2, i),
                Input(kTexCoord + 4 * unit + 3, i)}};
    for (int k = 0; k < 4; ++k)
      if (u.generates[k]) coord.c[k] = Generated(u.generated[k], k, object, eye, normal);
    if (d_.has_texture_matrix[std::size_t(unit)]) coord = Transformed(d_.texture_matrix[std::size_t(unit)], coord);
    const int at = kOutTexCoord + 3 * unit;
    Output(coord.c[0], at, i);
    Output(coord.c[1], at + 1, i);
    Output(coord.c[3], at + 2, i);
  }

  [[nodiscard]] HWY_NOINLINE VF Generated(const TexGenState& gen, int axis, const Vec4& object, const Vec4& eye,
                                          const Vec3& n) const {
    switch (gen.mode) {
      case GL_OBJECT_LINEAR: return Dot(gen.object_plane, object);
      case GL_EYE_LINEAR: return Dot(gen.eye_plane, eye);
      case GL_NORMAL_MAP: return axis == 0 ? n.x : axis == 1 ? n.y : n.z;
      default: break;
    }
    const Vec3 u = Unit({eye.c[0], eye.c[1], eye.c[2]});
    const Vec3 r = Minus(u, Times(n, hn::Mul(All(2), Dot(n, u))));
    const VF along = axis == 0 ? r.x : axis == 1 ? r.y : r.z;
    if (gen.mode == GL_REFLECTION_MAP) return along;
    const Vec3 m{r.x, r.y, hn::Add(r.z, All(1))};
    const VF length = hn::Mul(All(2), hn::Sqrt(Dot(m, m)));
    return hn::Add(hn::Div(along, hn::Max(length, All(1e-30f))), All(0.5f));
  }

  Batch& b_;
  const DrawState& d_;
  VertexLighting lighting_;
};

void TransformVertices(Batch& batch) { VertexStage(batch).Run(); }

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::gl_detail {

FRONTMOST_KERNELS(TransformVertices);

void transform_vertices(Batch& batch, Isa isa) { kernel_for(TransformVerticesKernels, isa)(batch); }

}  // namespace frontmost::gl_detail
#endif  // HWY_ONCE
