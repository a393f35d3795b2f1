#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_text.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <limits>

namespace firn {
namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

/// Little-endian, whatever this machine is.
std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

void add_facet_of_last_three(TriangleMesh& mesh, const std::string& name) {
  if (mesh.vertices.size() > std::size_t(std::numeric_limits<std::int32_t>::max())) {
    throw Error(ErrorKind::usage, name + ": more than 715827882 triangles");
  }
  const auto end = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.triangles.push_back({end - 3, end - 2, end - 1});
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  const std::size_t count = read_u32(bytes, 80);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vec3d x;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t offset = kHeaderBytes + t * kFacetBytes + 12 + corner * 12 + i * 4;
        x[static_cast<int>(i)] = static_cast<double>(std::bit_cast<float>(read_u32(bytes, offset)));
        if (!std::isfinite(x[static_cast<int>(i)])) {
          throw Error(ErrorKind::usage, fmt::format("{}: byte {}: {} of corner {} of triangle {} is not finite", name,
                                                    offset, "xyz"[i], corner + 1, t + 1));
        }
      }
      mesh.vertices.push_back(x);
    }
    add_facet_of_last_three(mesh, name);
  }
  return mesh;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

void expect(TextScanner& scanner, std::string_view wanted) {
  const std::string found = lower(scanner.word_across_lines(fmt::format("'{}'", wanted)));
  if (found != wanted) scanner.fail(fmt::format("expected '{}', got '{}'", wanted, shown_text(found)));
}

void parse_ascii_facet(TextScanner& scanner, TriangleMesh& mesh) {
  expect(scanner, "normal");
  // Normals follow from the corners; many programs write zeros or rubbish here, so they are not even parsed.
  for (int i = 0; i < 3; ++i) scanner.word_across_lines("a normal");
  expect(scanner, "outer");
  expect(scanner, "loop");
  for (int corner = 0; corner < 3; ++corner) {
    expect(scanner, "vertex");
    Vec3d x;
    for (int i = 0; i < 3; ++i) {
      const std::string what =
          fmt::format("{} of corner {} of triangle {}", "xyz"[i], corner + 1, mesh.triangles.size() + 1);
      x[i] = scanner.to_number(scanner.word_across_lines(what), what);
    }
    mesh.vertices.push_back(x);
  }
  expect(scanner, "endloop");
  expect(scanner, "endfacet");
}

TriangleMesh parse_ascii(std::string_view bytes, const std::string& name) {
  TextScanner scanner(bytes, name, TextScanner::Continuation::none);
  TriangleMesh mesh;
  while (scanner.next_line()) {
    std::string keyword = lower(scanner.word());
    if (keyword.empty()) continue;
    if (keyword != "solid") scanner.fail(fmt::format("expected 'solid', got '{}'", shown_text(keyword)));
    scanner.next_line();  // the rest of the line is a name
    for (keyword = lower(scanner.word_across_lines("'facet' or 'endsolid'")); keyword == "facet";
         keyword = lower(scanner.word_across_lines("'facet' or 'endsolid'"))) {
      parse_ascii_facet(scanner, mesh);
      add_facet_of_last_three(mesh, name);
    }
    if (keyword != "endsolid")
      scanner.fail(fmt::format("expected 'facet' or 'endsolid', got '{}'", shown_text(keyword)));
  }
  return mesh;
}

bool starts_like_ascii(std::string_view bytes) {
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return begin != std::string_view::npos && lower(bytes.substr(begin, 5)) == "solid";
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name) {
  // The size decides first: many binary files begin with "solid" too.
  const bool has_header = bytes.size() >= kHeaderBytes;
  const std::size_t wanted = has_header ? kHeaderBytes + kFacetBytes * read_u32(bytes, 80) : kHeaderBytes;
  TriangleMesh mesh;
  if (has_header && bytes.size() == wanted) {
    mesh = parse_binary(bytes, name);
  } else if (starts_like_ascii(bytes)) {
    mesh = parse_ascii(bytes, name);
  } else if (has_header && bytes.size() > wanted) {
    mesh = parse_binary(bytes, name);  // some programs append their own data
  } else {
    throw Error(ErrorKind::usage, fmt::format("{}: byte {}: a binary STL file of this header has {} bytes; the file is "
                                              "truncated or not STL",
                                              name, bytes.size(), wanted));
  }
  if (mesh.triangles.empty()) throw Error(ErrorKind::usage, name + ": the file has no triangles");
  merge_vertices(mesh);
  return mesh;
}

}  // namespace firn
