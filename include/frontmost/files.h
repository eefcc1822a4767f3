// SPDX-License-Identifier: Apache-2.0
// Files: reading models, images and environments; writing images, models and tables.
//
// Formats differ in what they hold and in how files break; the results of this header do not. A model of any format
// becomes a Scene that validate() accepts, or an Error that names the file, the place and the reason. Output files are
// written whole or not at all: the bytes go to a temporary file beside the target, which is renamed at the end.
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

/// Decodes texture images in place of load(), for formats that load() does not know, or in a build without the
/// libraries for PNG, JPEG and WebP. Several threads may call a decoder at once. If it throws an Error, the scene gets
/// a warning, and the texture is left out.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// \returns the width and height of an image file. Called before pixels(), so that oversized images take no memory.
  [[nodiscard]] virtual glm::ivec2 size(std::span<const std::byte> file) const = 0;
  /// \returns width, height and pixels, with straight alpha and the first row on top. Values are as stored: sRGB for
  /// colours, or what the material expects.
  [[nodiscard]] virtual Texture pixels(std::span<const std::byte> file) const = 0;
};

/// How models are read whose formats take the program frontmost-import: STEP, IGES, BREP and foreign meshes. It runs as
/// a process of its own, which ends with load(), also when load() is cancelled.
struct ImportOptions {
  /// Curved surfaces: greatest distance of the triangles from the surface, in millimetres; 0: 0.05 % of the diagonal.
  double tolerance = 0;
  double angle = 0.20943951023931953;  ///< radians between the normals of neighbouring triangles, above 0; 12 degrees
  double seconds = 600;                ///< greatest time, above 0
  std::uint64_t bytes = std::uint64_t(8) << 30;  ///< greatest size of the process's memory
  /// Whether a copy of a STEP, IGES or BREP file and its triangles are kept in $XDG_CACHE_HOME/frontmost/import (else
  /// ~/.cache/frontmost/import), and taken from there the next time. The folder holds 1 GiB at most; the entries used
  /// least recently are deleted first.
  bool cache = true;
};

struct LoadOptions {
  std::optional<ModelFormat> format;  ///< none: found by suffix, or by content if the suffix names no format
  /// None: by the scene file or foreign file, or by format: z for STL, 3MF, STEP, IGES and BREP, y for others.
  std::optional<Axis> up;
  const ImageDecoder* image_decoder = nullptr;  ///< borrowed during load(); null: PNG, JPEG, WebP only
  /// Further folders in or below which a scene file may name models and poses. Its own folder needs no entry.
  std::vector<std::string> allow_outside{};
  ImportOptions import{};
};

/// Reads a model from a file; "-" is standard input, "builtin:NAME" a built-in scene. Keeps the file's triangle count
/// and order. A file that the model names (material libraries, buffers, textures, models of scene files) must be in the
/// model's folder or below, or, for scene files, in LoadOptions::allow_outside. A model that lies far from zero for its
/// size gets a Scene::origin (see fitting_origin()), which is subtracted in doubles: point p of the scene is origin + p
/// in the file. Callers subtract the origin from eyes, rays and points that are in the file's coordinates.
/// Scene::source holds the format, the unit and the files read. Memory while reading: about twice the result at most.
/// frontmost-import is the program that FRONTMOST_IMPORT names, or the one beside this program, or the installed one.
/// \throws Error file_unreadable, file_malformed, unsupported or limit_exceeded: "name: place: reason".
[[nodiscard]] Scene load(const std::string& path, const LoadOptions& options = {}, const Execution& execution = {});

/// Reads a model from memory, and sets the origin in the same way; `name` stands for the file in messages. Files that
/// the model names are not read.
[[nodiscard]] Scene load(std::span<const std::byte> bytes, const std::string& name, const LoadOptions& options = {},
                         const Execution& execution = {});

/// Replaces the categories of a scene by those of a JSON file; "-" is standard input. "objects" maps names of objects
/// to names of categories. "categories" lists the categories as in a scene file: names, numbered from 1, or objects
/// with `name` and `number`. Without this list, categories are in the order of the objects' names. All objects of one
/// name get one category; objects that the file does not name have none. The scene gets a warning for each name that no
/// object has. O(size of the file + objects).
/// \throws Error file_unreadable, file_malformed or limit_exceeded (64 MiB): "name: place: reason". After an error the
/// scene is unchanged.
void load_categories(const std::string& path, Scene& scene);
/// Reads the categories from memory; `name` stands for the file in messages.
void load_categories(std::span<const std::byte> bytes, const std::string& name, Scene& scene);

// Images out. What each format holds:
//
//   PNG         colours (sRGB, straight alpha, without A if all is opaque), or one map: luminance Y as 8-bit grey;
//               depth or id + 1 as 16-bit grey, 0 where nothing is seen; or N.X, N.Y, N.Z with 0 as the middle value.
//               Text chunks tell load_image() which.
//   EXR         any channels: floats as 32-bit float, ids as uint32
//   PFM         one or three float channels
//   NPY         channels of one type, shape (height, width) or (height, width, channels)
//   JPEG, WebP  colours (sRGB; WebP with straight alpha, JPEG only if all is opaque). Values read back differ by a few
//               steps of 255, at quality 90 by at most 3 on average.

enum class ImageFormat : std::uint8_t { png, exr, pfm, npy, jpeg, webp };

struct SaveOptions {
  std::optional<ImageFormat> format;  ///< none: by suffix; required for "-"
  int bits = 8;                       ///< PNG: 8 or 16 for colours; ids and depths always have 16
  /// For a PNG of depths: stored value = depth * scale, rounded. None: the visible range of depths fills 1 to 65535.
  std::optional<double> depth_scale;
  int quality = 90;  ///< JPEG and WebP: 1 to 100; higher is closer to the picture, and larger
};

/// Writes an image; "-" is standard output. An existing file at `path` is replaced when the new file is complete, and
/// stays if writing fails. The bytes do not depend on the number of threads.
/// \throws Error file_unwritable; unsupported for channels or alpha that the format cannot hold, and for EXR or WebP in
/// a build without it; limit_exceeded for ids above 65534 and depths above 65535 / depth_scale in PNG, and for width or
/// height above 65500 pixels in JPEG or 16383 in WebP; bad_argument for `bits` or `quality` out of range.
void save(const Image& image, const std::string& path, const SaveOptions& options = {},
          const Execution& execution = {});

/// Writes a bitmap as PNG, JPEG or WebP. The file has the same bytes as for the Image of the same picture. Of the
/// options, only the format and the quality are used.
void save(const Bitmap& bitmap, const std::string& path, const SaveOptions& options = {},
          const Execution& execution = {});

/// Writes a deep OpenEXR file, whatever the suffix of `path`: one part of type deepscanline, with ZIPS compression,
/// 32-bit floats and uint32. \throws Error file_unwritable; bad_argument as validate() does; unsupported in a build
/// without OpenEXR.
void save(const DeepImage& image, const std::string& path, const Execution& execution = {});

/// Writes text, such as an SVG drawing, whole or not at all. \throws Error file_unwritable.
void save_text(std::string_view text, const std::string& path);

/// Reads a whole file, such as a list of points; "-" is standard input. Removes a UTF-8 byte order mark at the start
/// and does not check the other bytes.
/// \throws Error file_unreadable; limit_exceeded for more than `most_bytes`. Reading stops at the limit, so endless
/// devices and pipes do no harm.
[[nodiscard]] std::string load_text(const std::string& path, std::uint64_t most_bytes);

/// Reads PNG, EXR, PFM and NPY as save() writes them, and Radiance (.hdr), recognised by content; "-" is standard
/// input. PNG files that save() did not write give R, G, B, A, linear and premultiplied. PFM and NPY files hold no
/// channel names. One channel is read as Z, or, if it holds integers, as primitive; three or four float channels are
/// read as R, G, B, A; any others as 0, 1, 2... Radiance pictures give R, G, B as stored, whatever exposure the file
/// states.
/// \throws Error file_unreadable, file_malformed, unsupported, limit_exceeded (16384 pixels a side).
[[nodiscard]] Image load_image(const std::string& path);
/// Reads an image from memory; `name` stands for the file in messages.
[[nodiscard]] Image load_image(std::span<const std::byte> bytes, const std::string& name);

/// Reads an environment: an equirectangular picture of any format that load_image() reads, mostly Radiance (.hdr) or
/// OpenEXR. Rows go from straight up to straight down, columns once around to the right, as in a Panorama. The result
/// has float channels R, G, B: linear light, 0 to max_environment_value. Alpha is ignored; a grey picture (Y) gives
/// three equal channels. NaN and negative values are read as 0. Infinity, an overflow of half floats, is read as 65504,
/// the greatest half float. Values above max_environment_value are read as the maximum.
/// \throws Error as load_image() does; unsupported without such channels, or if the picture is not twice as wide as
/// high: cube maps and mirror balls are not environments.
[[nodiscard]] Image load_environment(const std::string& path);
/// Reads an environment from memory; `name` stands for the file in messages.
[[nodiscard]] Image load_environment(std::span<const std::byte> bytes, const std::string& name);

/// \returns the picture as text for a terminal, with two pixels a character (half blocks, UTF-8), in 24-bit colours or
/// in those of the 256-colour palette. The text fits into `columns` x `rows` characters and keeps the picture's
/// proportions; every line ends with a reset of colours and a line feed. Transparent parts show the terminal's
/// background.
/// \throws Error bad_argument; unsupported for an image without R, G, B.
[[nodiscard]] std::string terminal_picture(const Image& image, int columns, int rows, bool true_color = true);

// Tables of numbers, as files: a row for each item, a column for each of its numbers.
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

  /// Number of rows; 0 without columns.
  [[nodiscard]] std::size_t row_count() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// \throws Error bad_argument for columns of different sizes, and names that are empty or contain other characters.
void validate(const Table& table);

enum class TableFormat : std::uint8_t { csv, npy };

/// Writes a table, whole or not at all; "-" is standard output. CSV (RFC 4180, lines end in a line feed) has the names
/// in its first line, and enough digits to restore each number exactly. NPY is a structured array of one dimension,
/// little-endian, with packed fields: `numpy.load(path)["pixels"]` is a column.
/// O(rows x columns). \throws Error file_unwritable, and as validate() does.
void save(const Table& table, const std::string& path, TableFormat format);

// Models out. What each format holds:
//
//   .ply   all objects as one mesh, with numbers and colours of faces; floats, or doubles if the scene has an origin
//   .stl   triangles alone, as floats
//   .glb   glTF 2.0: a node for each object, a mesh for each one in use, normals, colours and texture coordinates,
//          materials with the layers of glTF's extensions, textures as PNG. Vertices are shared if all of their data
//          agree. A root node turns and moves the model if its up axis is not y, or the scene has an origin.

/// Writes the objects of a scene, whole or not at all, in the format that the suffix names. Triangles keep the order of
/// primitive ids; coordinates are the source file's, with the scene's origin added. PLY and STL reverse the winding of
/// mirrored objects, so that outsides stay outside. GLB omits triangles with non-finite corners, and the normals of a
/// mesh if one of them has no direction. Curved primitives, cameras, lights and categories are left out. `of_triangles`
/// has further properties of PLY faces, one row for each triangle: uchar, uint or double; byte columns named red, green
/// and blue are colours. O(triangles), for GLB O(triangles log triangles). \throws Error file_unwritable; unsupported
/// for other suffixes, or a table without PLY; bad_argument for a table that does not fit the triangles; limit_exceeded
/// above 2^32 - 2 vertices in PLY or 4 GiB in GLB; as validate(scene) does.
void save(const Scene& scene, const std::string& path, const Table& of_triangles = {});

}  // namespace frontmost
