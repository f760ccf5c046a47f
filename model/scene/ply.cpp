// PLY, ASCII and binary of both byte orders, with any properties; polygons become fans of triangles.
//
// Our own reader and no library: the only one packaged for our platform rounds ASCII coordinates wrongly in the last
// bit, which would change hits, and un-shares vertices. The format is small enough to be read strictly.
#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "model/base/error.h"
#include "model/scene/byte_cursor.h"
#include "model/scene/readers.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {
namespace {

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct Property {
  std::string name;
  Scalar type = Scalar::kFloat32;
  bool is_list = false;
  Scalar count_type = Scalar::kUint8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::size_t body_offset = 0;
};

constexpr const char* kDamaged = "the file is damaged: fetch or export it again";

std::uint64_t bytes_of(Scalar type) {
  switch (type) {
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kFloat64:
      return 8;
    default:
      return 4;
  }
}

Scalar scalar_named(std::string_view name, const TextCursor& text) {
  if (name == "char" || name == "int8") return Scalar::kInt8;
  if (name == "uchar" || name == "uint8") return Scalar::kUint8;
  if (name == "short" || name == "int16") return Scalar::kInt16;
  if (name == "ushort" || name == "uint16") return Scalar::kUint16;
  if (name == "int" || name == "int32") return Scalar::kInt32;
  if (name == "uint" || name == "uint32") return Scalar::kUint32;
  if (name == "float" || name == "float32") return Scalar::kFloat32;
  if (name == "double" || name == "float64") return Scalar::kFloat64;
  text.fail(fmt::format("unknown PLY type '{}'", name.substr(0, 40)), kDamaged);
}

Encoding encoding_named(std::string_view name, const TextCursor& text) {
  if (name == "ascii") return Encoding::kAscii;
  if (name == "binary_little_endian") return Encoding::kLittleEndian;
  if (name == "binary_big_endian") return Encoding::kBigEndian;
  text.fail(fmt::format("unknown PLY format '{}'", name.substr(0, 40)), kDamaged);
}

Property read_property(TextCursor& text) {
  Property property;
  std::string_view type = text.word("a type");
  if (type == "list") {
    property.is_list = true;
    property.count_type = scalar_named(text.word("the type of a list's length"), text);
    if (property.count_type == Scalar::kFloat32 || property.count_type == Scalar::kFloat64)
      text.fail("a list's length cannot be a floating-point number", kDamaged);
    type = text.word("the type of a list's items");
  }
  property.type = scalar_named(type, text);
  property.name = text.word("a property's name");
  return property;
}

Header read_header(const SourceFile& file) {
  TextCursor text(file);
  if (text.word("'ply'") != "ply") text.fail("is no PLY file: it does not start with 'ply'", "check the file's name");
  Header header;
  bool has_format = false;
  for (;;) {
    const std::string_view key = text.word("'end_header'");
    if (key == "end_header") break;
    if (key == "format") {
      header.encoding = encoding_named(text.word("a format"), text);
      has_format = true;
    } else if (key == "element") {
      Element element;
      element.name = text.word("an element's name");
      const std::int64_t count = text.integer("an element's count");
      if (count < 0) text.fail("an element's count is negative", kDamaged);
      element.count = static_cast<std::uint64_t>(count);
      header.elements.push_back(std::move(element));
    } else if (key == "property") {
      if (header.elements.empty()) text.fail("a property before any element", kDamaged);
      header.elements.back().properties.push_back(read_property(text));
    } else if (key != "comment" && key != "obj_info") {
      text.fail(fmt::format("unknown word '{}' in a PLY header", key.substr(0, 40)), kDamaged);
    }
    text.rest_of_line();
  }
  if (!has_format) text.fail("the header states no format", kDamaged);
  text.rest_of_line();
  if (text.peek() == '\n') text.skip(1);
  header.body_offset = text.offset();
  return header;
}

// The body as a sequence of scalars, the same for text and binary.
class AsciiBody {
 public:
  AsciiBody(const SourceFile& file, const Header& header) : text_(file, 0, header.body_offset) {}
  float real(Scalar) { return text_.number("a coordinate"); }
  std::int64_t integer(Scalar) { return text_.integer("an index or a list's length"); }
  void skip(Scalar, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) text_.word("a property");
  }
  std::string where() const { return text_.where().text(); }
  /// A character and the space behind it.
  static std::uint64_t least_bytes(Scalar) { return 2; }
  std::uint64_t bytes_left() const { return text_.bytes_left() + 1; }
  bool at_end() { return text_.at_end(); }

 private:
  TextCursor text_;
};

class BinaryBody {
 public:
  BinaryBody(const SourceFile& file, const Header& header)
      : bytes_(file, header.encoding == Encoding::kBigEndian, header.body_offset) {}

  float real(Scalar type) {
    if (type == Scalar::kFloat32) return bytes_.take<float>("a coordinate");
    if (type == Scalar::kFloat64) return static_cast<float>(bytes_.take<double>("a coordinate"));
    return static_cast<float>(integer(type));
  }
  std::int64_t integer(Scalar type) {
    constexpr const char* kWhat = "an index or a list's length";
    switch (type) {
      case Scalar::kInt8:
        return bytes_.take<std::int8_t>(kWhat);
      case Scalar::kUint8:
        return bytes_.take<std::uint8_t>(kWhat);
      case Scalar::kInt16:
        return bytes_.take<std::int16_t>(kWhat);
      case Scalar::kUint16:
        return bytes_.take<std::uint16_t>(kWhat);
      case Scalar::kInt32:
        return bytes_.take<std::int32_t>(kWhat);
      case Scalar::kUint32:
        return bytes_.take<std::uint32_t>(kWhat);
      default:
        throw Error(bytes_.where(), "an index or a list's length is a floating-point number", kDamaged);
    }
  }
  void skip(Scalar type, std::uint64_t count) {
    bytes_.expect(count, bytes_of(type), "items of a list");
    bytes_.skip(count * bytes_of(type), "a property");
  }
  std::string where() const { return bytes_.where(); }
  static std::uint64_t least_bytes(Scalar type) { return bytes_of(type); }
  std::uint64_t bytes_left() const { return bytes_.bytes_left(); }
  bool at_end() const { return bytes_.bytes_left() == 0; }

 private:
  ByteCursor bytes_;
};

template <class Body>
void check_count(const Body& body, const SourceFile& file, const Element& element) {
  std::uint64_t least = 0;
  for (const Property& p : element.properties) least += Body::least_bytes(p.is_list ? p.count_type : p.type);
  if (least != 0 && element.count > body.bytes_left() / least)
    throw Error(fmt::format("{}: element {}", file.path, element.name),
                fmt::format("the header states {} of them, but only {} bytes follow", element.count, body.bytes_left()),
                "the file is cut off or its header is damaged: fetch or export it again");
}

template <class Body>
std::uint64_t list_length(Body& body, const Property& property) {
  const std::int64_t length = body.integer(property.count_type);
  if (length < 0) throw Error(body.where(), "a list's length is negative", kDamaged);
  return static_cast<std::uint64_t>(length);
}

template <class Body>
void skip_property(Body& body, const Property& property) {
  body.skip(property.type, property.is_list ? list_length(body, property) : 1);
}

template <class Body>
void skip_element(Body& body, const Element& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const Property& property : element.properties) skip_property(body, property);
}

int axis_named(const Property& property) {
  if (property.is_list) return -1;
  return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

template <class Body>
void read_vertices(Body& body, const SourceFile& file, const Element& element, Draft& draft) {
  std::vector<int> axes;
  int seen = 0;
  for (const Property& property : element.properties) {
    axes.push_back(axis_named(property));
    if (axes.back() >= 0) seen |= 1 << axes.back();
  }
  if (seen != 7) throw Error(fmt::format("{}: element vertex", file.path), "has no x, y and z", kDamaged);
  draft.require_room(file.path, element.count, 0);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Vec3 vertex;
    for (std::size_t p = 0; p < axes.size(); ++p) {
      if (axes[p] < 0)
        skip_property(body, element.properties[p]);
      else if (!std::isfinite(vertex[axes[p]] = body.real(element.properties[p].type)))
        throw Error(fmt::format("{} (vertex {})", body.where(), i), "a coordinate is NaN, infinite or too large",
                    "repair the model before loading it");
    }
    draft.mesh.vertices.push_back(vertex);
  }
}

template <class Body>
void read_polygon(Body& body, const Property& list, std::uint64_t face, std::uint64_t base, std::uint64_t vertices,
                  Draft& draft) {
  const std::uint64_t corners = list_length(body, list);
  std::uint32_t first = 0, previous = 0;
  for (std::uint64_t c = 0; c < corners; ++c) {
    const std::int64_t index = body.integer(list.type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
      throw Error(fmt::format("{} (face {})", body.where(), face),
                  fmt::format("names vertex {}, but there are {}", index, vertices), kDamaged);
    const auto corner = static_cast<std::uint32_t>(base + static_cast<std::uint64_t>(index));
    if (c == 0) first = corner;
    if (c >= 2) draft.mesh.triangles.push_back({first, previous, corner});
    previous = corner;
  }
  if (corners < 3) draft.warn("ply: a face with fewer than three corners was skipped");
}

template <class Body>
void read_faces(Body& body, const SourceFile& file, const Element& element, std::uint64_t base, Draft& draft) {
  std::size_t list = 0;
  while (list < element.properties.size() && element.properties[list].name != "vertex_indices" &&
         element.properties[list].name != "vertex_index")
    ++list;
  if (list == element.properties.size() || !element.properties[list].is_list)
    throw Error(fmt::format("{}: element face", file.path), "has no list vertex_indices", kDamaged);
  const std::uint64_t vertices = draft.mesh.vertices.size() - base;
  draft.require_room(file.path, 0, element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (p == list)
        read_polygon(body, element.properties[p], i, base, vertices, draft);
      else
        skip_property(body, element.properties[p]);
    if (draft.mesh.triangles.size() > kMostTriangles) draft.require_room(file.path, 0, 1);
  }
}

template <class Body>
void read_body(Body body, const SourceFile& file, const Header& header, Draft& draft) {
  const std::uint64_t base = draft.mesh.vertices.size();
  bool has_vertices = false, has_faces = false;
  for (const Element& element : header.elements) {
    check_count(body, file, element);
    if (element.name == "vertex" && !has_vertices) {
      read_vertices(body, file, element, draft);
      has_vertices = true;
    } else if (element.name == "face" && has_vertices && !has_faces) {
      read_faces(body, file, element, base, draft);
      has_faces = true;
    } else {
      skip_element(body, element);
    }
  }
  if (!has_vertices || !has_faces)
    throw Error(file.path, "has no elements 'vertex' and 'face', in this order",
                "point clouds and triangle strips are not read: export a mesh of faces");
  if (!body.at_end()) draft.warn(fmt::format("{}: bytes after the last element are ignored", file.path));
}

}  // namespace

void read_ply(const SourceFile& file, Draft& draft) {
  draft.add_format("ply");
  append_ply(file, draft);
}

void append_ply(const SourceFile& file, Draft& draft) {
  const Header header = read_header(file);
  if (header.encoding == Encoding::kAscii)
    read_body(AsciiBody(file, header), file, header, draft);
  else
    read_body(BinaryBody(file, header), file, header, draft);
}

}  // namespace ctu::scene
