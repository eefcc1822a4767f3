// SPDX-License-Identifier: Apache-2.0
// MTL describes the Phong model of 1990 and, by later convention, metallic and roughness, too. Colours are read as
// sRGB, as most programs that write and read these files do.
#include "io/models/obj/mtl.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/models/mesh_building.h"
#include "io/models/reader.h"
#include "io/models/text.h"
#include "io/models/textures.h"

namespace frontmost {
namespace {

class MtlReader {
 public:
  MtlReader(Bytes bytes, const ModelSource& library, const std::string& folder, TextureFiles& textures,
            NamedMaterials& materials)
      : text_(bytes, library, TextScanner::Comments::hash),
        folder_(folder),
        textures_(textures),
        materials_(materials) {}

  void read() {
    do {
      const std::string_view word = text_.word();
      if (word == "newmtl") {
        finish_material();
        number_ = materials_.define(name_of(text_.rest()));
      } else if (number_ != no_index) {
        statement(word);
      }
    } while (text_.next_line());
    finish();
  }

 private:
  Material& material() { return materials_[number_]; }

  void statement(std::string_view word) {
    if (word == "Kd") {
      const glm::vec3 c = color();
      material().base_color = glm::vec4(c, material().base_color.a);
    } else if (word == "Ke") {
      material().emissive = color();
    } else if (word == "d") {
      set_alpha(value());
    } else if (word == "Tr") {
      set_alpha(1 - value());
    } else if (word == "Ns") {
      // The roughness whose highlight is as wide as that of the Blinn-Phong exponent.
      material().roughness = std::sqrt(2 / (2 + std::max(value(), 0.0f)));
    } else if (word == "Pr") {
      material().roughness = unit(value());
    } else if (word == "Pm") {
      material().metallic = unit(value());
    } else {
      texture_statement(word);
    }
  }

  void texture_statement(std::string_view word) {
    if (word == "map_Kd") {
      maps_[number_].color = read_map();
    } else if (word == "map_d") {
      if (!text_.at_line_end()) maps_[number_].alpha = read_map();  // some exporters leave it empty
    } else if (word == "map_Ke") {
      material().emissive_texture = texture();
      glowing_.push_back(number_);
    } else if (word == "norm") {
      material().normal_texture = texture();
    }
  }

  /// Reads a number. Exporters write "nan" for materials without a value, which is no reason to refuse the model.
  float value() {
    float value = 0;
    if (text_.next_is('-')) skip_option();
    if (!text_.number(value)) text_.fail("a number was expected");
    return std::isfinite(value) ? value : 0;
  }
  /// Skips an option, as in "d -halo 0.5", unless the word is a negative number.
  void skip_option() {
    float value = 0;
    // A copy of the scanner looks ahead, so that a number can still be read.
    TextScanner ahead = text_;
    if (!ahead.number(value)) text_.word();
  }
  static float unit(float value) { return std::clamp(value, 0.0f, 1.0f); }

  void set_alpha(float alpha) {
    material().base_color.a = unit(alpha);
    if (alpha < 1) material().alpha = Material::Alpha::blend;
  }

  /// Reads a colour; one number stands for three. Spectral curves and CIE colours are not supported and give white.
  glm::vec3 color() {
    glm::vec4 srgb(1);
    if (text_.number(srgb.r)) {
      srgb.g = srgb.b = srgb.r;
      if (text_.number(srgb.g)) srgb.b = srgb.g, (void)text_.number(srgb.b);
    }
    return glm::vec3(linear_color(srgb));
  }

  struct Map {
    TextureUse use;
    Texture::Wrap wrap = Texture::Wrap::repeat;
    std::string file;  ///< empty: no map
  };
  struct BaseMaps {
    Map color, alpha;  ///< map_Kd, map_d
  };

  /// Reads "[-option values]... file name".
  Map read_map() {
    Map map;
    glm::vec2 scale(1), offset(0);
    while (text_.next_is('-')) {
      const std::string_view option = text_.word();
      if (option == "-s") {
        scale = pair(1);
      } else if (option == "-o") {
        offset = pair(0);
      } else if (option == "-clamp") {
        if (text_.word() == "on") map.wrap = Texture::Wrap::clamp;
        // Turbulence is not used, but its numbers must not become the file's name.
      } else if (option == "-t") {
        pair(0);
      } else if (option == "-mm") {
        text_.word();
        text_.word();
      } else {
        text_.word();
      }
    }
    const std::string file(text_.rest());
    if (file.empty()) text_.fail("a file name was expected");
    map.file = folder_.empty() ? file : folder_ + "/" + file;
    // v points up in the file: v' = s v + o there is v' = s v + (1 - s - o) here.
    map.use.scale = scale;
    map.use.offset = {offset.x, 1 - scale.y - offset.y};
    return map;
  }

  MadeTexture made(const TextureParts& parts) { return textures_.get(parts, "material " + printable(material().name)); }
  TextureUse texture() {
    Map map = read_map();
    map.use.texture = made({map.file, {}, map.wrap}).texture;
    return map.use;
  }

  /// Reads up to three numbers and returns the first two.
  glm::vec2 pair(float missing) {
    glm::vec3 values(missing);
    for (int k = 0; k < 3; ++k)
      if (!text_.number(values[k])) break;
    return {values.x, values.y};
  }

  /// Combines the colour and alpha maps to one texture, with the options of map_Kd if there is one, else of map_d.
  ///
  /// MTL multiplies Kd and the texture. But exporters write a default grey or black Kd beside a texture that is meant
  /// unchanged, so Kd only counts if it has a hue. A black Kd also becomes white if the texture cannot be read, and so
  /// does a black Ke.
  void finish_material() {
    const auto found = maps_.find(number_);
    if (found == maps_.end()) return;
    const BaseMaps& maps = found->second;
    const bool is_colored = !maps.color.file.empty();
    const Map& map = is_colored ? maps.color : maps.alpha;
    Material& m = material();
    const MadeTexture texture = made({maps.color.file, maps.alpha.file, map.wrap});
    m.base_color_texture = map.use;
    m.base_color_texture.texture = texture.texture;
    if (m.alpha == Material::Alpha::opaque) m.alpha = texture.alpha;
    glm::vec4& c = m.base_color;
    const bool is_grey = c.r == c.g && c.g == c.b, is_black = glm::vec3(c) == glm::vec3(0);
    if (is_colored && (is_black || (is_grey && texture.has_color))) c = glm::vec4(1, 1, 1, c.a);
  }

  void finish() {
    finish_material();
    for (const std::uint32_t number : glowing_) {
      Material& m = materials_[number];
      if (m.emissive == glm::vec3(0)) m.emissive = glm::vec3(1);
      if (!m.emissive_texture.is_set())
        lose_emissive_texture(m, "material " + printable(m.name), materials_.warnings());
    }
  }

  TextScanner text_;
  const std::string& folder_;
  TextureFiles& textures_;
  NamedMaterials& materials_;
  std::uint32_t number_ = no_index;
  std::map<std::uint32_t, BaseMaps> maps_;  ///< by number of the material
  std::vector<std::uint32_t> glowing_;      ///< materials with a map_Ke
};

}  // namespace

std::uint32_t NamedMaterials::number(const std::string& name) {
  const auto [entry, is_new] = numbers_.try_emplace(name, std::uint32_t(scene_.materials.size()));
  if (is_new) {
    if (scene_.materials.size() >= max_objects) source_.fail_limit("material " + printable(name), "too many materials");
    scene_.materials.emplace_back().name = name;
    is_defined_.push_back(false);
  }
  return entry->second;
}

std::uint32_t NamedMaterials::define(const std::string& name) {
  const std::uint32_t number = this->number(name);
  is_defined_[number] = true;
  return number;
}

void NamedMaterials::finish() {
  std::size_t undefined = 0, first = 0;
  for (std::size_t i = is_defined_.size(); i-- > 0;)
    if (!is_defined_[i]) ++undefined, first = i;
  if (undefined > 0)
    scene_.warnings.push_back("usemtl " + in_quotes(scene_.materials[first].name) + ": " + std::to_string(undefined) +
                              (undefined == 1 ? " material is" : " materials are") +
                              " not defined by any library that was read");
}

void read_mtl(Bytes bytes, const ModelSource& library, const std::string& folder, TextureFiles& textures,
              NamedMaterials& materials) {
  MtlReader(bytes, library, folder, textures, materials).read();
}

}  // namespace frontmost
