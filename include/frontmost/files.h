// SPDX-License-Identifier: Apache-2.0
// Files: models, images and environments in; images, models and tables out.
//
// Formats differ in what they hold and how they break; here they do not. A model of any format becomes a Scene that
// validate() passes, or an Error that names file, place and reason. A file that is written is there whole, or not at
// all: its bytes go to a temporary file beside it, which takes the name when it is whole.
#pragma once

#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/image.h"
#include "frontmost/scene.h"

namespace frontmost {

/// Decodes the images of textures in place of load(): formats that it does not know, or PNG, JPEG and WebP in a build
/// without libraries for them. Called from several threads at once. What it throws as Error becomes a warning of the
/// scene, and the texture is left out.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// Width and height of an image file, asked for before pixels() so that no memory goes to what is over a limit.
  [[nodiscard]] virtual glm::ivec2 size(std::span<const std::byte> file) const = 0;
  /// Width, height and pixels (sRGB or whatever the material takes them for; straight alpha; the first row on top).
  [[nodiscard]] virtual Texture pixels(std::span<const std::byte> file) const = 0;
};

struct LoadOptions {
  std::optional<ModelFormat> format;  ///< none: by suffix and, for memory and standard input, by content
  std::optional<Axis> up;             ///< none: the format's (z for STL and 3MF, y for the others) or the scene file's
  const ImageDecoder* image_decoder = nullptr;  ///< borrowed while it loads; none: PNG, JPEG and WebP
  /// Folders in which, or below which, scene files may name models and poses, besides their own folder.
  std::vector<std::string> allow_outside{};
};

/// Reads a model. "-" reads standard input, "builtin:NAME" makes a built-in scene. Files named inside a model
/// (material libraries, buffers, textures, the models of a scene file) are read only from its own folder and below, and
/// those of scene files also from LoadOptions::allow_outside. Triangle order and count are the file's. Memory while
/// reading is at most about twice the result. A model that lies far from zero for its size, as surveys do, gets a
/// Scene::origin: it is taken off while coordinates are still doubles, so that text and double formats lose nothing,
/// and files of floats nothing more. Positions, instances and cameras of the scene are about it; what is at p there is
/// at origin + p in the file. fitting_origin() says when and which. Whoever brings eyes, rays or points in the file's
/// coordinates takes it off first. Scene::source tells the format, the unit and the files that were read.
/// \throws Error file_unreadable, file_malformed, unsupported or limit_exceeded: "name: place: reason".
[[nodiscard]] Scene load(const std::string& path, const LoadOptions& options = {}, const Execution& execution = {});

/// Reads a model from memory; `name` stands for the file in messages. Files named inside it are not read.
/// The origin is as above.
[[nodiscard]] Scene load(std::span<const std::byte> bytes, const std::string& name, const LoadOptions& options = {},
                         const Execution& execution = {});

/// Gives objects the categories that a file names, in place of those that the scene has. It is JSON: "objects" has
/// names of objects, each with that of a category, and "categories" lists these as in a scene file: names, which are
/// numbered from 1, or objects with `name` and `number`; without the list there are those that objects name, in the
/// order of the objects' names. Objects of one name get one category, objects that are not named have none, and names
/// that no object has are told in Scene::warnings. "-" reads standard input. O(size of the file + objects). \throws
/// Error file_unreadable, file_malformed or limit_exceeded (64 MiB): "name: place: reason"; the scene stays as it is
/// then.
void load_categories(const std::string& path, Scene& scene);
/// The same from memory; `name` stands for the file in messages.
void load_categories(std::span<const std::byte> bytes, const std::string& name, Scene& scene);

enum class ImageFormat : std::uint8_t { png, exr, pfm, npy, jpeg, webp };

struct SaveOptions {
  std::optional<ImageFormat> format;  ///< none: by suffix; needed for "-"
  int bits = 8;                       ///< PNG: 8 or 16 for colours; ids and depths are always 16
  /// PNG of a depth channel: stored value = depth * scale, rounded. None: the seen range fills 1 to 65535.
  std::optional<double> depth_scale;
  int quality = 90;  ///< JPEG and WebP: 1 to 100; more is nearer to the picture, and larger
};

/// Nothing is seen at `path` before the file is whole, and a file that was there stays as it is when writing fails.
/// "-" writes standard output.
/// PNG takes colours (sRGB, straight alpha, without A where all is opaque), or one channel: luminance Y as 8-bit grey,
/// depth or id + 1 as 16-bit grey, 0 where nothing is seen, or N.X, N.Y, N.Z with 0 as the middle value. Text chunks
/// tell load_image() which. EXR takes any channels (floats as 32-bit float, ids as uint32). PFM takes one or three
/// float channels. NPY takes channels of one type, shape (height, width) or (height, width, channels). JPEG and WebP
/// take colours (sRGB; WebP with straight alpha, JPEG where all is opaque), which they change a little: what is read
/// back is within a few steps of 255 of what was saved, at quality 90 within 3 on the mean. The bytes do not depend on
/// the number of threads. \throws Error file_unwritable, unsupported (channels or alpha that the format cannot hold,
/// EXR or WebP in a build without it), limit_exceeded (id over 65534, depth over 65535 / depth_scale, JPEG over 65500
/// pixels a side, WebP over 16383), bad_argument (bits, quality).
void save(const Image& image, const std::string& path, const SaveOptions& options = {},
          const Execution& execution = {});

/// The same for a bitmap, which only PNG, JPEG and WebP take; the file is that of the image to the byte. Of the
/// options, only the format and the quality count.
void save(const Bitmap& bitmap, const std::string& path, const SaveOptions& options = {},
          const Execution& execution = {});

/// Writes a deep OpenEXR file (one part of type deepscanline, compression ZIPS, 32-bit floats and uint32), whatever the
/// name. \throws Error file_unwritable; bad_argument as validate() does; unsupported in a build without OpenEXR.
void save(const DeepImage& image, const std::string& path, const Execution& execution = {});

/// Writes text, such as an SVG drawing, with the same care: whole or not at all. \throws Error file_unwritable.
void save_text(std::string_view text, const std::string& path);

/// Reads a whole file, or "-", which is standard input, such as a list of points, without a UTF-8 byte order mark at
/// its start; the other bytes are not looked at.
/// \throws Error file_unreadable; limit_exceeded for more than `most_bytes`, which is found out without reading on, so
/// that a device or a pipe without an end does no harm.
[[nodiscard]] std::string load_text(const std::string& path, std::uint64_t most_bytes);

/// Reads PNG, EXR, PFM or NPY, told apart by content, as save() writes them; "-" reads standard input. PNGs that were
/// not written by save() give R, G, B, A: linear, premultiplied. PFM and NPY hold no names: one channel is read as Z or
/// (integers) primitive, three or four float channels as R, G, B, A, others as 0, 1, 2... Radiance pictures (.hdr) give
/// R, G, B as they are stored, whatever exposure they tell of.
/// \throws Error file_unreadable, file_malformed, unsupported, limit_exceeded (16384 pixels a side).
[[nodiscard]] Image load_image(const std::string& path);
/// Reads an image from memory; `name` stands for the file in messages.
[[nodiscard]] Image load_image(std::span<const std::byte> bytes, const std::string& name);

/// Reads the light that comes from all around: an equirectangular picture of any format that load_image() reads, above
/// all Radiance (.hdr) and OpenEXR. Rows go from straight up to straight down, columns once around to the right, as of
/// a Panorama. The result has the channels R, G, B and no others, as floats: linear light, 0 to max_environment_value.
/// Alpha is left aside; of a grey picture (Y) all three are the same. NaN and negative values are read as 0, infinity
/// as 65504, which is the greatest half float and what it was made of, and greater values as the greatest. \throws
/// Error as load_image() does; unsupported where there are no such channels, or where the picture is not twice as wide
/// as high: cubes and mirror balls are no environments.
[[nodiscard]] Image load_environment(const std::string& path);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] Image load_environment(std::span<const std::byte> bytes, const std::string& name);

/// The picture as text for a terminal, two pixels a character (half blocks, UTF-8), in 24-bit colours or those of the
/// 256-colour palette. Keeps its proportions and fits `columns` x `rows` characters; every line ends with a reset and a
/// line feed. Transparent parts show the terminal's background.
/// \throws Error bad_argument, or unsupported where there is no R, G, B.
[[nodiscard]] std::string terminal_picture(const Image& image, int columns, int rows, bool true_color = true);

// Tables of numbers, as files: a row for each thing, a column for each number that is known of it.
//
//   primitive,object,triangle,pixels        CSV: names, then a line for each row
//   0,0,0,12.5                              NPY: an array of records, whose fields are the columns
//   7,1,3,0.25

struct TableColumn {
  /// Letters, digits and underscores.
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint32_t>, std::vector<double>> values;

  [[nodiscard]] std::size_t size() const;
};

struct Table {
  std::vector<TableColumn> columns;  ///< all of one size

  /// How many; 0 without columns.
  [[nodiscard]] std::size_t row_count() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// \throws Error bad_argument for columns of different sizes and names that are empty or hold other characters.
void validate(const Table& table);

enum class TableFormat : std::uint8_t { csv, npy };

/// Writes a table, whole or not at all; "-" is standard output. CSV (RFC 4180, lines end in a line feed) has names in
/// its first line and numbers with as many digits as make the same number again. NPY is a structured array of one
/// dimension, little-endian, its fields packed: `numpy.load(path)["pixels"]` is a column.
/// O(rows x columns). \throws Error file_unwritable, and as validate() does.
void save(const Table& table, const std::string& path, TableFormat format);

// Models out: what a scene holds as a file that other programs read.
//
//   .ply   all objects as one mesh; numbers and colours of its faces
//   .stl   nothing but triangles
//   .glb   objects with their names and places, materials, textures

/// Writes the objects of a scene, whole or not at all, in the format that the suffix names. Triangles have the order of
/// primitive ids. Coordinates are those of the file that the scene came from (about its origin again); PLY is of
/// floats, and of doubles where the scene has an origin; STL of floats. PLY and STL wind the triangles of mirrored
/// objects the other way, so that what is outside stays outside. Curved primitives, cameras, lights and categories are
/// left out.
///
/// `of_triangles` are further properties of the faces in a PLY file, a row for every triangle: uchar, uint or double.
/// Columns of bytes that are named red, green and blue are the colours that viewers show.
///
/// GLB (glTF 2.0) has a node for each object, a mesh for each that is used, materials with the layers of glTF's
/// extensions, and textures as PNG. Its y is up: where another axis is, or the scene has an origin, a node above all
/// others turns and moves them. Vertices are those that corners need: one for each position, normal, colour and texture
/// coordinates that belong together. Triangles with corners that are not finite are left out, and so are normals of a
/// mesh of which one has no direction.
/// O(triangles log triangles) for GLB, O(triangles) for others. \throws Error file_unwritable; unsupported for another
/// suffix, or a table where the format is not PLY; bad_argument for a table that is not of the scene's triangles;
/// limit_exceeded for more than 2^32 - 2 vertices in PLY or 4 GiB in GLB; as validate(scene) does.
void save(const Scene& scene, const std::string& path, const Table& of_triangles = {});

}  // namespace frontmost
