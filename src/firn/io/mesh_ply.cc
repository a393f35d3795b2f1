#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_text.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace firn {
namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct ScalarName {
  std::string_view name;
  Scalar scalar;
};

constexpr ScalarName kScalarNames[] = {
    {"char", Scalar::int8},      {"int8", Scalar::int8},       {"uchar", Scalar::uint8},
    {"uint8", Scalar::uint8},    {"short", Scalar::int16},     {"int16", Scalar::int16},
    {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},   {"int", Scalar::int32},
    {"int32", Scalar::int32},    {"uint", Scalar::uint32},     {"uint32", Scalar::uint32},
    {"float", Scalar::float32},  {"float32", Scalar::float32}, {"double", Scalar::float64},
    {"float64", Scalar::float64}};

std::size_t size_of(Scalar scalar) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(scalar)];
}

struct Property {
  std::string name;
  Scalar scalar;
  std::optional<Scalar> count;  ///< of a list: the type of its length
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
};

Scalar read_scalar(TextScanner& scanner) {
  const std::string_view word = scanner.word();
  for (const ScalarName& entry : kScalarNames) {
    if (entry.name == word) return entry.scalar;
  }
  scanner.fail(fmt::format("unknown PLY type '{}'", shown_text(word)));
}

Format read_format(TextScanner& scanner) {
  const std::string_view word = scanner.word();
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little_endian;
  if (word == "binary_big_endian") return Format::big_endian;
  scanner.fail(fmt::format("unknown PLY format '{}'", shown_text(word)));
}

/// Names stand in messages, and two of one name would leave open which is meant.
template <class Named>
std::string read_name(TextScanner& scanner, const std::vector<Named>& before, std::string_view what) {
  const std::string name(scanner.word());
  if (name.empty()) scanner.fail(fmt::format("the name of the {} is missing", what));
  if (std::ranges::any_of(name, is_control))
    scanner.fail(fmt::format("'{}' is no name of a PLY {}", shown_text(name), what));
  if (std::ranges::find(before, name, &Named::name) != before.end()) {
    scanner.fail(fmt::format("the {} '{}' is declared twice", what, name));
  }
  return name;
}

Element read_element(TextScanner& scanner, const std::vector<Element>& before) {
  Element element;
  element.name = read_name(scanner, before, "element");
  const std::int64_t count = scanner.integer("number of elements");
  if (count < 0) scanner.fail(fmt::format("number of elements must not be negative, got {}", count));
  element.count = static_cast<std::size_t>(count);
  return element;
}

Property read_property(TextScanner& scanner, const std::vector<Property>& before) {
  Property property;
  // Only `list` is not a type, and looking ahead needs no more than a copy of the scanner.
  TextScanner ahead = scanner;
  if (ahead.word() == "list") {
    scanner = ahead;
    property.count = read_scalar(scanner);
    if (*property.count == Scalar::float32 || *property.count == Scalar::float64) {
      scanner.fail("the length of a list cannot be a floating-point number");
    }
  }
  property.scalar = read_scalar(scanner);
  property.name = read_name(scanner, before, "property");
  return property;
}

/// Reads up to and with end_header.
Header read_header(TextScanner& scanner) {
  Header header;
  bool has_format = false;
  if (!scanner.next_line() || scanner.word() != "ply") scanner.fail("a PLY file starts with the line 'ply'");
  while (scanner.next_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "format") {
      header.format = read_format(scanner);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(scanner, header.elements));
    } else if (keyword == "property") {
      if (header.elements.empty()) scanner.fail("a property before the first element");
      std::vector<Property>& properties = header.elements.back().properties;
      properties.push_back(read_property(scanner, properties));
    } else if (keyword == "end_header") {
      if (!has_format) scanner.fail("the header has no line 'format'");
      return header;
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      scanner.fail(fmt::format("unknown word '{}' in the PLY header", shown_text(keyword)));
    }
  }
  scanner.fail("the header has no line 'end_header'; the file seems truncated");
}

/// Where the values of the body come from. Every type fits into a double exactly.
class Values {
 public:
  virtual ~Values() = default;
  virtual double next(Scalar scalar, std::string_view what) = 0;
  /// Throws at the value that was read last.
  [[noreturn]] virtual void fail(const std::string& message) const = 0;
  /// No more values than this can follow.
  virtual std::size_t most_left() const = 0;
};

class TextValues final : public Values {
 public:
  TextValues(TextScanner scanner, std::size_t bytes) : scanner_(std::move(scanner)), bytes_(bytes) {}

  double next(Scalar scalar, std::string_view what) override {
    const std::string_view word = scanner_.word_across_lines(what);
    const bool real = scalar == Scalar::float32 || scalar == Scalar::float64;
    return real ? scanner_.to_number(word, what) : static_cast<double>(scanner_.to_integer(word, what));
  }
  void fail(const std::string& message) const override { scanner_.fail(message); }
  std::size_t most_left() const override { return bytes_; }

 private:
  TextScanner scanner_;
  std::size_t bytes_;
};

class BinaryValues final : public Values {
 public:
  BinaryValues(std::string_view bytes, std::size_t offset, const std::string& name, bool big_endian)
      : bytes_(bytes), offset_(offset), name_(name), big_endian_(big_endian) {}

  double next(Scalar scalar, std::string_view what) override {
    const std::size_t size = size_of(scalar);
    if (bytes_.size() - offset_ < size) {
      throw Error(ErrorKind::usage, fmt::format("{}: byte {}: the file ends where {} should follow; it seems truncated",
                                                name_, bytes_.size(), what));
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto byte = static_cast<unsigned char>(bytes_[offset_ + (big_endian_ ? i : size - 1 - i)]);
      bits = bits << 8 | byte;
    }
    last_ = offset_;
    offset_ += size;
    return decode(scalar, bits);
  }

  void fail(const std::string& message) const override {
    throw Error(ErrorKind::usage, fmt::format("{}: byte {}: {}", name_, last_, message));
  }
  std::size_t most_left() const override { return bytes_.size() - offset_; }

 private:
  static double decode(Scalar scalar, std::uint64_t bits) {
    switch (scalar) {
      case Scalar::int8:
        return static_cast<std::int8_t>(bits);
      case Scalar::uint8:
        return static_cast<std::uint8_t>(bits);
      case Scalar::int16:
        return static_cast<std::int16_t>(bits);
      case Scalar::uint16:
        return static_cast<std::uint16_t>(bits);
      case Scalar::int32:
        return static_cast<std::int32_t>(bits);
      case Scalar::uint32:
        return static_cast<std::uint32_t>(bits);
      case Scalar::float32:
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      case Scalar::float64:
        return std::bit_cast<double>(bits);
    }
    return 0;
  }

  std::string_view bytes_;
  std::size_t offset_;
  std::size_t last_ = 0;
  std::string name_;
  bool big_endian_;
};

class PlyBody {
  static constexpr std::size_t kNotAnAxis = std::string_view::npos;

 public:
  /// @param attribute property of the vertices to keep besides x, y, z; may be empty
  PlyBody(const Header& header, Values& values, std::string_view attribute)
      : header_(header), values_(values), attribute_(attribute) {
    for (const Element& element : header.elements) {
      if (element.name == "vertex") vertex_count_ = element.count;
    }
  }

  PaintedMesh read() {
    for (const Element& element : header_.elements) {
      if (element.name == "vertex" && element.count > std::size_t(std::numeric_limits<std::int32_t>::max())) {
        values_.fail(fmt::format("{} vertices; the most possible is 2147483647", element.count));
      }
      // An element without properties takes no bytes, whatever its count says.
      if (element.properties.empty()) continue;
      for (std::size_t i = 0; i < element.count; ++i) read_one(element, i);
    }
    return {std::move(mesh_), std::move(painted_)};
  }

 private:
  void read_one(const Element& element, std::size_t index) {
    Vec3d x = {};
    for (const Property& property : element.properties) {
      if (property.count) {
        read_list(element, property, index);
        continue;
      }
      const bool is_vertex = element.name == "vertex";
      const double value = values_.next(property.scalar, property.name);
      const std::size_t axis = property.name.size() == 1 ? std::string_view("xyz").find(property.name) : kNotAnAxis;
      const bool is_attribute = is_vertex && !attribute_.empty() && property.name == attribute_;
      if (!is_attribute && (!is_vertex || axis == kNotAnAxis)) continue;
      if (!std::isfinite(value)) values_.fail(fmt::format("{} of vertex {} is not finite", property.name, index));
      if (axis != kNotAnAxis) x[static_cast<int>(axis)] = value;
      if (is_attribute) painted_.push_back(value);
    }
    if (element.name == "vertex") mesh_.vertices.push_back(x);
  }

  void read_list(const Element& element, const Property& property, std::size_t index) {
    const double length = values_.next(*property.count, "the length of " + property.name);
    if (length < 0 || length > static_cast<double>(values_.most_left())) {
      values_.fail(fmt::format("the list {} has the impossible length {}", property.name, length));
    }
    const bool is_face =
        element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
    corners_.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(length); ++i) {
      const double value = values_.next(property.scalar, property.name);
      if (!is_face) continue;
      if (value < 0 || value >= static_cast<double>(vertex_count_) || value != std::floor(value)) {
        values_.fail(
            fmt::format("face {} refers to vertex {}, the file has {} (counted from 0)", index, value, vertex_count_));
      }
      corners_.push_back(static_cast<std::int32_t>(value));
    }
    if (!is_face) return;
    if (corners_.size() < 3)
      values_.fail(fmt::format("face {} needs at least 3 corners, got {}", index, corners_.size()));
    add_fan(corners_.data(), corners_.size(), mesh_);
  }

  const Header& header_;
  Values& values_;
  std::size_t vertex_count_ = 0;
  TriangleMesh mesh_;
  std::string_view attribute_;
  std::vector<double> painted_;
  std::vector<std::int32_t> corners_;
};

void check_header(const Header& header, const std::string& name) {
  const auto has = [&](std::string_view element, std::string_view property) {
    for (const Element& e : header.elements) {
      if (e.name != element) continue;
      for (const Property& p : e.properties) {
        if (p.name == property && (element == "face") == p.count.has_value()) return true;
      }
    }
    return false;
  };
  for (const char* axis : {"x", "y", "z"}) {
    if (!has("vertex", axis))
      throw Error(ErrorKind::usage, fmt::format("{}: the vertices have no property {}", name, axis));
  }
  if (!has("face", "vertex_indices") && !has("face", "vertex_index")) {
    throw Error(ErrorKind::usage,
                name + ": the file has no faces with a list vertex_indices; export triangles, not points");
  }
}

void check_attribute(const Header& header, const std::string& name, const std::string& attribute) {
  std::string known;
  for (const Element& element : header.elements) {
    if (element.name != "vertex") continue;
    for (const Property& property : element.properties) {
      if (property.count) continue;
      if (property.name == attribute) return;
      known += (known.empty() ? "" : ", ") + property.name;
    }
  }
  throw Error(ErrorKind::usage,
              fmt::format("{}: the vertices have no property \"{}\"; they have {}", name, attribute, known));
}

/// The part of the file that is text: the header, and the body of an ascii file.
std::string_view text_part(std::string_view bytes) {
  const std::size_t end = bytes.find("end_header");
  if (end == std::string_view::npos) return bytes;
  const std::string_view header = bytes.substr(0, end);
  if (header.find("format ascii") != std::string_view::npos) return bytes;
  const std::size_t newline = bytes.find('\n', end);
  return bytes.substr(0, newline == std::string_view::npos ? bytes.size() : newline + 1);
}

}  // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& name) {
  return parse_painted_ply(bytes, name, "").mesh;
}

PaintedMesh parse_painted_ply(std::string_view bytes, const std::string& name, const std::string& attribute) {
  TextScanner scanner(text_part(bytes), name, TextScanner::Continuation::none);
  const Header header = read_header(scanner);
  check_header(header, name);
  if (!attribute.empty()) check_attribute(header, name, attribute);
  PaintedMesh painted;
  if (header.format == Format::ascii) {
    scanner.next_line();
    TextValues values(scanner, bytes.size());
    painted = PlyBody(header, values, attribute).read();
  } else {
    BinaryValues values(bytes, scanner.offset_after_line(), name, header.format == Format::big_endian);
    painted = PlyBody(header, values, attribute).read();
  }
  if (painted.mesh.vertices.empty()) throw Error(ErrorKind::usage, name + ": the file has no vertices");
  if (painted.mesh.triangles.empty()) throw Error(ErrorKind::usage, name + ": the file has no faces");
  return painted;
}

}  // namespace firn
